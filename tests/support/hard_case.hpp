#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/scene.hpp"
#include "renderer/techniques/technique_info.hpp"
#include "tests/support/picture_error.hpp"

namespace limn::test {

/// A picture that a technique is known to miss in one scene: the bound it keeps there, and the reason. Such a cell stays marked.
struct KnownMiss {
  std::string technique;             ///< name
  std::string reason;                ///< one sentence, for the table
  double deviation = 0.0;            ///< bound in place of the general one
};

/// Light that glass and mirrors focus reaches points by few paths, and is interpolated between them.
KnownMiss interpolatedCaustics();

/// A scene that is awkward in one way, and what its picture must be: that of a twin without the awkwardness, or the same radiance
/// everywhere. With neither, it is compared with an unbiased technique's picture.
struct HardCase {
  std::string name;
  std::string claim;                 ///< one sentence, for the table
  std::function<Scene()> scene;
  std::string twinName;              ///< cases with one twin share its pictures
  std::function<Scene()> twin;
  std::optional<double> radiance;    ///< of every pixel [W·sr⁻¹·m⁻²], all channels
  std::optional<double> ceiling;     ///< of the mean [W·sr⁻¹·m⁻²], where less than the reference is all that is allowed
  double rounding = 1e-4;            ///< relative error that the scene itself makes
  double outside = 1.0;              ///< of a picture that must be black: the radiance that could leak in [W·sr⁻¹·m⁻²]
  uint32_t bounces = 4;
  bool caustics = false;             ///< fireflies are counted and not judged
  std::vector<KnownMiss> known;
};

/// Pictures of one cell, and how many samples were thrown away in making them.
struct HardPictures {
  PicturePair pair;
  uint64_t discarded = 0, taken = 0;
};

/// What may be said of a figure: its value and the bounds. `general` holds for all scenes, `bound` for this one.
struct HardFigure {
  double value = 0.0, general = 0.0, bound = 0.0;
  bool good() const { return value <= general; }
};

/// One technique on one hard case.
struct HardCell {
  std::string name, claim, technique;
  bool biased = false, sound = false, causticsAllowed = false;
  HardFigure deviation;              ///< of an unbiased technique the worst of all blocks, of a biased one without noise
  std::string unit;                  ///< of the deviation: "sigma", "relMSE", "leak"
  HardFigure energy;                 ///< mean over that of the truth
  HardFigure discarded;              ///< share of the samples
  HardFigure fireflies;              ///< share of the pixels over 20 times the truth
  double largest = 0.0;              ///< brightest channel of the picture [W·sr⁻¹·m⁻²]
  std::string reason;                ///< of a known miss
  bool good() const { return sound && deviation.good() && energy.good() && discarded.good() && fireflies.good(); }
};

/// `reference` is the picture that must be met, `truth` that of an unbiased technique for the same.
HardCell judge(const HardCase& hard, const TechniqueInfo& technique, const HardPictures& pictures, const PicturePair& reference,
               const PicturePair& truth);

/// A picture of one radiance, twice.
PicturePair constantPictures(uint32_t width, uint32_t height, double radiance);

/// Writes the cells of one program into `directory`/hard-cases/`group`.json, and those of all programs into
/// `directory`/hard_cases.json. Programs may do so at the same time. Throws std::runtime_error.
void writeHardCases(const std::string& directory, const std::string& group, const std::vector<HardCell>& cells);

}  // namespace limn::test
