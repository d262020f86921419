#ifndef LIMN_CAMERA_GLSL
#define LIMN_CAMERA_GLSL
#include "shaders/lib/math.glsl"

// Ray through `pixel` (continuous, 0,0 is the upper left corner of the picture), starting on the clip plane.
void cameraRay(vec2 pixel, out vec3 originR, out vec3 dirR) {
  vec2 ndc = pixel / vec2(camera.width, camera.height) * 2.0 - 1.0;
  vec3 offset = camera.right * ndc.x - camera.up * ndc.y;
  if (camera.perspective != 0u) {
    vec3 along = camera.forward + offset;
    originR = camera.eyeR + along * camera.clipNear;
    dirR = normalize(along);
  } else {
    originR = camera.eyeR + offset + camera.forward * camera.clipNear;
    dirR = camera.forward;
  }
}

// [m] from where a camera ray starts back to the eye, or to the plane through it that all rays cross.
float distanceToEye(vec3 originR) { return camera.perspective != 0u ? distance(originR, camera.eyeR) : camera.clipNear; }

#endif
