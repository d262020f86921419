#include "renderer/film/film.hpp"

#include <cmath>

#include "renderer/base/hash.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"

namespace limn {

Result<Film> Film::create(vk::Device& device, uint32_t width, uint32_t height) {
  static constexpr const char* kNames[kPlanes] = {"film.mean", "film.half", "film.direct", "film.albedo", "film.normal"};
  Film film;
  film.m_width = width;
  film.m_height = height;
  for (size_t i = 0; i < kPlanes; ++i) {
    vk::BufferDesc desc;
    desc.size = size_t(width) * height * sizeof(glm::vec4);
    desc.name = kNames[i];
    desc.owner = "film";
    auto buffer = vk::Buffer::create(device, desc);
    if (!buffer) return buffer.error();
    film.m_planes[i] = buffer.take();
    if (auto cleared = vk::fill(device, film.m_planes[i], 0, desc.size, 0); !cleared) return cleared.error();
  }
  return film;
}

void Film::recordClear(vk::CommandRecorder& recorder) const { recorder.fillBuffer(m_planes[0], 0, m_planes[0].size(), 0); }

std::vector<vk::Binding> Film::bindings() const {
  std::vector<vk::Binding> list;
  for (size_t i = 0; i < kPlanes; ++i) list.push_back(vk::storage(BINDING_FILM_MEAN + uint32_t(i), m_planes[i]));
  return list;
}

Result<std::vector<glm::vec4>> Film::readPlane(vk::Device& device, size_t plane) const {
  return vk::readBackArray<glm::vec4>(device, m_planes[plane], pixelCount());
}

Result<uint64_t> Film::hash(vk::Device& device) const {
  auto mean = readPlane(device, 0);
  if (!mean) return mean.error();
  for (glm::vec4& pixel : *mean)
    if (pixel.w == 0.0f) pixel = glm::vec4(0.0f);  // what an older picture left there
  uint64_t hash = fnv1a(mean->data(), mean->size() * sizeof(glm::vec4));
  for (size_t plane = 1; plane < 3; ++plane) {
    auto values = readPlane(device, plane);
    if (!values) return values.error();
    for (size_t i = 0; i < values->size(); ++i)
      if ((*mean)[i].w > 0.0f) hash = fnv1a(&(*values)[i], sizeof(glm::vec4), hash);
  }
  return hash;
}

namespace {

FilmLayer& addLayer(FilmImage& image, const char* name, uint32_t channels) {
  image.layers.push_back({name, channels, std::vector<float>(size_t(image.width) * image.height * channels, 0.0f)});
  return image.layers.back();
}

void put(FilmLayer& layer, size_t pixel, const glm::vec3& v) {
  for (size_t c = 0; c < 3; ++c) layer.data[pixel * 3 + c] = v[int(c)];
}

}  // namespace

Result<FilmImage> Film::read(vk::Device& device) const {
  std::array<std::vector<glm::vec4>, kPlanes> planes;
  for (size_t i = 0; i < kPlanes; ++i) {
    auto values = readPlane(device, i);
    if (!values) return values.error();
    planes[i] = values.take();
  }
  FilmImage image;
  image.width = m_width;
  image.height = m_height;
  image.layers.reserve(8);
  FilmLayer& beauty = addLayer(image, "beauty", 3);
  FilmLayer& direct = addLayer(image, "direct", 3);
  FilmLayer& indirect = addLayer(image, "indirect", 3);
  FilmLayer& albedo = addLayer(image, "albedo", 3);
  FilmLayer& normal = addLayer(image, "normal", 3);
  FilmLayer& depth = addLayer(image, "depth", 1);
  FilmLayer& samples = addLayer(image, "samples", 1);
  FilmLayer& error = addLayer(image, "error", 1);
  for (size_t i = 0; i < pixelCount(); ++i) {
    const glm::vec4 mean = planes[0][i];
    const float n = mean.w;
    samples.data[i] = n;
    if (!(n > 0.0f)) continue;
    put(beauty, i, mean);
    put(direct, i, planes[2][i]);
    put(indirect, i, glm::vec3(mean) - glm::vec3(planes[2][i]));
    put(albedo, i, planes[3][i]);
    put(normal, i, planes[4][i]);
    // Rays that left the scene count 0 in the mean depth; the hit share undoes that.
    depth.data[i] = planes[4][i].w > 0.0f ? planes[3][i].w / planes[4][i].w : 0.0f;
    error.data[i] = n > 1.0f ? std::sqrt(planes[1][i].w / (n - 1.0f) / n) : 0.0f;
  }
  return image;
}

}  // namespace limn
