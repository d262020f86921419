#pragma once
#include <arpa/inet.h>
#include <libwebsockets.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "renderer/base/check.hpp"

namespace limn::testing {

/// One accepted WebSocket, byte by byte: the script decides about every frame. An end of the connection reads as opcode 8
/// with an empty payload.
class ScriptedConnection {
 public:
  explicit ScriptedConnection(int fd) : m_fd(fd) {
    const int on = 1;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }
  ~ScriptedConnection() { ::close(m_fd); }

  struct WireFrame {
    bool final = true, masked = false;
    int opcode = 8;
    std::string payload;
  };

  std::string readRequest() {
    std::string head;
    for (char c; head.find("\r\n\r\n") == std::string::npos && ::recv(m_fd, &c, 1, 0) == 1;) head.push_back(c);
    return head;
  }

  void accept(const std::string& request) {
    const std::string name = "Sec-WebSocket-Key: ";
    const size_t at = request.find(name) + name.size();
    const std::string key = request.substr(at, request.find("\r\n", at) - at) + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";
    unsigned char digest[20];
    char accepted[64];
    lws_SHA1(reinterpret_cast<const unsigned char*>(key.data()), key.size(), digest);
    lws_b64_encode_string(reinterpret_cast<const char*>(digest), 20, accepted, sizeof accepted);
    writeRaw("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
             "Sec-WebSocket-Protocol: limn.v1\r\nSec-WebSocket-Accept: " + std::string(accepted) + "\r\n\r\n");
  }

  void writeRaw(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(m_fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return;
      bytes.remove_prefix(size_t(sent));
    }
  }

  void write(int opcode, std::string_view payload, bool final = true) {
    std::string head{char((final ? 0x80 : 0) | opcode)};
    if (payload.size() < 126) {
      head.push_back(char(payload.size()));
    } else {
      LIMN_CHECK(payload.size() < 65536);
      head.push_back(126);
      head.push_back(char(payload.size() >> 8));
      head.push_back(char(payload.size() & 0xFF));
    }
    writeRaw(head + std::string(payload));
  }
  void text(std::string_view json) { write(1, json); }

  WireFrame readFrame() {
    WireFrame frame;
    const std::string head = read(2);
    if (head.size() < 2) return frame;
    frame.final = (head[0] & 0x80) != 0;
    frame.opcode = head[0] & 0x0F;
    frame.masked = (head[1] & 0x80) != 0;
    uint64_t length = uint64_t(head[1] & 0x7F);
    if (length >= 126) {
      const std::string longer = read(length == 126 ? 2 : 8);
      length = 0;
      for (const char c : longer) length = length << 8 | uint8_t(c);
    }
    const std::string mask = frame.masked ? read(4) : std::string(4, '\0');
    frame.payload = read(length);
    for (size_t i = 0; i < frame.payload.size(); ++i) frame.payload[i] = char(frame.payload[i] ^ mask[i % 4]);
    return frame;
  }

 private:
  std::string read(size_t count) {
    std::string bytes(count, '\0');
    size_t have = 0;
    while (have < count) {
      const ssize_t got = ::recv(m_fd, bytes.data() + have, count - have, 0);
      if (got <= 0) return {};
      have += size_t(got);
    }
    return bytes;
  }

  int m_fd;
};

/// Accepts one connection on a free port of the loopback and runs the script on it.
class ScriptedServer {
 public:
  explicit ScriptedServer(std::function<void(ScriptedConnection&)> script) {
    m_listener = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    LIMN_CHECK(::bind(m_listener, reinterpret_cast<sockaddr*>(&address), size) == 0 && ::listen(m_listener, 4) == 0);
    LIMN_CHECK(::getsockname(m_listener, reinterpret_cast<sockaddr*>(&address), &size) == 0);
    m_port = ntohs(address.sin_port);
    m_thread = std::thread([this, script = std::move(script)] {
      ScriptedConnection connection(::accept(m_listener, nullptr, nullptr));
      script(connection);
    });
  }
  ~ScriptedServer() {
    ::shutdown(m_listener, SHUT_RDWR);
    m_thread.join();
    ::close(m_listener);
  }
  std::string url() const { return "ws://127.0.0.1:" + std::to_string(m_port) + "/ws"; }

 private:
  int m_listener = -1;
  uint16_t m_port = 0;
  std::thread m_thread;
};

}  // namespace limn::testing
