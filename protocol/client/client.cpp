#include "protocol/client/client.hpp"

#include "protocol/client/socket.hpp"
#include "renderer/base/clock.hpp"

namespace limn::protocol {

Client::Client(std::unique_ptr<Socket> socket) : m_socket(std::move(socket)) {}
Client::~Client() = default;

Result<std::unique_ptr<Client>> Client::connect(const ClientOptions& options) {
  Result<ServerUrl> url = parseServerUrl(options.url);
  if (!url) return url.error();
  auto socket = std::make_unique<Socket>(options, url.take());
  if (const Result<void> opened = socket->open(); !opened) return opened.error();
  return std::unique_ptr<Client>(new Client(std::move(socket)));
}

Result<std::unique_ptr<Client>> Client::greet(const ClientOptions& options, ClientHello hello) {
  Result<std::unique_ptr<Client>> connected = connect(options);
  if (!connected) return connected.error();
  hello.version = kVersion;
  if (hello.client.empty()) hello.client = "limn";
  Result<ServerHello> reply = (*connected)->request<ServerHello>(std::move(hello), options.connectSeconds);
  if (!reply) return reply.error();
  (*connected)->m_hello = reply.take();
  return connected;
}

uint32_t Client::send(ClientMessage message) { return m_socket->send(std::move(message)); }

void Client::sendText(std::string text) { m_socket->push({false, {text.begin(), text.end()}}); }

void Client::sendBinary(std::vector<uint8_t> bytes) { m_socket->push({true, std::move(bytes)}); }

std::optional<Event> Client::nextEvent(double seconds) {
  return m_socket->take(seconds, [](const Event&) { return true; });
}

Result<Event> Client::take(Wanted wanted, uint32_t seq, double seconds) {
  std::optional<Event> event = m_socket->take(seconds, [&](const Event& candidate) {
    return std::holds_alternative<Broken>(candidate) || wanted(candidate, seq);
  });
  if (!event) return Error{"io", "the server did not answer in time", "seq " + std::to_string(seq)};
  if (const auto* broken = std::get_if<Broken>(&*event)) return broken->error;
  if (const auto* closed = std::get_if<Closed>(&*event))
    return Error{"io", "the connection was closed with " + std::to_string(closed->code) + " " + closed->reason, ""};
  return std::move(*event);
}

Result<ReceivedFrame> Client::frameShowing(uint32_t seq, double seconds) {
  const auto isImage = [](const Event& event, uint32_t) {
    const auto* frame = std::get_if<ReceivedFrame>(&event);
    return frame && frame->header.kind == FrameKind::image;
  };
  const double end = nowSeconds() + seconds;
  while (true) {
    Result<Event> event = take(isImage, seq, std::max(0.0, end - nowSeconds()));
    if (!event) return event.error();
    auto& frame = std::get<ReceivedFrame>(*event);
    if (frame.header.ackSeq >= seq) return std::move(frame);
  }
}

Result<ReceivedFrame> Client::file(uint32_t seq, double seconds) {
  const auto isFile = [](const Event& event, uint32_t s) {
    const auto* frame = std::get_if<ReceivedFrame>(&event);
    return frame && frame->header.kind == FrameKind::file && frame->header.ackSeq == s;
  };
  Result<Event> event = take(isFile, seq, seconds);
  if (!event) return event.error();
  return std::move(std::get<ReceivedFrame>(*event));
}

void Client::setReading(bool reading) { m_socket->setReading(reading); }
void Client::close(uint16_t code) { m_socket->close(code); }

uint32_t answeredSeq(const ServerMessage& message) {
  return std::visit(
      [](const auto& m) -> uint32_t {
        if constexpr (requires { m.seq.value_or(0u); }) return m.seq.value_or(0u);
        else if constexpr (requires { m.seq; }) return m.seq;
        else return 0;
      },
      message);
}

}  // namespace limn::protocol
