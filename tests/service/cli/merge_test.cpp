#include "server/limn/merge_parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace limn {
namespace {

using ::testing::HasSubstr;

constexpr uint32_t kWidth = 7, kHeight = 5;
constexpr size_t kPixels = size_t(kWidth) * kHeight;

/// Radiance of sample `index` of a pixel and channel, the same whichever part takes it. Multiples of 1/64 below 16, so
/// that the means of 2^k samples are exact in float.
double sampleOf(size_t pixel, size_t channel, uint64_t index) {
  std::mt19937 random(uint32_t(pixel * 7919 + channel * 104729 + index * 1299709 + 1));
  return double(random() % 1024) / 64.0;
}

bool takesAll(size_t, uint64_t) { return true; }

/// What a film holds after the samples of [first, end) for which `takes` says yes.
FilmImage film(uint64_t first, uint64_t end, const std::function<bool(size_t, uint64_t)>& takes = takesAll) {
  FilmImage image{kWidth, kHeight, {{"beauty", 3, {}}, {"depth", 1, {}}, {"error", 1, {}}, {"samples", 1, {}}}, {}};
  for (FilmLayer& layer : image.layers) layer.data.resize(kPixels * layer.channels);
  for (size_t p = 0; p < kPixels; ++p) {
    double count = 0.0, sum[3] = {}, luminanceSum = 0.0, squares = 0.0;
    for (uint64_t s = first; s < end; ++s) {
      if (!takes(p, s)) continue;
      const double rgb[3] = {sampleOf(p, 0, s), sampleOf(p, 1, s), sampleOf(p, 2, s)};
      const double y = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
      for (int c = 0; c < 3; ++c) sum[c] += rgb[c];
      count += 1.0;
      luminanceSum += y;
      squares += y * y;
    }
    image.layers[3].data[p] = float(count);
    if (count == 0.0) continue;
    for (size_t c = 0; c < 3; ++c) image.layers[0].data[p * 3 + c] = float(sum[c] / count);
    image.layers[1].data[p] = 3.0f + float(p);
    const double deviations = squares - luminanceSum * luminanceSum / count;
    image.layers[2].data[p] = count > 1.0 ? float(std::sqrt(std::max(0.0, deviations) / (count - 1.0) / count)) : 0.0f;
  }
  image.metadata = {{"limn:samples", sampleRangeText({first, end})}, {"limn:sceneHash", "abc"}, {"limn:seconds", "1.5"},
                    {"limn:seed", "3"}, {"limn:technique", "path-tracing"}};
  return image;
}

FilmImage headerOf(FilmImage image) {
  for (FilmLayer& layer : image.layers) layer.data.clear();
  return image;
}

Result<std::vector<MergePart>> ordered(const std::vector<FilmImage>& images) {
  std::vector<MergePart> parts;
  for (const FilmImage& image : images) {
    Result<MergePart> part = mergePartOf(headerOf(image), "part" + std::to_string(parts.size()) + ".exr");
    if (!part) return part.error();
    parts.push_back(part.take());
  }
  return orderParts(std::move(parts));
}

/// As the command does it: headers first, then the pixels in sample order.
FilmImage merge(const std::vector<FilmImage>& images) {
  const Result<std::vector<MergePart>> parts = ordered(images);
  EXPECT_TRUE(parts.ok()) << parts.error().text();
  PartMerger merger(parts->front());
  for (const MergePart& part : *parts)
    for (const FilmImage& image : images) {
      if (image.metadata[0].second != sampleRangeText(part.range)) continue;
      EXPECT_TRUE(merger.add(part, image).ok());
    }
  return merger.finish();
}

void expectNear(const FilmImage& a, const FilmImage& b, const std::string& layer, double relative) {
  const FilmLayer* x = a.find(layer);
  const FilmLayer* y = b.find(layer);
  ASSERT_TRUE(x && y && x->data.size() == y->data.size());
  for (size_t i = 0; i < x->data.size(); ++i)
    EXPECT_NEAR(x->data[i], y->data[i], relative * std::abs(y->data[i])) << layer << " " << i;
}

TEST(Merge, PowersOfTwoGiveTheUnsplitFilmBitForBit) {
  const FilmImage whole = film(0, 64);
  const FilmImage merged = merge({film(32, 64), film(0, 16), film(16, 32)});
  for (const char* layer : {"beauty", "depth", "samples"}) EXPECT_EQ(merged.find(layer)->data, whole.find(layer)->data);
  expectNear(merged, whole, "error", 1e-5);
}

TEST(Merge, AnySplitGivesTheUnsplitFilmToTheLastBitButOne) {
  const FilmImage whole = film(0, 50);
  const FilmImage merged = merge({film(0, 1), film(1, 7), film(7, 10), film(10, 37), film(37, 50)});
  expectNear(merged, whole, "beauty", 1.2e-7);
  expectNear(merged, whole, "error", 1e-5);
  EXPECT_EQ(merged.find("samples")->data, whole.find("samples")->data);
}

TEST(Merge, EachPixelIsWeightedByItsOwnSampleCount) {
  const auto adaptive = [](size_t pixel, uint64_t sample) { return sample % (1 + pixel % 4) == 0; };
  const FilmImage whole = film(0, 40, adaptive);
  const FilmImage merged = merge({film(0, 13, adaptive), film(13, 40, adaptive)});
  expectNear(merged, whole, "beauty", 2.4e-7);
  expectNear(merged, whole, "error", 1e-5);
  EXPECT_EQ(merged.find("samples")->data, whole.find("samples")->data);
}

TEST(Merge, APixelThatAPartDidNotReachTakesNothingFromIt) {
  const auto late = [](size_t pixel, uint64_t sample) { return pixel != 4 || sample >= 8; };
  const auto never = [](size_t pixel, uint64_t) { return pixel != 4; };
  EXPECT_EQ(merge({film(0, 8, late), film(8, 16, late)}).find("depth")->data, film(0, 16).find("depth")->data);
  const FilmImage empty = merge({film(0, 8, never), film(8, 16, never)});
  EXPECT_EQ(empty.find("beauty")->data[4 * 3], 0.0f);
  EXPECT_EQ(empty.find("samples")->data[4], 0.0f);
}

TEST(Merge, WithoutASamplesLayerTheRangeIsTheWeight) {
  std::vector<FilmImage> parts = {film(0, 10), film(10, 40)};
  for (FilmImage& part : parts) part.layers.pop_back();
  expectNear(merge(parts), film(0, 40), "beauty", 2.4e-7);
}

TEST(Merge, MetadataSpeakOfTheWhole) {
  const FilmImage merged = merge({film(0, 8), film(8, 16)});
  EXPECT_THAT(merged.metadata, ::testing::Contains(std::pair<std::string, std::string>("limn:samples", "0:16")));
  EXPECT_THAT(merged.metadata, ::testing::Contains(std::pair<std::string, std::string>("limn:seconds", "3.000000")));
  EXPECT_THAT(merged.metadata, ::testing::Contains(std::pair<std::string, std::string>("limn:sceneHash", "abc")));
}

TEST(Merge, AMergedPartMergesOn) {
  const FilmImage merged = merge({merge({film(0, 8), film(8, 16)}), film(16, 32)});
  EXPECT_EQ(merged.find("beauty")->data, film(0, 32).find("beauty")->data);
}

void expectRefused(const std::vector<FilmImage>& images, const std::string& code, const std::string& says) {
  const Result<std::vector<MergePart>> parts = ordered(images);
  ASSERT_FALSE(parts.ok()) << code;
  EXPECT_EQ(parts.error().code, code);
  EXPECT_THAT(parts.error().text(), HasSubstr(says));
}

TEST(Merge, RangesThatDoNotMakeAWholeAreRefused) {
  expectRefused({film(0, 8), film(0, 8)}, "overlap", "0:8");
  expectRefused({film(0, 8), film(7, 16)}, "overlap", "part1.exr");
  expectRefused({film(0, 16), film(4, 8)}, "overlap", "4:8");
  expectRefused({film(0, 8), film(9, 16)}, "gap", "8:9");
  expectRefused({film(8, 16), film(16, 24)}, "gap", "0:8");
}

TEST(Merge, PartsOfDifferentRendersAreRefused) {
  for (const char* key : {"limn:sceneHash", "limn:seed", "limn:technique"}) {
    FilmImage other = film(8, 16);
    for (auto& [name, value] : other.metadata)
      if (name == key) value = "other";
    expectRefused({film(0, 8), other}, "mismatch", std::string(key).substr(5) + " other");
  }
  FilmImage other = film(8, 16);
  other.metadata.emplace_back("limn:parameters", "maxBounces=2");
  expectRefused({film(0, 8), other}, "mismatch", "parameters");
  other = film(8, 16);
  other.width += 1;
  expectRefused({film(0, 8), other}, "mismatch", "size");
  other = film(8, 16);
  other.layers.pop_back();
  expectRefused({film(0, 8), other}, "mismatch", "layers");
}

TEST(Merge, PicturesThatSayNoRangeAreRefused) {
  for (const char* text : {"", "5", "5:", ":5", "8:8", "9:8", "a:b", "-1:5", "0:5x"}) {
    FilmImage image = film(0, 8);
    image.metadata[0].second = text;
    expectRefused({image}, "bad-part", "part0.exr");
  }
  FilmImage image = film(0, 8);
  image.metadata.erase(image.metadata.begin());
  expectRefused({image}, "bad-part", "no sample range");
  image = film(0, 8);
  image.metadata.erase(image.metadata.begin() + 1);
  expectRefused({image}, "bad-part", "limn:sceneHash");
}

TEST(Merge, AFileThatChangedMeanwhileIsNoticed) {
  const Result<std::vector<MergePart>> parts = ordered({film(0, 8)});
  ASSERT_TRUE(parts.ok());
  FilmImage other = film(0, 8);
  other.layers.pop_back();
  EXPECT_EQ(PartMerger(parts->front()).add(parts->front(), other).error().code, "mismatch");
}

}  // namespace
}  // namespace limn
