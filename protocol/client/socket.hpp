#pragma once
#include <libwebsockets.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "protocol/client/client.hpp"
#include "protocol/client/url.hpp"

namespace limn::protocol {

/// The connection and the thread that serves it: everything that knows libwebsockets.
class Client::Socket {
 public:
  Socket(const ClientOptions& options, ServerUrl url);
  ~Socket();
  /// Any thread. Waits for the upgrade.
  Result<void> open();

  struct Outgoing {
    bool binary = false;
    std::vector<uint8_t> bytes;
  };
  /// Any thread. Gives a seq of 0 the next number; returns the seq.
  uint32_t send(ClientMessage message);
  /// Any thread.
  void push(Outgoing message);
  void setReading(bool reading);
  void close(uint16_t code);
  /// Any thread. The first event in the queue for which `wanted` is true, removed from it; nothing at the end of the time.
  /// Closed is never removed, and is given when nothing else can come.
  template <class Predicate>
  std::optional<Event> take(double seconds, Predicate wanted);

 private:
  static int callback(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t length);
  int onEvent(lws* wsi, lws_callback_reasons reason, void* in, size_t length);
  int receive(lws* wsi, const uint8_t* bytes, size_t length);
  int write(lws* wsi);
  int appendHeaders(lws* wsi, void* in, size_t length);
  void onWake(lws* wsi);
  void finish(Closed closed);
  void deliverText(std::string_view json);
  void deliverFrame(std::vector<uint8_t> message);
  void deliver(Event event);
  void serve();

  const ClientOptions m_options;
  const ServerUrl m_url;
  std::array<lws_protocols, 2> m_protocols{};
  lws_context* m_context = nullptr;
  std::thread m_thread;

  // Service thread only.
  lws* m_wsi = nullptr;
  std::vector<uint8_t> m_incoming;
  std::vector<uint8_t> m_scratch;
  std::optional<Outgoing> m_current;
  size_t m_sent = 0;
  Closed m_closing;
  bool m_reads = true;

  std::mutex m_mutex;  // guards all below
  std::condition_variable m_changed;
  enum class State { connecting, open, closed } m_state = State::connecting;
  bool m_upgraded = false;
  std::string m_refusal;
  std::deque<Outgoing> m_outgoing;
  std::deque<Event> m_events;
  uint32_t m_lastSeq = 0;
  bool m_stop = false, m_reading = true;
  std::optional<uint16_t> m_closeCode;
};

template <class Predicate>
std::optional<Event> Client::Socket::take(double seconds, Predicate wanted) {
  std::unique_lock lock(m_mutex);
  std::optional<Event> found;
  const auto look = [&] {
    for (auto event = m_events.begin(); event != m_events.end(); ++event) {
      const bool last = std::holds_alternative<Closed>(*event);
      if (!last && !wanted(*event)) continue;
      found = last ? *event : std::move(*event);
      if (!last) m_events.erase(event);
      return true;
    }
    return false;
  };
  m_changed.wait_for(lock, std::chrono::duration<double>(seconds), look);
  return found;
}

}  // namespace limn::protocol
