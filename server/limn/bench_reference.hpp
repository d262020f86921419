#pragma once
#include <array>
#include <string>

#include "renderer/film/film_image.hpp"
#include "server/limn/bench_run.hpp"

namespace limn::bench {

/// A picture of the path tracer that others are measured against: two halves of independent seeds and their mean.
/// Errors are taken with the halves, so that the reference's own noise adds nothing to them on average, as in
/// film/compare.hpp. Each half is kept as a file and goes on from there when a later run wants less noise.
class ReferencePictures {
 public:
  /// `name` and a hash of scene, view, size, parameters and version name the files in `directory`, which is made.
  /// Errors: "io", and those of readExr().
  static Result<ReferencePictures> open(const std::string& directory, const std::string& name,
                                        const LoadedScene& loaded, const SessionConfig& config);

  /// Adds samples for about `seconds`, to both halves the same number, and at least one pass to each.
  Result<void> refine(vk::Device& device, const LoadedScene& loaded, double seconds);
  /// Writes both halves. Errors: "io".
  Result<void> save() const;

  bool empty() const { return m_samples == 0; }
  uint64_t samples() const { return m_samples; }  ///< of a pixel, in both halves together
  double seconds() const { return m_seconds; }    ///< spent on both, of all runs that added to them
  /// relMSE of the mean by its own noise, from the halves; infinity while it is empty.
  double noise() const;
  Reference reference() const;
  const RadianceImage& mean() const { return m_mean; }
  std::array<std::string, 2> files() const;

 private:
  Result<void> load();
  void updateMean();

  SessionConfig m_config;
  std::string m_key, m_stem;           ///< what the files are of; their path without ending
  uint64_t m_samples = 0;
  double m_seconds = 0.0;
  std::array<RadianceImage, 2> m_halves;
  RadianceImage m_mean;
};

/// The path tracer as the judge: every pixel gets every sample; what --set says of the path tracer holds for it too.
SessionConfig referenceConfig(const BenchOptions& options);

}  // namespace limn::bench
