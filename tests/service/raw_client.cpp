#include "tests/service/raw_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>

#include "renderer/base/check.hpp"
#include "renderer/base/clock.hpp"

namespace limn::server::testing {

uint16_t RawClient::Message::closeCode() const {
  return payload.size() < 2 ? uint16_t(0) : uint16_t(uint8_t(payload[0]) << 8 | uint8_t(payload[1]));
}

RawClient::RawClient(RawClient&& other) noexcept
    : m_socket(std::exchange(other.m_socket, -1)), m_buffer(std::move(other.m_buffer)) {}

void RawClient::connect(uint16_t port, int receiveBuffer) {
  shut();
  m_buffer.clear();
  m_socket = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  LIMN_CHECK(m_socket >= 0);
  if (receiveBuffer > 0) setsockopt(m_socket, SOL_SOCKET, SO_RCVBUF, &receiveBuffer, sizeof receiveBuffer);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(m_socket, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) shut();
}

void RawClient::shut() {
  if (m_socket >= 0) ::close(m_socket);
  m_socket = -1;
}

void RawClient::reset() {
  const linger now{1, 0};
  if (m_socket >= 0) setsockopt(m_socket, SOL_SOCKET, SO_LINGER, &now, sizeof now);
  shut();
}

bool RawClient::sendBytes(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(m_socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(size_t(sent));
  }
  return true;
}

bool RawClient::fill(double deadline) {
  if (m_socket < 0) return false;
  pollfd waiting{m_socket, POLLIN, 0};
  const double left = deadline - nowSeconds();
  if (left <= 0.0 || poll(&waiting, 1, int(left * 1e3) + 1) <= 0) {
    m_timedOut = true;
    return false;
  }
  char bytes[65536];
  const ssize_t got = recv(m_socket, bytes, sizeof bytes, 0);
  if (got <= 0) return false;
  m_buffer.append(bytes, size_t(got));
  return true;
}

bool RawClient::need(size_t bytes, double deadline) {
  while (m_buffer.size() < bytes)
    if (!fill(deadline)) return false;
  return true;
}

std::string RawClient::take(size_t bytes) {
  std::string out = m_buffer.substr(0, bytes);
  m_buffer.erase(0, bytes);
  return out;
}

RawClient::Reply RawClient::readReply(bool head) {
  const double deadline = nowSeconds() + kPatience;
  size_t end;
  while ((end = m_buffer.find("\r\n\r\n")) == std::string::npos)
    if (!fill(deadline)) return {};
  std::string text = take(end + 4);
  Reply reply;
  if (text.starts_with("HTTP/1.") && text.size() > 12) reply.status = std::stoi(text.substr(9, 3));
  for (size_t line = text.find("\r\n") + 2; line + 2 < text.size(); line = text.find("\r\n", line) + 2) {
    const size_t colon = text.find(':', line), stop = text.find("\r\n", line);
    if (colon == std::string::npos || colon > stop) continue;
    std::string name = text.substr(line, colon - line);
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    const size_t begin = text.find_first_not_of(' ', colon + 1);
    reply.headers[name] = text.substr(begin, stop - begin);
  }
  const auto length = reply.headers.find("content-length");
  if (length == reply.headers.end() || head) return reply;
  const size_t bytes = size_t(std::stoul(length->second));
  if (need(bytes, deadline)) reply.body = take(bytes);
  return reply;
}

RawClient::Reply RawClient::request(const std::string& line, std::vector<std::string> headers) {
  std::string text = line + "\r\n";
  for (const std::string& header : headers) text += header + "\r\n";
  if (!sendBytes(text + "\r\n")) return {};
  return readReply(line.starts_with("HEAD"));
}

std::string RawClient::handshake(uint16_t port, const std::map<std::string, std::string>& replace,
                                 const std::string& path) {
  std::map<std::string, std::string> headers{{"Host", "127.0.0.1:" + std::to_string(port)},
                                             {"Upgrade", "websocket"},
                                             {"Connection", "Upgrade"},
                                             {"Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="},
                                             {"Sec-WebSocket-Version", "13"},
                                             {"Sec-WebSocket-Protocol", "limn.v1"}};
  for (const auto& [name, value] : replace) headers[name] = value;
  std::string text = "GET " + path + " HTTP/1.1\r\n";
  for (const auto& [name, value] : headers)
    if (!value.empty()) text += name + ": " + value + "\r\n";
  return text + "\r\n";
}

int RawClient::upgrade(uint16_t port, const std::map<std::string, std::string>& replace, const std::string& path) {
  if (!connected()) connect(port);
  if (!connected() || !sendBytes(handshake(port, replace, path))) return 0;
  return readReply().status;
}

std::string frameBytes(RawClient::Opcode opcode, std::string_view payload, bool fin, bool mask) {
  std::string bytes(1, char((fin ? 0x80 : 0) | uint8_t(opcode)));
  const uint8_t masked = mask ? 0x80 : 0;
  const size_t size = payload.size();
  if (size < 126) bytes.push_back(char(masked | size));
  else if (size < 65536) bytes += {char(masked | 126), char(size >> 8), char(size)};
  else {
    bytes.push_back(char(masked | 127));
    for (int shift = 56; shift >= 0; shift -= 8) bytes.push_back(char(uint64_t(size) >> shift));
  }
  if (!mask) return bytes.append(payload);
  constexpr char kMask[4] = {0x12, 0x34, 0x56, 0x78};
  bytes.append(kMask, 4);
  for (size_t i = 0; i < size; ++i) bytes.push_back(char(payload[i] ^ kMask[i % 4]));
  return bytes;
}

bool RawClient::sendFrame(Opcode opcode, std::string_view payload, bool fin, bool mask) {
  return sendBytes(frameBytes(opcode, payload, fin, mask));
}

std::optional<RawClient::Message> RawClient::receive(double patience) {
  const double deadline = nowSeconds() + patience;
  Message whole;
  whole.fragments = 0;
  while (true) {
    if (!need(2, deadline)) return std::nullopt;
    const bool fin = uint8_t(m_buffer[0]) & 0x80;
    const auto opcode = Opcode(uint8_t(m_buffer[0]) & 0x0f);
    size_t size = uint8_t(m_buffer[1]) & 0x7f, header = 2;
    const size_t extra = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (!need(header + extra, deadline)) return std::nullopt;
    if (extra > 0) size = 0;
    for (size_t i = 0; i < extra; ++i) size = size << 8 | uint8_t(m_buffer[header + i]);
    header += extra;
    if (!need(header + size, deadline)) return std::nullopt;
    take(header);
    std::string payload = take(size);
    if (opcode == Opcode::ping) sendFrame(Opcode::pong, payload);
    if (opcode == Opcode::close || opcode == Opcode::pong) return Message{opcode, payload, 1, size};
    if (opcode == Opcode::ping) continue;
    if (opcode != Opcode::continuation) whole.opcode = opcode;
    whole.payload += payload;
    whole.longestFragment = std::max(whole.longestFragment, size);
    ++whole.fragments;
    if (fin) return whole;
  }
}

uint16_t RawClient::waitForClose() {
  uint16_t code = 0;
  while (const auto message = receive())
    if (message->opcode == Opcode::close) {
      code = message->closeCode();
      sendFrame(Opcode::close, message->payload);
    }
  return code;
}

}  // namespace limn::server::testing
