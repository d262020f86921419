#include "tests/support/hard_case.hpp"

#include <algorithm>
#include <cmath>

#include "tests/support/statistics.hpp"

namespace limn::test {
namespace {

/// More cases than there are: all of the suite's comparisons share one level.
constexpr size_t kMostCases = 50;
constexpr double kSigmas = 3.0;

// What renderer/README.md says of biased techniques.
constexpr double kBiasedRelMse = 0.01;
constexpr double kBiasedEnergy = 1.1;
constexpr double kBiasedLeak = 0.01;

constexpr double kDiscarded = 1e-5, kFireflies = 1e-4, kFireflyFactor = 20.0;

/// The deviation that is as unlikely among `tests` comparisons as one of kSigmas in a single one. [Bonferroni]
double sigmasOf(size_t tests) {
  const double level = normalTails(kSigmas) / double(tests);
  double low = kSigmas, high = 20.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (normalTails(middle) > level ? low : high) = middle;
  }
  return high;
}

double pairMean(const PicturePair& pair) { return 0.5 * (meanOf(pair.a, "beauty") + meanOf(pair.b, "beauty")); }

/// Relative standard error of the quotient of the two means.
double errorOfQuotient(const PicturePair& pair, const PicturePair& truth) {
  const Deviation d = deviationOf(pair, truth, "beauty", 0.0);
  const double quotient = pairMean(pair) / pairMean(truth);
  return d.whole > 0.0 ? std::abs(quotient - 1.0) / d.whole : 0.0;
}

const KnownMiss* knownOf(const HardCase& hard, const std::string& technique) {
  for (const KnownMiss& miss : hard.known)
    if (miss.technique == technique) return &miss;
  return nullptr;
}

HardFigure figure(double value, double general, double known = 0.0) {
  return {value, general, known > 0.0 ? known : general};
}

bool isBlack(const HardCase& hard) { return hard.radiance == 0.0; }

HardFigure deviation(const HardCase& hard, HardCell& cell, const PicturePair& pair, const PicturePair& reference, double known) {
  if (!cell.biased) {
    const Deviation d = deviationOf(pair, reference, "beauty", hard.rounding);
    cell.unit = "sigma";
    return figure(std::max(d.whole, d.worstTile), sigmasOf((d.tiles + 1) * kMostCases), known);
  }
  cell.unit = isBlack(hard) ? "leak" : "relMSE";
  if (isBlack(hard)) return figure(cell.largest / hard.outside, kBiasedLeak, known);
  return figure(std::max(0.0, biasOf(pair, reference, "beauty")), kBiasedRelMse + hard.rounding, known);
}

HardFigure energy(const HardCase& hard, const HardCell& cell, const PicturePair& pair, const PicturePair& truth) {
  const double most = hard.ceiling.value_or(isBlack(hard) ? hard.outside : pairMean(truth));
  double allowed = cell.biased ? kBiasedEnergy : 1.0 + hard.rounding;
  if (!cell.biased && !isBlack(hard)) allowed += sigmasOf(kMostCases) * errorOfQuotient(pair, truth);
  return figure(pairMean(pair) / most, allowed);
}

/// The picture of all samples of both.
FilmImage bothOf(const PicturePair& pair) {
  FilmLayer beauty = *pair.a.find("beauty");
  const std::vector<float>& other = pair.b.find("beauty")->data;
  for (size_t i = 0; i < other.size(); ++i) beauty.data[i] = 0.5f * (beauty.data[i] + other[i]);
  FilmImage picture;
  picture.width = pair.a.width;
  picture.height = pair.a.height;
  picture.layers = {beauty};
  return picture;
}

/// Of a picture that must be black the leak says it all.
double fireflyShare(const HardCase& hard, const PicturePair& pair, const PicturePair& truth) {
  if (isBlack(hard)) return 0.0;
  return double(firefliesOf(bothOf(pair), bothOf(truth), kFireflyFactor)) / (double(pair.a.width) * pair.a.height);
}

}  // namespace

KnownMiss interpolatedCaustics() {
  KnownMiss miss;
  miss.technique = "point-projection";
  miss.reason = "Caustics reach points by few paths and are interpolated between them";
  miss.deviation = 0.06;
  return miss;
}

HardCell judge(const HardCase& hard, const TechniqueInfo& technique, const HardPictures& pictures, const PicturePair& reference,
               const PicturePair& truth) {
  const PicturePair& pair = pictures.pair;
  const KnownMiss* known = knownOf(hard, technique.name);
  HardCell cell;
  cell.name = hard.name;
  cell.claim = hard.claim;
  cell.technique = technique.name;
  cell.biased = technique.biased;
  cell.causticsAllowed = hard.caustics;
  cell.sound = isSound(pair.a) && isSound(pair.b);
  cell.largest = std::max(largestOf(pair.a, "beauty"), largestOf(pair.b, "beauty"));
  cell.deviation = deviation(hard, cell, pair, reference, known ? known->deviation : 0.0);
  cell.energy = energy(hard, cell, pair, truth);
  cell.discarded = figure(double(pictures.discarded) / double(pictures.taken), kDiscarded);
  const double mostFireflies = hard.caustics ? 1.0 : kFireflies;
  cell.fireflies = figure(fireflyShare(hard, pair, truth), mostFireflies);
  if (known) cell.reason = known->reason;
  return cell;
}

PicturePair constantPictures(uint32_t width, uint32_t height, double radiance) {
  PicturePair pair;
  pair.a.width = width;
  pair.a.height = height;
  pair.a.layers = {{"beauty", 3, std::vector<float>(size_t(width) * height * 3, float(radiance))}};
  pair.b = pair.a;
  return pair;
}

}  // namespace limn::test
