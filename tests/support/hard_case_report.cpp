#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "protocol/json_writer.hpp"
#include "renderer/base/file_bytes.hpp"
#include "tests/support/hard_case.hpp"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

using protocol::JsonWriter;

/// Held while the object lives, also against other processes.
class FileLock {
 public:
  explicit FileLock(const fs::path& file) : m_file(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
    if (m_file < 0 || flock(m_file, LOCK_EX) != 0) throw std::runtime_error("cannot lock " + file.string());
  }
  ~FileLock() { close(m_file); }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int m_file;
};

void write(const fs::path& file, const std::string& text) {
  const auto* bytes = reinterpret_cast<const uint8_t*>(text.data());
  if (auto done = writeFileAtomically(file, {bytes, text.size()}); !done) throw std::runtime_error(done.error().text());
}

void writeFigure(JsonWriter& json, const char* name, const HardFigure& figure) {
  json.key(name);
  json.beginObject();
  json.field("value", figure.value);
  json.field("general", figure.general);
  json.field("bound", figure.bound);
  json.field("good", figure.good());
  json.endObject();
}

void writeCell(JsonWriter& json, const HardCell& cell) {
  json.beginObject();
  json.field("case", cell.name);
  json.field("claim", cell.claim);
  json.field("technique", cell.technique);
  json.field("biased", cell.biased);
  json.field("good", cell.good());
  json.field("sound", cell.sound);
  json.field("unit", cell.unit);
  writeFigure(json, "deviation", cell.deviation);
  writeFigure(json, "energy", cell.energy);
  writeFigure(json, "discarded", cell.discarded);
  writeFigure(json, "fireflies", cell.fireflies);
  json.field("caustics", cell.causticsAllowed);
  json.field("largest", cell.largest);
  json.field("reason", cell.reason);
  json.endObject();
}

/// The parts' arrays as one, in the order of their names.
std::string joined(const fs::path& directory) {
  std::vector<fs::path> parts;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory))
    if (entry.path().extension() == ".json") parts.push_back(entry.path());
  std::sort(parts.begin(), parts.end());
  std::string cells;
  for (const fs::path& part : parts) {
    std::ostringstream text;
    text << std::ifstream(part).rdbuf();
    const std::string array = text.str();
    if (array.size() > 2) cells += (cells.empty() ? "" : ",\n") + array.substr(1, array.size() - 2);
  }
  return "{\"cells\":[" + cells + "]}\n";
}

}  // namespace

void writeHardCases(const std::string& directory, const std::string& group, const std::vector<HardCell>& cells) {
  JsonWriter json;
  json.beginArray();
  for (const HardCell& cell : cells) writeCell(json, cell);
  json.endArray();
  const fs::path whole = fs::path(directory) / "hard_cases.json", parts = fs::path(directory) / "hard-cases";
  fs::create_directories(parts);
  const FileLock lock(parts / "lock");
  write(parts / (group + ".json"), json.take());
  write(whole, joined(parts));
}

}  // namespace limn::test
