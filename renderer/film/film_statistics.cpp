#include "renderer/film/film_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/film/compare.hpp"
#include "renderer/gpu/work_groups.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"

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

/// Half the width of a 95 % interval, in standard deviations.
constexpr double kSigmas = 1.96;
/// How far the denominators may be off, relative, in standard deviations: they are themselves made from the film. Measured on
/// twelve scenes.
constexpr double kDenominatorDoubt = 0.12;

/// The values that are left out of the mean: those in bins behind `lastBin`, and `ofLast` more that are as large as `value`.
struct Trim {
  uint32_t lastBin = 0;
  double ofLast = 0.0, value = 0.0;
  double kept = 0.0;            ///< values that stay
};

Trim trimLargest(std::span<const uint32_t> sizes) {
  const double all = std::accumulate(sizes.begin(), sizes.end(), 0.0);
  double discarded = std::floor(kDiscardedShare * all);
  Trim trim{shared::kErrorBins - 1, 0.0, 0.0, all - discarded};
  while (trim.lastBin > 0 && sizes[trim.lastBin] <= discarded) discarded -= sizes[trim.lastBin--];
  trim.ofLast = discarded;
  trim.value = std::exp2((trim.lastBin + 0.5) / shared::kErrorBinsPerOctave - shared::kErrorLeastOctave);
  return trim;
}

/// The error that is told and the true one are two draws around the same variance: where the errors of a pixel are normal,
/// the square q of one of them varies by 2/3·q², and so does the other. Channels err together. The interval is one of the
/// logarithm, for few large values make the sum.
FilmError combine(std::span<const shared::TileError> tiles, const Trim& trim) {
  double sum = -trim.ofLast * trim.value, squares = -trim.ofLast * trim.value * trim.value;
  for (const shared::TileError& t : tiles) sum += t.errorSum, squares += t.squareSum;
  FilmError error;
  if (!(trim.kept > 0.0)) return error;
  error.relMse = std::max(0.0, sum) / trim.kept;
  const double variance = sum > 0.0 ? 4.0 * std::max(0.0, squares) / (sum * sum) : 0.0;
  const double factor = std::exp(kSigmas * std::sqrt(variance + kDenominatorDoubt * kDenominatorDoubt));
  error.low = error.relMse / factor;
  error.high = error.relMse * factor;
  return error;
}

}  // namespace

Result<FilmStatistics> FilmStatistics::create(vk::Device& device, const Film& film) {
  FilmStatistics s;
  if (auto made = s.resize(device, film); !made) return made.error();
  auto sizes = makeReadback(device, shared::kErrorBins * sizeof(uint32_t), "film.errorSizes");
  if (!sizes) return sizes.error();
  s.m_errorSizes = sizes.take();
  const auto errorBindings = s.errorBindings(film);
  auto errorPass = gpu::Pass::create(device, "film_error", errorBindings, sizeof(shared::FilmErrorPush));
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

std::vector<vk::Binding> FilmStatistics::errorBindings(const Film& film) const {
  return gpu::joined(film.bindings(),
                     {vk::storage(BINDING_OUTPUT, m_tileErrors), vk::storage(BINDING_COUNTERS, m_errorSizes)});
}

Result<void> FilmStatistics::runError(vk::Device& device, const Film& film, shared::FilmErrorPush push) {
  push.width = film.width();
  push.height = film.height();
  return gpu::runNow(device, [&](vk::CommandRecorder& r) {
    if (push.stage == 1) r.fillBuffer(m_errorSizes, 0, 0, 0);
    r.barrier();
    m_error.record(r, errorBindings(film), push, m_tilesX, m_tilesY);
  });
}

Result<FilmStatistics::Means> FilmStatistics::means(vk::Device& device, const Film& film) {
  if (auto done = runError(device, film, {.stage = 0}); !done) return done.error();
  Means means;
  for (const shared::TileError& t : m_tileErrors.as<shared::TileError>()) {
    means.radiance += t.radianceSum;
    means.samples += t.samples;
  }
  means.radiance /= film.pixelCount();
  means.samples /= film.pixelCount();
  return means;
}

Result<FilmError> FilmStatistics::estimate(vk::Device& device, const Film& film, double meanRadiance) {
  shared::FilmErrorPush push{.stage = 1, .meanRadiance = float(meanRadiance)};
  if (auto done = runError(device, film, push); !done) return done.error();
  const Trim trim = trimLargest(m_errorSizes.as<uint32_t>());
  push.stage = 2;
  push.largestBin = trim.lastBin;
  if (auto done = runError(device, film, push); !done) return done.error();
  return combine(m_tileErrors.as<shared::TileError>(), trim);
}

Result<uint32_t> FilmStatistics::selectPixels(vk::Device& device, const Film& film, const vk::Buffer& pixelList,
                                              uint32_t minSamples, float threshold, double meanRadiance) {
  const uint32_t tileCount = m_tilesX * m_tilesY;
  shared::SelectPush push{film.width(), film.height(), minSamples, tileCount, threshold, 0, float(meanRadiance)};
  const auto bindings = gpu::joined(film.bindings(), {vk::storage(BINDING_PIXEL_LIST, pixelList), vk::storage(BINDING_OUTPUT, m_tileCounts)});
  auto done = gpu::runNow(device, [&](vk::CommandRecorder& r) {
    for (uint32_t stage = 0; stage < 3; ++stage) {
      push.stage = stage;
      const gpu::WorkGroups groups = gpu::groupsInRows(stage == 1 ? 1 : tileCount);
      m_select.record(r, bindings, push, groups.x, groups.y);
      r.barrier();
    }
  });
  if (!done) return done.error();
  return m_tileCounts.as<uint32_t>()[tileCount];
}

}  // namespace limn
