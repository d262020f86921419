#include "renderer/film/resolver.hpp"

#include <cmath>
#include <cstring>

#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"

namespace limn {
namespace {

uint32_t tiles(uint32_t pixels) { return (pixels + 15) / 16; }

}  // namespace

Result<Resolver> Resolver::create(vk::Device& device, const Film& film) {
  Resolver resolver;
  if (auto made = resolver.resize(device, film); !made) return made.error();
  const auto bindings = gpu::joined(film.bindings(), {vk::storage(BINDING_OUTPUT, resolver.m_output)});
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
                                               uint32_t stride, uint32_t view) {
  const shared::ResolvePush push{film.width(), film.height(), stride, uint32_t(settings.toneMap), std::exp2(settings.exposure), view};
  const auto bindings = gpu::joined(film.bindings(), {vk::storage(BINDING_OUTPUT, m_output)});
  auto done = gpu::runNow(device, [&](vk::CommandRecorder& r) { m_pass.record(r, bindings, push, tiles(film.width()), tiles(film.height())); });
  if (!done) return done.error();
  std::vector<uint8_t> rgba(m_output.size());
  std::memcpy(rgba.data(), m_output.mapped(), rgba.size());
  return rgba;
}

}  // namespace limn
