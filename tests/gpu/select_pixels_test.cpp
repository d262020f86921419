// Which pixels still need samples, against the rule written again on the host, over random films.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/film/film_statistics.hpp"
#include "renderer/gpu/work_groups.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/film_shared.h"
#include "tests/gpu/picture_fixture.hpp"

namespace limn::test {
namespace {

/// The words of the film that the rule reads: mean radiance and count, and the second moment of luminance.
struct FilmWords {
  uint32_t width = 0, height = 0;
  std::vector<glm::vec4> mean, half;
};

struct Rule {
  uint32_t minSamples = 8;
  float threshold = 0.05f, meanLuminance = 0.5f;
};

/// Most pixels are quiet and have enough samples; some are dark, noisy, or hardly sampled.
FilmWords randomFilm(uint32_t seed, Size size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  FilmWords film{size.first, size.second, {}, {}};
  for (uint32_t i = 0; i < film.width * film.height; ++i) {
    const bool noisy = random() % 24 == 0, few = random() % 64 == 0, black = random() % 8 == 0;
    const float count = few ? float(random() % 8) : 8.0f + float(random() % 50);
    const float scale = black ? 0.0f : 1.0f;
    film.mean.push_back({scale * unit(random), scale * unit(random), scale * unit(random), count});
    const float deviation = (noisy ? 2.0f : 0.08f) * unit(random);
    film.half.push_back({unit(random), unit(random), unit(random), count * deviation * deviation});
  }
  return film;
}

/// Standard error of the mean luminance, relative to the pixel and a tenth of the picture.
double relativeError(const FilmWords& film, const Rule& rule, size_t pixel) {
  const glm::dvec4 mean(film.mean[pixel]);
  if (mean.w < rule.minSamples) return std::numeric_limits<double>::infinity();
  const double y = 0.2126 * mean.r + 0.7152 * mean.g + 0.0722 * mean.b;
  const double ofMean = film.half[pixel].w / (std::max(mean.w - 1.0, 1.0) * mean.w);
  return std::sqrt(ofMean / (y * y + 0.01 * double(rule.meanLuminance) * rule.meanLuminance + 1e-30));
}

/// A pixel rests when it and those of its eight neighbours that are in the picture are at or under the threshold.
bool needsSamples(const FilmWords& film, const Rule& rule, int x, int y) {
  for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, int(film.height) - 1); ++ny)
    for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, int(film.width) - 1); ++nx)
      if (relativeError(film, rule, size_t(ny) * film.width + size_t(nx)) > rule.threshold) return true;
  return false;
}

/// Tiles of 16x16 in rows, and the pixels of each along the Morton curve, whose even bits are x.
std::vector<uint32_t> expectedList(const FilmWords& film, const Rule& rule) {
  std::vector<uint32_t> list;
  for (uint32_t tileY = 0; tileY < film.height; tileY += 16)
    for (uint32_t tileX = 0; tileX < film.width; tileX += 16)
      for (uint32_t code = 0; code < 256; ++code) {
        uint32_t x = tileX, y = tileY;
        for (uint32_t bit = 0; bit < 4; ++bit) {
          x += (code >> (2 * bit) & 1) << bit;
          y += (code >> (2 * bit + 1) & 1) << bit;
        }
        if (x < film.width && y < film.height && needsSamples(film, rule, int(x), int(y)))
          list.push_back(y * film.width + x);
      }
  return list;
}

/// What the three stages of the shader write.
std::vector<uint32_t> selectedList(const FilmWords& film, const Rule& rule) {
  vk::Device& device = SharedDevice::get();
  const size_t pixels = film.mean.size();
  const uint32_t tiles = ((film.width + 15) / 16) * ((film.height + 15) / 16);
  const vk::Buffer mean = inputOf(film.mean), half = inputOf(film.half), other = inputOf(film.mean);
  const vk::Buffer list = inputOf(std::vector<uint32_t>(pixels)), counts = inputOf(std::vector<uint32_t>(tiles + 1));
  const std::vector<vk::Binding> bindings{
      vk::storage(BINDING_FILM_MEAN, mean),    vk::storage(BINDING_FILM_HALF, half),
      vk::storage(BINDING_FILM_DIRECT, other), vk::storage(BINDING_FILM_ALBEDO, other),
      vk::storage(BINDING_FILM_NORMAL, other), vk::storage(BINDING_PIXEL_LIST, list),
      vk::storage(BINDING_OUTPUT, counts)};
  static gpu::Pass pass = [&] {
    SharedDevice::atEnd([] { pass = {}; });
    return must(gpu::Pass::create(device, "select_pixels", bindings, sizeof(shared::SelectPush)));
  }();
  shared::SelectPush push{film.width, film.height, rule.minSamples, tiles, rule.threshold, 0, rule.meanLuminance};
  must(gpu::runNow(device, [&](vk::CommandRecorder& r) {
    for (push.stage = 0; push.stage < 3; ++push.stage) {
      const gpu::WorkGroups groups = gpu::groupsInRows(push.stage == 1 ? 1 : tiles);
      pass.record(r, bindings, push, groups.x, groups.y);
      r.barrier();
    }
  }));
  const uint32_t total = must(vk::readBackArray<uint32_t>(device, counts, tiles + 1)).back();
  EXPECT_LE(total, pixels);
  std::vector<uint32_t> all = must(vk::readBackArray<uint32_t>(device, list, pixels));
  all.resize(std::min(size_t(total), pixels));
  return all;
}

class SelectPixels : public testing::TestWithParam<Size> {};
INSTANTIATE_TEST_SUITE_P(Sizes, SelectPixels,
                         // The last has more tiles than the workgroup that places them has invocations.
                         testing::Values(Size{1, 1}, Size{16, 16}, Size{17, 33}, Size{100, 37}, Size{300, 5},
                                         Size{280, 272}),
                         nameOfSize);

TEST_P(SelectPixels, TheListIsThatOfTheRuleSeeds1To4) {
  for (uint32_t seed = 1; seed <= 4; ++seed) {
    const FilmWords film = randomFilm(seed, GetParam());
    for (const Rule& rule : {Rule{}, Rule{1, 0.02f, 0.5f}, Rule{16, 0.1f, 0.01f}, Rule{8, 0.2f, 0.0f}})
      EXPECT_EQ(selectedList(film, rule), expectedList(film, rule)) << "seed " << seed << ", " << rule.threshold;
  }
}

/// A quiet film of 40x40 with one pixel changed.
FilmWords quietFilmWith(uint32_t x, uint32_t y, glm::vec4 mean, float secondMoment) {
  FilmWords film{40, 40, std::vector<glm::vec4>(1600, {0.5f, 0.5f, 0.5f, 16.0f}), std::vector<glm::vec4>(1600)};
  film.mean[y * 40 + x] = mean;
  film.half[y * 40 + x].w = secondMoment;
  return film;
}

std::vector<uint32_t> sorted(std::vector<uint32_t> list) {
  std::sort(list.begin(), list.end());
  return list;
}

TEST(SelectPixelsRule, AQuietFilmRests) {
  EXPECT_TRUE(selectedList(quietFilmWith(0, 0, {0.5f, 0.5f, 0.5f, 16.0f}, 0.0f), {}).empty());
}

TEST(SelectPixelsRule, ANoisyPixelKeepsItsNeighboursAcrossTheTilesBorder) {
  const auto list = sorted(selectedList(quietFilmWith(15, 16, {0.5f, 0.5f, 0.5f, 16.0f}, 100.0f), {}));
  EXPECT_EQ(list, (std::vector<uint32_t>{614, 615, 616, 654, 655, 656, 694, 695, 696}));
}

TEST(SelectPixelsRule, UnderTheMinimumAPixelNeedsSamplesHoweverQuiet) {
  const auto list = sorted(selectedList(quietFilmWith(39, 39, {0.5f, 0.5f, 0.5f, 7.0f}, 0.0f), {}));
  EXPECT_EQ(list, (std::vector<uint32_t>{1558, 1559, 1598, 1599}));
  EXPECT_TRUE(selectedList(quietFilmWith(39, 39, {0.5f, 0.5f, 0.5f, 8.0f}, 0.0f), {}).empty());
}

// Pictures of 8192x8192 pixels have four times as many.
TEST(SelectPixelsOfAFilm, MayHaveMoreTilesThanADispatchHasWorkgroupsInARow) {
  vk::Device& device = SharedDevice::get();
  const Film film = must(Film::create(device, 1, 16 * 65536));
  must(gpu::runNow(device, [&](vk::CommandRecorder& r) { film.recordClear(r); }));
  FilmStatistics statistics = must(FilmStatistics::create(device, film));
  const vk::Buffer list = inputOf(std::vector<uint32_t>(film.pixelCount()));
  EXPECT_EQ(must(statistics.selectPixels(device, film, list, 1, 0.05f, 0.5)), film.pixelCount());
  const auto pixels = must(vk::readBackArray<uint32_t>(device, list, film.pixelCount()));
  std::vector<uint32_t> all(film.pixelCount());
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(pixels, all) << "a column of tiles one pixel wide, in order";
}

}  // namespace
}  // namespace limn::test
