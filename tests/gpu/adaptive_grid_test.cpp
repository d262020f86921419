#include "renderer/placement/adaptive_grid.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>
#include <set>

#include "tests/gpu/picture_fixture.hpp"

namespace limn::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

using List = std::vector<uint32_t>;

AdaptiveGrid& grid() {
  static std::unique_ptr<AdaptiveGrid> kept;
  if (kept == nullptr) {
    kept = std::make_unique<AdaptiveGrid>();
    SharedDevice::atEnd([] { kept.reset(); });
  }
  return *kept;
}

/// Runs one of the grid's selections on a picture and gives the list.
template <class Select>
List listOf(const Picture& p, Select select) {
  const DevicePicture device(p);
  const PlacementBuffers buffers{device.sites, device.gathered, device.list};
  must(grid().prepare(SharedDevice::get(), buffers, p.width, p.height));
  const uint32_t count = must(select(buffers));
  EXPECT_LE(count, p.pixels());
  return count == 0 ? List{} : must(vk::readBackArray<uint32_t>(SharedDevice::get(), device.list, count));
}

List incoherent(const Picture& p, uint32_t stride, const CoherenceRule& rule) {
  return listOf(p, [&](const PlacementBuffers& b) {
    return grid().selectIncoherent(SharedDevice::get(), b, stride, rule);
  });
}
List scattered(const Picture& p, uint32_t first, uint32_t count, bool unsampledOnly = false) {
  return listOf(p, [&](const PlacementBuffers& b) {
    return grid().selectScattered(SharedDevice::get(), b, first, count, unsampledOnly);
  });
}

bool usable(const IndirectTexel& l) {
  for (int c = 0; c < 3; ++c)
    if (!(std::abs(l.diffuse[c]) < 1e30f) || !(std::abs(l.glossy[c]) < 1e30f)) return false;
  return true;
}

double outgoing(const IndirectTexel& l) {
  return glm::dot(glm::dvec3(l.diffuse) + glm::dvec3(l.glossy), {0.2126, 0.7152, 0.0722});
}

/// Plain form of the metric. [IPP §3.3]
double metric(const Picture& p, int x, int y, int stride, const CoherenceRule& rule) {
  const GatherSite& own = p.sites[p.at(x, y)];
  double geometry = 0.0;
  for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
    const int qx = x + dx * stride, qy = y + dy * stride;
    if (!p.holds(qx, qy)) continue;
    const GatherSite& other = p.sites[p.at(qx, qy)];
    const double cosine = glm::dot(decodedNormal(own.normal), decodedNormal(other.normal));
    double change = glm::distance(glm::dvec3(own.posR), glm::dvec3(other.posR)) / rule.extent +
                    std::sqrt(std::max(0.0, 2.0 - 2.0 * cosine));
    if (!seesSurface(other)) change = 1.0;
    if (other.object != own.object) change = std::max(change, 1.0);
    geometry = std::max(geometry, change);
  }
  std::vector<double> light;
  const int coarse = 2 * stride;
  for (int k = 0; k < 4; ++k) {
    const int qx = (x / coarse + k % 2) * coarse, qy = (y / coarse + k / 2) * coarse;
    if (!p.holds(qx, qy) || !seesSurface(p.sites[p.at(qx, qy)])) continue;
    const IndirectTexel& parent = p.light[p.at(qx, qy)];
    if (!usable(parent)) return kInf;
    if (parent.state != shared::kIndirectNone && parent.count != shared::kCountGuessed)
      light.push_back(outgoing(parent) / rule.luminance);
  }
  double radiance = 0.0;
  for (size_t j = 0; j < light.size(); ++j)
    for (size_t k = j + 1; k < light.size(); ++k) radiance += std::abs(light[j] - light[k]);
  return geometry + rule.lambda * radiance;
}

/// Random light of all kinds, as it is between two levels.
void lightUnevenly(Picture& p, uint32_t seed, int coarse, bool broken) {
  std::mt19937 random(seed);
  eachPixel(p, [&](int x, int y, GatherSite&, IndirectTexel& l) {
    l = randomLight(random);
    l.diffuse *= 0.1f;
    l.glossy *= 0.1f;
    const bool parent = x % coarse == 0 && y % coarse == 0;
    const uint32_t kind = random() % 16;
    if (!parent || kind < 4) l.state = kind == 0 ? shared::kIndirectSampled : shared::kIndirectInterpolated;
    if (l.state == shared::kIndirectInterpolated) {
      l.count = kind == 1 ? shared::kCountFar : kind == 2 ? shared::kCountGuessed : 0.0f;
    }
    if (broken && random() % 16 == 0) l.diffuse.y = random() % 2 == 0 ? kNan : kInf;
  });
}

class SelectIncoherent : public testing::TestWithParam<Size> {};

TEST_P(SelectIncoherent, ListsWhatTheMetricSaysRowByRow) {
  const auto [width, height] = GetParam();
  size_t candidates = 0, unsure = 0, selected = 0, left = 0;
  for (uint32_t stride = 16; stride > 0; stride /= 2)
    for (const float threshold : {0.0f, 0.3f, 0.9f, 2.5f, 10.0f}) {
      const uint32_t seed = stride + uint32_t(threshold * 100);
      Picture p = randomPicture(seed, width, height);
      lightUnevenly(p, seed, int(2 * stride), threshold == 0.9f);
      const CoherenceRule rule{threshold, 8.0f, 2.0f, 1.0f};
      const List list = incoherent(p, stride, rule);
      EXPECT_EQ(list, incoherent(p, stride, rule)) << "the same bits on every run";
      const std::set<uint32_t> chosen(list.begin(), list.end());
      List expected;
      for (int y = 0; y < int(height); y += int(stride))
        for (int x = 0; x < int(width); x += int(stride)) {
          const auto pixel = uint32_t(p.at(x, y));
          if (!seesSurface(p.sites[pixel]) || p.light[pixel].state == shared::kIndirectSampled) continue;
          const double value = metric(p, x, y, int(stride), rule);
          const bool rounded = std::abs(value - threshold) < 1e-5;
          const bool wanted = rounded ? chosen.count(pixel) > 0 : value > threshold || p.light[pixel].count < 0.0f;
          if (wanted) expected.push_back(pixel);
          unsure += rounded && p.light[pixel].count >= 0.0f && threshold > 0.0f;
          ++(wanted ? selected : left);
          ++candidates;
        }
      EXPECT_EQ(list, expected) << "stride " << stride << ", threshold " << threshold;
    }
  EXPECT_LE(unsure, candidates / 200);
  if (width * height > 100) {
    EXPECT_GT(selected, candidates / 8);
    EXPECT_GT(left, candidates / 8);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, SelectIncoherent,
                         testing::Values(Size{37, 23}, Size{1, 1}, Size{130, 65}, Size{3, 200}), nameOfSize);

constexpr CoherenceRule kRule{0.3f, 8.0f, 10.0f, 1.0f};

TEST(AdaptiveGrid, AFlatEvenlyLitPlaneSelectsNothing) {
  for (uint32_t stride = 8; stride > 0; stride /= 2) {
    Picture p = planePicture(64, 48);
    lightGrid(p, int(2 * stride), [](int, int) { return sampledLight({0.4f, 0.5f, 0.6f}); });
    EXPECT_EQ(incoherent(p, stride, kRule), List{}) << stride;
  }
}

TEST(AdaptiveGrid, ADepthEdgeSelectsThePixelsOnBothSides) {
  for (const uint32_t stride : {8u, 4u, 2u, 1u}) {
    Picture p = planePicture(64, 48);
    lightGrid(p, int(2 * stride), [](int, int) { return sampledLight(glm::vec3(0.5f)); });
    eachPixel(p, [](int x, int, GatherSite& s, IndirectTexel&) { s.posR.z -= x < 29 ? 0.0f : 5.0f; });
    const int left = 28 / int(stride) * int(stride), right = left + int(stride);
    List expected;
    for (int y = 0; y < 48; y += int(stride))
      for (const int x : {left, right})
        if (p.light[p.at(x, y)].state == shared::kIndirectNone) expected.push_back(uint32_t(p.at(x, y)));
    EXPECT_EQ(incoherent(p, stride, kRule), expected) << stride;
  }
}

TEST(AdaptiveGrid, ARadianceEdgeSelectsTheCellsItCrosses) {
  Picture p = planePicture(64, 48);
  lightGrid(p, 8, [](int x, int) { return sampledLight(glm::vec3(x < 27 ? 0.1f : 0.9f)); });
  List expected;
  for (int y = 0; y < 48; y += 4)
    for (const int x : {24, 28})
      if (x % 8 != 0 || y % 8 != 0) expected.push_back(uint32_t(p.at(x, y)));
  EXPECT_EQ(incoherent(p, 4, kRule), expected);
  CoherenceRule blind = kRule;
  blind.lambda = 0.0f;
  EXPECT_EQ(incoherent(p, 4, blind), List{});
  CoherenceRule bright = kRule;
  bright.luminance = 1000.0f;
  EXPECT_EQ(incoherent(p, 4, bright), List{}) << "differences are measured over the picture's luminance";
}

TEST(AdaptiveGrid, BesideAnotherObjectIncoherenceIsOneAtLeast) {
  Picture p = planePicture(16, 16);
  lightGrid(p, 2, [](int, int) { return sampledLight(glm::vec3(0.5f)); });
  eachPixel(p, [](int x, int, GatherSite& s, IndirectTexel&) { s.object = x < 8 ? 0 : 1; });
  const auto count = [&](float threshold) { return incoherent(p, 1, {threshold, 8.0f, 10.0f, 1.0f}).size(); };
  EXPECT_EQ(count(0.99f), 16u + 8u);
  EXPECT_EQ(count(1.01f), 0u);
  eachPixel(p, [](int x, int, GatherSite& s, IndirectTexel&) { s.posR.z -= x < 8 ? 0.0f : 15.0f; });
  EXPECT_EQ(count(1.4f), 16u + 8u);
  EXPECT_EQ(count(1.6f), 0u);
}

TEST(AdaptiveGrid, WhatInterpolationCouldNotServeIsGatheredAtAnyThreshold) {
  Picture p = planePicture(16, 16);
  lightGrid(p, 2, [](int, int) { return sampledLight(glm::vec3(0.5f)); });
  p.light[p.at(3, 5)] = {glm::vec3(0.5f), shared::kCountFar, glm::vec3(0.0f), shared::kIndirectInterpolated};
  p.light[p.at(7, 9)] = {glm::vec3(0.5f), shared::kCountGuessed, glm::vec3(0.0f), shared::kIndirectInterpolated};
  EXPECT_EQ(incoherent(p, 1, {1e6f, 8.0f, 10.0f, 1.0f}), (List{uint32_t(p.at(3, 5)), uint32_t(p.at(7, 9))}));
}

TEST(AdaptiveGrid, AParentWhoseLightIsNoNumberMakesItsCellsIncoherent) {
  for (const float broken : {kNan, kInf, -kInf})
    for (const float lambda : {0.0f, 8.0f}) {
      Picture p = planePicture(32, 32);
      lightGrid(p, 4, [](int, int) { return sampledLight(glm::vec3(0.5f)); });
      p.light[p.at(16, 16)].glossy.z = broken;
      List expected;
      for (int y = 12; y < 20; y += 2)
        for (int x = 12; x < 20; x += 2)
          if (x % 4 != 0 || y % 4 != 0) expected.push_back(uint32_t(p.at(x, y)));
      EXPECT_EQ(incoherent(p, 2, {10.0f, lambda, 10.0f, 1.0f}), expected) << broken;
    }
}

TEST(AdaptiveGrid, MeanLuminanceIsThatOfTheSampledLight) {
  Picture p = randomPicture(3, 37, 23);
  lightUnevenly(p, 3, 4, true);
  double sum = 0.0, number = 0.0;
  for (int y = 0; y < 23; y += 2)
    for (int x = 0; x < 37; x += 2) {
      const IndirectTexel& l = p.light[p.at(x, y)];
      const bool counts = seesSurface(p.sites[p.at(x, y)]) && l.state == shared::kIndirectSampled && usable(l);
      sum += counts ? outgoing(l) : 0.0;
      number += counts;
    }
  const DevicePicture device(p);
  const PlacementBuffers buffers{device.sites, device.gathered, device.list};
  must(grid().prepare(SharedDevice::get(), buffers, p.width, p.height));
  EXPECT_GT(number, 30.0);
  EXPECT_NEAR(must(grid().meanLuminance(SharedDevice::get(), buffers, 2)), sum / number, 1e-6);
}

TEST(AdaptiveGrid, PicturesOfManyWorkgroupsAreListedWhole) {
  const Picture p = planePicture(1100, 1000);  // two rows of workgroups
  List all(p.pixels());
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(listOf(p, [](const PlacementBuffers& b) { return grid().selectGrid(SharedDevice::get(), b, 1); }), all);
}

TEST(ScatteredOrder, VisitsEveryPixelThatSeesSomethingOnce) {
  for (const auto& [width, height] : {std::pair{37u, 23u}, {1u, 1u}, {2u, 2u}, {5u, 200u}, {64u, 64u}}) {
    const Picture p = randomPicture(9, width, height);
    List expected, visited;
    for (uint32_t i = 0; i < p.pixels(); ++i)
      if (seesSurface(p.sites[i])) expected.push_back(i);
    uint32_t first = 0;
    scattered(p, 0, 1);  // makes room for the size
    const uint32_t places = grid().scatteredCount();
    for (const uint32_t share : {places / 7 + 1, places / 3 + 1, places}) {
      const List part = scattered(p, first, share);
      visited.insert(visited.end(), part.begin(), part.end());
      first += share;
    }
    std::sort(visited.begin(), visited.end());
    EXPECT_EQ(visited, expected) << width << "x" << height;
  }
}

TEST(ScatteredOrder, AnyShareIsSpreadEvenly) {
  const Picture p = planePicture(64, 64);
  std::mt19937 random(5);
  for (int turn = 0; turn < 20; ++turn) {
    const uint32_t first = random() % 3000, count = 1 + random() % 1000;
    const List list = scattered(p, first, count);
    ASSERT_EQ(list.size(), count);
    for (const uint32_t side : {32u, 16u, 8u}) {
      const uint32_t across = 64 / side;
      std::vector<uint32_t> blocks(across * across);
      for (const uint32_t pixel : list) ++blocks[pixel / 64 / side * across + pixel % 64 / side];
      for (const uint32_t n : blocks) {
        EXPECT_GE(n, count / blocks.size());
        EXPECT_LE(n, count / blocks.size() + 1);
      }
    }
  }
}

TEST(ScatteredOrder, LeavesSampledPixelsOutWhenAsked) {
  Picture p = randomPicture(11, 37, 23);
  lightUnevenly(p, 11, 1000, false);
  List list = scattered(p, 0, 1u << 30, true), expected;
  for (uint32_t i = 0; i < p.pixels(); ++i)
    if (seesSurface(p.sites[i]) && p.light[i].state != shared::kIndirectSampled) expected.push_back(i);
  std::sort(list.begin(), list.end());
  EXPECT_EQ(list, expected);
  EXPECT_LT(list.size(), size_t(std::count_if(p.sites.begin(), p.sites.end(), seesSurface)));
}

}  // namespace
}  // namespace limn::test
