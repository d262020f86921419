#include "renderer/techniques/audit.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/base/clock.hpp"
#include "renderer/base/mix.hpp"
#include "renderer/gpu/ray_counters.hpp"
#include "renderer/techniques/audit_estimate.hpp"
#include "renderer/techniques/parameter_default.hpp"
#include "renderer/techniques/path_tracing.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"

namespace limn {
namespace {

/// The picture is cut into about this many tiles, each as often looked at as any other.
constexpr uint32_t kTiles = 1024;
/// [pixel] Smaller ones have no room for kSets pixels.
constexpr uint32_t kLeastTileSide = 4;
/// Pixels of a tile at most.
constexpr uint32_t kSets = 16;
/// Of every pixel, to begin with.
constexpr uint32_t kFirstSamples = 4;
/// Pixels to begin with, where the picture has as many: few may all miss the places that make the error.
constexpr uint32_t kLeastPixels = 512;
/// Samples a dispatch takes of a pixel, for the reason that path_tracing.cpp gives.
constexpr uint32_t kSamplesAtOnce = 4;
constexpr uint32_t kLeastPiece = 64, kLargestPiece = 512;
/// The film's samples and the audit's must not be the same.
constexpr uint32_t kSeedSalt = 0x3c6ef372u;

/// Pixels [begin, end) along one side of tile `i` of `tiles`: all tiles are of one size, to a pixel.
struct Range {
  uint32_t begin, end;
};
Range rangeOf(uint32_t i, uint32_t tiles, uint32_t side) {
  return {uint32_t(uint64_t(i) * side / tiles), uint32_t(uint64_t(i + 1) * side / tiles)};
}

/// As many different pixels of a tile as it has, up to kSets, in random order.
std::vector<uint32_t> drawPixels(Range across, Range down, uint32_t width, uint32_t seed) {
  std::vector<uint32_t> pixels;
  for (uint32_t y = down.begin; y < down.end; ++y)
    for (uint32_t x = across.begin; x < across.end; ++x) pixels.push_back(y * width + x);
  const auto area = uint32_t(pixels.size()), drawn = std::min(area, kSets);
  for (uint32_t i = 0; i < drawn; ++i)
    std::swap(pixels[i], pixels[i + mix32(mix32(pixels[i] ^ seed) + i) % (area - i)]);
  pixels.resize(drawn);
  return pixels;
}

struct TileGrid {
  uint32_t x = 0, y = 0;
};
TileGrid tilesOf(uint32_t width, uint32_t height) {
  const uint32_t side = std::max(kLeastTileSide, uint32_t(std::ceil(std::sqrt(double(width) * height / kTiles))));
  return {(width + side - 1) / side, (height + side - 1) / side};
}

}  // namespace

ParameterInfo auditShareInfo() {
  return {"auditShare", "Share of the time in which single pixels are path traced, to tell the error; 0 leaves it unknown",
          "1", ParameterType::real, 0.0, 0.5, 0.05, CostClass::displayOnly};
}

uint32_t auditEntries(uint32_t width, uint32_t height) {
  const TileGrid tiles = tilesOf(width, height);
  return tiles.x * tiles.y * kSets;
}

Result<void> Audit::prepare(const TechniqueContext& context, const SceneNeeds& needs, bool mayCompile) {
  if (m_width != context.film.width() || m_height != context.film.height() || m_seed != context.seed)
    if (auto made = makeBuffers(context); !made) return made;
  m_needs = needs;
  if (auto done = m_trace.prepare(context.device, traceBindings(context), needs, mayCompile); !done) return done;
  if (m_compare) return {};
  const auto bindings = recordBindings(context);
  auto pass = gpu::Pass::create(context.device, "audit_records", bindings, sizeof(shared::AuditPush));
  if (!pass) return pass.error();
  m_compare = pass.take();
  return gpu::runNow(context.device, [&](vk::CommandRecorder& r) { m_compare.warmUp(r, bindings); });
}

Result<void> Audit::makeBuffers(const TechniqueContext& context) {
  const TileGrid tiles = tilesOf(context.film.width(), context.film.height());
  m_tilesX = tiles.x;
  m_tilesY = tiles.y;
  const uint32_t entries = auditEntries(context.film.width(), context.film.height());
  auto film = Film::create(context.device, entries, 1);
  if (!film) return film.error();
  m_film = film.take();
  vk::BufferDesc desc;
  desc.owner = "audit";
  desc.memory = vk::MemoryKind::readback;
  desc.name = "audit.records";
  desc.size = entries * sizeof(shared::AuditRecord);
  auto records = vk::Buffer::create(context.device, desc);
  if (!records) return records.error();
  m_records = records.take();
  auto counters = gpu::makeRayCounters(context.device, "audit", "audit.counters");
  if (!counters) return counters.error();
  m_counters = counters.take();
  return makeList(context);
}

// Entry `set * tiles + tile` is pixel number `set` of the tile, in the tile's random order.
Result<void> Audit::makeList(const TechniqueContext& context) {
  m_width = context.film.width();
  m_height = context.film.height();
  m_seed = context.seed;
  const uint32_t tiles = m_tilesX * m_tilesY;
  std::vector<uint32_t> list(size_t(tiles) * kSets);
  for (uint32_t tile = 0; tile < tiles; ++tile) {
    const Range across = rangeOf(tile % m_tilesX, m_tilesX, m_width), down = rangeOf(tile / m_tilesX, m_tilesY, m_height);
    const auto pixels = drawPixels(across, down, m_width, m_seed);
    for (uint32_t set = 0; set < kSets; ++set) list[size_t(set) * tiles + tile] = pixels[set % pixels.size()];
  }
  vk::BufferDesc desc;
  desc.owner = "audit";
  desc.name = "audit.list";
  auto made = vk::createBufferWith(context.device, desc, std::span<const uint32_t>(list));
  if (!made) return made.error();
  m_list = made.take();
  return {};
}

std::vector<vk::Binding> Audit::traceBindings(const TechniqueContext& context) const {
  auto all = gpu::joined(context.scene.bindings(), m_film->bindings());
  all = gpu::joined(std::move(all), context.tracer.bindings());
  return gpu::joined(std::move(all), {vk::storage(BINDING_CAMERA, context.camera), vk::storage(BINDING_PIXEL_LIST, m_list),
                                      vk::storage(BINDING_COUNTERS, m_counters)});
}

std::vector<vk::Binding> Audit::recordBindings(const TechniqueContext& context) const {
  vk::Binding shown = context.film.bindings().front();  // the mean
  shown.binding = BINDING_SHOWN;
  return gpu::joined(m_film->bindings(),
                     {shown, vk::storage(BINDING_PIXEL_LIST, m_list), vk::storage(BINDING_OUTPUT, m_records)});
}

Result<void> Audit::restart(const TechniqueContext& context) {
  m_whole = {};
  m_goal = {1, kFirstSamples};
  while (m_goal.sets < kSets && entriesOf(m_goal) < kLeastPixels) m_goal.sets *= 2;
  m_piece = {};
  m_paths = 0;
  return gpu::runNow(context.device, [&](vk::CommandRecorder& r) { m_film->recordClear(r); });
}

uint32_t Audit::entriesOf(Extent extent) const { return m_tilesX * m_tilesY * extent.sets; }

// Of a good picture the error is far below the noise of a few samples: it is looked at in few places, and long. The variance
// of n samples of each of N pixels is that of the pixels over N, and that of a product of two halves' noise over n²N.
Result<void> Audit::chooseGoal(const TechniqueContext& context) {
  m_whole = m_goal;
  const auto records = compare(context);
  if (!records) return records.error();
  const bool deeper = m_whole.sets == kSets || noiseOutweighsChoice(*records, m_tilesX, m_tilesY);
  (deeper ? m_goal.samples : m_goal.sets) *= 2;
  return {};
}

// A piece takes its entries to the goal's samples, from those that the whole extent has or from none.
Result<void> Audit::beginPiece(const TechniqueContext& context, double seconds) {
  uint32_t first = m_piece.first + m_piece.count;
  if (first == entriesOf(m_goal)) {
    if (auto chosen = chooseGoal(context); !chosen) return chosen;
    first = m_goal.samples > m_whole.samples ? 0 : entriesOf(m_whole);
  }
  const uint32_t end = first < entriesOf(m_whole) ? entriesOf(m_whole) : entriesOf(m_goal);
  const double fits = seconds < 1.0 ? double(m_rate.itemsIn(seconds)) / kSamplesAtOnce : double(kLargestPiece);
  const uint32_t count = uint32_t(std::clamp(fits, double(kLeastPiece), double(kLargestPiece)));
  m_piece = {first, std::min(count, end - first), first < entriesOf(m_whole) ? m_whole.samples : 0};
  return {};
}

Result<void> Audit::advance(const TechniqueContext& context, double seconds) {
  if (m_piece.count == 0 || m_piece.samples == m_goal.samples)
    if (auto begun = beginPiece(context, seconds); !begun) return begun;
  const shared::PathTracingPush push{.firstEntry = m_piece.first,
                                     .entryCount = m_piece.count,
                                     .firstSample = m_piece.samples,
                                     .sampleCount = kSamplesAtOnce,
                                     .seed = mix32(m_seed ^ kSeedSalt),
                                     .maxBounces = uint32_t(defaultOf(pathTracingInfo(), "maxBounces")),
                                     .rouletteStart = uint32_t(defaultOf(pathTracingInfo(), "rouletteStart")),
                                     .byEntry = 1};
  const double begin = nowSeconds();
  auto done = gpu::runNow(context.device, [&](vk::CommandRecorder& r) {
    recordPathTracing(r, *m_trace, traceBindings(context), push, m_needs);
  });
  if (!done) return done;
  const uint64_t paths = uint64_t(m_piece.count) * kSamplesAtOnce;
  m_rate.measured(paths, nowSeconds() - begin);
  m_paths += paths;
  m_piece.samples += kSamplesAtOnce;
  return {};
}

// All pixels of the extent before are known, and of this one the pieces that are done.
uint32_t Audit::knownEntries() const {
  const bool done = m_piece.samples == m_goal.samples;
  const uint32_t ended = m_piece.first + (done ? m_piece.count : 0);
  const uint32_t known = std::max(ended, entriesOf(m_whole));
  return known < m_tilesX * m_tilesY ? 0 : known;
}

Result<std::span<const shared::AuditRecord>> Audit::compare(const TechniqueContext& context) {
  const shared::AuditPush push{knownEntries()};
  auto done = gpu::runNow(context.device, [&](vk::CommandRecorder& r) {
    m_compare.record(r, recordBindings(context), push, (push.entryCount + 63) / 64);
  });
  if (!done) return done.error();
  return std::span<const shared::AuditRecord>(m_records.as<shared::AuditRecord>()).first(push.entryCount);
}

Result<FilmError> Audit::estimate(const TechniqueContext& context) {
  if (knownEntries() == 0) return FilmError{};
  const auto records = compare(context);
  if (!records) return records.error();
  return estimateFromAudit(*records, m_tilesX, m_tilesY);
}

}  // namespace limn
