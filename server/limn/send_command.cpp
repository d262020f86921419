#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "protocol/client/client.hpp"
#include "protocol/client/url.hpp"
#include "renderer/base/clock.hpp"
#include "renderer/base/file_bytes.hpp"
#include "server/limn/commands.hpp"
#include "server/limn/hex_text.hpp"
#include "server/limn/send_script.hpp"

namespace limn {
namespace {

using namespace protocol;

constexpr double kDefaultTimeout = 60.0;  // [s]
constexpr double kLastFrameWait = 5.0;    // [s]; an edit that changed nothing shows in no frame

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// What an answer says, in a few words.
std::string describe(const ServerMessage& answer) {
  if (const auto* ack = std::get_if<Ack>(&answer))
    return std::string(name(ack->cost)) + (ack->superseded ? ", superseded" : "");
  if (const auto* loaded = std::get_if<Loaded>(&answer)) return "loaded in" + number(" %.2f s", loaded->seconds);
  if (const auto* saved = std::get_if<Saved>(&answer)) return std::to_string(saved->bytes) + " bytes";
  if (const auto* picked = std::get_if<Picked>(&answer)) {
    if (!picked->hit) return "nothing there";
    return "node " + std::to_string(picked->node.value_or(0)) + number(" at %.4g m", picked->distance.value_or(0.0));
  }
  if (const auto* waited = std::get_if<Waited>(&answer)) {
    const std::string error = waited->estimatedError && waited->errorLow && waited->errorHigh
                                  ? number(", estimated relMSE %.3g", *waited->estimatedError) +
                                        number(" (%.3g", *waited->errorLow) + number(" to %.3g)", *waited->errorHigh)
                                  : "";
    return std::to_string(waited->steps) + " steps, film " + hexText(waited->filmHash.value) + error;
  }
  return std::string(opOf(answer));
}

/// The messages of a script on their way over one connection, one answer awaited after the other.
class Sending {
 public:
  Sending(Client& client, std::string directory, double timeout)
      : m_client(client), m_directory(std::move(directory)), m_timeout(timeout) {}

  /// Prints one line. Errors: the server's error reply; "io" when the answer does not come. They name `place`, or that
  /// of the earlier message that the server complains of.
  Result<void> send(const std::string& label, const std::string& place, ClientMessage message) {
    const bool answered = !std::holds_alternative<AckFrame>(message), file = std::holds_alternative<Save>(message);
    const bool bye = std::holds_alternative<ClientBye>(message);
    const std::string op(opOf(message));
    if (isEdit(message)) m_edited = true;
    const bool edit = isEdit(message);
    const double begin = nowSeconds();
    const uint32_t seq = m_client.send(std::move(message));
    m_places[seq] = place;
    if (edit) m_lastEdit = seq;
    if (bye) m_saidBye = true;
    std::string outcome = "sent";
    if (answered) {
      const Result<ServerMessage> answer = awaitAnswer(seq, bye);
      if (!answer) return answer.error();
      outcome = describe(*answer);
      if (file)
        if (Result<void> kept = keepFile(seq); !kept) return errorOf(seq, kept.error());
    }
    std::printf("%s: %s seq %u: %s, %.1f ms\n", label.c_str(), op.c_str(), seq, outcome.c_str(),
                (nowSeconds() - begin) * 1e3);
    std::fflush(stdout);
    return {};
  }

  /// Keeps frames until one shows the last edit, where frames are kept and anything was edited. After a bye there are
  /// only those that the server had sent before.
  Result<void> keepLastFrame() {
    if (m_directory.empty() || !m_edited) return {};
    const double end = nowSeconds() + std::min(m_timeout, kLastFrameWait);
    while (m_shown < m_lastEdit && nowSeconds() < end) {
      const std::optional<Event> event = m_client.nextEvent(end - nowSeconds());
      if (!event || endsAfterBye(*event)) break;
      if (Result<void> taken = take(*event); !taken) return taken;
    }
    return {};
  }

  uint64_t framesKept() const { return m_framesKept; }

 private:
  /// The error with the line of the script that was sent as `seq`.
  Error errorOf(uint32_t seq, Error error) const {
    const auto sent = m_places.find(seq);
    return sent == m_places.end() ? error : errorAt(sent->second, std::move(error));
  }

  bool endsAfterBye(const Event& event) const {
    const auto* closed = std::get_if<Closed>(&event);
    return m_saidBye && closed && closed->code == kCloseNormal;
  }

  Result<ServerMessage> awaitAnswer(uint32_t seq, bool bye) {
    const double end = nowSeconds() + m_timeout;
    while (true) {
      const std::optional<Event> event = m_client.nextEvent(std::max(0.0, end - nowSeconds()));
      const std::string late = "no answer to seq " + std::to_string(seq) + number(" within %.3g s", m_timeout);
      if (!event) return errorOf(seq, {"io", late, ""});
      const auto* received = std::get_if<ReceivedMessage>(&*event);
      if (!received) {
        if (Result<void> taken = take(*event); !taken) return errorOf(seq, taken.error());
        continue;
      }
      if (const auto* error = std::get_if<ErrorMessage>(&received->message))
        return errorOf(error->seq.value_or(seq), {error->code, error->message, error->place.value_or("")});
      if (bye && std::holds_alternative<ServerBye>(received->message)) return received->message;
      if (answeredSeq(received->message) == seq) return received->message;
    }
  }

  Result<void> keepFile(uint32_t seq) {
    const Result<ReceivedFrame> file = m_client.file(seq, m_timeout);
    if (!file) return file.error();
    if (m_directory.empty()) return {};
    return writeFileAtomically(path("save-", seq, ".exr"), file->payload());
  }

  Result<void> take(const Event& event) {
    if (const auto* frame = std::get_if<ReceivedFrame>(&event)) return keepFrame(*frame);
    if (const auto* broken = std::get_if<Broken>(&event)) return broken->error;
    if (const auto* closed = std::get_if<Closed>(&event))
      return Error{"io", "the connection ended with " + std::to_string(closed->code) +
                             (closed->reason.empty() ? "" : ": " + closed->reason), ""};
    return {};
  }

  Result<void> keepFrame(const ReceivedFrame& frame) {
    if (frame.header.kind != FrameKind::image) return {};
    m_shown = std::max(m_shown, frame.header.ackSeq);
    if (m_directory.empty()) return {};
    ++m_framesKept;
    const char* extension = frame.header.encoding == Encoding::jpeg ? ".jpg" : ".png";
    return writeFileAtomically(path("frame-", frame.header.frameId, extension), frame.payload());
  }

  std::filesystem::path path(const char* kind, uint32_t id, const char* extension) const {
    char digits[16];
    std::snprintf(digits, sizeof digits, "%06u", id);
    return std::filesystem::path(m_directory) / (std::string(kind) + digits + extension);
  }

  Client& m_client;
  std::string m_directory;
  double m_timeout = 0.0;
  std::map<uint32_t, std::string> m_places;  ///< of what was sent, by seq
  bool m_edited = false, m_saidBye = false;
  uint32_t m_lastEdit = 0, m_shown = 0;
  uint64_t m_framesKept = 0;
};

/// A server renders for those who watch; an error is judged by the pictures it publishes.
bool watches(const Arguments& arguments, const std::vector<ScriptMessage>& script) {
  const auto waitsForError = [](const ScriptMessage& entry) {
    const auto* wait = std::get_if<Wait>(&entry.message);
    return wait && wait->error;
  };
  return arguments.has("save") || arguments.has("wait-error") ||
         std::any_of(script.begin(), script.end(), waitsForError);
}

Result<std::unique_ptr<Client>> connect(const Arguments& arguments, bool watch, double timeout) {
  ClientOptions options;
  options.url = arguments.positionals()[0];
  options.connectSeconds = timeout;
  if (const char* token = std::getenv("LIMN_TOKEN")) options.token = token;
  ClientHello hello;
  hello.client = "limn send";
  hello.watch = watch;
  return Client::greet(options, hello);
}

Result<void> run(const Arguments& arguments) {
  const Result<ServerUrl> url = parseServerUrl(arguments.positionals()[0]);
  if (!url) return usageError(url.error().text());
  const Result<double> timeout = arguments.real("timeout", kDefaultTimeout, 1e-3, 1e7);
  if (!timeout) return timeout.error();
  const Result<double> waitError = arguments.real("wait-error", 0.0, 1e-12, 1e6);
  if (!waitError) return waitError.error();
  const Result<std::vector<ScriptMessage>> script = readScript(arguments.positionals()[1]);
  if (!script) return script.error();
  const std::string directory = arguments.text("save");
  std::error_code problem;
  if (!directory.empty() && !std::filesystem::is_directory(directory, problem))
    if (!std::filesystem::create_directories(directory, problem)) return Error{"io", problem.message(), directory};

  const Result<std::unique_ptr<Client>> client = connect(arguments, watches(arguments, *script), *timeout);
  if (!client) return client.error();
  Sending sending(**client, directory, *timeout);
  for (const ScriptMessage& entry : *script)
    if (Result<void> sent = sending.send("line " + std::to_string(entry.line), entry.place, entry.message); !sent)
      return sent;
  if (arguments.has("wait-error")) {
    Wait wait;
    wait.error = float(*waitError);
    if (Result<void> waited = sending.send("end", "--wait-error", wait); !waited) return waited;
  }
  if (Result<void> kept = sending.keepLastFrame(); !kept) return kept;
  if (!directory.empty())
    std::printf("%s: %s frames\n", directory.c_str(), std::to_string(sending.framesKept()).c_str());
  return {};
}

}  // namespace

Command sendCommand() {
  return {{"limn send",
           "Sends the messages of a script to limnd, one JSON object a line, each after the answer to the one before; "
           "every seq is made anew.",
           {"URL", "SCRIPT.jsonl"},
           {{"save", "DIR", "keep frames and saved files there"},
            {"wait-error", "E", "after the last message wait until the upper end of relMSE's 95 % interval is this small"},
            {"timeout", "SECONDS", "give up when an answer takes longer (default: 60)"}}},
          run};
}

}  // namespace limn
