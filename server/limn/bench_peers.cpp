#include <algorithm>
#include <filesystem>

#include "renderer/base/file_bytes.hpp"
#include "server/limn/bench_scene.hpp"

namespace limn::bench {
namespace {

constexpr uint64_t kMostListBytes = 16u << 20;

std::string trimmed(std::string line) {
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
  return line;
}

}  // namespace

Result<std::vector<PeerPicture>> readPeerPictures(const std::string& list) {
  if (list.empty()) return std::vector<PeerPicture>();
  const Result<std::vector<uint8_t>> bytes = readFileBytes(list, kMostListBytes);
  if (!bytes) return bytes.error();
  const std::filesystem::path directory = std::filesystem::path(list).parent_path();
  std::vector<PeerPicture> pictures;
  size_t number = 0;
  for (const std::string& raw : splitList(std::string(bytes->begin(), bytes->end()), '\n')) {
    ++number;
    const std::string line = trimmed(raw);
    if (line.empty() || line[0] == '#' || line.starts_with("scene,")) continue;
    const std::vector<std::string> fields = splitList(line, ',');
    PeerPicture picture;
    if (fields.size() != 4 || !parseReal(fields[2], picture.seconds) || !(picture.seconds > 0.0))
      return Error{"bad-file", "expected scene,name,seconds,file.exr", list + " line " + std::to_string(number)};
    picture.scene = fields[0];
    picture.renderer = fields[1];
    picture.file = (directory / fields[3]).string();
    pictures.push_back(picture);
  }
  std::stable_sort(pictures.begin(), pictures.end(),
                   [](const PeerPicture& a, const PeerPicture& b) { return a.seconds < b.seconds; });
  return pictures;
}

}  // namespace limn::bench
