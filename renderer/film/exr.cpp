#include "renderer/film/exr.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <string_view>

#include "renderer/film/exr_layers.hpp"
#include "renderer/base/file_bytes.hpp"

namespace limn {
namespace {

/// Writes one image with the OIIO writer `format`, chosen by name so that no other plugin ever sees the data.
Result<std::vector<uint8_t>> encode(const char* format, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                                    const void* pixels, OIIO::stride_t pixelStride) {
  std::vector<uint8_t> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(format);
  if (!out) return Error{"io", OIIO::geterror(), format};
  const std::string name = std::string("memory.") + format;
  const bool done = out->set_ioproxy(&memory) && out->open(name, spec) && out->write_image(type, pixels, pixelStride) &&
                    out->close();
  if (!done) return Error{"io", out->geterror(), format};
  return bytes;
}

Result<void> checkLayers(const FilmImage& image) {
  const size_t pixels = size_t(image.width) * image.height;
  if (pixels == 0 || image.layers.empty()) return Error{"bad-image", "the image is empty", ""};
  for (const FilmLayer& layer : image.layers)
    if ((layer.channels != 1 && layer.channels != 3) || layer.data.size() != pixels * layer.channels)
      return Error{"bad-image", "layer '" + layer.name + "' does not fit the image", ""};
  return {};
}

/// String attributes that say something about the picture, not about how it was stored.
bool isMetadata(const OIIO::ParamValue& attribute) {
  const std::string_view name(attribute.name().c_str());
  return attribute.type() == OIIO::TypeString && name != "compression" && name != "DateTime" &&
         !name.starts_with("oiio:") && !name.starts_with("openexr:");
}

}  // namespace

Result<std::vector<uint8_t>> encodeExr(const FilmImage& image) {
  if (Result<void> checked = checkLayers(image); !checked) return checked.error();
  OIIO::ImageSpec spec(int(image.width), int(image.height), 0, OIIO::TypeDesc::FLOAT);
  for (const FilmLayer& layer : image.layers)
    for (const std::string& name : exrChannelNames(layer)) spec.channelnames.push_back(name);
  spec.nchannels = int(spec.channelnames.size());
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");  // else the writer puts the clock in, and equal images get unequal bytes
  for (const auto& [key, value] : image.metadata) spec.attribute(key, value);

  const size_t pixels = size_t(image.width) * image.height, stride = spec.channelnames.size();
  std::vector<float> interleaved(pixels * stride);
  size_t first = 0;
  for (const FilmLayer& layer : image.layers) {
    for (size_t p = 0; p < pixels; ++p)
      std::copy_n(&layer.data[p * layer.channels], layer.channels, &interleaved[p * stride + first]);
    first += layer.channels;
  }
  return encode("openexr", spec, OIIO::TypeDesc::FLOAT, interleaved.data(), OIIO::AutoStride);
}

Result<void> writeExr(const std::filesystem::path& file, const FilmImage& image) {
  Result<std::vector<uint8_t>> bytes = encodeExr(image);
  if (!bytes) return Error{bytes.error().code, bytes.error().message, file.string()};
  return writeFileAtomically(file, *bytes);
}

namespace {

enum class Content { header, pixels };

void fillLayer(FilmLayer& layer, const ExrLayerPlan& plan, const std::vector<float>& interleaved, size_t stride) {
  const size_t pixels = interleaved.size() / stride, channels = layer.channels;
  layer.data.resize(pixels * channels);
  for (size_t p = 0; p < pixels; ++p)
    for (size_t c = 0; c < channels; ++c) layer.data[p * channels + c] = interleaved[p * stride + plan.sources[c]];
}

Result<FilmImage> decode(std::span<const uint8_t> bytes, const std::string& place, const ExrLimits& limits,
                         Content content) {
  const Result<ExrHeader> header = readExrHeader(bytes, limits, place);
  if (!header) return header.error();

  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::create("openexr");
  if (!in) return Error{"io", OIIO::geterror(), place};
  OIIO::ImageSpec spec;
  if (!in->set_ioproxy(&memory) || !in->open("memory.exr", spec)) return Error{"bad-file", in->geterror(), place};
  if (spec.width != int(header->width) || spec.height != int(header->height) || spec.deep ||
      size_t(spec.nchannels) != header->channels.size())
    return Error{"bad-file", "the header contradicts itself", place};

  FilmImage image{header->width, header->height, {}, {}};
  for (const OIIO::ParamValue& attribute : spec.extra_attribs)
    if (isMetadata(attribute)) image.metadata.emplace_back(attribute.name().string(), attribute.get_string());
  std::sort(image.metadata.begin(), image.metadata.end());
  const std::vector<ExrLayerPlan> plans = planExrLayers(spec.channelnames);
  for (const ExrLayerPlan& plan : plans) image.layers.push_back({plan.name, uint32_t(plan.sources.size()), {}});
  if (content == Content::header) return image;

  const size_t pixels = size_t(header->width) * header->height, stride = size_t(spec.nchannels);
  std::vector<float> interleaved(pixels * stride);
  if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, interleaved.data()))
    return Error{"bad-file", "the pixels cannot be decoded: " + in->geterror(), place};
  for (size_t l = 0; l < plans.size(); ++l) fillLayer(image.layers[l], plans[l], interleaved, stride);
  return image;
}

Result<FilmImage> readFile(const std::filesystem::path& file, const ExrLimits& limits, Content content) {
  const Result<std::vector<uint8_t>> bytes = readFileBytes(file, limits.maxFileBytes);
  return bytes ? decode(*bytes, file.string(), limits, content) : Result<FilmImage>(bytes.error());
}

}  // namespace

Result<FilmImage> decodeExr(std::span<const uint8_t> bytes, const std::string& place, const ExrLimits& limits) {
  return decode(bytes, place, limits, Content::pixels);
}

Result<FilmImage> readExr(const std::filesystem::path& file, const ExrLimits& limits) {
  return readFile(file, limits, Content::pixels);
}

Result<FilmImage> readExrWithoutPixels(const std::filesystem::path& file, const ExrLimits& limits) {
  return readFile(file, limits, Content::header);
}

Result<std::vector<uint8_t>> encodePng(uint32_t width, uint32_t height, std::span<const uint8_t> rgba) {
  if (width == 0 || height == 0 || rgba.size() != size_t(width) * height * 4)
    return Error{"bad-image", "the pixels do not fit the image", ""};
  OIIO::ImageSpec spec(int(width), int(height), 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  return encode("png", spec, OIIO::TypeDesc::UINT8, rgba.data(), 4);
}

Result<void> writePng(const std::filesystem::path& file, uint32_t width, uint32_t height,
                      std::span<const uint8_t> rgba) {
  Result<std::vector<uint8_t>> bytes = encodePng(width, height, rgba);
  if (!bytes) return Error{bytes.error().code, bytes.error().message, file.string()};
  return writeFileAtomically(file, *bytes);
}

}  // namespace limn
