// The scene's bindings; every shader that traces includes this first.
#ifndef LIMN_SCENE_BINDINGS_GLSL
#define LIMN_SCENE_BINDINGS_GLSL
#ifdef LIMN_RAY_QUERY
#extension GL_EXT_ray_query : require
#endif
#include "shaders/shared/bindings.h"
#include "shaders/shared/scene_shared.h"

// What the scene holds, fixed when a pipeline is made (gpu/needs_constants.hpp counts the same): a vector of lanes walks through
// every branch that any scene might need, so branches that this scene never takes are cut out.
layout(constant_id = 0) const bool kUseTextures = true;
layout(constant_id = 1) const bool kUseVertexColors = true;
layout(constant_id = 2) const bool kUseAlpha = true;
layout(constant_id = 3) const bool kUseSpecular = true;
layout(constant_id = 4) const bool kUseTransmission = true;
layout(constant_id = 5) const bool kUseClearcoat = true;
layout(constant_id = 6) const bool kUsePunctualLights = true;
layout(constant_id = 7) const bool kUseTriangleLights = true;
layout(constant_id = 8) const bool kUseEnvironment = true;
layout(constant_id = 9) const bool kUseEnvironmentImage = true;
layout(constant_id = 10) const bool kUseLightTree = true;
layout(constant_id = 11) const bool kUsePanes = true;

#ifdef LIMN_RAY_QUERY
layout(binding = BINDING_ACCELERATION) uniform accelerationStructureEXT bvhAcceleration;
#else
layout(binding = BINDING_BVH_NODES) uniform BVH_NODE_SAMPLER bvhNodes;
layout(binding = BINDING_BVH_TRIANGLES) uniform samplerBuffer bvhTriangles;
#endif
layout(binding = BINDING_TRIANGLES) uniform usamplerBuffer triangles;          // corners' vertices, material
layout(binding = BINDING_POSITIONS) uniform samplerBuffer positions;           // render space
layout(binding = BINDING_VERTICES) uniform usamplerBuffer vertices;            // two texels a vertex, gpu/packing.hpp
layout(binding = BINDING_TRIANGLE_LIGHTS) uniform usamplerBuffer triangleLights;  // light of a triangle, or kNoIndex
layout(binding = BINDING_MATERIALS, scalar) readonly buffer Materials { MaterialData materials[]; };
layout(binding = BINDING_TEXTURE_SLOTS, scalar) readonly buffer TextureSlots { TextureSlot textureSlots[]; };
layout(binding = BINDING_LIGHTS, scalar) readonly buffer Lights { LightData lights[]; };
layout(binding = BINDING_LIGHT_TREE) uniform usamplerBuffer lightTree;          // three texels a LightNode
layout(binding = BINDING_IMAGES, scalar) readonly buffer Images { ImageInfo images[]; };
layout(binding = BINDING_TEXELS) uniform usamplerBuffer texels;                // RGBA8 in one word
layout(binding = BINDING_ENVIRONMENT) uniform samplerBuffer environmentTexels; // RGBA float
layout(binding = BINDING_ENVIRONMENT_TABLE) uniform usamplerBuffer environmentTable;  // share, alias, probability of each cell
layout(binding = BINDING_SCENE_INFO, scalar) readonly buffer Info { SceneInfo sceneInfo; };
layout(binding = BINDING_CAMERA, scalar) readonly buffer Cameras { CameraData camera; };

#endif
