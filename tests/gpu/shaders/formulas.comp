// Functions of shaders/lib that a double-precision reference knows too, on the inputs of a buffer.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/ggx_albedo.glsl"
#include "shaders/lib/tone_map.glsl"
#include "tests/gpu/shaders/formulas.h"

layout(local_size_x = 64) in;
layout(binding = 30, scalar) buffer Out { vec4 result[]; };
layout(binding = 0, scalar) readonly buffer In { vec4 values[]; };
layout(push_constant, scalar) uniform Push { FormulasPush push; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  vec4 v = values[i];
  if (push.formula == kFormulaOctDecode) result[i] = vec4(octDecode(floatBitsToUint(v.x)), 0.0);
  else if (push.formula == kFormulaFrame) {
    vec3 t, b;
    makeFrame(v.xyz, t, b);
    vec3 wrong = abs(vec3(dot(t, b), dot(t, v.xyz), dot(b, v.xyz)));
    result[i] = vec4(max(maxComponent(wrong), maxComponent(abs(cross(t, b) - v.xyz))), length(t), length(b), 0.0);
  } else if (push.formula == kFormulaSrgb) result[i] = vec4(linearToSrgb(v.xyz), 0.0);
  else if (push.formula == kFormulaRemainder)
    result[i] = vec4(float(remainderOf(floatBitsToUint(v.x), floatBitsToUint(v.y))));
  else if (push.formula == kFormulaGgxAlbedo)
    result[i] = vec4(ggxAlbedo(v.x, v.y), ggxSchlickAlbedo(v.x, v.y), meanGgxAlbedo(v.y), meanGgxSchlickAlbedo(v.y));
  else result[i] = vec4(toneMap(v.xyz, push.formula - kFormulaToneMap), 0.0);
}
