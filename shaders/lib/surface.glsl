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

Attributes interpolate(uvec3 corner, vec3 weights, bool second) {
  Attributes a = Attributes(vec3(0.0), vec4(0.0), vec2(0.0), vec2(0.0), second ? vec4(0.0) : vec4(1.0));
  for (int i = 0; i < 3; ++i) {
    float w = i == 0 ? weights.x : i == 1 ? weights.y : weights.z;
    int v = int(i == 0 ? corner.x : i == 1 ? corner.y : corner.z) * 2;
    uvec4 p = texelFetch(vertices, v);
    a.normal += w * octDecode(p.x);
    a.tangent += w * vec4(octDecode(p.y & ~1u), (p.y & 1u) != 0u ? -1.0 : 1.0);
    a.uv0 += w * uintBitsToFloat(p.zw);
    if (second) {
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
vec3 towardsViewer(vec3 n, vec3 geometricNormal, vec3 viewDir) {
  const float kGrazing = 1e-3;
  float c = dot(n, viewDir);
  if (c >= kGrazing) return n;
  return normalize(n + viewDir * (kGrazing - c));
}

float surfaceAlpha(uint triangle, vec2 barycentrics) {
  uvec4 t = texelFetch(triangles, int(triangle));
  MaterialData m = materials[t.w];
  vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
  Attributes a = interpolate(t.xyz, weights, true);
  float alpha = m.baseColor.a * sampleTexture(m.baseColorTexture, a.uv0, a.uv1).a;
  if ((m.flags & kMaterialVertexColor) != 0u) alpha *= a.color.a;
  return (m.flags & kMaterialMask) != 0u ? (alpha >= m.alphaCutoff ? 1.0 : 0.0) : alpha;
}

Surface makeSurface(uint triangle, vec2 barycentrics, vec3 viewDir) {
  uvec4 t = texelFetch(triangles, int(triangle));
  vec3 p0 = texelFetch(positions, int(t.x)).xyz, p1 = texelFetch(positions, int(t.y)).xyz, p2 = texelFetch(positions, int(t.z)).xyz;
  vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
  Surface s;
  s.posR = p0 * weights.x + p1 * weights.y + p2 * weights.z;
  s.extent = max(maxComponent(abs(p0)), max(maxComponent(abs(p1)), maxComponent(abs(p2))));
  vec3 edge1 = p1 - p0, edge2 = p2 - p0;
  // Edges are scaled first: the cross product of tiny ones would underflow.
  float scale = max(maxComponent(abs(edge1)), maxComponent(abs(edge2)));
  s.geometricNormal = normalize(cross(edge1 / scale, edge2 / scale));
  s.frontFace = dot(s.geometricNormal, viewDir) >= 0.0;

  MaterialData m = materials[t.w];
  s.material = t.w;
  s.flags = m.flags;
  bool second = (m.flags & (kMaterialTextured | kMaterialVertexColor)) != 0u;
  Attributes a = interpolate(t.xyz, weights, second);
  float normalLength = length(a.normal);
  vec3 n = normalLength > 1e-6 ? a.normal / normalLength : s.geometricNormal;
  // Winding decides the side; mirrored nodes and odd files may hold normals that disagree with it.
  if (dot(n, s.geometricNormal) < 0.0) n = -n;

  s.baseColor = m.baseColor.rgb;
  s.metallic = m.metallic;
  float roughness = m.roughness;
  s.emission = m.emission;
  s.transmission = m.transmission;
  s.ior = m.ior;
  s.specular = m.specular;
  s.specularColor = m.specularColor;
  s.clearcoat = m.clearcoat;
  float clearcoatRoughness = m.clearcoatRoughness;
  s.clearcoatNormal = n;
  if ((m.flags & kMaterialVertexColor) != 0u) s.baseColor *= a.color.rgb;
  if ((m.flags & kMaterialTextured) != 0u) {
    s.baseColor *= sampleTexture(m.baseColorTexture, a.uv0, a.uv1).rgb;
    vec4 metallicRoughness = sampleTexture(m.metallicRoughnessTexture, a.uv0, a.uv1);
    s.metallic *= metallicRoughness.b;
    roughness *= metallicRoughness.g;
    s.emission *= sampleTexture(m.emissiveTexture, a.uv0, a.uv1).rgb;
    s.transmission *= sampleTexture(m.transmissionTexture, a.uv0, a.uv1).r;
    s.specular *= sampleTexture(m.specularTexture, a.uv0, a.uv1).a;
    s.specularColor *= sampleTexture(m.specularColorTexture, a.uv0, a.uv1).rgb;
    s.clearcoat *= sampleTexture(m.clearcoatTexture, a.uv0, a.uv1).r;
    clearcoatRoughness *= sampleTexture(m.clearcoatRoughnessTexture, a.uv0, a.uv1).g;
    if (m.clearcoatNormalTexture.image != kNoIndex)
      s.clearcoatNormal = applyNormalMap(sampleTexture(m.clearcoatNormalTexture, a.uv0, a.uv1).xyz, m.clearcoatNormalScale, n, a.tangent);
    if (m.normalTexture.image != kNoIndex)
      n = applyNormalMap(sampleTexture(m.normalTexture, a.uv0, a.uv1).xyz, m.normalScale, n, a.tangent);
  }
  s.alpha = roughness * roughness;
  s.clearcoatAlpha = clearcoatRoughness * clearcoatRoughness;
  if (!s.frontFace) {
    s.geometricNormal = -s.geometricNormal;
    n = -n;
    s.clearcoatNormal = -s.clearcoatNormal;
  }
  s.normal = towardsViewer(n, s.geometricNormal, viewDir);
  s.clearcoatNormal = towardsViewer(s.clearcoatNormal, s.geometricNormal, viewDir);
  return s;
}

#endif
