// What one sample says of the place that a ray first meets.
#ifndef LIMN_FILM_SAMPLE_GLSL
#define LIMN_FILM_SAMPLE_GLSL

struct FilmSample {
  vec3 radiance;
  vec3 direct;
  vec3 albedo;
  vec3 normal;
  float depth;  // [m], 0 where the ray left the scene
  float hit;    // 1 where it did not
};

#endif
