#pragma once
#include <optional>
#include <span>

#include "renderer/gpu/tailored_pass.hpp"
#include "renderer/techniques/technique.hpp"
#include "renderer/techniques/work_rate.hpp"

namespace limn {

/// The parameter "auditShare" that every biased technique announces.
ParameterInfo auditShareInfo();

/// Pixels that the audit of a picture of that size keeps samples of.
uint32_t auditEntries(uint32_t width, uint32_t height);

/// Tells the error of a biased technique: what such a picture's own samples agree on may be wrong. A random set of pixels, as
/// many in every part of the picture, is traced by the path tracer and compared with what is displayed there. The samples hold
/// until the scene or the view changes; they grow in number of pixels and of samples a pixel, and never touch the film.
/// Render thread.
class Audit {
 public:
  /// Buffers for the film's size, pipelines compiled and warm, as Technique::prepare().
  Result<void> prepare(const TechniqueContext& context, const SceneNeeds& needs, bool mayCompile);
  /// Forgets all samples.
  Result<void> restart(const TechniqueContext& context);
  /// One piece of work that takes about `seconds`. What a sample is never depends on how the pieces fall. Waits.
  Result<void> advance(const TechniqueContext& context, double seconds);
  /// Paths traced since the restart.
  uint64_t paths() const { return m_paths; }
  /// How far the film as it stands is from the truth, its bias included; infinity until every part of the picture was looked
  /// at. Waits.
  Result<FilmError> estimate(const TechniqueContext& context);

 private:
  /// Pixels of every tile, and samples of each of them.
  struct Extent {
    uint32_t sets = 0, samples = 0;
  };
  /// Entries that are sampled together, and how far they are.
  struct Piece {
    uint32_t first = 0, count = 0;
    uint32_t samples = 0;         ///< of every entry of it
  };

  Result<void> makeBuffers(const TechniqueContext& context);
  Result<void> makeList(const TechniqueContext& context);
  std::vector<vk::Binding> traceBindings(const TechniqueContext& context) const;
  std::vector<vk::Binding> recordBindings(const TechniqueContext& context) const;
  uint32_t entriesOf(Extent extent) const;
  uint32_t knownEntries() const;
  Result<std::span<const shared::AuditRecord>> compare(const TechniqueContext& context);
  Result<void> beginPiece(const TechniqueContext& context, double seconds);
  Result<void> chooseGoal(const TechniqueContext& context);

  gpu::TailoredPass m_trace{"path_tracing", sizeof(shared::PathTracingPush)};
  gpu::Pass m_compare;
  SceneNeeds m_needs;
  std::optional<Film> m_film;     ///< a pixel is an entry of m_list
  vk::Buffer m_list, m_records, m_counters;
  uint32_t m_width = 0, m_height = 0, m_seed = 0;  ///< that m_list was made for
  uint32_t m_tilesX = 0, m_tilesY = 0;
  Extent m_whole, m_goal;         ///< what has been taken, and what is being taken
  Piece m_piece;
  uint64_t m_paths = 0;
  WorkRate m_rate{2e5};           ///< paths; as of the path tracer
};

}  // namespace limn
