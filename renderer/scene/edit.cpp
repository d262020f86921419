#include "renderer/scene/edit.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/scene/node_order.hpp"

namespace limn {
namespace {

constexpr const char* kCostNames[] = {"none", "display-only", "relight", "re-gather", "rebuild", "reload"};
constexpr const char* kToneMapNames[] = {"pbr-neutral", "aces", "agx", "linear"};
constexpr const char* kResolveViewNames[] = {"beauty", "direct", "indirect", "albedo",
                                             "normal", "depth",  "samples",  "placement"};

/// The enumerator of a name, its place in `names`.
template <class E, size_t N>
std::optional<E> fromName(const char* const (&names)[N], std::string_view name) {
  for (size_t i = 0; i < N; ++i) {
    if (name == names[i]) return E(i);
  }
  return std::nullopt;
}

template <class T, class V>
void assign(T& field, const std::optional<V>& value) {
  if (value) field = *value;
}

/// Unit quaternions pass unchanged, so that a value read back and set again changes nothing.
glm::dquat unit(const glm::dquat& q) { return std::abs(glm::dot(q, q) - 1.0) < 1e-12 ? q : glm::normalize(q); }

bool same(const Material& a, const Material& b) {
  return a.baseColor == b.baseColor && a.metallic == b.metallic && a.roughness == b.roughness &&
         a.emission == b.emission && a.ior == b.ior && a.transmission == b.transmission && a.thickness == b.thickness &&
         a.attenuationDistance == b.attenuationDistance && a.attenuationColor == b.attenuationColor &&
         a.specular == b.specular && a.specularColor == b.specularColor && a.clearcoat == b.clearcoat &&
         a.clearcoatRoughness == b.clearcoatRoughness && a.normalScale == b.normalScale &&
         a.alphaCutoff == b.alphaCutoff && a.alphaMode == b.alphaMode;
}

bool same(const Light& a, const Light& b) {
  return a.color == b.color && a.intensity == b.intensity && a.range == b.range &&
         a.innerConeAngle == b.innerConeAngle && a.outerConeAngle == b.outerConeAngle;
}

bool same(const Transform& a, const Transform& b) {
  return a.translation == b.translation && a.rotation == b.rotation && a.scale == b.scale && a.matrix == b.matrix;
}

bool same(const std::shared_ptr<const Image>& a, const std::shared_ptr<const Image>& b) {
  if (!a || !b || a == b) return a == b;
  return a->name == b->name && a->width == b->width && a->height == b->height && a->rgbaF == b->rgbaF;
}

bool same(const Environment& a, const Environment& b) {
  return a.radiance == b.radiance && a.rotation == b.rotation && same(a.image, b.image);
}

bool same(const Camera& a, const Camera& b) {
  return a.perspective == b.perspective && a.yfov == b.yfov && a.ymag == b.ymag && a.znear == b.znear;
}

bool same(const View& a, const View& b) {
  return a.eye == b.eye && a.target == b.target && a.up == b.up && same(a.lens, b.lens);
}

/// Remembers what the touched parts of the scene were before the batch, and tells in the end which of them differ.
class Batch {
 public:
  Batch(Scene& scene, ResolveSettings& resolve)
      : m_scene(scene), m_resolve(resolve), m_before{{}, {}, {}, scene.environment, scene.view, resolve} {}

  void operator()(const SetMaterial& e) {
    Material& m = touch(m_before.materials, m_scene.materials, e.material);
    assign(m.baseColor, e.baseColor);
    assign(m.metallic, e.metallic);
    assign(m.roughness, e.roughness);
    assign(m.emission, e.emission);
    assign(m.ior, e.ior);
    assign(m.transmission, e.transmission);
    assign(m.thickness, e.thickness);
    assign(m.attenuationDistance, e.attenuationDistance);
    assign(m.attenuationColor, e.attenuationColor);
    assign(m.specular, e.specular);
    assign(m.specularColor, e.specularColor);
    assign(m.clearcoat, e.clearcoat);
    assign(m.clearcoatRoughness, e.clearcoatRoughness);
    assign(m.normalScale, e.normalScale);
    assign(m.alphaCutoff, e.alphaCutoff);
    assign(m.alphaMode, e.alphaMode);
  }

  void operator()(const SetLight& e) {
    Light& light = touch(m_before.lights, m_scene.lights, e.light);
    assign(light.color, e.color);
    assign(light.intensity, e.intensity);
    assign(light.range, e.range);
    assign(light.innerConeAngle, e.innerConeAngle);
    assign(light.outerConeAngle, e.outerConeAngle);
  }

  void operator()(const SetNodeTransform& e) {
    Transform& t = m_scene.nodes[e.node].parentFromLocal;
    m_before.transforms.try_emplace(e.node, t);
    change(t, e);
  }

  void operator()(const SetEnvironment& e) {
    assign(m_scene.environment.radiance, e.radiance);
    assign(m_scene.environment.rotation, e.rotation);
    assign(m_scene.environment.image, e.image);
  }
  void operator()(const SetView& e) { m_scene.view = e.view; }
  void operator()(const SetResolve& e) {
    assign(m_resolve.exposure, e.exposure);
    assign(m_resolve.toneMap, e.toneMap);
    assign(m_resolve.view, e.view);
  }
  void operator()(const SetTechnique&) {}
  void operator()(const SetImageSize&) {}

  AppliedEdits take() {
    ChangeSet found = changes();
    return {std::move(found), std::move(m_before)};
  }

 private:
  ChangeSet changes() const {
    ChangeSet set;
    for (const auto& [index, before] : m_before.materials) {
      const Material& now = m_scene.materials[index];
      if (same(before, now)) continue;
      set.materials.push_back(index);
      if (before.emission != now.emission) set.emissive.push_back(index);
    }
    for (const auto& [index, before] : m_before.lights) {
      if (!same(before, m_scene.lights[index])) set.lights.push_back(index);
    }
    set.nodes = movedNodes();
    set.environment = !same(m_before.environment, m_scene.environment);
    set.environmentImage = !same(m_before.environment.image, m_scene.environment.image);
    set.view = !same(m_before.view, m_scene.view);
    set.resolve = m_before.resolve != m_resolve;
    return set;
  }

  template <class T>
  static T& touch(std::map<uint32_t, T>& before, std::vector<T>& items, uint32_t index) {
    before.try_emplace(index, items[index]);
    return items[index];
  }

  std::vector<uint32_t> movedNodes() const {
    std::vector<uint32_t> moved;
    for (const auto& [index, before] : m_before.transforms) {
      if (!same(before, m_scene.nodes[index].parentFromLocal)) moved.push_back(index);
    }
    std::vector<bool> seen(m_scene.nodes.size(), false);
    for (size_t at = 0; at < moved.size(); ++at) {
      if (seen[moved[at]]) continue;
      seen[moved[at]] = true;
      const std::vector<uint32_t>& children = m_scene.nodes[moved[at]].children;
      moved.insert(moved.end(), children.begin(), children.end());
    }
    std::sort(moved.begin(), moved.end());
    moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
    return moved;
  }

  Scene& m_scene;
  ResolveSettings& m_resolve;
  Overwritten m_before;
};

}  // namespace

const char* costClassName(CostClass cost) { return kCostNames[size_t(cost)]; }
const char* toneMapName(ToneMap map) { return kToneMapNames[size_t(map)]; }
const char* resolveViewName(ResolveView view) { return kResolveViewNames[size_t(view)]; }

std::optional<ToneMap> toneMapFromName(std::string_view name) { return fromName<ToneMap>(kToneMapNames, name); }
std::optional<ResolveView> resolveViewFromName(std::string_view name) {
  return fromName<ResolveView>(kResolveViewNames, name);
}

bool ChangeSet::empty() const {
  return !everything && materials.empty() && emissive.empty() && lights.empty() && nodes.empty() && !environment &&
         !view && !resolve;
}

CostClass ChangeSet::cost() const {
  if (everything) return CostClass::reload;
  if (!nodes.empty()) return CostClass::rebuild;
  if (!materials.empty() || view) return CostClass::regather;
  if (!lights.empty() || !emissive.empty() || environment) return CostClass::relight;
  return resolve ? CostClass::displayOnly : CostClass::none;
}

AppliedEdits apply(Scene& scene, ResolveSettings& resolve, const std::vector<Edit>& edits) {
  Batch batch(scene, resolve);
  for (const Edit& edit : edits) std::visit(batch, edit);
  return batch.take();
}

void change(Transform& t, const SetNodeTransform& edit) {
  if (t.matrix && (edit.rotation || edit.scale))
    t.matrix.reset();  // TRS, which holds the nearest decomposition, takes over
  assign(t.translation, edit.translation);
  assign(t.scale, edit.scale);
  if (edit.rotation) t.rotation = unit(*edit.rotation);
  if (t.matrix && edit.translation) (*t.matrix)[3] = glm::dvec4(*edit.translation, 1.0);
}

void takeBack(Scene& scene, ResolveSettings& resolve, const Overwritten& before) {
  for (const auto& [index, material] : before.materials) scene.materials[index] = material;
  for (const auto& [index, light] : before.lights) scene.lights[index] = light;
  for (const auto& [index, transform] : before.transforms) scene.nodes[index].parentFromLocal = transform;
  scene.environment = before.environment;
  scene.view = before.view;
  resolve = before.resolve;
}

}  // namespace limn
