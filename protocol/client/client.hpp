#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "protocol/frame.hpp"
#include "protocol/messages.gen.hpp"
#include "protocol/traffic.hpp"

namespace limn::protocol {

/// A binary message as it came, its header, length and CRC checked.
struct ReceivedFrame {
  std::vector<uint8_t> message;
  FrameHeader header;
  double receivedAt = 0.0;  ///< nowSeconds() of its last byte
  std::span<const uint8_t> payload() const { return std::span(message).subspan(kFrameHeaderBytes); }
};
struct ReceivedMessage {
  ServerMessage message;
  std::string json;
  double receivedAt = 0.0;
};
/// The connection has ended; nothing comes after it.
struct Closed {
  uint16_t code = 1006;     ///< of the server's close frame; 1005: it had none; 1006: there was no close frame
  std::string reason;
};
/// Something came that the protocol does not allow.
struct Broken { Error error; };
using Event = std::variant<ReceivedMessage, ReceivedFrame, Closed, Broken>;

/// When image frames are acknowledged.
enum class FrameAcks {
  onArrival,  ///< by the client itself, at once
  manual      ///< by the caller's AckFrame messages; the server holds back meanwhile
};

struct ClientOptions {
  std::string url;              ///< "ws://127.0.0.1:8080/ws"; see parseServerUrl
  std::string token;            ///< sent as Authorization: Bearer; empty: none
  std::string origin;           ///< Origin header; empty: none, as programs do
  std::string subprotocol{kSubprotocol};
  FrameAcks acks = FrameAcks::onArrival;
  bool newestFrameOnly = false; ///< an image frame that nobody has taken yet gives way to a newer one
  double connectSeconds = 10.0;
  TrafficRecorder* recorder = nullptr;  ///< sees every message both ways, but for sendText; outlives the client
};

/// One connection to limnd, used from one thread; a thread of its own serves the socket. Messages wait in a queue until they
/// are taken.
class Client {
 public:
  /// Connects and upgrades; says no hello yet. Errors: "bad-message" (address), "io" (refused, and why).
  static Result<std::unique_ptr<Client>> connect(const ClientOptions& options);
  /// connect, then hello; the server's hello is kept in serverHello().
  static Result<std::unique_ptr<Client>> greet(const ClientOptions& options, ClientHello hello = {});
  ~Client();

  /// Sends; a seq of 0 is replaced by the next one, and should be: acknowledgements on arrival take numbers too. Returns the seq.
  uint32_t send(ClientMessage message);
  /// Sends text as it is, for tests of what a server refuses.
  void sendText(std::string text);
  void sendBinary(std::vector<uint8_t> bytes);

  /// The oldest event that was not taken yet; nothing when none comes within `seconds`. After Closed, always Closed.
  std::optional<Event> nextEvent(double seconds);
  /// Waits for an answer to `seq`: the message of type T, or the error that the server sent as an Error. Other events stay in
  /// the queue. Error "io" when the connection ends or `seconds` are over.
  template <class T>
  Result<T> answer(uint32_t seq, double seconds = 10.0);
  /// send, then answer.
  template <class T>
  Result<T> request(ClientMessage message, double seconds = 10.0) {
    return answer<T>(send(std::move(message)), seconds);
  }
  /// Waits for an image frame that shows the edit `seq` (header.ackSeq at or after it); drops older ones.
  Result<ReceivedFrame> frameShowing(uint32_t seq, double seconds = 10.0);
  /// Waits for the file that answers the save `seq`.
  Result<ReceivedFrame> file(uint32_t seq, double seconds = 60.0);

  const ServerHello& serverHello() const { return m_hello; }
  /// Stops and resumes reading from the socket, as a slow reader would.
  void setReading(bool reading);
  /// Begins the closing handshake; Closed follows.
  void close(uint16_t code = kCloseNormal);

 private:
  class Socket;
  explicit Client(std::unique_ptr<Socket> socket);
  using Wanted = bool (*)(const Event&, uint32_t seq);
  Result<Event> take(Wanted wanted, uint32_t seq, double seconds);

  std::unique_ptr<Socket> m_socket;
  ServerHello m_hello;
};

/// The seq that a message of the server answers; 0 when it answers none.
uint32_t answeredSeq(const ServerMessage& message);

template <class T>
Result<T> Client::answer(uint32_t seq, double seconds) {
  const auto wanted = [](const Event& event, uint32_t s) {
    const auto* received = std::get_if<ReceivedMessage>(&event);
    if (!received || answeredSeq(received->message) != s) return false;
    return std::holds_alternative<T>(received->message) || std::holds_alternative<ErrorMessage>(received->message);
  };
  Result<Event> event = take(wanted, seq, seconds);
  if (!event) return event.error();
  ServerMessage& message = std::get<ReceivedMessage>(*event).message;
  if (auto* error = std::get_if<ErrorMessage>(&message)) return Error{error->code, error->message, error->place.value_or("")};
  return std::move(std::get<T>(message));
}

}  // namespace limn::protocol
