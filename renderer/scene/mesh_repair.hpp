#pragma once
#include <cstdint>
#include <vector>

#include "renderer/scene/scene.hpp"

namespace limn {

/// Takes triangles without area (equal corners, or corners on a line) out of the index list; gives their number.
uint64_t dropDegenerateTriangles(Primitive& primitive);

/// Gives every triangle its own three vertices with the triangle's normal; all attributes follow.
void unshareWithFlatNormals(Primitive& primitive);

struct NormalRepair {
  uint64_t replaced = 0;  ///< zero, NaN or infinite: the area-weighted mean of the adjacent triangles instead
  uint64_t rescaled = 0;  ///< more than 1 % away from unit length
};
/// Makes every normal a unit vector.
NormalRepair repairNormals(Primitive& primitive);

/// Zero or broken tangents become any vector perpendicular to the normal, all become unit, w becomes -1 or 1; gives the
/// number replaced.
uint64_t repairTangents(Primitive& primitive);

/// Tangents for a normal map on texture coordinates `uv` (one a vertex), after the rules of MikkTSpace: each triangle
/// has the direction in which u grows; a vertex gets the mean of its triangles' directions, projected on the plane of
/// its normal and weighted by the corner's angle; vertices of equal position, normal and uv count as one; where
/// mirrored and unmirrored triangles meet, the vertex is split. w is 1 where v grows downwards as seen from outside
/// (glTF: bitangent = cross(normal, tangent) * w points to smaller v). Triangles without texture area give no
/// direction.
void generateTangents(Primitive& primitive, std::vector<glm::vec2> uv);

/// Vertices `source[i]` in order i, all attributes; indices are not touched.
void gatherVertices(Primitive& primitive, const std::vector<uint32_t>& source);

/// A unit vector perpendicular to the unit vector n.
glm::vec3 anyPerpendicular(const glm::vec3& n);

}  // namespace limn
