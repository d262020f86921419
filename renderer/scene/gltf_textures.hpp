#pragma once
#include <vector>

#include "renderer/scene/gltf_document.hpp"

namespace limn::gltf {

/// Turns textureInfo objects into TextureRefs and decodes an image when the first of them needs it.
class Textures {
 public:
  Textures(Document& document, Scene& scene);

  /// The member `key` of `owner` as a reference; absent, or not supported and then reported: one that is not present().
  /// Throws Fault: out-of-range, bad-file, unsupported (no PNG, no JPEG), limit, io, path.
  TextureRef read(const Value& owner, const char* key, const std::string& material);

 private:
  int32_t image(uint32_t index);
  std::vector<uint8_t> fileBytes(const Value& image);

  Document& m_document;
  Scene& m_scene;
  uint64_t m_encodedBytes = 0;         // of the image files read so far
  std::vector<int32_t> m_sceneImages;  // by glTF image; kNone: not decoded yet
};

}  // namespace limn::gltf
