#include "renderer/gpu/light_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "renderer/base/luminance.hpp"
#include "renderer/gpu/alias_table.hpp"
#include "renderer/gpu/light_tree.hpp"
#include "renderer/scene/scene_needs.hpp"

namespace limn::gpu {
namespace {

constexpr double kPi = std::numbers::pi;

double srgbToLinear(uint8_t v) {
  const double c = v / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

glm::vec3 meanLinear(const Image& image) {
  double lut[256];
  for (int i = 0; i < 256; ++i) lut[i] = srgbToLinear(uint8_t(i));
  glm::dvec3 sum(0.0);
  const size_t n = image.rgba8.size() / 4;
  for (size_t i = 0; i < n; ++i) sum += glm::dvec3(lut[image.rgba8[4 * i]], lut[image.rgba8[4 * i + 1]], lut[image.rgba8[4 * i + 2]]);
  return n ? glm::vec3(sum / double(n)) : glm::vec3(1.0f);
}

glm::vec3 meanRadiance(const Scene& scene) {
  const Environment& e = scene.environment;
  if (!e.image) return e.radiance;
  const Image& image = *e.image;
  glm::dvec3 sum(0.0);
  double weights = 0.0;
  for (uint32_t y = 0; y < image.height; ++y) {
    const double w = std::sin((y + 0.5) / image.height * kPi);
    glm::dvec3 row(0.0);
    for (uint32_t x = 0; x < image.width; ++x) {
      const float* t = &image.rgbaF[(size_t(y) * image.width + x) * 4];
      row += glm::dvec3(t[0], t[1], t[2]);
    }
    sum += row * w;
    weights += w * image.width;
  }
  return weights > 0.0 ? e.radiance * glm::vec3(sum / weights) : glm::vec3(0.0f);
}

struct Builder {
  LightTable table;
  std::vector<double> powers;
  std::vector<LightBounds> placed;  ///< those at a place

  void add(shared::LightData light, double power) {
    light.node = shared::kNoIndex;
    table.lights.push_back(light);
    powers.push_back(power);
  }
  void add(const shared::LightData& light, double power, LightBounds bounds) {
    bounds.light = uint32_t(table.lights.size());
    placed.push_back(bounds);
    add(light, power);
  }
};

void addPunctual(Builder& b, const Light& light, const glm::dmat4& world, const glm::dvec3& origin, double sceneRadius) {
  shared::LightData d{};
  d.triangle = shared::kNoIndex;
  d.posR = glm::vec3(glm::dvec3(world[3]) - origin);
  const glm::dvec3 direction = -glm::dvec3(world[2]);
  const double length = glm::length(direction);
  d.dirR = length > 0.0 ? glm::vec3(direction / length) : glm::vec3(0.0f, 0.0f, -1.0f);
  d.color = light.color * light.intensity;
  d.invRange = light.range > 0.0f ? 1.0f / light.range : 0.0f;
  const double value = luminance(d.color);
  if (!(value > 0.0)) return;
  switch (light.type) {
    case LightType::point:
      d.type = shared::kLightPoint;
      return b.add(d, 4.0 * kPi * value, pointBounds(d.posR, value));
    case LightType::spot: {
      d.type = shared::kLightSpot;
      const float inner = std::cos(light.innerConeAngle), outer = std::cos(light.outerConeAngle);
      d.spotScale = 1.0f / std::max(0.001f, inner - outer);
      d.spotOffset = -outer * d.spotScale;
      return b.add(d, 2.0 * kPi * (1.0 - double(outer)) * value, spotBounds(d.posR, d.dirR, outer, value));
    }
    case LightType::directional:
      d.type = shared::kLightDirectional;
      return b.add(d, kPi * sceneRadius * sceneRadius * value);
  }
}

double triangleArea(const glm::vec3* corner) {
  return 0.5 * glm::length(glm::cross(glm::dvec3(corner[1]) - glm::dvec3(corner[0]), glm::dvec3(corner[2]) - glm::dvec3(corner[0])));
}

void addEmissiveBlock(Builder& b, const Scene& scene, const GeometryBlock& block, std::map<int32_t, glm::vec3>& means) {
  const Material& m = scene.materials[block.material - 1];
  glm::vec3 emission = m.emission;
  if (m.emissiveTexture.present()) {
    auto [entry, isNew] = means.try_emplace(m.emissiveTexture.image);
    if (isNew) entry->second = meanLinear(scene.images[size_t(m.emissiveTexture.image)]);
    // A part of the picture that this mesh shows may be brighter than the mean says: no emitter gets less than a tenth.
    emission *= glm::max(entry->second, glm::vec3(0.1f));
  }
  for (uint32_t t = 0; t < block.triangleCount(); ++t) {
    const glm::vec3* corner = &block.corners[size_t(t) * 3];
    const double area = triangleArea(corner), intensity = area * luminance(emission), power = 2.0 * kPi * intensity;
    if (!(power > 0.0)) continue;
    shared::LightData d{};
    d.type = shared::kLightTriangle;
    d.triangle = block.firstTriangle + t;
    d.area = float(area);
    b.table.lightOfTriangle[d.triangle] = uint32_t(b.table.lights.size());
    b.add(d, power, triangleBounds(corner, intensity));
  }
}

/// Neither kind of light gets less: power tells how much of it arrives in all, not what arrives at a place; and a choice
/// needs the digits that the one between tree and table leaves of its random number.
constexpr double kLeastShare = 0.125;

/// Moves the lights at a place from the alias table's care to a tree's.
void plantTree(Builder& b) {
  if (b.placed.size() <= kFewLights) return;
  double placed = 0.0;
  for (const LightBounds& bounds : b.placed) placed += std::exchange(b.powers[bounds.light], 0.0);
  const double infinite = std::accumulate(b.powers.begin(), b.powers.end(), 0.0);
  const double share = placed / (placed + infinite);
  b.table.treeShare = infinite > 0.0 ? float(std::clamp(share, kLeastShare, 1.0 - kLeastShare)) : 1.0f;
  b.table.tree = buildLightTree(b.placed);
  for (uint32_t node = 0; node < b.table.tree.size(); ++node)
    if (const uint32_t child = b.table.tree[node].child; child & shared::kLightLeaf)
      b.table.lights[child & ~shared::kLightLeaf].node = node;
}

}  // namespace

LightTable buildLightTable(const Scene& scene, const std::vector<GeometryBlock>& blocks, const glm::dvec3& renderOrigin,
                           double sceneRadius) {
  Builder b;
  const std::vector<glm::dmat4> worlds = scene.worldFromNodes();
  for (size_t node = 0; node < scene.nodes.size(); ++node)
    if (scene.nodes[node].light != kNone)
      addPunctual(b, scene.lights[size_t(scene.nodes[node].light)], worlds[node], renderOrigin, sceneRadius);

  size_t triangleCount = 0;
  for (const GeometryBlock& block : blocks) triangleCount += block.triangleCount();
  b.table.lightOfTriangle.assign(triangleCount, shared::kNoIndex);
  std::map<int32_t, glm::vec3> means;
  for (const GeometryBlock& block : blocks)
    if (block.material > 0 && luminance(scene.materials[block.material - 1].emission) > 0.0 && !scene.materials[block.material - 1].unlit)
      addEmissiveBlock(b, scene, block, means);

  const double environment = luminance(meanRadiance(scene));
  if (environment > 0.0) {
    shared::LightData d{};
    d.type = shared::kLightEnvironment;
    d.triangle = shared::kNoIndex;
    b.table.environmentLight = uint32_t(b.table.lights.size());
    b.add(d, 4.0 * kPi * kPi * sceneRadius * sceneRadius * environment);
  }

  plantTree(b);
  const std::vector<AliasEntry> alias = buildAliasTable(b.powers);
  for (size_t i = 0; i < alias.size(); ++i) {
    b.table.lights[i].probability = alias[i].probability * (1.0f - b.table.treeShare);
    b.table.lights[i].aliasShare = alias[i].share;
    b.table.lights[i].alias = alias[i].alias;
  }
  return std::move(b.table);
}

}  // namespace limn::gpu
