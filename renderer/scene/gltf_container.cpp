#include "renderer/scene/gltf_container.hpp"

#include <array>
#include <cstring>

#include "renderer/scene/gltf_json.hpp"

namespace limn::gltf {
namespace {

constexpr uint32_t kGlbMagic = 0x46546c67;   // "glTF"
constexpr uint32_t kJsonChunk = 0x4e4f534a;  // "JSON"
constexpr uint32_t kBinChunk = 0x004e4942;   // "BIN\0"

template <class T>
T unwrap(Result<T> result, const std::string& pointer = "") {
  if (!result) fail(result.error().code, result.error().message, pointer);
  return result.take();
}

uint32_t word(const std::vector<uint8_t>& bytes, size_t at) {
  uint32_t w;
  std::memcpy(&w, bytes.data() + at, 4);  // little-endian host, as everywhere in Limn
  return w;
}

struct Chunk {
  uint32_t length = 0, type = 0;
};

Chunk chunkAt(const FileReader& file, uint64_t offset, uint64_t end) {
  if (end - offset < 8) fail("bad-file", "the GLB ends inside a chunk's header", "");
  const std::vector<uint8_t> header = unwrap(file.read(offset, 8));
  const Chunk chunk{word(header, 0), word(header, 4)};
  if (chunk.length > end - offset - 8) fail("bad-file", "the GLB ends inside a chunk", "");
  return chunk;
}

/// Looked at before the text is read, for its parsed form takes several times as much.
void checkJsonBytes(uint64_t bytes, const LoadLimits& limits) {
  if (bytes <= limits.maxJsonBytes) return;
  fail("limit",
       "the JSON has " + std::to_string(bytes) + " bytes, the limit is " + std::to_string(limits.maxJsonBytes), "");
}

void readGlb(Container& container, const FileReader& file, const LoadLimits& limits) {
  const std::vector<uint8_t> header = unwrap(file.read(0, 12));
  if (word(header, 4) != 2) fail("unsupported", "GLB version " + std::to_string(word(header, 4)) + " is not 2", "");
  const uint64_t end = word(header, 8);
  if (end > file.size()) {
    fail("bad-file",
         "the GLB says it has " + std::to_string(end) + " bytes, the file has " + std::to_string(file.size()), "");
  }
  if (end < 20) fail("bad-file", "the GLB has no JSON chunk", "");

  const Chunk json = chunkAt(file, 12, end);
  if (json.type != kJsonChunk) fail("bad-file", "the first GLB chunk is not JSON", "");
  checkJsonBytes(json.length, limits);
  const std::vector<uint8_t> text = unwrap(file.read(20, json.length));
  container.json.assign(text.begin(), text.end());

  const uint64_t next = 20ull + json.length;
  if (end - next < 8) return;
  const Chunk binary = chunkAt(file, next, end);
  if (binary.type == kBinChunk) container.binary = unwrap(file.read(next + 8, binary.length));
}

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percentDecoded(std::string_view text, const std::string& pointer) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    const int high = i + 2 < text.size() ? hexDigit(text[i + 1]) : -1,
              low = i + 2 < text.size() ? hexDigit(text[i + 2]) : -1;
    if (high < 0 || low < 0) fail("bad-file", "the URI has a '%' without two hexadecimal digits", pointer);
    out += char(high * 16 + low);
    i += 2;
  }
  return out;
}

std::vector<uint8_t> base64Decoded(std::string_view text, const std::string& pointer) {
  static const auto kDigits = [] {
    std::array<int8_t, 256> digits;
    digits.fill(-1);
    constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < alphabet.size(); ++i) digits[uint8_t(alphabet[i])] = int8_t(i);
    return digits;
  }();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) fail("bad-file", "the base64 data is cut off", pointer);
  std::vector<uint8_t> out;
  out.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    const int digit = kDigits[uint8_t(c)];
    if (digit < 0) fail("bad-file", "the data URI is not base64", pointer);
    bits = (bits << 6) | uint32_t(digit);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    out.push_back(uint8_t(bits >> held));
  }
  return out;
}

std::vector<uint8_t> dataUri(std::string_view uri, uint64_t maxBytes, const std::string& pointer) {
  const size_t comma = uri.find(',');
  if (comma == std::string_view::npos) fail("bad-file", "the data URI has no comma", pointer);
  const std::string_view payload = uri.substr(comma + 1);
  if (payload.size() / 4 * 3 > maxBytes) {
    fail("limit", "the data URI holds more than " + std::to_string(maxBytes) + " bytes", pointer);
  }
  if (uri.substr(0, comma).ends_with(";base64")) return base64Decoded(payload, pointer);
  const std::string bytes = percentDecoded(payload, pointer);
  return {bytes.begin(), bytes.end()};
}

/// "http:", "file:", "C:" and the like: a colon before any slash.
bool hasScheme(std::string_view uri) {
  const size_t colon = uri.find(':');
  return colon != std::string_view::npos && colon < uri.find('/');
}

std::string withSlash(std::string folder) {
  if (folder == ".") return "";
  return folder.empty() ? folder : folder + "/";
}

}  // namespace

Container openContainer(const std::filesystem::path& file, const LoadOptions& options) {
  std::error_code failure;
  const std::filesystem::path real = std::filesystem::canonical(file, failure);
  if (failure) fail("io", "cannot be opened: " + failure.message(), "");
  Container container{
      unwrap(AssetRoot::open(options.assetRoot.empty() ? real.parent_path() : options.assetRoot)), "", "", {}};
  const std::filesystem::path below = real.lexically_relative(container.root.folder());
  if (below.empty() || *below.begin() == "..") fail("path", "the file is not below the asset root", "");
  container.folder = withSlash(below.parent_path().string());

  const FileReader reader = unwrap(container.root.openFile(below.string(), options.limits.maxFileBytes));
  if (reader.size() >= 12 && word(unwrap(reader.read(0, 4)), 0) == kGlbMagic) {
    readGlb(container, reader, options.limits);
    return container;
  }
  checkJsonBytes(reader.size(), options.limits);
  const std::vector<uint8_t> text = unwrap(reader.read(0, reader.size()));
  const size_t mark =
      text.size() >= 3 && text[0] == 0xef && text[1] == 0xbb && text[2] == 0xbf ? 3 : 0;  // UTF-8 byte order mark
  container.json.assign(text.begin() + std::ptrdiff_t(mark), text.end());
  return container;
}

std::string pathOfUri(const Container& container, const std::string& uri, const std::string& pointer) {
  if (uri.starts_with("data:")) return "";
  if (hasScheme(uri)) fail("path", "only relative paths and data URIs are opened", pointer);
  const std::string path = percentDecoded(uri, pointer);
  if (path.empty() || path.front() == '/') fail("path", "only relative paths and data URIs are opened", pointer);
  return container.folder + path;
}

std::vector<uint8_t> readUri(const Container& container, const std::string& uri, uint64_t maxBytes,
                             const std::string& pointer) {
  if (uri.starts_with("data:")) return dataUri(uri, maxBytes, pointer);
  const FileReader reader = unwrap(container.root.openFile(pathOfUri(container, uri, pointer), maxBytes), pointer);
  return unwrap(reader.read(0, reader.size()), pointer);
}

}  // namespace limn::gltf
