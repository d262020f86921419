#include "renderer/techniques/audit_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "renderer/base/luminance.hpp"
#include "renderer/film/compare.hpp"

namespace limn {
namespace {

using glm::dvec3;

/// Half the width of a 95 % interval, in standard deviations.
constexpr double kSigmas = 1.96;
/// How far the denominators may be off, relative: the truth in them is known from few samples.
constexpr double kDenominatorDoubt = 0.1;
/// A pixel is shown this much brighter than the truth around it only by mistake, unless both halves agree with it.
constexpr double kMostOverAround = 3.0;
/// Squared differences under this many variances are noise: for the cautious, and for who believes the pixel's own mean.
constexpr double kCautiousDoubt = 12.0, kSampledDoubt = 6.0;
/// The variance that is expected of a pixel counts as if it were known from so many samples.
constexpr double kSamplesOfExpectation = 16.0;
/// Of two ways to know the denominators, the share of the one that believes the pixel's own mean; and how far the error may be
/// from there, in distances to what either way tells. Measured on twelve scenes.
constexpr double kSampledShare = 0.2, kDenominatorsApart = 1.5;

/// One pixel: what is shown, the truth as two halves know it, and the variance of one sample.
struct Pixel {
  uint32_t tile = 0;
  double samples = 0.0;
  dvec3 shown, even, odd, truth, variance;
};

std::vector<Pixel> readRecords(std::span<const shared::AuditRecord> records, uint32_t tiles) {
  std::vector<Pixel> pixels;
  for (size_t i = 0; i < records.size(); ++i) {
    const shared::AuditRecord& r = records[i];
    if (!(r.shownCount > 0.0f && r.evenCount > 0.0f && r.oddCount > 0.0f)) continue;
    Pixel p{uint32_t(i % tiles), double(r.evenCount) + r.oddCount, r.shown, r.even, r.odd, {}, {}};
    p.truth = (p.even * double(r.evenCount) + p.odd * double(r.oddCount)) / p.samples;
    const double y = luminance(p.truth);
    const dvec3 share = y > 0.0 ? p.truth / y : dvec3(0.0);
    p.variance = share * share * (double(r.squares) / (p.samples - 1.0));
    pixels.push_back(p);
  }
  return pixels;
}

/// Sums over the pixels of a part of the picture.
struct Sums {
  double count = 0.0, samples = 0.0;
  dvec3 shown{0.0}, truth{0.0}, variance{0.0}, rest{0.0};

  /// Of one sample, over the square of the mean.
  dvec3 relativeVariance() const { return variance * count / glm::max(truth * truth, dvec3(1e-300)); }
};

/// What the truth of a pixel is likely to be before its own samples are looked at: what is shown there, less the bias that
/// the tiles around have, as far as noise lets it be seen.
class Expectation {
 public:
  Expectation(const std::vector<Pixel>& pixels, uint32_t tilesX, uint32_t tilesY)
      : m_tilesX(tilesX), m_tilesY(tilesY), m_tiles(size_t(tilesX) * tilesY), m_around(m_tiles.size()) {
    for (const Pixel& p : pixels)
      for (Sums* s : {&m_all, &m_tiles[p.tile]}) {
        s->count += 1.0;
        s->samples += p.samples;
        s->shown += p.shown;
        s->truth += p.truth;
        s->variance += p.variance;
      }
    addAround([](Sums& into, const Sums& s) {
      into.count += s.count;
      into.samples += s.samples;
      into.shown += s.shown;
      into.truth += s.truth;
      into.variance += s.variance;
    });
    for (const Pixel& p : pixels) {
      const dvec3 expected = truthOf(p);
      const dvec3 mean = m_around[p.tile].truth / m_around[p.tile].count;
      m_tiles[p.tile].rest += glm::clamp((p.even - expected) * (p.odd - expected), -mean * mean, mean * mean);
    }
    addAround([](Sums& into, const Sums& s) { into.rest += s.rest; });
  }

  /// The square of the truth, known in two ways.
  struct Squares {
    dvec3 cautious;  ///< both halves must say that it is not what is expected: seen too late, the error is told too small
    dvec3 sampled;   ///< the pixel's own mean says so; where it is low by chance, the error is told too large
  };
  Squares squaresOf(const Pixel& p) const {
    const dvec3 expected = truthOf(p), rest = restAround(p), difference = p.truth - expected;
    const dvec3 relative = m_around[p.tile].relativeVariance();
    // Few samples may all have missed what is rare, and know nothing of it: their own variance counts for more the more there are.
    const dvec3 below = glm::min(glm::max(p.even, p.odd) - expected, dvec3(0.0));
    const dvec3 agreed = below + glm::max(glm::min(p.even, p.odd) - expected, dvec3(0.0));
    const dvec3 ofExpected = expected * expected * relative;
    const dvec3 pooled = (p.variance * p.samples + ofExpected * kSamplesOfExpectation) / (p.samples + kSamplesOfExpectation);
    const dvec3 doubted = glm::mix(ofExpected, pooled, glm::lessThan(below, dvec3(0.0)));
    const dvec3 own = glm::max(p.variance, p.truth * p.truth * relative);
    return {squareOf(expected, agreed, doubted / p.samples, kCautiousDoubt, rest),
            squareOf(expected, difference, own / p.samples, kSampledDoubt, rest)};
  }
  /// The same before the pixel's own samples are looked at.
  dvec3 expectedSquare(const Pixel& p) const {
    const dvec3 expected = truthOf(p);
    return expected * expected + restAround(p);
  }
  /// What relMSE adds to every denominator.
  double leastSquare() const {
    const double mean = (m_all.truth.x + m_all.truth.y + m_all.truth.z) / (3.0 * m_all.count);
    return 0.01 * mean * mean + 1e-30;
  }

 private:
  /// Variance of the truth around what is expected.
  dvec3 restAround(const Pixel& p) const {
    const Sums& around = m_around[p.tile];
    return glm::max(around.rest / around.count, dvec3(0.0));
  }

  /// The difference is believed as soon as it is more than noise. [Efron, Morris 1973]
  static dvec3 squareOf(const dvec3& expected, const dvec3& difference, const dvec3& noise, double doubt, const dvec3& rest) {
    const dvec3 spread = glm::max(difference * difference - doubt * noise, dvec3(0.0));
    const dvec3 trust = spread / glm::max(spread + noise, dvec3(1e-300));
    const dvec3 known = expected + trust * difference;
    return known * known + (1.0 - trust) * rest;
  }

  template <class Add>
  void addAround(Add add) {
    for (uint32_t y = 0; y < m_tilesY; ++y)
      for (uint32_t x = 0; x < m_tilesX; ++x)
        for (uint32_t v = y > 0 ? y - 1 : 0; v < std::min(y + 2, m_tilesY); ++v)
          for (uint32_t u = x > 0 ? x - 1 : 0; u < std::min(x + 2, m_tilesX); ++u)
            add(m_around[size_t(y) * m_tilesX + x], m_tiles[size_t(v) * m_tilesX + u]);
  }

  // True over shown is that of the tiles around as far as the noise of so many samples lets it be seen, else of the picture.
  dvec3 truthOf(const Pixel& p) const {
    const Sums& around = m_around[p.tile];
    const dvec3 noise = m_all.relativeVariance() / around.samples;
    dvec3 expected;
    for (int c = 0; c < 3; ++c) {
      if (!(m_all.shown[c] > 0.0) || !(m_all.truth[c] > 0.0)) {
        expected[c] = m_all.truth[c] / m_all.count;
        continue;
      }
      double ratio = m_all.truth[c] / m_all.shown[c];
      if (around.shown[c] > 0.0)
        ratio += (around.truth[c] / around.shown[c] - ratio) / (1.0 + noise[c]);
      const double most = kMostOverAround * around.truth[c] / around.count;
      expected[c] = std::min(p.shown[c] * ratio, std::max(most, std::min(p.even[c], p.odd[c])));
    }
    return expected;
  }

  uint32_t m_tilesX, m_tilesY;
  Sums m_all;
  std::vector<Sums> m_tiles, m_around;
};

/// In magnitude; what is larger is left out, as of any picture that is measured.
double largestKept(const std::vector<dvec3>& quotients) {
  std::vector<double> sizes;
  for (const dvec3& q : quotients)
    for (int c = 0; c < 3; ++c) sizes.push_back(std::abs(q[c]));
  const auto last = sizes.end() - 1 - std::ptrdiff_t(std::floor(kDiscardedShare * double(sizes.size())));
  std::nth_element(sizes.begin(), last, sizes.end());
  return *last;
}

/// Mean quotient of each tile; not a number where it has none, for its pixels were left out.
std::vector<double> tileMeans(const std::vector<Pixel>& pixels, const std::vector<dvec3>& quotients, size_t tiles) {
  const double largest = largestKept(quotients);
  std::vector<double> sums(tiles), kept(tiles);
  for (size_t i = 0; i < pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      if (std::abs(quotients[i][c]) > largest) continue;
      sums[pixels[i].tile] += quotients[i][c];
      kept[pixels[i].tile] += 1.0;
    }
  for (size_t i = 0; i < tiles; ++i) sums[i] /= kept[i];
  return sums;
}

std::vector<double> known(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  return values;
}

double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

/// Where between what two ways tell the error lies: at the mean of their logarithms, for with few samples the larger may be ten
/// times the smaller. What noise has made negative has no logarithm, and stays.
double shareOfSampled(double cautious, double sampled) {
  if (sampled <= cautious) return kSampledShare;
  if (cautious <= 0.0) return 0.0;
  const double middle = std::pow(cautious, 1.0 - kSampledShare) * std::pow(sampled, kSampledShare);
  return (middle - cautious) / (sampled - cautious);
}

/// Mean over the tiles with an interval that minds their skewness: where few tiles make the error, the mean is more likely
/// too low than too high. [Johnson 1978] The denominators let it be off by as much as `below` and `above` say.
FilmError intervalOf(const std::vector<double>& tiles, double below, double above) {
  const double n = double(tiles.size()), mean = meanOf(tiles);
  double second = 0.0, third = 0.0;
  for (const double e : tiles) second += (e - mean) * (e - mean) / (n - 1.0), third += std::pow(e - mean, 3.0) / n;
  const double deviation = std::sqrt(second / n);
  const double skewness = second > 0.0 ? third / std::pow(second, 1.5) : 0.0;
  const double middle = mean + skewness * (1.0 + 2.0 * kSigmas * kSigmas) / (6.0 * std::sqrt(n)) * deviation;
  const double half = kSigmas * std::hypot(deviation, kDenominatorDoubt * std::max(mean, 0.0));
  const double low = middle - std::hypot(half, below), high = middle + std::hypot(half, above);
  return {std::max(mean, 0.0), std::max(low, 0.0), std::max(high, 0.0)};
}

}  // namespace

FilmError estimateFromAudit(std::span<const shared::AuditRecord> records, uint32_t tilesX, uint32_t tilesY) {
  const size_t tiles = size_t(tilesX) * tilesY;
  const std::vector<Pixel> pixels = readRecords(records, uint32_t(tiles));
  if (pixels.empty()) return {};
  const Expectation expectation(pixels, tilesX, tilesY);
  const double least = expectation.leastSquare();
  std::vector<dvec3> cautious, sampled;
  for (const Pixel& p : pixels) {
    const dvec3 square = (p.shown - p.even) * (p.shown - p.odd);
    const Expectation::Squares squares = expectation.squaresOf(p);
    cautious.push_back(square / (squares.cautious + least));
    sampled.push_back(square / (squares.sampled + least));
  }
  // Each way leaves out the largest of its own quotients: of some tiles only one of them knows anything.
  const std::vector<double> low = tileMeans(pixels, cautious, tiles), high = tileMeans(pixels, sampled, tiles);
  const std::vector<double> lowKnown = known(low), highKnown = known(high);
  if (std::min(lowKnown.size(), highKnown.size()) < kLeastTiles) return {};
  const double meanLow = meanOf(lowKnown), meanHigh = meanOf(highKnown), share = shareOfSampled(meanLow, meanHigh);
  std::vector<double> middle(tiles);
  for (size_t i = 0; i < tiles; ++i)
    middle[i] = std::isnan(low[i]) ? high[i] : std::isnan(high[i]) ? low[i] : std::lerp(low[i], high[i], share);
  const double doubt = kDenominatorsApart * std::abs(meanHigh - meanLow);
  return intervalOf(known(middle), share * doubt, (1.0 - share) * doubt);
}

bool noiseOutweighsChoice(std::span<const shared::AuditRecord> records, uint32_t tilesX, uint32_t tilesY) {
  const std::vector<Pixel> pixels = readRecords(records, tilesX * tilesY);
  if (pixels.empty()) return false;
  const Expectation expectation(pixels, tilesX, tilesY);
  const double least = expectation.leastSquare();
  std::vector<dvec3> quotients, noises;
  for (const Pixel& p : pixels) {
    const dvec3 denominator = expectation.expectedSquare(p) + least;
    quotients.push_back((p.shown - p.even) * (p.shown - p.odd) / denominator);
    noises.push_back(2.0 * p.variance / p.samples / denominator);  // variance of a half
  }
  const double largest = largestKept(quotients);
  double count = 0.0, sum = 0.0, squares = 0.0, noise = 0.0;
  for (size_t i = 0; i < pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double q = quotients[i][c];
      if (std::abs(q) > largest) continue;
      count += 1.0, sum += q, squares += q * q, noise += noises[i][c] * noises[i][c];
    }
  return noise > 0.5 * (squares - sum * sum / count);
}

}  // namespace limn
