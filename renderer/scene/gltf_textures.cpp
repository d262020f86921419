#include "renderer/scene/gltf_textures.hpp"

#include "renderer/scene/image_file.hpp"

namespace limn::gltf {
namespace {

Wrap wrapOf(const Value& sampler, const char* key) {
  switch (sampler.unsignedOr(key, 10497)) {
    case 10497: return Wrap::repeat;
    case 33071: return Wrap::clampToEdge;
    case 33648: return Wrap::mirroredRepeat;
    default: sampler.need(key).fail("bad-file", "there is no such wrap mode");
  }
}

void readSampler(TextureRef& ref, const Value& sampler) {
  ref.wrapS = wrapOf(sampler, "wrapS");
  ref.wrapT = wrapOf(sampler, "wrapT");
  ref.nearest = sampler.unsignedOr("magFilter", 9729) == 9728;
}

void readTransform(TextureRef& ref, const Value& transform) {
  const std::vector<double> offset = transform.numbers("offset", 2), scale = transform.numbers("scale", 2);
  if (!offset.empty()) ref.offset = {float(offset[0]), float(offset[1])};
  if (!scale.empty()) ref.scale = {float(scale[0]), float(scale[1])};
  ref.rotation = float(transform.numberOr("rotation", 0.0));
  ref.texCoord = uint32_t(transform.unsignedOr("texCoord", ref.texCoord, 0, 1u << 16));
}

}  // namespace

Textures::Textures(Document& document, Scene& scene)
    : m_document(document), m_scene(scene), m_sceneImages(document.count("images"), kNone) {}

TextureRef Textures::read(const Value& owner, const char* key, const std::string& material) {
  const std::optional<Value> info = owner.find(key);
  if (!info) return {};
  const Value textures = m_document.root().list("textures");
  const Value texture = textures[info->need("index").asIndex(textures.size(), "texture")];

  TextureRef ref;
  ref.texCoord = uint32_t(info->unsignedOr("texCoord", 0, 0, 1u << 16));
  if (const auto transform = info->extension("KHR_texture_transform")) readTransform(ref, *transform);
  if (ref.texCoord > 1) {
    m_document.reporter.unsupported("TEXCOORD_" + std::to_string(ref.texCoord), "textures that use it are left out",
                                    material);
    return {};
  }
  const Value samplers = m_document.root().list("samplers");
  if (const int32_t sampler = texture.indexOr("sampler", samplers.size(), "sampler"); sampler >= 0)
    readSampler(ref, samplers[size_t(sampler)]);

  const int32_t source = texture.indexOr("source", m_sceneImages.size(), "image");
  if (source < 0) {
    m_document.reporter.unsupported("texture without a PNG or JPEG image", "the texture is left out", material);
    return {};
  }
  ref.image = image(uint32_t(source));
  return ref;
}

std::vector<uint8_t> Textures::fileBytes(const Value& image) {
  const auto view = image.find("bufferView");
  const auto uri = image.find("uri");
  if (!view == !uri) image.fail("bad-file", "an image has either a URI or a bufferView");
  if (uri) {
    const uint64_t left = m_document.limits.maxFileBytes - m_encodedBytes;
    std::vector<uint8_t> bytes = readUri(m_document.container, uri->asString(), left, uri->pointer());
    m_encodedBytes += bytes.size();
    return bytes;
  }
  const tinygltf::BufferView& range =
      m_document.model.bufferViews[view->asIndex(m_document.model.bufferViews.size(), "bufferView")];
  const auto begin = m_document.model.buffers[size_t(range.buffer)].data.begin() + std::ptrdiff_t(range.byteOffset);
  return {begin, begin + std::ptrdiff_t(range.byteLength)};
}

int32_t Textures::image(uint32_t index) {
  if (m_sceneImages[index] != kNone) return m_sceneImages[index];
  const Value description = m_document.root().list("images")[index];
  const std::vector<uint8_t> bytes = fileBytes(description);
  const Result<ImageHeader> header = readImageHeader(bytes);
  if (!header) description.fail(header.error().code, header.error().message);

  // The limits are looked at before any texel is decoded.
  const LoadLimits& limits = m_document.limits;
  const std::string size = std::to_string(header->width) + "x" + std::to_string(header->height);
  if (header->width > limits.maxImageSide || header->height > limits.maxImageSide) {
    description.fail("limit", "an image of " + size + " is over the limit of " + std::to_string(limits.maxImageSide) +
                                  " texels a side");
  }
  uint64_t& used = m_document.reporter.report().imageBytes;
  used += uint64_t(header->width) * header->height * 4;
  if (used > limits.maxImageBytes) {
    description.fail("limit", "with an image of " + size + " the images pass the limit of " +
                                  std::to_string(limits.maxImageBytes) + " bytes");
  }

  Result<Image> decoded = decodeImage(bytes, *header);
  if (!decoded) description.fail(decoded.error().code, decoded.error().message);
  decoded->name = description.stringOr("name", "");
  if (header->sixteenBit) m_document.reporter.count("16-bit images were reduced to 8 bits a channel", 1);
  m_sceneImages[index] = int32_t(m_scene.images.size());
  m_scene.images.push_back(decoded.take());
  return m_sceneImages[index];
}

}  // namespace limn::gltf
