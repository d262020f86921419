// One of many lights, chosen by what it may bring to a place: its intensity, distance and direction, all bounded for whole
// branches of a tree. [Conty Estevez and Kulla 2018] gpu/light_tree.cpp builds it. All of it is precise: a compiler that
// rounded otherwise in another variant of a pipeline would have another light chosen now and then.
#ifndef LIMN_LIGHT_TREE_GLSL
#define LIMN_LIGHT_TREE_GLSL
#include "shaders/lib/math.glsl"

// Whom light is chosen for.
struct LightReceiver {
  vec3 posR;
  vec3 normal;  // unit, geometric: light from behind counts only for `both` sides
  bool both;
};

LightNode lightNode(uint index) {
  uvec4 a = texelFetch(lightTree, int(3u * index)), b = texelFetch(lightTree, int(3u * index + 1u)),
        c = texelFetch(lightTree, int(3u * index + 2u));
  return LightNode(uintBitsToFloat(a.xyz), uintBitsToFloat(a.w), uintBitsToFloat(b.xyz), uintBitsToFloat(b.w),
                   uintBitsToFloat(c.x), uintBitsToFloat(c.y), c.z, c.w);
}

// (cos, sin) of an angle in [0, pi], from its cosine.
vec2 angleOf(float cosine) {
  precise float sine2 = 1.0 - cosine * cosine;
  return vec2(cosine, sqrt(max(sine2, 0.0)));
}
// Of max(a - b, 0).
vec2 angleBeyond(vec2 a, vec2 b) {
  precise vec2 difference = vec2(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y);
  return a.x > b.x ? vec2(1.0, 0.0) : difference;
}

// In proportion to the most irradiance that a node's lights may bring together from where their centre is; 0 only where
// none of them brings any. A light low above the surface keeps a tenth, for lobes that are not diffuse.
float importanceOf(LightNode n, LightReceiver at) {
  const float kLow = 0.1, kRounding = 1e-3, kLeast = 1e-37, kMost = 1e30;
  precise vec3 way = n.centerR - at.posR;
  precise float d2 = dot(way, way), r2 = n.radius * n.radius;
  if (d2 <= r2) return clamp(n.intensity / max(r2, kLeast), kLeast, kMost);
  way *= inversesqrt(d2);
  precise vec2 size = vec2(sqrt(max(1.0 - r2 / d2, 0.0)), sqrt(r2 / d2));  // half the angle that the node fills

  precise float cosReceiver = dot(way, at.normal), cosAxis = -dot(way, n.axis);
  float facing = angleBeyond(angleOf(at.both ? abs(cosReceiver) : cosReceiver), size).x;
  vec2 off = angleBeyond(angleOf(n.cosEnd == kTwoSidedEnd ? abs(cosAxis) : cosAxis), angleOf(n.cosOpening));
  float sent = angleBeyond(off, size).x;
  if (facing < -kRounding || sent < n.cosEnd - kRounding) return 0.0;
  precise float most = n.intensity * sent * mix(kLow, 1.0, max(facing, 0.0)) / d2;
  return clamp(most, kLeast, kMost);
}

// A light of the tree, or kNoIndex where none brings anything. Every step down uses up digits of u.x, and then of u.y.
uint chooseFromTree(LightReceiver at, vec2 u, out float probability) {
  const float kUsedUp = 1.0 / 256.0;
  probability = 1.0;
  bool usedUp = false;
  for (uint first = 0u;;) {
    LightNode left = lightNode(first), right = lightNode(first + 1u);
    float a = importanceOf(left, at), b = importanceOf(right, at);
    if (!(a + b > 0.0)) return kNoIndex;
    precise float share = a / (a + b), inLeft = u.x / share, inRight = (u.x - share) / (1.0 - share);
    bool isLeft = u.x < share || !(b > 0.0);
    u.x = min(isLeft ? inLeft : inRight, 0.99999994);
    probability *= isLeft ? share : b / (a + b);
    uint child = isLeft ? left.child : right.child;
    if ((child & kLightLeaf) != 0u) return child & ~kLightLeaf;
    first = child;
    if (!usedUp && probability < kUsedUp) {
      u.x = u.y;
      usedUp = true;
    }
  }
}

// That chooseFromTree() ends at leaf `node`.
float treeProbability(LightReceiver at, uint node) {
  float probability = 1.0;
  while (node != kNoIndex && probability > 0.0) {
    LightNode own = lightNode(node);
    float a = importanceOf(own, at);
    probability *= a > 0.0 ? a / (a + importanceOf(lightNode(node ^ 1u), at)) : 0.0;
    node = own.parent;
  }
  return probability;
}

#endif
