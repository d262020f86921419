#include "server/journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <utility>

#include "renderer/base/hash.hpp"
#include "renderer/base/log.hpp"
#include "renderer/base/file_bytes.hpp"
#include "server/limn/hex_text.hpp"

namespace limn::server {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTitle = "limn-journal 1\n";
constexpr uint64_t kMostBytes = 1u << 28;       // what is read at all
constexpr uint64_t kWorthRewriting = 1u << 18;  // a file under this is left as it is
constexpr uint64_t kRewriteFactor = 8;          // over what its messages would take

std::span<const uint8_t> bytesOf(std::string_view text) { return {reinterpret_cast<const uint8_t*>(text.data()), text.size()}; }

std::string linesOf(std::span<const Accepted> messages) {
  std::string lines;
  for (const Accepted& accepted : messages) lines += lineOf(accepted);
  return lines;
}

/// Whether a power cut may take them: where somebody looks from is found again at once.
bool areViews(std::span<const Accepted> messages) {
  const auto isView = [](const protocol::Edit& edit) { return std::holds_alternative<protocol::CameraEdit>(edit); };
  return std::all_of(messages.begin(), messages.end(), [&](const Accepted& accepted) {
    const auto* batch = std::get_if<protocol::Batch>(&accepted.message);
    return batch && std::all_of(batch->edits.begin(), batch->edits.end(), isView);
  });
}

Error ioError(const fs::path& file, const std::string& what) {
  return {"io", "the journal " + what + ": " + std::strerror(errno), file.string()};
}

bool writeAll(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(fd, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(size_t(written));
  }
  return true;
}

}  // namespace

Result<std::unique_ptr<Journal>> Journal::open(const fs::path& file) {
  std::unique_ptr<Journal> journal(new Journal(file));
  for (const auto step : {&Journal::lock, &Journal::openFile, &Journal::read})
    if (Result<void> done = (journal.get()->*step)(); !done) return done.error();
  return journal;
}

Journal::~Journal() {
  for (const int fd : {m_fd, m_lock})
    if (fd >= 0) ::close(fd);
}

// A lock of its own, because the file itself is replaced.
Result<void> Journal::lock() {
  const fs::path file = m_file.string() + ".lock";
  m_lock = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (m_lock < 0) return ioError(m_file, "cannot be written");
  if (flock(m_lock, LOCK_EX | LOCK_NB) == 0) return {};
  return Error{"busy", "another process keeps this journal", m_file.string()};
}

Result<void> Journal::openFile() {
  if (m_fd >= 0) ::close(std::exchange(m_fd, -1));
  m_fd = ::open(m_file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (m_fd < 0) return ioError(m_file, "cannot be written");
  return {};
}

Result<void> Journal::read() {
  const Result<std::vector<uint8_t>> bytes = readFileBytes(m_file, kMostBytes);
  if (!bytes) return bytes.error();
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  if (kTitle.starts_with(text)) return rewrite();  // new, or ended while it was made
  if (!text.starts_with(kTitle)) return Error{"bad-file", "this is no journal", m_file.string()};
  size_t at = kTitle.size();
  for (size_t end; (end = text.find('\n', at)) != text.npos; at = end + 1) {
    const std::string_view line = text.substr(at, end - at);
    if (!isWhole(line)) break;
    const Result<Accepted> accepted = acceptedOf(line);
    if (accepted) m_summary.add(*accepted);
    else logWarning(m_file.string() + ": an edit of another version is passed over: " + accepted.error().text());
  }
  if (at < text.size())
    logWarning(m_file.string() + ": " + std::to_string(text.size() - at) + " bytes at the end are torn and cut off");
  if (ftruncate(m_fd, off_t(at)) != 0) return ioError(m_file, "cannot be written");
  m_bytes = at;
  m_leastBytes = linesOf(m_summary.all()).size();
  return {};
}

std::vector<protocol::ClientMessage> Journal::messages() const {
  std::vector<protocol::ClientMessage> messages;
  for (Accepted& accepted : m_summary.all()) messages.push_back(std::move(accepted.message));
  return messages;
}

// The lock file says how often.
Result<void> Journal::begin() {
  if (m_summary.all().empty()) return {};
  m_confirmed = false;
  char text[16] = {};
  (void)!pread(m_lock, text, sizeof text - 1, 0);
  const uint32_t before = uint32_t(std::strtoul(text, nullptr, 10));
  if (before < kMostStarts) {
    writeStarts(before + 1);
    return {};
  }
  logWarning(m_file.string() + ": the last " + std::to_string(before) + " starts with it came to nothing; it is set aside");
  return setAside();
}

void Journal::writeStarts(uint32_t count) {
  const std::string text = std::to_string(count) + "\n";
  if (ftruncate(m_lock, 0) != 0 || pwrite(m_lock, text.data(), text.size(), 0) != ssize_t(text.size()))
    logWarning(m_file.string() + ": cannot count starts: " + std::strerror(errno));
}

void Journal::confirm() {
  if (!std::exchange(m_confirmed, true)) writeStarts(0);
}

Result<void> Journal::append(std::span<const Accepted> messages) {
  for (const Accepted& accepted : messages) m_summary.add(accepted);
  if (m_behind) return rewrite();
  const std::string lines = linesOf(messages);
  m_behind = true;
  if (!writeAll(m_fd, lines) || (!areViews(messages) && fdatasync(m_fd) != 0)) {
    const Error error = ioError(m_file, "cannot be written");
    (void)!ftruncate(m_fd, off_t(m_bytes));
    return error;
  }
  m_behind = false;
  m_bytes += lines.size();
  if (m_bytes > std::max(kWorthRewriting, kRewriteFactor * m_leastBytes)) shorten();
  return {};
}

Result<void> Journal::catchUp() { return m_behind ? rewrite() : Result<void>(); }

// Where that fails the file says the same as before, and is left until it has grown once more.
void Journal::shorten() {
  const Result<void> written = rewrite();
  if (written) return;
  logWarning(written.error().text() + "; it stays as long as it is");
  m_behind = m_fd < 0;
  m_leastBytes = m_bytes;
}

Result<void> Journal::rewrite() {
  const std::string text = std::string(kTitle) + linesOf(m_summary.all());
  m_behind = true;
  if (Result<void> written = writeFileAtomically(m_file, bytesOf(text)); !written) return written;
  if (Result<void> opened = openFile(); !opened) return opened;
  m_behind = false;
  m_bytes = m_leastBytes = text.size();
  return {};
}

Result<void> Journal::setAside() {
  confirm();
  fs::path aside;
  std::error_code problem;
  for (uint32_t n = 1; aside.empty() || fs::exists(aside, problem); ++n) aside = m_file.string() + ".aside." + std::to_string(n);
  if (std::rename(m_file.c_str(), aside.c_str()) != 0) return ioError(m_file, "cannot be set aside");
  m_summary = {};
  return rewrite();
}

Result<fs::path> journalFileFor(const fs::path& directory, const fs::path& scene) {
  std::ifstream in(scene, std::ios::binary);
  std::vector<char> block(1u << 20);
  uint64_t hash = fnv1a(std::string_view());
  while (in.read(block.data(), std::streamsize(block.size())) || in.gcount() > 0)
    hash = fnv1a(block.data(), size_t(in.gcount()), hash);
  if (!in.eof()) return Error{"io", "the scene cannot be read", scene.string()};
  return directory / (scene.stem().string() + "-" + hexText(hash) + ".edits");
}

}  // namespace limn::server
