#include "renderer/scene/environment_image.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "renderer/scene/asset_files.hpp"
#include "renderer/scene/clean_environment.hpp"
#include "renderer/scene/oiio_input.hpp"

namespace limn {
namespace {

constexpr int kMaxChannels = 64;
constexpr const char* kExrReader = "openexr";

const char* readerOf(std::span<const uint8_t> bytes) {
  constexpr uint8_t kExr[4] = {0x76, 0x2f, 0x31, 0x01};
  if (bytes.size() >= 4 && std::memcmp(bytes.data(), kExr, 4) == 0) return kExrReader;
  if (bytes.size() >= 2 && bytes[0] == '#' && bytes[1] == '?') return "hdr";
  return nullptr;
}

/// Deep data and several parts are bits of an EXR's version field; such files never reach the library.
bool deepOrMultiPart(std::span<const uint8_t> bytes) {
  constexpr uint8_t kDeep = 0x08, kMultiPart = 0x10;
  return bytes.size() < 8 || (bytes[5] & (kDeep | kMultiPart)) != 0;
}

Result<void> checkHeader(OIIO::ImageInput& input, const LoadLimits& limits) {
  const OIIO::ImageSpec spec = input.spec();
  if (spec.width < 1 || spec.height < 1 || spec.depth != 1) return Error{"bad-file", "the image has no texels", ""};
  if (spec.nchannels < 1 || spec.nchannels > kMaxChannels)
    return Error{"unsupported", "the image has too many channels", ""};
  const uint64_t bytes =
      uint64_t(spec.width) * uint64_t(spec.height) * uint64_t(std::max(4, spec.nchannels)) * sizeof(float);
  if (uint32_t(std::max(spec.width, spec.height)) > limits.maxImageSide || bytes > limits.maxImageBytes) {
    return Error{"limit",
                 "an image of " + std::to_string(spec.width) + "x" + std::to_string(spec.height) + " is over the limit",
                 ""};
  }
  return {};
}

/// The channels that are red, green and blue; one channel stands for all three.
std::array<int, 3> colorChannels(const OIIO::ImageSpec& spec) {
  std::array<int, 3> found{};
  for (int c = 0; c < 3; ++c) {
    const char* const name = c == 0 ? "R" : c == 1 ? "G" : "B";
    const auto at = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
    found[size_t(c)] =
        at != spec.channelnames.end() ? int(at - spec.channelnames.begin()) : std::min(c, spec.nchannels < 3 ? 0 : 2);
  }
  return found;
}

bool readRows(OIIO::ImageInput& input, Image& image) {
  const OIIO::ImageSpec spec = input.spec();
  const std::array<int, 3> channels = colorChannels(spec);
  const size_t stride = size_t(spec.nchannels);
  std::vector<float> all(size_t(spec.width) * size_t(spec.height) * stride);
  if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, all.data())) return false;
  image.rgbaF.resize(size_t(spec.width) * size_t(spec.height) * 4);
  for (size_t i = 0; i < image.rgbaF.size() / 4; ++i) {
    for (size_t c = 0; c < 3; ++c) image.rgbaF[i * 4 + c] = all[i * stride + size_t(channels[c])];
    image.rgbaF[i * 4 + 3] = 1.0f;
  }
  return true;
}

Result<Image> load(const std::filesystem::path& file, const LoadOptions& options, std::vector<std::string>& notes) {
  std::error_code failure;
  const std::filesystem::path real = std::filesystem::canonical(file, failure);
  if (failure) return Error{"io", "cannot be opened: " + failure.message(), ""};
  auto root = AssetRoot::open(options.assetRoot.empty() ? real.parent_path() : options.assetRoot);
  if (!root) return root.error();
  const std::string below = real.lexically_relative(root->folder()).generic_string();
  if (below.empty() || below.starts_with("..")) return Error{"path", "the file is not below the asset root", ""};
  auto reader = root->openFile(below, options.limits.maxFileBytes);
  if (!reader) return reader.error();
  auto bytes = reader->read(0, reader->size());
  if (!bytes) return bytes.error();
  Result<Image> image = decodeEnvironmentImage(*bytes, options.limits, notes);
  if (image) image->name = below;
  return image;
}

}  // namespace

Result<Image> decodeEnvironmentImage(std::span<const uint8_t> bytes, const LoadLimits& limits,
                                     std::vector<std::string>& notes) {
  const char* const name = readerOf(bytes);
  if (!name) return Error{"unsupported", "the environment is neither Radiance HDR nor OpenEXR", ""};
  if (name == kExrReader && deepOrMultiPart(bytes)) {
    return Error{"unsupported", "deep and multi-part images are not supported", ""};
  }
  OIIO::Filesystem::IOMemReader memory(const_cast<uint8_t*>(bytes.data()), bytes.size());  // it only reads
  auto input = openOiio(name, memory);
  if (!input) return input.error();
  if (auto good = checkHeader(**input, limits); !good) return good.error();

  Image image;
  image.width = uint32_t((*input)->spec().width);
  image.height = uint32_t((*input)->spec().height);
  if (!readRows(**input, image))
    return Error{"bad-file", "the image cannot be decoded: " + oiioMessage(**input), ""};
  noteCleaned(cleanRadiance(image), notes);
  return image;
}

Result<Image> loadEnvironmentImage(const std::filesystem::path& file, const LoadOptions& options,
                                   std::vector<std::string>& notes) {
  Result<Image> image = load(file, options, notes);
  if (image) return image;
  Error error = image.error();
  error.place = file.filename().string();
  return error;
}

}  // namespace limn
