#pragma once
#include "renderer/scene/gltf_document.hpp"

namespace limn::gltf {

/// The nodes of the default scene with their lights and cameras, and the meshes that they carry: bent ones once a node,
/// others shared. EXT_mesh_gpu_instancing becomes child nodes. Throws Fault.
void readNodes(Document& document, Scene& scene);

/// TRS when it expresses the matrix to 1e-5, otherwise the matrix beside the nearest TRS.
Transform transformFromMatrix(const glm::dmat4& matrix);

/// The instances of a node that EXT_mesh_gpu_instancing asks for; empty when it does not. Throws Fault.
std::vector<Transform> instancesOf(const Document& document, const Value& node);

}  // namespace limn::gltf
