#pragma once
#include <functional>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "protocol/frame.hpp"
#include "protocol/traffic.hpp"
#include "server/service.hpp"
#include "tests/service/fake_renderer.hpp"
#include "tests/service/raw_client.hpp"

namespace limn::server::testing {

/// Everything these tests say and hear is held against the schema.
protocol::TrafficRecorder& traffic();

/// A service with a fake renderer behind it, on a free port of the loopback.
class TestService {
 public:
  struct Options {
    FakeRenderer::Options renderer;
    std::function<void(ServiceConfig&)> configure = [](ServiceConfig&) {};
    bool ready = true;
    std::vector<protocol::ClientMessage> kept = {};   ///< by a journal
  };
  TestService() : TestService(Options{}) {}
  explicit TestService(const Options& options);
  ~TestService();

  uint16_t port() const { return service->port(); }
  /// The value of a metric; nothing when the connection was refused or there is none.
  std::optional<double> tryMetric(const std::string& name) const;
  /// The same; fails the test when there is none.
  double metric(const std::string& name) const;
  /// Asks until the metric has the value; fails the test when patience ends.
  void waitForMetric(const std::string& name, double value) const;

  Mailbox mailbox;
  FrameSlot frames;
  StatusQueue replies;
  std::unique_ptr<Service> service;
  std::unique_ptr<FakeRenderer> renderer;
  std::thread loop;
};

/// A well-behaved client, in so far as the test wants it to be.
class TestClient {
 public:
  struct Picture {
    protocol::FrameHeader header;
    std::vector<uint8_t> payload;
  };

  explicit TestClient(uint16_t port, int receiveBuffer = 0) {
    socket.connect(port, receiveBuffer);
    EXPECT_EQ(socket.upgrade(port), 101);
  }
  /// Says hello and waits for the answer.
  protocol::ServerHello greet(std::optional<bool> watch = std::nullopt,
                              std::optional<std::vector<protocol::Encoding>> encodings = std::nullopt);
  uint32_t nextSeq() { return ++m_seq; }
  void send(const protocol::ClientMessage& message);
  /// Sends bytes that the schema would not allow.
  void sendWrong(std::string_view bytes) { EXPECT_TRUE(socket.sendText(bytes)); }
  void acknowledge(uint32_t frameId);

  /// Reads on until a text message of this kind comes; pictures and other messages are kept or dropped on the way.
  template <class T>
  T await() { return await<T>([](const T&) { return true; }); }
  template <class T>
  T await(const std::function<bool(const T&)>& wanted) {
    while (step())
      if (text)
        if (const T* message = std::get_if<T>(&*text); message && wanted(*message)) return *message;
    ADD_FAILURE() << "no message \"" << T::kOp << "\" came";
    return {};
  }
  /// The answer of this kind to a seq.
  template <class T>
  T awaitReply(uint32_t seq) { return await<T>([seq](const T& m) { return m.seq == seq; }); }
  Picture awaitPicture(const std::function<bool(const protocol::FrameHeader&)>& wanted = [](const auto&) {
    return true;
  });

  /// Reads one message into `text` or `picture`; false at the end of the connection.
  bool step();

  RawClient socket;
  bool acknowledges = true;            ///< every picture, as soon as it is read
  std::optional<protocol::ServerMessage> text;
  std::optional<Picture> picture;
  uint16_t closeCode = 0;
  uint32_t picturesSeen = 0, longestFragment = 0;

 private:
  uint32_t m_seq = 0;
};

/// 8-bit RGB of a PNG or JPEG, width*height*3.
std::vector<uint8_t> decodeImage(const std::vector<uint8_t>& bytes, protocol::Encoding encoding, uint32_t& width,
                                 uint32_t& height);

/// "#/materials/0/roughness = value" as a message.
protocol::SetMessage setRoughness(uint32_t seq, uint32_t material, float roughness);
protocol::SetCamera moveCamera(uint32_t seq, double x);

}  // namespace limn::server::testing
