// From a hit to what shading needs: position, normals, material parameters with textures applied.
#ifndef LIMN_SURFACE_GLSL
#define LIMN_SURFACE_GLSL
#include "shaders/lib/math.glsl"
#include "shaders/lib/texture.glsl"

struct Surface {
  vec3 posR;             // render space
  float extent;          // [m] largest coordinate of the corners, for offsetOrigin
  vec3 geometricNormal;  // unit, towards the viewer
  vec3 normal;           // shading, towards the viewer
  vec3 clearcoatNormal;
  bool frontFace;        // the viewer sees the side the winding calls front
  uint material;
  uint flags;            // kMaterial...
  vec3 baseColor;
  float metallic;
  float alpha;           // GGX alpha, roughness squared
  vec3 emission;         // [W·sr⁻¹·m⁻²]
  float transmission;
  float ior;
  float specular;
  vec3 specularColor;
  float clearcoat;
  float clearcoatAlpha;
};

struct Attributes {
  vec3 normal;
  vec4 tangent;
  vec2 uv0, uv1;
  vec4 color;
};

Attributes interpolate(uvec3 corner, vec3 weights) {
  Attributes a = Attributes(vec3(0.0), vec4(0.0), vec2(0.0), vec2(0.0), vec4(0.0));
  for (int i = 0; i < 3; ++i) {
    float w = i == 0 ? weights.x : i == 1 ? weights.y : weights.z;
    int v = int(i == 0 ? corner.x : i == 1 ? corner.y : corner.z) * 2;
    uvec4 p = texelFetch(vertices, v);
    a.normal += w * octDecode(p.x);
    if (kUseTextures) {
      a.tangent += w * vec4(octDecode(p.y & ~1u), (p.y & 1u) != 0u ? -1.0 : 1.0);
      a.uv0 += w * uintBitsToFloat(p.zw);
    }
    if (kUseTextures || kUseVertexColors) {
      uvec4 q = texelFetch(vertices, v + 1);
      a.uv1 += w * uintBitsToFloat(q.xy);
      a.color += w * vec4(unpackHalf2x16(q.z), unpackHalf2x16(q.w));
    }
  }
  return a;
}

// Shading normal from a tangent-space map; falls back to `n` where the tangent is degenerate.
vec3 applyNormalMap(vec3 texel, float scale, vec3 n, vec4 tangent) {
  vec3 t = tangent.xyz - n * dot(n, tangent.xyz);
  float len = length(t);
  if (!(len > 1e-6)) return n;
  t /= len;
  vec3 b = cross(n, t) * (tangent.w < 0.0 ? -1.0 : 1.0);
  vec3 m = (texel * 2.0 - 1.0) * vec3(scale, scale, 1.0);
  vec3 mapped = t * m.x + b * m.y + n * m.z;
  float mappedLength = length(mapped);
  return mappedLength > 1e-6 ? mapped / mappedLength : n;
}

// A shading normal seen from behind would reflect into the surface; it is bent until the viewer grazes it.
vec3 towardsViewer(vec3 n, vec3 viewDir) {
  const float kGrazing = 1e-3;
  float c = dot(n, viewDir);
  if (c >= kGrazing) return n;
  return normalize(n + viewDir * (kGrazing - c));
}

float surfaceAlpha(uint triangle, vec2 barycentrics) {
  uvec4 t = texelFetch(triangles, int(triangle));
  vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
  Attributes a = interpolate(t.xyz, weights);
  float alpha = materials[t.w].baseColor.a;
  uint flags = materials[t.w].flags, first = materials[t.w].firstSlot;
  // The base colour's slot is the first where there is one.
  if (kUseTextures && materials[t.w].slotCount > 0u && textureSlots[first].target == kTargetBaseColor)
    alpha *= sampleTexture(textureSlots[first], a.uv0, a.uv1).a;
  if (kUseVertexColors && (flags & kMaterialVertexColor) != 0u) alpha *= a.color.a;
  return (flags & kMaterialMask) != 0u ? (alpha >= materials[t.w].alphaCutoff ? 1.0 : 0.0) : alpha;
}

struct MappedNormals { vec3 base, clearcoat; };

// Scales the parameters by the material's textures, one turn of the loop an image.
void applyTextures(inout Surface s, inout float roughness, inout float clearcoatRoughness, inout MappedNormals normals, Attributes a) {
  uint first = materials[s.material].firstSlot, count = materials[s.material].slotCount;
  vec3 n = normals.base;
  for (uint i = 0u; i < count; ++i) {
    TextureSlot slot = textureSlots[first + i];
    vec4 v = sampleTexture(slot, a.uv0, a.uv1);
    uint target = slot.target;
    s.baseColor *= target == kTargetBaseColor ? v.rgb : vec3(1.0);
    s.metallic *= target == kTargetMetallicRoughness ? v.b : 1.0;
    roughness *= target == kTargetMetallicRoughness ? v.g : 1.0;
    s.emission *= target == kTargetEmissive ? v.rgb : vec3(1.0);
    s.transmission *= target == kTargetTransmission ? v.r : 1.0;
    s.specular *= target == kTargetSpecular ? v.a : 1.0;
    s.specularColor *= target == kTargetSpecularColor ? v.rgb : vec3(1.0);
    s.clearcoat *= target == kTargetClearcoat ? v.r : 1.0;
    clearcoatRoughness *= target == kTargetClearcoatRoughness ? v.g : 1.0;
    vec3 mapped = applyNormalMap(v.xyz, slot.scale, n, a.tangent);
    normals.base = target == kTargetNormal ? mapped : normals.base;
    normals.clearcoat = target == kTargetClearcoatNormal ? mapped : normals.clearcoat;
  }
}

// A place on a triangle, before any material.
struct Facet {
  vec3 posR;
  float extent;    // [m] largest coordinate of the corners, for offsetOrigin
  vec3 normal;     // unit, to the side that the winding calls front
  bool frontFace;  // the viewer sees that side
};

Facet facetOf(uvec3 corner, vec3 weights, vec3 viewDir) {
  vec3 p0 = texelFetch(positions, int(corner.x)).xyz, p1 = texelFetch(positions, int(corner.y)).xyz,
       p2 = texelFetch(positions, int(corner.z)).xyz;
  // Kept off the edges by about what offsetOrigin() keeps off the plane: where walls meet, a ray that leaves one of them would
  // else start behind the other.
  const float kOffEdges = 1.0 / 524288.0;
  weights = mix(weights, vec3(1.0 / 3.0), kOffEdges);
  Facet f;
  f.posR = p0 * weights.x + p1 * weights.y + p2 * weights.z;
  f.extent = max(maxComponent(abs(p0)), max(maxComponent(abs(p1)), maxComponent(abs(p2))));
  vec3 edge1 = p1 - p0, edge2 = p2 - p0;
  // Edges are scaled first: the cross product of tiny ones would underflow.
  float scale = max(maxComponent(abs(edge1)), maxComponent(abs(edge2)));
  f.normal = normalize(cross(edge1 / scale, edge2 / scale));
  f.frontFace = dot(f.normal, viewDir) >= 0.0;
  return f;
}

vec3 cornerWeights(vec2 barycentrics) { return vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics); }

Surface makeSurface(uint triangle, vec2 barycentrics, vec3 viewDir) {
  uvec4 t = texelFetch(triangles, int(triangle));
  vec3 weights = cornerWeights(barycentrics);
  Facet facet = facetOf(t.xyz, weights, viewDir);
  Surface s;
  s.posR = facet.posR;
  s.extent = facet.extent;
  s.geometricNormal = facet.normal;
  s.frontFace = facet.frontFace;

  s.material = t.w;
  s.flags = materials[t.w].flags;
  Attributes a = interpolate(t.xyz, weights);
  float normalLength = length(a.normal);
  vec3 n = normalLength > 1e-6 ? a.normal / normalLength : s.geometricNormal;
  // Winding decides the side; mirrored nodes and odd files may hold normals that disagree with it.
  if (dot(n, s.geometricNormal) < 0.0) n = -n;

  s.baseColor = materials[t.w].baseColor.rgb;
  s.metallic = materials[t.w].metallic;
  s.emission = materials[t.w].emission;
  s.transmission = kUseTransmission ? materials[t.w].transmission : 0.0;
  s.ior = materials[t.w].ior;
  s.specular = materials[t.w].specular;
  s.specularColor = materials[t.w].specularColor;
  s.clearcoat = kUseClearcoat ? materials[t.w].clearcoat : 0.0;
  float roughness = materials[t.w].roughness, clearcoatRoughness = materials[t.w].clearcoatRoughness;
  if (kUseVertexColors && (s.flags & kMaterialVertexColor) != 0u) s.baseColor *= a.color.rgb;
  MappedNormals normals = MappedNormals(n, n);
  if (kUseTextures) applyTextures(s, roughness, clearcoatRoughness, normals, a);
  s.alpha = roughness * roughness;
  s.clearcoatAlpha = clearcoatRoughness * clearcoatRoughness;
  float side = s.frontFace ? 1.0 : -1.0;
  s.geometricNormal *= side;
  s.normal = towardsViewer(normals.base * side, viewDir);
  s.clearcoatNormal = kUseClearcoat ? towardsViewer(normals.clearcoat * side, viewDir) : s.normal;
  return s;
}

#endif
