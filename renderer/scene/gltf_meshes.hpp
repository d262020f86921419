#pragma once
#include <optional>
#include <vector>

#include "renderer/scene/gltf_document.hpp"

namespace limn::gltf {

/// What bends a mesh at time zero.
struct Deformation {
  std::vector<double> morphWeights;       ///< one a morph target; empty: none
  std::vector<glm::dmat4> localFromBind;  ///< one a joint: the skinned node's space from the bind pose; empty: no skin
  bool empty() const { return morphWeights.empty() && localFromBind.empty(); }
};

/// Vertex attributes as the file holds them.
struct Attributes {
  Primitive vertices;                         ///< no indices yet; normals may be missing or not unit
  std::vector<std::vector<uint32_t>> joints;  ///< a set of JOINTS_n: 4 a vertex
  std::vector<std::vector<float>> weights;    ///< as joints
};

/// Moves positions, normals and tangents by morph targets, then by the skin; restPositions keep what was there where
/// there are any. `pointer` is the primitive's place. Throws Fault.
void deform(Document& document, const tinygltf::Primitive& source, const Deformation& deformation,
            const std::string& pointer, Attributes& attributes);

/// Mesh `index` as triangles, deformed. Counts towards the limits. Throws Fault.
Mesh readMesh(Document& document, const Scene& scene, uint32_t index, const Deformation& deformation);

}  // namespace limn::gltf
