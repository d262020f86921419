// The scene as the device sees it; written by gpu::DeviceScene alone.
#ifndef LIMN_SCENE_SHARED_H
#define LIMN_SCENE_SHARED_H
#include "shaders/shared/shared.h"
#ifndef LIMN_GLSL
namespace limn::shared {
#endif

LIMN_CONST_UINT(kNoIndex, 0xffffffffu);
LIMN_CONST_FLOAT(kMinAlpha, 1e-4f);          // GGX alpha at and below which a lobe is a perfect mirror

LIMN_CONST_UINT(kMostPanes, 16u);            // that a shadow ray passes

// TextureSlot.sampler
LIMN_CONST_UINT(kSamplerWrapMask, 3u);       // wrapS in bits 0-1, wrapT in bits 2-3: 0 repeat, 1 clamp, 2 mirror
LIMN_CONST_UINT(kSamplerNearest, 1u << 4);
LIMN_CONST_UINT(kSamplerSrgb, 1u << 5);      // texels are sRGB-encoded
LIMN_CONST_UINT(kSamplerTexCoord1, 1u << 6);

// What a texture slot scales. TextureSlot.target
LIMN_CONST_UINT(kTargetBaseColor, 0u);
LIMN_CONST_UINT(kTargetMetallicRoughness, 1u);
LIMN_CONST_UINT(kTargetNormal, 2u);
LIMN_CONST_UINT(kTargetEmissive, 3u);
LIMN_CONST_UINT(kTargetTransmission, 4u);
LIMN_CONST_UINT(kTargetSpecular, 5u);
LIMN_CONST_UINT(kTargetSpecularColor, 6u);
LIMN_CONST_UINT(kTargetClearcoat, 7u);
LIMN_CONST_UINT(kTargetClearcoatRoughness, 8u);
LIMN_CONST_UINT(kTargetClearcoatNormal, 9u);

// One image of one material, in the order of targets; a material's slots follow each other.
struct TextureSlot {
  uint image;      // index into images
  uint sampler_;   // kSampler... bits
  vec3 rowU;       // u' = dot(rowU, (u, v, 1))
  vec3 rowV;       // v' = dot(rowV, (u, v, 1))
  uint target;     // kTarget...
  float scale;     // of a normal map's x and y
};
LIMN_ASSERT_SIZE(TextureSlot, 40);

struct ImageInfo {
  uint firstTexel; // in the texel heap
  uint width;      // [texel]
  uint height;     // [texel]
  uint pad;
};
LIMN_ASSERT_SIZE(ImageInfo, 16);

// MaterialData.flags
LIMN_CONST_UINT(kMaterialEmissive, 1u << 0);
LIMN_CONST_UINT(kMaterialUnlit, 1u << 1);
LIMN_CONST_UINT(kMaterialMask, 1u << 2);
LIMN_CONST_UINT(kMaterialBlend, 1u << 3);
LIMN_CONST_UINT(kMaterialThin, 1u << 4);     // transmits without bounding a volume
LIMN_CONST_UINT(kMaterialVertexColor, 1u << 5);

struct MaterialData {
  vec4 baseColor;            // linear Rec. 709, alpha
  vec3 emission;             // [W·sr⁻¹·m⁻²], both faces
  float metallic;            // 0..1
  float roughness;           // 0..1, perceptual; alpha = roughness²
  float ior;                 // 1..
  float transmission;        // 0..1
  float specular;            // 0..1
  vec3 specularColor;        // linear
  float clearcoat;           // 0..1
  float clearcoatRoughness;  // 0..1
  float alphaCutoff;         // 0..1
  vec3 absorption;           // [1/m], of the volume behind the surface
  uint flags;                // kMaterial... bits
  uint firstSlot;            // of its texture slots
  uint slotCount;
};
LIMN_ASSERT_SIZE(MaterialData, 96);

LIMN_CONST_UINT(kLightPoint, 0u);
LIMN_CONST_UINT(kLightSpot, 1u);
LIMN_CONST_UINT(kLightDirectional, 2u);
LIMN_CONST_UINT(kLightTriangle, 3u);
LIMN_CONST_UINT(kLightEnvironment, 4u);

struct LightData {
  vec3 posR;          // render space; point, spot
  uint type;          // kLight...
  vec3 dirR;          // unit, the way the light shines; spot, directional
  uint triangle;      // global triangle id; triangle lights
  vec3 color;         // point, spot: radiant intensity [W/sr]; directional: irradiance [W/m²]
  float invRange;     // [1/m], 0: infinite
  float spotScale;    // ramp = clamp(cos * spotScale + spotOffset, 0, 1)²
  float spotOffset;
  float area;         // [m²]; triangle lights
  float probability;  // of being chosen by the alias table, for its power
  float aliasShare;   // alias table: keep this entry below it
  uint alias;         // else take this one
  uint node;          // its leaf in the light tree; kNoIndex: it is in none
};
LIMN_ASSERT_SIZE(LightData, 76);

LIMN_CONST_UINT(kLightLeaf, 1u << 31);     // of LightNode.child
LIMN_CONST_FLOAT(kTwoSidedEnd, 0.0f);      // of emitters that shine by the cosine, from both faces, and points
LIMN_CONST_FLOAT(kSpotEnd, 0.999f);        // of spots: nothing outside the cone but what rounding needs

// Lights of one branch of the light tree, bounded in place and direction. Siblings follow each other, and nodes 0 and 1
// are the roots. [Conty Estevez and Kulla 2018]
struct LightNode {
  vec3 centerR;       // of a sphere around them, render space
  float radius;       // [m]
  vec3 axis;          // unit, of a cone that holds the ways their emission is strongest
  float cosOpening;   // of half the cone's angle; -1: any way
  float intensity;    // [W/sr] of all together, each the way it is strongest; luminance
  float cosEnd;       // of the angle off the cone beyond which nothing is sent: kTwoSidedEnd or kSpotEnd
  uint child;         // first of two; or kLightLeaf and the light's index
  uint parent;        // kNoIndex for the roots
};
LIMN_ASSERT_SIZE(LightNode, 48);

// One for the scene.
struct SceneInfo {
  uint lightCount;
  uint environmentLight;     // index into lights, kNoIndex when the environment is black
  uint environmentWidth;     // [texel], 0: constant radiance
  uint environmentHeight;    // [texel]
  vec3 environmentRadiance;  // [W·sr⁻¹·m⁻²], multiplies the image
  float environmentRotation; // [rad] about +y
  uint distributionWidth;    // cells of the environment's importance table, 0: uniform over the sphere
  uint distributionHeight;
  float sceneRadius;         // [m], of the bounding sphere
  uint triangleCount;
  float lightTreeShare;      // chance that a light is chosen by the light tree, not the alias table; 0: there is no tree
};
LIMN_ASSERT_SIZE(SceneInfo, 52);

struct CameraData {
  vec3 eyeR;        // [m], render space
  float clipNear;   // [m] along the view axis
  vec3 right;       // perspective: half width of the image plane at distance 1; orthographic: half width [m]
  uint perspective; // 1: perspective, 0: orthographic
  vec3 up;          // as right, half height
  uint width;       // [pixel]
  vec3 forward;     // unit
  uint height;      // [pixel]
};
LIMN_ASSERT_SIZE(CameraData, 64);

#ifndef LIMN_GLSL
}  // namespace limn::shared
#endif
#endif
