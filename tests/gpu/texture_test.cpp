#include <cmath>
#include <random>

#include "renderer/gpu/device_scene.hpp"
#include "tests/gpu/kernel.hpp"
#include "tests/gpu/textures.spv.hpp"
#include "tests/support/scene_builder.hpp"

namespace limn::test {
namespace {

Image noise(uint32_t width, uint32_t height, uint32_t seed) {
  std::mt19937 engine(seed);
  Image image;
  image.width = width;
  image.height = height;
  for (uint32_t i = 0; i < 4 * width * height; ++i) image.rgba8.push_back(uint8_t(engine()));
  return image;
}

/// Index of a texel as OpenGL's wrap modes count it.
int wrapped(int64_t i, int size, Wrap mode) {
  if (mode == Wrap::clampToEdge) return int(std::clamp<int64_t>(i, 0, size - 1));
  const int64_t period = mode == Wrap::mirroredRepeat ? 2 * size : size, r = ((i % period) + period) % period;
  return int(r < size ? r : period - 1 - r);
}

glm::dvec4 texel(const Image& image, const TextureRef& ref, bool srgb, int64_t x, int64_t y) {
  const size_t at =
      size_t(wrapped(y, int(image.height), ref.wrapT)) * image.width + size_t(wrapped(x, int(image.width), ref.wrapS));
  glm::dvec4 c;
  for (int k = 0; k < 4; ++k) {
    c[k] = image.rgba8[4 * at + size_t(k)] / 255.0;
    if (srgb && k < 3) c[k] = c[k] <= 0.04045 ? c[k] / 12.92 : std::pow((c[k] + 0.055) / 1.055, 2.4);
  }
  return c;
}

/// glTF's sampler after KHR_texture_transform, in double precision. Rotations are counter-clockwise as seen with v
/// downwards, as its text and the viewers have it; the GLSL in its README turns the other way.
glm::dvec4 reference(const Image& image, const TextureRef& ref, bool srgb, const glm::vec4& coordinates) {
  const glm::dvec2 uv =
      ref.texCoord == 1 ? glm::dvec2(coordinates.z, coordinates.w) : glm::dvec2(coordinates.x, coordinates.y);
  const glm::dvec2 scaled = uv * glm::dvec2(ref.scale);
  const double c = std::cos(double(ref.rotation)), s = std::sin(double(ref.rotation));
  const glm::dvec2 turned(c * scaled.x + s * scaled.y, -s * scaled.x + c * scaled.y);
  const glm::dvec2 st = (turned + glm::dvec2(ref.offset)) * glm::dvec2(image.width, image.height);
  if (ref.nearest) return texel(image, ref, srgb, int64_t(std::floor(st.x)), int64_t(std::floor(st.y)));
  const double x = std::floor(st.x - 0.5), y = std::floor(st.y - 0.5), fx = st.x - 0.5 - x, fy = st.y - 0.5 - y;
  const auto at = [&](int dx, int dy) { return texel(image, ref, srgb, int64_t(x) + dx, int64_t(y) + dy); };
  return (at(0, 0) * (1 - fx) + at(1, 0) * fx) * (1 - fy) + (at(0, 1) * (1 - fx) + at(1, 1) * fx) * fy;
}

/// One material a variant, its picture as base colour (sRGB) and as metallic-roughness (linear).
SceneBuilder variants(std::vector<TextureRef>& slots) {
  SceneBuilder b;
  b.scene.images = {noise(7, 5, 1), noise(16, 8, 2), noise(1, 1, 3)};
  for (const Wrap wrapS : {Wrap::repeat, Wrap::clampToEdge, Wrap::mirroredRepeat})
    for (const Wrap wrapT : {Wrap::repeat, Wrap::clampToEdge, Wrap::mirroredRepeat})
      for (const bool nearest : {false, true})
        for (const bool moved : {false, true}) {
          TextureRef ref;
          ref.image = int32_t(slots.size() / 2 % 3);
          ref.wrapS = wrapS;
          ref.wrapT = wrapT;
          ref.nearest = nearest;
          if (moved) {
            ref.texCoord = 1;
            ref.offset = {0.3f, -0.7f};
            ref.scale = {1.7f, -0.6f};
            ref.rotation = 0.6f;
          }
          Material m;
          m.baseColorTexture = m.metallicRoughnessTexture = ref;
          b.quad(b.material(m), {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
          slots.push_back(ref);
          slots.push_back(ref);
        }
  return b;
}

TEST(Texture, EverySamplerMatchesTheReference) {
  std::vector<TextureRef> slots;
  const SceneBuilder b = variants(slots);
  gpu::DeviceScene mirror(SharedDevice::get());
  ChangeSet everything;
  everything.everything = true;
  must(mirror.sync(b.scene, everything));

  std::mt19937 engine(4);
  std::uniform_real_distribution<float> wide(-4, 5), unit(0, 1);
  std::vector<glm::vec4> coordinates{
      {0, 0, 0, 0}, {0.5f, 0.5f, 0.5f, 0.5f}, {0.999f, 0.001f, 0.001f, 0.999f}, {-1.25f, 2.75f, 3.5f, -2.5f}};
  for (int i = 0; i < 500; ++i) coordinates.push_back({unit(engine), unit(engine), unit(engine), unit(engine)});
  for (int i = 0; i < 500; ++i) coordinates.push_back({wide(engine), wide(engine), wide(engine), wide(engine)});
  const vk::Buffer in = inputOf(coordinates);

  struct Push {
    uint32_t slot, count;
  };
  for (uint32_t slot = 0; slot < slots.size(); ++slot) {
    const bool srgb = slot % 2 == 0;  // a material's slots: base colour, then metallic-roughness
    const Image& image = b.scene.images[size_t(slots[slot].image)];
    const auto sampled = runKernel<glm::vec4>(texturesSpirv, gpu::joined(mirror.bindings(), {vk::storage(31, in)}),
                                              Push{slot, uint32_t(coordinates.size())}, coordinates.size(),
                                              groupsFor(coordinates.size()));
    int wrong = 0;
    for (size_t i = 0; i < coordinates.size(); ++i) {
      const glm::dvec4 difference = glm::dvec4(sampled[i]) - reference(image, slots[slot], srgb, coordinates[i]);
      wrong += std::sqrt(glm::dot(difference, difference)) > 1e-4;
    }
    // Where a coordinate lies on the border of two texels, rounding picks one.
    EXPECT_LE(wrong, slots[slot].nearest ? 4 : 0) << "slot " << slot;
  }
}

}  // namespace
}  // namespace limn::test
