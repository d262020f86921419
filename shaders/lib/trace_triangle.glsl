// A watertight ray-triangle test: neighbours compute a shared edge from the same numbers, so no ray slips between them.
#ifndef LIMN_TRACE_TRIANGLE_GLSL
#define LIMN_TRACE_TRIANGLE_GLSL

// The ray's own coordinates: x and y across it, z the ray parameter t.
struct TraceFrame {
  vec3 originR;
  vec3 across;
  vec3 up;
  vec3 along;
};

TraceFrame makeTraceFrame(vec3 originR, vec3 dirR) {
  TraceFrame f;
  f.originR = originR;
  f.along = dirR / dot(dirR, dirR);
  vec3 n = normalize(dirR);
  float s = n.z >= 0.0 ? 1.0 : -1.0;
  float a = -1.0 / (s + n.z);
  float c = n.x * n.y * a;
  f.across = vec3(1.0 + s * n.x * n.x * a, s * c, -s * n.x);
  f.up = vec3(c, s + n.y * n.y * a, -n.y);
  return f;
}

vec3 toTraceFrame(TraceFrame f, vec3 posR) {
  vec3 p = posR - f.originR;
  return vec3(dot(p, f.across), dot(p, f.up), dot(p, f.along));
}

// The hit's (weight of corner 1, weight of corner 2, t). False on a miss; edges count as inside, triangles seen from
// their edge are missed. The edge functions keep both products rounded apart: swapping two corners must only flip the
// sign.
bool hitTriangle(TraceFrame f, vec3 cornerA, vec3 cornerB, vec3 cornerC, out vec3 hit) {
  vec3 a = toTraceFrame(f, cornerA);
  vec3 b = toTraceFrame(f, cornerB);
  vec3 c = toTraceFrame(f, cornerC);
  precise float u1 = c.x * b.y, u2 = c.y * b.x;
  precise float v1 = a.x * c.y, v2 = a.y * c.x;
  precise float w1 = b.x * a.y, w2 = b.y * a.x;
  precise float u = u1 - u2, v = v1 - v2, w = w1 - w2;
  float det = u + v + w;
  bool inside = min(u, min(v, w)) >= 0.0 || max(u, max(v, w)) <= 0.0;
  vec3 weights = vec3(u, v, w) * (1.0 / det);
  hit = vec3(weights.yz, dot(weights, vec3(a.z, b.z, c.z)));
  return inside && det != 0.0;
}

#endif
