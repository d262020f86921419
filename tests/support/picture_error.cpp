#include "tests/support/picture_error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/base/check.hpp"
#include "renderer/base/luminance.hpp"

namespace limn::test {
namespace {

const std::vector<float>& dataOf(const FilmImage& picture, const std::string& layer) {
  const FilmLayer* found = picture.find(layer);
  LIMN_CHECK(found != nullptr);
  return found->data;
}

double luminanceOf(const std::vector<float>& rgb, size_t pixel) { return luminance(&rgb[3 * pixel]); }

/// Mean of (x−r)(y−s) over the square of the reference, whose noise `r` and `s` share none of.
double meanQuotient(const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& r, const std::vector<float>& s) {
  double mean = 0.0, sum = 0.0;
  for (size_t i = 0; i < r.size(); ++i) mean += 0.5 * (double(r[i]) + s[i]) / double(r.size());
  for (size_t i = 0; i < r.size(); ++i) {
    const double truth = 0.5 * (double(r[i]) + s[i]);
    sum += (double(x[i]) - r[i]) * (double(y[i]) - s[i]) / (truth * truth + 0.01 * mean * mean + 1e-30);
  }
  return sum / double(r.size());
}

/// [pixel] Smaller tiles hold too few pixels on edges, the only ones with noise under a point light, to tell that noise.
constexpr uint32_t kTile = 16;

struct Sums {
  double difference = 0.0, variance = 0.0, scale = 0.0;
  double deviation(double rounding) const {
    const double error = std::sqrt(variance) + rounding * scale;
    return error > 0.0 ? std::abs(difference) / error : 0.0;
  }
};

}  // namespace

double biasOf(const PicturePair& pair, const PicturePair& reference, const std::string& layer) {
  return meanQuotient(dataOf(pair.a, layer), dataOf(pair.b, layer), dataOf(reference.a, layer), dataOf(reference.b, layer));
}

double relMseOf(const FilmImage& picture, const PicturePair& reference, const std::string& layer) {
  const auto& x = dataOf(picture, layer);
  return meanQuotient(x, x, dataOf(reference.a, layer), dataOf(reference.b, layer));
}

Deviation deviationOf(const PicturePair& pair, const PicturePair& reference, const std::string& layer, double rounding) {
  const std::vector<float>*all[] = {&dataOf(pair.a, layer), &dataOf(pair.b, layer), &dataOf(reference.a, layer),
                                    &dataOf(reference.b, layer)};
  const uint32_t width = pair.a.width, tilesX = (width + kTile - 1) / kTile, tilesY = (pair.a.height + kTile - 1) / kTile;
  std::vector<Sums> tiles(size_t(tilesX) * tilesY);
  Sums whole;
  for (size_t i = 0; i < size_t(width) * pair.a.height; ++i) {
    double v[4];
    for (int k = 0; k < 4; ++k) v[k] = luminanceOf(*all[k], i);
    for (Sums* s : {&whole, &tiles[i / width / kTile * tilesX + i % width / kTile]}) {
      s->difference += 0.5 * (v[0] + v[1] - v[2] - v[3]);
      s->variance += 0.25 * ((v[0] - v[1]) * (v[0] - v[1]) + (v[2] - v[3]) * (v[2] - v[3]));
      s->scale += 0.5 * std::abs(v[2] + v[3]);
    }
  }
  Deviation d{whole.deviation(rounding), 0.0, tiles.size()};
  for (const Sums& s : tiles) d.worstTile = std::max(d.worstTile, s.deviation(rounding));
  return d;
}

double meanOf(const FilmImage& picture, const std::string& layer) {
  const auto& data = dataOf(picture, layer);
  double sum = 0.0;
  for (const float v : data) sum += v;
  return sum / double(data.size());
}

double largestOf(const FilmImage& picture, const std::string& layer) {
  const auto& data = dataOf(picture, layer);
  return *std::max_element(data.begin(), data.end());
}

bool isSound(const FilmImage& picture) {
  for (const FilmLayer& layer : picture.layers)
    if (!std::all_of(layer.data.begin(), layer.data.end(), [](float v) { return std::isfinite(v); })) return false;
  const auto &beauty = dataOf(picture, "beauty"), &direct = dataOf(picture, "direct"), &indirect = dataOf(picture, "indirect");
  for (size_t i = 0; i < beauty.size(); ++i)
    if (std::min({beauty[i], direct[i], indirect[i]}) < -1e-5f * std::max(beauty[i], direct[i])) return false;
  return true;
}

int firefliesOf(const FilmImage& picture, const FilmImage& reference, double factor) {
  const auto &x = dataOf(picture, "beauty"), &r = dataOf(reference, "beauty");
  const int width = int(picture.width), height = int(picture.height);
  const double floor = 0.1 * meanOf(reference, "beauty");
  int count = 0;
  for (int i = 0; i < width * height; ++i) {
    double around = floor;
    for (int k = 0; k < 9; ++k) {
      const int qx = i % width + k % 3 - 1, qy = i / width + k / 3 - 1;
      if (qx >= 0 && qy >= 0 && qx < width && qy < height)
        around = std::max(around, luminanceOf(r, size_t(qy * width + qx)));
    }
    count += luminanceOf(x, size_t(i)) > factor * around;
  }
  return count;
}

}  // namespace limn::test
