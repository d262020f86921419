#include <bit>
#include <cstring>

#include "renderer/scene/scene.hpp"

namespace limn {
namespace {

/// A 64-bit hash of a stream of words: multiply and rotate per 8 bytes, finalised by xor-shifts. Not for security.
class Hasher {
 public:
  void word(uint64_t w) { m_state = std::rotl(m_state ^ (w * 0x9e3779b97f4a7c15ull), 29) * 0xbf58476d1ce4e5b9ull; }
  /// Zero and minus zero are the same value and hash the same.
  void number(float v) { word(std::bit_cast<uint32_t>(v + 0.0f)); }
  void number(double v) { word(std::bit_cast<uint64_t>(v + 0.0)); }
  void numbers(const float* v, size_t count) {
    for (size_t i = 0; i < count; ++i) number(v[i]);
  }
  void numbers(const double* v, size_t count) {
    for (size_t i = 0; i < count; ++i) number(v[i]);
  }

  /// The elements' bytes; for data that no edit rewrites.
  template <class T>
  void bulk(const std::vector<T>& data) {
    word(data.size());
    const auto* bytes = reinterpret_cast<const unsigned char*>(data.data());
    size_t left = data.size() * sizeof(T);
    for (; left >= 8; left -= 8, bytes += 8) {
      uint64_t w;
      std::memcpy(&w, bytes, 8);
      word(w);
    }
    if (left == 0) return;
    uint64_t tail = 0;
    std::memcpy(&tail, bytes, left);
    word(tail);
  }

  uint64_t finish() const {
    uint64_t h = m_state;
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ull;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebull;
    return h ^ (h >> 31);
  }

 private:
  uint64_t m_state = 0x6c696d6e7363656eull;
};

void add(Hasher& h, const TextureRef& t) {
  h.word(uint64_t(int64_t(t.image)));
  if (!t.present()) return;
  h.word(t.texCoord);
  h.word(uint64_t(t.wrapS));
  h.word(uint64_t(t.wrapT));
  h.word(t.nearest);
  h.numbers(&t.offset.x, 2);
  h.numbers(&t.scale.x, 2);
  h.number(t.rotation);
}

void add(Hasher& h, const Material& m) {
  h.numbers(&m.baseColor.x, 4);
  h.numbers(&m.emission.x, 3);
  h.numbers(&m.attenuationColor.x, 3);
  h.numbers(&m.specularColor.x, 3);
  for (const float v : {m.metallic, m.roughness, m.normalScale, m.alphaCutoff, m.ior, m.transmission, m.thickness,
                        m.attenuationDistance, m.specular, m.clearcoat, m.clearcoatRoughness, m.clearcoatNormalScale}) {
    h.number(v);
  }
  h.word(uint64_t(m.alphaMode));
  h.word(m.doubleSided);
  h.word(m.unlit);
  for (const TextureRef* t : {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.emissiveTexture,
                              &m.transmissionTexture, &m.specularTexture, &m.specularColorTexture, &m.clearcoatTexture,
                              &m.clearcoatRoughnessTexture, &m.clearcoatNormalTexture}) {
    add(h, *t);
  }
}

void add(Hasher& h, const Image& image) {
  h.word(image.width);
  h.word(image.height);
  h.bulk(image.rgba8);
  h.bulk(image.rgbaF);
}

void add(Hasher& h, const Primitive& p) {
  h.word(uint64_t(int64_t(p.material)));
  h.bulk(p.positions);
  h.bulk(p.restPositions);
  h.bulk(p.normals);
  h.bulk(p.tangents);
  h.bulk(p.uv0);
  h.bulk(p.uv1);
  h.bulk(p.colors);
  h.bulk(p.indices);
}

void add(Hasher& h, const Node& node) {
  for (const int32_t index : {node.parent, node.mesh, node.camera, node.light}) h.word(uint64_t(int64_t(index)));
  const Transform& t = node.parentFromLocal;
  h.word(t.matrix.has_value());
  if (t.matrix) {
    for (int column = 0; column < 4; ++column) h.numbers(&(*t.matrix)[column].x, 4);
    return;
  }
  h.numbers(&t.translation.x, 3);
  for (const double v : {t.rotation.w, t.rotation.x, t.rotation.y, t.rotation.z}) h.number(v);
  h.numbers(&t.scale.x, 3);
}

void add(Hasher& h, const Light& light) {
  h.word(uint64_t(light.type));
  h.numbers(&light.color.x, 3);
  for (const float v : {light.intensity, light.range, light.innerConeAngle, light.outerConeAngle}) h.number(v);
}

template <class T>
void addAll(Hasher& h, const std::vector<T>& items) {
  h.word(items.size());
  for (const T& item : items) add(h, item);
}

}  // namespace

uint64_t Scene::hash() const {
  Hasher h;
  addAll(h, images);
  addAll(h, materials);
  h.word(meshes.size());
  for (const Mesh& mesh : meshes) addAll(h, mesh.primitives);
  addAll(h, nodes);
  addAll(h, lights);
  h.word(environment.image != nullptr);
  if (environment.image) add(h, *environment.image);
  h.numbers(&environment.radiance.x, 3);
  h.number(environment.rotation);
  return h.finish();
}

}  // namespace limn
