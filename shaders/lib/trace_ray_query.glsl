// The functions of trace.glsl by hardware ray queries, for devices that have them (vk::Device::hasRayQuery()). The
// includer enables GL_EXT_ray_query, defines LIMN_RAY_QUERY and declares `accelerationStructureEXT bvhAcceleration`,
// the top of SceneAcceleration. What differs from the walk: of hits at the same t any may be reported, and t > 0 is only as good as the hardware's.
#ifndef LIMN_TRACE_RAY_QUERY_GLSL
#define LIMN_TRACE_RAY_QUERY_GLSL

bool traceScene(vec3 originR, vec3 dirR, float tMax, const bool any, inout uint alphaState, out Hit hit) {
  hit = Hit(tMax, kNoTriangle, vec2(0.0));
  rayQueryEXT query;
  uint flags = any ? gl_RayFlagsTerminateOnFirstHitEXT : gl_RayFlagsNoneEXT;
  rayQueryInitializeEXT(query, bvhAcceleration, flags, 0xffu, originR, 0.0, dirR, tMax);
  while (rayQueryProceedEXT(query)) {
#ifdef LIMN_ALPHA
    uint id = uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false)) +
              uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
    vec2 barycentrics = rayQueryGetIntersectionBarycentricsEXT(query, false);
    if (!LIMN_ALPHA_ENABLED || alphaAccepts(id, barycentrics, alphaState)) rayQueryConfirmIntersectionEXT(query);
#else
    rayQueryConfirmIntersectionEXT(query);
#endif
  }
  if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT) return false;
  hit.t = rayQueryGetIntersectionTEXT(query, true);
  hit.triangle = uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true)) +
                 uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
  hit.barycentrics = rayQueryGetIntersectionBarycentricsEXT(query, true);
  return true;
}

#endif
