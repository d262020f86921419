#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace limn {

constexpr int32_t kNone = -1;  ///< an absent index

/// 8-bit RGBA texels as the file holds them (sRGB or linear is the use's matter), or float RGBA for environments.
struct Image {
  std::string name;
  uint32_t width = 0, height = 0;   ///< [texel]
  std::vector<uint8_t> rgba8;       ///< width*height*4, row 0 on top; empty when rgbaF is used
  std::vector<float> rgbaF;         ///< width*height*4, linear Rec. 709
};

enum class Wrap : uint32_t { repeat, clampToEdge, mirroredRepeat };

/// An image with its sampler and UV transform (KHR_texture_transform), as one material slot uses it.
struct TextureRef {
  int32_t image = kNone;
  uint32_t texCoord = 0;            ///< 0 or 1
  Wrap wrapS = Wrap::repeat, wrapT = Wrap::repeat;
  bool nearest = false;             ///< magFilter NEAREST
  glm::vec2 offset{0.0f}, scale{1.0f};
  float rotation = 0.0f;            ///< [rad], counter-clockwise
  bool present() const { return image != kNone; }
};

enum class AlphaMode : uint32_t { opaque, mask, blend };

/// glTF metallic-roughness with the extensions of DESIGN.md section 4.
struct Material {
  std::string name;
  glm::vec4 baseColor{1.0f};        ///< linear Rec. 709, alpha
  float metallic = 1.0f, roughness = 1.0f;
  glm::vec3 emission{0.0f};         ///< emissiveFactor x emissiveStrength [W·sr⁻¹·m⁻²], both faces
  float normalScale = 1.0f;
  AlphaMode alphaMode = AlphaMode::opaque;
  float alphaCutoff = 0.5f;
  bool doubleSided = false;
  bool unlit = false;               ///< KHR_materials_unlit: base colour is shown as radiance, nothing bounces
  float ior = 1.5f;
  float transmission = 0.0f;
  float thickness = 0.0f;           ///< 0: thin-walled; > 0: the mesh bounds a volume
  glm::vec3 attenuationColor{1.0f};
  float attenuationDistance = 0.0f; ///< [m]; 0: no attenuation
  float specular = 1.0f;
  glm::vec3 specularColor{1.0f};
  float clearcoat = 0.0f, clearcoatRoughness = 0.0f;
  float clearcoatNormalScale = 1.0f;
  TextureRef baseColorTexture, metallicRoughnessTexture, normalTexture, emissiveTexture, transmissionTexture,
      specularTexture, specularColorTexture, clearcoatTexture, clearcoatRoughnessTexture, clearcoatNormalTexture;
};

/// Indexed triangles of one material in the mesh's own space. Normals are unit and always present after loading;
/// tangents are present when the material has a normal map; other attributes may be empty.
struct Primitive {
  int32_t material = kNone;         ///< kNone: the default material
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> restPositions;  ///< before morph targets and skin; empty: nothing bends the primitive
  std::vector<glm::vec3> normals;
  std::vector<glm::vec4> tangents;  ///< w: handedness
  std::vector<glm::vec2> uv0, uv1;
  std::vector<glm::vec4> colors;    ///< linear, multiplies the base colour
  std::vector<uint32_t> indices;    ///< 3 a triangle, each < positions.size()
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
};

/// Translation, rotation, scale of a node against its parent; double, so that far scenes keep their precision.
struct Transform {
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 scale{1.0};
  std::optional<glm::dmat4> matrix;  ///< set: a matrix that TRS cannot express; then TRS is not used
  glm::dmat4 toMatrix() const;
};

struct Node {
  std::string name;
  int32_t parent = kNone;
  std::vector<uint32_t> children;
  Transform parentFromLocal;
  int32_t mesh = kNone, camera = kNone, light = kNone;
};

enum class LightType : uint32_t { point, spot, directional };

/// KHR_lights_punctual; shines along the node's -z.
struct Light {
  std::string name;
  LightType type = LightType::point;
  glm::vec3 color{1.0f};            ///< linear Rec. 709
  float intensity = 1.0f;           ///< point, spot: radiant intensity [W/sr]; directional: irradiance [W/m²]
  float range = 0.0f;               ///< [m]; 0: infinite
  float innerConeAngle = 0.0f, outerConeAngle = 0.7853981634f;  ///< [rad]
};

/// Perspective or orthographic lens (glTF camera).
struct Camera {
  std::string name;
  bool perspective = true;
  float yfov = 0.8f;                ///< [rad]
  float ymag = 1.0f;                ///< orthographic half height [m]
  float znear = 0.01f;              ///< [m]; hits nearer than this are clipped
};

/// Light from infinitely far away: a constant radiance, or a latitude-longitude image times it.
struct Environment {
  std::shared_ptr<const Image> image;  ///< float, named by its path below the asset root; null: constant
  glm::vec3 radiance{0.0f};         ///< [W·sr⁻¹·m⁻²]; multiplies the image
  float rotation = 0.0f;            ///< [rad] about +y
};

/// Where the picture is taken from. Kept apart from glTF cameras: a viewer moves it without touching the scene.
struct View {
  glm::dvec3 eye{0.0, 0.0, 1.0};    ///< [m], world space
  glm::dvec3 target{0.0};           ///< the point orbited about
  glm::dvec3 up{0.0, 1.0, 0.0};
  Camera lens;
};

/// The only truth: plain data, no device objects. Derived data (BVH, device mirror, points) is never stored here.
struct Scene {
  std::string name;                 ///< file name without directory
  std::vector<Image> images;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Node> nodes;          ///< parents need not precede children
  std::vector<uint32_t> roots;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  Environment environment;
  View view;                        ///< the first camera, or one that frames the scene

  /// World matrix of every node, in index order; double precision.
  std::vector<glm::dmat4> worldFromNodes() const;
  /// A view through glTF camera `index` placed by the node that carries it; nothing when no node does.
  std::optional<View> viewOfCamera(uint32_t index) const;
  /// Order-free of history: equal data gives equal hash. Geometry, images, materials, lights, transforms, environment.
  uint64_t hash() const;
};

/// World bounds of all triangles; empty scenes give a unit box about the origin.
struct Bounds {
  glm::dvec3 low{0.0}, high{0.0};
  glm::dvec3 center() const { return (low + high) * 0.5; }
  double radius() const { return glm::length(high - low) * 0.5; }
};
Bounds worldBounds(const Scene& scene);
/// Of the triangles of one mesh; the node's place where it has none.
Bounds worldBounds(const Mesh& mesh, const glm::dmat4& worldFromNode);

/// A view that frames the whole scene.
View framingView(const Bounds& bounds, const Camera& lens);

}  // namespace limn
