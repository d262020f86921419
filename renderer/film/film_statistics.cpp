#include "renderer/film/film_statistics.hpp"

#include <cmath>
#include <limits>

#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/film_shared.h"

namespace limn {
namespace {

Result<vk::Buffer> makeReadback(vk::Device& device, size_t bytes, const char* name) {
  vk::BufferDesc desc;
  desc.size = bytes;
  desc.memory = vk::MemoryKind::readback;
  desc.name = name;
  desc.owner = "film";
  return vk::Buffer::create(device, desc);
}

/// The spread of tile errors gives the interval: tiles err nearly independently.
FilmError combine(std::span<const shared::TileError> tiles, double meanValue, double meanSamples) {
  FilmError error;
  error.meanSamples = meanSamples;
  error.meanValue = meanValue;
  error.withhold();
  double sum = 0.0, pixels = 0.0;
  for (const shared::TileError& t : tiles) sum += t.errorSum, pixels += t.pixels;
  if (!(pixels > 0.0)) return error;
  error.relMse = sum / pixels;
  double squares = 0.0;
  for (const shared::TileError& t : tiles) {
    const double residual = t.errorSum - error.relMse * t.pixels;
    squares += residual * residual;
  }
  const double n = double(tiles.size());
  const double deviation = n > 1.0 ? std::sqrt(squares * n / (n - 1.0)) / pixels : error.relMse;
  error.low = std::max(0.0, error.relMse - 1.96 * deviation);
  error.high = error.relMse + 1.96 * deviation;
  return error;
}

}  // namespace

Result<FilmStatistics> FilmStatistics::create(vk::Device& device, const Film& film) {
  FilmStatistics s;
  if (auto made = s.resize(device, film); !made) return made.error();
  const auto errorBindings = gpu::joined(film.bindings(), {vk::storage(BINDING_OUTPUT, s.m_tileErrors)});
  auto errorPass = gpu::Pass::create(device, "film_error", errorBindings, sizeof(shared::SelectPush));
  if (!errorPass) return errorPass.error();
  s.m_error = errorPass.take();
  // The list it will write is the technique's; any storage buffer has the same layout.
  const auto selectBindings = gpu::joined(film.bindings(), {vk::storage(BINDING_PIXEL_LIST, s.m_tileErrors),
                                                            vk::storage(BINDING_OUTPUT, s.m_tileCounts)});
  auto selectPass = gpu::Pass::create(device, "select_pixels", selectBindings, sizeof(shared::SelectPush));
  if (!selectPass) return selectPass.error();
  s.m_select = selectPass.take();
  auto warm = gpu::runNow(device, [&](vk::CommandRecorder& r) {
    s.m_error.warmUp(r, errorBindings);
    s.m_select.warmUp(r, selectBindings);
  });
  if (!warm) return warm.error();
  return s;
}

Result<void> FilmStatistics::resize(vk::Device& device, const Film& film) {
  m_tilesX = (film.width() + 15) / 16;
  m_tilesY = (film.height() + 15) / 16;
  const size_t tileCount = size_t(m_tilesX) * m_tilesY;
  auto errors = makeReadback(device, tileCount * sizeof(shared::TileError), "film.tileErrors");
  if (!errors) return errors.error();
  m_tileErrors = errors.take();
  auto counts = makeReadback(device, (tileCount + 1) * sizeof(uint32_t), "film.tileCounts");
  if (!counts) return counts.error();
  m_tileCounts = counts.take();
  return {};
}

Result<FilmError> FilmStatistics::estimate(vk::Device& device, const Film& film) {
  shared::SelectPush push{};
  push.width = film.width();
  push.height = film.height();
  const auto bindings = gpu::joined(film.bindings(), {vk::storage(BINDING_OUTPUT, m_tileErrors)});
  const auto run = [&] {
    return gpu::runNow(device, [&](vk::CommandRecorder& r) { m_error.record(r, bindings, push, m_tilesX, m_tilesY); });
  };
  if (auto done = run(); !done) return done.error();
  double sum = 0.0, samples = 0.0;
  for (const shared::TileError& t : m_tileErrors.as<shared::TileError>()) sum += t.luminanceSum, samples += t.samples;
  const double meanValue = sum / film.pixelCount();
  push.stage = 1;
  push.meanLuminance = float(meanValue);
  if (auto done = run(); !done) return done.error();
  return combine(m_tileErrors.as<shared::TileError>(), meanValue, samples / film.pixelCount());
}

Result<uint32_t> FilmStatistics::selectPixels(vk::Device& device, const Film& film, const vk::Buffer& pixelList,
                                              uint32_t minSamples, float threshold, double meanValue) {
  const uint32_t tileCount = m_tilesX * m_tilesY;
  shared::SelectPush push{film.width(), film.height(), minSamples, tileCount, threshold, 0, float(meanValue)};
  const auto bindings = gpu::joined(film.bindings(), {vk::storage(BINDING_PIXEL_LIST, pixelList), vk::storage(BINDING_OUTPUT, m_tileCounts)});
  auto done = gpu::runNow(device, [&](vk::CommandRecorder& r) {
    for (uint32_t stage = 0; stage < 3; ++stage) {
      push.stage = stage;
      m_select.record(r, bindings, push, stage == 1 ? 1 : tileCount);
      r.barrier();
    }
  });
  if (!done) return done.error();
  return m_tileCounts.as<uint32_t>()[tileCount];
}

}  // namespace limn
