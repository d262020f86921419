#include "tests/bench/projection_micro.hpp"

#include <array>
#include <map>

#include "server/limn/bench_page.hpp"
#include "tests/bench/projection_pictures.hpp"

namespace limn::projection {
namespace {

constexpr uint32_t kGrid = 16;     // pixels of the grid in a row and in a column
constexpr uint32_t kEnlarged = 6;  // [pixel] a texel
constexpr uint32_t kPictureEnlarged = 2;
constexpr int kFrame = 5;  // [pixel] half the side of the frame around a named pixel
constexpr size_t kTexels = size_t(kMicroSide) * kMicroSide;
constexpr glm::vec3 kNothingSeen{0.01f, 0.02f, 0.25f};  // as it is shown: dark blue

struct Way {
  const char* name;
  GatherVariant variant;
};

/// All points first: what the others are measured against.
const std::array<Way, 6> kWays{{{"all points", {GatherVariant::everyPoint, 0, 128}},
                                {"by importance, adaptive splats", {}},
                                {"at random, adaptive splats", {GatherVariant::atRandom, 0, 64}},
                                {"by importance, splats of 1 texel", {GatherVariant::byImportance, 1, 64}},
                                {"by importance, splats of 2 texels", {GatherVariant::byImportance, 2, 64}},
                                {"by importance, splats of 3 texels", {GatherVariant::byImportance, 3, 64}}}};

/// A place in the picture, in shares of its width and height from the top left.
struct NamedPixel {
  const char* name;
  double u, v;
};
using NamedPixels = std::array<NamedPixel, 5>;

const NamedPixels& namedPixels(const std::string& scene) {
  static const NamedPixels kCross{{{"upper left", 0.25, 0.25},
                                   {"upper right", 0.75, 0.25},
                                   {"middle", 0.5, 0.5},
                                   {"lower left", 0.25, 0.75},
                                   {"lower right", 0.75, 0.75}}};
  static const NamedPixels kCornell{{{"ceiling", 0.3, 0.12},
                                     {"red wall beside the tall block", 0.14, 0.68},
                                     {"front of the tall block", 0.4, 0.62},
                                     {"top of the short block", 0.64, 0.66},
                                     {"floor in the shadow of the short block", 0.82, 0.88}}};
  static const NamedPixels kDemo{{{"wall beside the lamp", 0.55, 0.2},
                                  {"red vase", 0.365, 0.58},
                                  {"top of the table", 0.3, 0.715},
                                  {"carpet under the table", 0.5, 0.84},
                                  {"seat of the chair", 0.94, 0.68}}};
  static const std::map<std::string, const NamedPixels*> kKnown{{"cornell-box", &kCornell},
                                                                {"cornell-glossy", &kCornell},
                                                                {"cornell-point", &kCornell},
                                                                {"demo", &kDemo}};
  const auto known = kKnown.find(scene);
  return known != kKnown.end() ? *known->second : kCross;
}

uint32_t pixelAt(const LitScene& scene, double u, double v) {
  const auto x = uint32_t(u * scene.width()), y = uint32_t(v * scene.height());
  return y * scene.width() + x;
}

std::vector<uint32_t> gridPixels(const LitScene& scene) {
  std::vector<uint32_t> pixels;
  for (uint32_t j = 0; j < kGrid; ++j)
    for (uint32_t i = 0; i < kGrid; ++i) {
      const uint32_t pixel = pixelAt(scene, (i + 0.5) / kGrid, (j + 0.5) / kGrid);
      if (scene.gathersAt(pixel)) pixels.push_back(pixel);
    }
  return pixels;
}

/// All micro-buffers of a list below each other.
RadianceImage columnOf(const std::vector<glm::vec4>& texels) {
  RadianceImage image{kMicroSide, uint32_t(texels.size() / kMicroSide), {}};
  for (const glm::vec4& texel : texels) image.values.insert(image.values.end(), {texel.x, texel.y, texel.z});
  return image;
}
RadianceImage rowOf(const std::vector<glm::vec3>& light) {
  RadianceImage image{uint32_t(light.size()), 1, {}};
  for (const glm::vec3& value : light) image.values.insert(image.values.end(), {value.x, value.y, value.z});
  return image;
}

double relativeSquareOf(const RadianceImage& image, const RadianceImage& reference) {
  double difference = 0.0, square = 0.0;
  for (size_t i = 0; i < image.values.size(); ++i) {
    const double r = reference.values[i], d = image.values[i] - r;
    difference += d * d;
    square += r * r;
  }
  return square > 0.0 ? difference / square : 0.0;
}

double holesOf(const std::vector<glm::vec4>& texels, const std::vector<glm::vec4>& reference) {
  size_t covered = 0, empty = 0;
  for (size_t i = 0; i < texels.size(); ++i) {
    if (reference[i].w == 0.0f) continue;
    ++covered;
    empty += texels[i].w == 0.0f;
  }
  return covered > 0 ? double(empty) / double(covered) : 0.0;
}

/// Micro-buffers of a list of pixels in one way, and what they bring to the pixels.
struct Gathered {
  std::vector<glm::vec4> texels;
  std::vector<glm::vec3> light;
};

Result<Gathered> gatherIn(const LitScene& scene, const Way& way, const std::vector<uint32_t>& pixels,
                          uint32_t projections) {
  auto texels = scene.microBuffers(pixels, way.variant, projections);
  if (!texels) return texels.error();
  auto light = scene.diffuseLight(pixels, way.variant, projections);
  if (!light) return light.error();
  return Gathered{texels.take(), light.take()};
}

Result<GatherError> errorOf(const Way& way, const Gathered& gathered, const Gathered& reference) {
  const RadianceImage texels = columnOf(gathered.texels), truth = columnOf(reference.texels);
  const RadianceImage light = rowOf(gathered.light), trueLight = rowOf(reference.light);
  const auto ofTexels = compareImages(texels.view(), {truth.view(), {}, {}});
  const auto ofLight = compareImages(light.view(), {trueLight.view(), {}, {}});
  if (!ofTexels || !ofLight) return ofTexels ? ofLight.error() : ofTexels.error();
  return GatherError{way.name, ofTexels->relMse, ofTexels->relMseAll, relativeSquareOf(texels, truth),
                     ofLight->relMseAll, holesOf(gathered.texels, reference.texels)};
}

Result<void> measureErrors(const LitScene& scene, uint32_t projections, MicroBufferReport& report) {
  const std::vector<uint32_t> pixels = gridPixels(scene);
  report.gridPixels = uint32_t(pixels.size());
  if (pixels.empty()) return Error{"unsupported", "no pixel of the grid sees a surface", ""};
  const auto reference = gatherIn(scene, kWays[0], pixels, projections);
  if (!reference) return reference.error();
  for (size_t i = 1; i < kWays.size(); ++i) {
    const auto gathered = gatherIn(scene, kWays[i], pixels, projections);
    if (!gathered) return gathered.error();
    const auto error = errorOf(kWays[i], *gathered, *reference);
    if (!error) return error.error();
    report.errors.push_back(*error);
  }
  return {};
}

/// The micro-buffer of place `index` in a list, enlarged; what sees nothing is blue.
RadianceImage shown(const std::vector<glm::vec4>& texels, size_t index, double exposure) {
  RadianceImage image = blankImage(kMicroSide, kMicroSide, glm::vec3(0.0f));
  for (size_t i = 0; i < kTexels; ++i) {
    const glm::vec4& texel = texels[index * kTexels + i];
    const glm::vec3 value = texel.w > 0.0f ? glm::vec3(texel) : kNothingSeen / float(exposure);
    setPixel(image, uint32_t(i % kMicroSide), uint32_t(i / kMicroSide), value);
  }
  return enlarged(image, kEnlarged);
}

Result<void> drawNamed(const LitScene& scene, const std::string& name, uint32_t projections,
                       MicroBufferReport& report) {
  const NamedPixels& named = namedPixels(name);
  std::vector<uint32_t> pixels;
  for (const NamedPixel& pixel : named) pixels.push_back(pixelAt(scene, pixel.u, pixel.v));
  std::vector<std::vector<glm::vec4>> texels;
  for (const Way& way : kWays) {
    auto made = scene.microBuffers(pixels, way.variant, projections);
    if (!made) return made.error();
    texels.push_back(made.take());
  }
  const double exposure = bench::exposureFor(columnOf(texels[0]));
  for (size_t i = 0; i < named.size(); ++i) {
    std::vector<RadianceImage> row;
    for (const std::vector<glm::vec4>& way : texels) row.push_back(shown(way, i, exposure));
    const std::string file = name + "-micro-" + std::to_string(i + 1) + ".png";
    auto picture = pictureOf(file, std::to_string(i + 1) + ": " + named[i].name,
                             sideBySide(row, float(1.0 / exposure)), exposure);
    if (!picture) return picture.error();
    report.pictures.push_back(picture.take());
  }
  return {};
}

/// A square around a place, as far as it lies in the picture.
void frame(RadianceImage& image, int x, int y, glm::vec3 value) {
  for (int side = -kFrame; side <= kFrame; ++side)
    for (const auto& [dx, dy] : {std::pair{side, -kFrame}, {side, kFrame}, {-kFrame, side}, {kFrame, side}}) {
      const int px = x + dx, py = y + dy;
      if (px >= 0 && py >= 0 && px < int(image.width) && py < int(image.height))
        setPixel(image, uint32_t(px), uint32_t(py), value);
    }
}

}  // namespace

Result<MicroBufferReport> reportMicroBuffers(const LitScene& scene, const std::string& sceneName,
                                             const ValidationOptions& options) {
  MicroBufferReport report;
  if (auto done = drawNamed(scene, sceneName, options.projections, report); !done) return done.error();
  if (auto done = measureErrors(scene, options.projections, report); !done) return done.error();
  return report;
}

Result<Picture> markNamedPixels(const RadianceImage& beauty, const std::string& sceneName) {
  const double exposure = bench::exposureFor(beauty);
  RadianceImage marked = enlarged(beauty, kPictureEnlarged);
  std::string caption = "1 to 5: ";
  for (const NamedPixel& pixel : namedPixels(sceneName)) {
    frame(marked, int(pixel.u * marked.width), int(pixel.v * marked.height), {0.0f, float(1.0 / exposure), 0.0f});
    caption += (caption.ends_with(' ') ? "" : ", ") + std::string(pixel.name);
  }
  return pictureOf(sceneName + "-pixels.png", caption, marked, exposure);
}

}  // namespace limn::projection
