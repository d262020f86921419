// The scene's bindings; every shader that traces includes this first.
#ifndef LIMN_SCENE_BINDINGS_GLSL
#define LIMN_SCENE_BINDINGS_GLSL
#include "shaders/shared/bindings.h"
#include "shaders/shared/scene_shared.h"

layout(binding = BINDING_BVH_NODES) uniform BVH_NODE_SAMPLER bvhNodes;
layout(binding = BINDING_BVH_TRIANGLES) uniform samplerBuffer bvhTriangles;
layout(binding = BINDING_TRIANGLES) uniform usamplerBuffer triangles;          // corners' vertices, material
layout(binding = BINDING_POSITIONS) uniform samplerBuffer positions;           // render space
layout(binding = BINDING_VERTICES) uniform usamplerBuffer vertices;            // two texels a vertex, gpu/packing.hpp
layout(binding = BINDING_TRIANGLE_LIGHTS) uniform usamplerBuffer triangleLights;  // light of a triangle, or kNoIndex
layout(binding = BINDING_MATERIALS, scalar) readonly buffer Materials { MaterialData materials[]; };
layout(binding = BINDING_LIGHTS, scalar) readonly buffer Lights { LightData lights[]; };
layout(binding = BINDING_IMAGES, scalar) readonly buffer Images { ImageInfo images[]; };
layout(binding = BINDING_TEXELS) uniform usamplerBuffer texels;                // RGBA8 in one word
layout(binding = BINDING_ENVIRONMENT) uniform samplerBuffer environmentTexels; // RGBA float
layout(binding = BINDING_ENVIRONMENT_TABLE) uniform usamplerBuffer environmentTable;  // share, alias, probability of each cell
layout(binding = BINDING_SCENE_INFO, scalar) readonly buffer Info { SceneInfo sceneInfo; };
layout(binding = BINDING_CAMERA, scalar) readonly buffer Cameras { CameraData camera; };

#endif
