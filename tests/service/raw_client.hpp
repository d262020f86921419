#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limn::server::testing {

/// A WebSocket or HTTP peer that can also misbehave: every byte is under the test's control. Blocking, one thread.
class RawClient {
 public:
  static constexpr double kPatience = 20.0;  ///< [s] the longest any read waits; a test that hits it fails
  enum class Opcode : uint8_t { continuation = 0, text = 1, binary = 2, close = 8, ping = 9, pong = 10 };

  struct Message {
    Opcode opcode = Opcode::text;
    std::string payload;
    uint16_t closeCode() const;
    uint32_t fragments = 1;
    size_t longestFragment = 0;
  };
  struct Reply {
    int status = 0;                          ///< 0: the connection was closed without an answer
    std::map<std::string, std::string> headers;  ///< names in lower case
    std::string body;
  };

  RawClient() = default;
  explicit RawClient(uint16_t port, int receiveBuffer = 0) { connect(port, receiveBuffer); }
  ~RawClient() { shut(); }
  RawClient(RawClient&& other) noexcept;
  RawClient(const RawClient&) = delete;

  void connect(uint16_t port, int receiveBuffer = 0);
  bool connected() const { return m_socket >= 0; }
  void shut();
  void reset();                              ///< closes with RST
  bool sendBytes(std::string_view bytes);    ///< false when the peer has gone

  Reply readReply(bool head = false);
  /// "GET / HTTP/1.1" and the headers given, each "Name: value".
  Reply request(const std::string& line, std::vector<std::string> headers = {});
  /// A good handshake for `port`, with `replace`d or added headers; an empty value leaves the header out.
  static std::string handshake(uint16_t port, const std::map<std::string, std::string>& replace = {},
                               const std::string& path = "/ws");
  /// Status of the answer to a handshake; 101 when the socket is open.
  int upgrade(uint16_t port, const std::map<std::string, std::string>& replace = {}, const std::string& path = "/ws");

  bool sendFrame(Opcode opcode, std::string_view payload, bool fin = true, bool mask = true);
  bool sendText(std::string_view text) { return sendFrame(Opcode::text, text); }
  /// The next whole message or close frame; pings are answered. Nothing when the connection ended or patience did.
  std::optional<Message> receive(double patience = kPatience);
  /// Reads until the peer closes; the close code, 0 without a close frame.
  uint16_t waitForClose();
  bool timedOut() const { return m_timedOut; }

 private:
  bool fill(double deadline);
  bool need(size_t bytes, double deadline);
  std::string take(size_t bytes);

  int m_socket = -1;
  std::string m_buffer;
  bool m_timedOut = false;
};

std::string frameBytes(RawClient::Opcode opcode, std::string_view payload, bool fin, bool mask);

}  // namespace limn::server::testing
