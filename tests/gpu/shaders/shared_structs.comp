// Every field of every struct of shaders/shared, in the order of declaration, out of the second element of an array.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/film_shared.h"
#include "shaders/shared/g_buffer_shared.h"
#include "shaders/shared/scene_shared.h"

layout(local_size_x = 64) in;
layout(binding = 30, scalar) buffer Out { uint result[]; };
layout(binding = 0, scalar) readonly buffer Structs {
  TextureSlot textureSlot[2];
  ImageInfo imageInfo[2];
  MaterialData materialData[2];
  LightData lightData[2];
  LightNode lightNode[2];
  SceneInfo sceneInfo[2];
  CameraData cameraData[2];
  PathTracingPush pathTracingPush[2];
  ResolvePush resolvePush[2];
  AuditRecord auditRecord[2];
  AuditPush auditPush[2];
  TileError tileError[2];
  FilmErrorPush filmErrorPush[2];
  SelectPush selectPush[2];
  GBufferTexel gBufferTexel[2];
  GBufferPush gBufferPush[2];
};
layout(push_constant, scalar) uniform Push { uint capacity; };

uint cursor = 0u;
void emit(uint v) { if (cursor < capacity) result[cursor++] = v; }
void emit(float v) { emit(floatBitsToUint(v)); }
void emit(vec2 v) { emit(v.x); emit(v.y); }
void emit(vec3 v) { emit(v.xy); emit(v.z); }
void emit(vec4 v) { emit(v.xyz); emit(v.w); }

void emitScene() {
  TextureSlot t = textureSlot[1];
  emit(t.image); emit(t.sampler_); emit(t.rowU); emit(t.rowV); emit(t.target); emit(t.scale);
  ImageInfo i = imageInfo[1];
  emit(i.firstTexel); emit(i.width); emit(i.height); emit(i.pad);
  MaterialData m = materialData[1];
  emit(m.baseColor);
  emit(m.emission);
  emit(m.metallic);
  emit(m.roughness);
  emit(m.ior);
  emit(m.transmission);
  emit(m.specular);
  emit(m.specularColor);
  emit(m.clearcoat);
  emit(m.clearcoatRoughness);
  emit(m.alphaCutoff);
  emit(m.absorption);
  emit(m.flags);
  emit(m.firstSlot); emit(m.slotCount);
  LightData l = lightData[1];
  emit(l.posR); emit(l.type); emit(l.dirR); emit(l.triangle); emit(l.color); emit(l.invRange); emit(l.spotScale);
  emit(l.spotOffset); emit(l.area); emit(l.probability); emit(l.aliasShare); emit(l.alias);
  emit(l.node);
  LightNode b = lightNode[1];
  emit(b.centerR); emit(b.radius); emit(b.axis); emit(b.cosOpening); emit(b.intensity); emit(b.cosEnd); emit(b.child);
  emit(b.parent);
  SceneInfo s = sceneInfo[1];
  emit(s.lightCount);
  emit(s.environmentLight);
  emit(s.environmentWidth);
  emit(s.environmentHeight);
  emit(s.environmentRadiance);
  emit(s.environmentRotation);
  emit(s.distributionWidth);
  emit(s.distributionHeight);
  emit(s.sceneRadius);
  emit(s.triangleCount);
  emit(s.lightTreeShare);
  CameraData c = cameraData[1];
  emit(c.eyeR);
  emit(c.clipNear);
  emit(c.right);
  emit(c.perspective);
  emit(c.up);
  emit(c.width);
  emit(c.forward);
  emit(c.height);
}

void emitFilm() {
  PathTracingPush p = pathTracingPush[1];
  emit(p.firstEntry); emit(p.entryCount); emit(p.firstSample); emit(p.sampleCount); emit(p.seed); emit(p.maxBounces);
  emit(p.rouletteStart); emit(p.byEntry);
  ResolvePush r = resolvePush[1];
  emit(r.width); emit(r.height); emit(r.stride); emit(r.toneMap); emit(r.exposure); emit(r.view);
  AuditRecord a = auditRecord[1];
  emit(a.shown); emit(a.shownCount); emit(a.even); emit(a.evenCount); emit(a.odd); emit(a.oddCount); emit(a.squares);
  emit(auditPush[1].entryCount);
  TileError e = tileError[1];
  emit(e.radianceSum); emit(e.samples); emit(e.errorSum); emit(e.squareSum);
  FilmErrorPush f = filmErrorPush[1];
  emit(f.width); emit(f.height); emit(f.stage); emit(f.largestBin); emit(f.meanRadiance);
  SelectPush s = selectPush[1];
  emit(s.width);
  emit(s.height);
  emit(s.minSamples);
  emit(s.tileCount);
  emit(s.threshold);
  emit(s.stage);
  emit(s.meanLuminance);
  GBufferTexel g = gBufferTexel[1];
  emit(g.triangle); emit(g.barycentrics); emit(g.distance); emit(g.posR); emit(g.pad);
  GBufferPush b = gBufferPush[1];
  emit(b.x); emit(b.y); emit(b.width); emit(b.height);
}

void main() {
  if (gl_GlobalInvocationID.x != 0u) return;
  emitScene();
  emitFilm();
}
