#include "renderer/film/resolver.hpp"

#include <cmath>
#include <cstring>

#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/film_shared.h"
#include "shaders/shared/gather_shared.h"

namespace limn {
namespace {

uint32_t tiles(uint32_t pixels) { return (pixels + 15) / 16; }

static_assert(uint32_t(ResolveView::beauty) == shared::kViewBeauty && uint32_t(ResolveView::placement) == shared::kViewPlacement);

uint32_t viewOf(ResolveView view, bool interpolates) {
  return view == ResolveView::placement && !interpolates ? shared::kViewOwnSamples : uint32_t(view);
}

}  // namespace

Result<Resolver> Resolver::create(vk::Device& device, const Film& film) {
  Resolver resolver;
  if (auto made = resolver.resize(device, film); !made) return made.error();
  vk::BufferDesc desc;
  desc.size = sizeof(shared::IndirectTexel);
  desc.name = "film.noIndirect";
  desc.owner = "film";
  auto none = vk::Buffer::create(device, desc);
  if (!none) return none.error();
  resolver.m_noIndirect = none.take();
  const auto bindings = gpu::joined(film.bindings(), {vk::storage(BINDING_OUTPUT, resolver.m_output),
                                                      vk::storage(BINDING_INDIRECT, resolver.m_noIndirect)});
  auto pass = gpu::Pass::create(device, "resolve", bindings, sizeof(shared::ResolvePush));
  if (!pass) return pass.error();
  resolver.m_pass = pass.take();
  if (auto warm = gpu::runNow(device, [&](vk::CommandRecorder& r) { resolver.m_pass.warmUp(r, bindings); }); !warm) return warm.error();
  return resolver;
}

Result<void> Resolver::resize(vk::Device& device, const Film& film) {
  vk::BufferDesc desc;
  desc.size = size_t(film.pixelCount()) * 4;
  desc.memory = vk::MemoryKind::readback;
  desc.name = "film.display";
  desc.owner = "film";
  auto output = vk::Buffer::create(device, desc);
  if (!output) return output.error();
  m_output = output.take();
  return {};
}

Result<std::vector<uint8_t>> Resolver::resolve(vk::Device& device, const Film& film, const ResolveSettings& settings,
                                               uint32_t stride, const vk::Buffer* indirect) {
  LIMN_CHECK(!indirect || indirect->size() >= film.pixelCount() * sizeof(shared::IndirectTexel));
  const uint32_t view = viewOf(settings.view, indirect != nullptr);
  const shared::ResolvePush push{film.width(), film.height(), stride, uint32_t(settings.toneMap), std::exp2(settings.exposure), view};
  const auto bindings = gpu::joined(film.bindings(), {vk::storage(BINDING_OUTPUT, m_output),
                                                      vk::storage(BINDING_INDIRECT, indirect ? *indirect : m_noIndirect)});
  auto done = gpu::runNow(device, [&](vk::CommandRecorder& r) { m_pass.record(r, bindings, push, tiles(film.width()), tiles(film.height())); });
  if (!done) return done.error();
  std::vector<uint8_t> rgba(m_output.size());
  std::memcpy(rgba.data(), m_output.mapped(), rgba.size());
  return rgba;
}

}  // namespace limn
