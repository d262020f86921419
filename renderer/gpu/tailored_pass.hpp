#pragma once
#include "renderer/gpu/needs_constants.hpp"
#include "renderer/gpu/pass.hpp"
#include "renderer/gpu/pipeline_variant.hpp"

namespace limn::gpu {

/// One shader in two variants: one that renders anything, and one cut to what the scene needs. An edit that adds a need is
/// rendered by the first, so that nothing is compiled while somebody waits. Render thread.
class TailoredPass {
 public:
  /// Specialization constants of a shader for a scene; those of needsConstants() come first.
  using Constants = std::vector<uint32_t> (*)(const SceneNeeds& needs);

  TailoredPass(std::string shader, uint32_t pushConstantBytes, Constants constants = &needsConstants)
      : m_shader(std::move(shader)), m_pushConstantBytes(pushConstantBytes), m_constants(constants) {}

  /// Compiled and warm afterwards: the first time, and where `mayCompile` says that a stop is no matter. What it has
  /// made it keeps, whatever fails then. Errors: "device", "out-of-memory", "device-lost", PipelineAllowance::kSpent.
  Result<void> prepare(vk::Device& device, const std::vector<vk::Binding>& like, const SceneNeeds& needs, bool mayCompile) {
    const std::vector<uint32_t> wanted = m_constants(needs);
    if (!m_tailored || (mayCompile && m_tailoredFor != wanted)) {
      auto tailored = Pass::createWarm(device, m_shader, like, m_pushConstantBytes, wanted);
      if (!tailored) return tailored.error();
      m_tailored = tailored.take();
      m_tailoredFor = wanted;
    }
    if (!m_general) {
      auto general = Pass::createWarm(device, m_shader, like, m_pushConstantBytes, m_constants(allNeeds()));
      if (!general) return general.error();
      m_general = general.take();
    }
    if (m_tailoredFor == wanted) m_variant = PipelineVariant::tailored;
    else m_variant = covers(wanted) ? PipelineVariant::superset : PipelineVariant::general;
    return {};
  }

  /// The variant for the scene of the last prepare().
  const Pass& operator*() const { return m_variant == PipelineVariant::general ? m_general : m_tailored; }
  const Pass* operator->() const { return &**this; }
  PipelineVariant variant() const { return m_variant; }

 private:
  bool covers(const std::vector<uint32_t>& wanted) const {
    for (size_t i = 0; i < wanted.size(); ++i)
      if (wanted[i] && !m_tailoredFor[i]) return false;
    return true;
  }

  std::string m_shader;
  uint32_t m_pushConstantBytes;
  Constants m_constants;
  Pass m_general, m_tailored;
  std::vector<uint32_t> m_tailoredFor;
  PipelineVariant m_variant = PipelineVariant::tailored;
};

}  // namespace limn::gpu
