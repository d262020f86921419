// The film: running means of radiance and of what the first hit looks like. Merging two ranges is exact up to rounding.
#ifndef LIMN_FILM_GLSL
#define LIMN_FILM_GLSL
#include "shaders/shared/bindings.h"
#include "shaders/lib/film_sample.glsl"
#include "shaders/shared/film_shared.h"

layout(binding = BINDING_FILM_MEAN, scalar) buffer FilmMean { vec4 filmMean[]; };       // radiance, count
layout(binding = BINDING_FILM_HALF, scalar) buffer FilmHalf { vec4 filmHalf[]; };       // radiance of even samples, M2 of luminance
layout(binding = BINDING_FILM_DIRECT, scalar) buffer FilmDirect { vec4 filmDirect[]; }; // radiance without indirect light, even count
layout(binding = BINDING_FILM_ALBEDO, scalar) buffer FilmAlbedo { vec4 filmAlbedo[]; }; // albedo, depth [m]
layout(binding = BINDING_FILM_NORMAL, scalar) buffer FilmNormal { vec4 filmNormal[]; }; // shading normal, hit share

struct FilmPixel { vec4 mean, half_, direct, albedo, normal; };

FilmPixel readFilm(uint pixel) {
  vec4 mean = filmMean[pixel];
  // The other planes are not cleared: without samples they hold an older picture.
  if (mean.w == 0.0) return FilmPixel(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  return FilmPixel(mean, filmHalf[pixel], filmDirect[pixel], filmAlbedo[pixel], filmNormal[pixel]);
}

void addSample(inout FilmPixel f, FilmSample s, bool even) {
  float n = f.mean.w + 1.0, rcp = 1.0 / n;
  float before = dot(f.mean.rgb, vec3(0.2126, 0.7152, 0.0722));
  float y = dot(s.radiance, vec3(0.2126, 0.7152, 0.0722));
  f.mean = vec4(f.mean.rgb + (s.radiance - f.mean.rgb) * rcp, n);
  float after = dot(f.mean.rgb, vec3(0.2126, 0.7152, 0.0722));
  f.half_.w += max(0.0, (y - before) * (y - after));  // [Welford 1962]
  f.direct.rgb += (s.direct - f.direct.rgb) * rcp;
  if (even) {
    f.direct.w += 1.0;
    f.half_.rgb += (s.radiance - f.half_.rgb) / f.direct.w;
  }
  f.albedo += (vec4(s.albedo, s.depth) - f.albedo) * rcp;
  f.normal += (vec4(s.normal, s.hit) - f.normal) * rcp;
}

void writeFilm(uint pixel, FilmPixel f) {
  filmMean[pixel] = f.mean;
  filmHalf[pixel] = f.half_;
  filmDirect[pixel] = f.direct;
  filmAlbedo[pixel] = f.albedo;
  filmNormal[pixel] = f.normal;
}

#endif
