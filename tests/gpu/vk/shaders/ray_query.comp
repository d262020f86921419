#version 460
#extension GL_EXT_ray_query : require
// Shoots a ray down the negative z axis from each start; writes instance, geometry, primitive and distance of the hit.
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1) readonly buffer In { vec4 starts[]; };
layout(set = 0, binding = 2) writeonly buffer Out { vec4 hits[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene, gl_RayFlagsOpaqueEXT, 0xff, starts[i].xyz, 0.0, vec3(0, 0, -1), 100.0);
  while (rayQueryProceedEXT(query)) {}
  hits[i] = vec4(-1.0);
  if (rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionTriangleEXT) return;
  hits[i] = vec4(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true),
                 rayQueryGetIntersectionGeometryIndexEXT(query, true),
                 rayQueryGetIntersectionPrimitiveIndexEXT(query, true), rayQueryGetIntersectionTEXT(query, true));
}
