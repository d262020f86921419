#include "tests/bench/picture_light.hpp"

#include "renderer/scene/image_file.hpp"

namespace limn::bench {
namespace {

constexpr double kDark = 1.0;  // mean byte of the colours up to which a picture counts as black

}  // namespace

Result<bool> holdsLight(std::span<const uint8_t> picture) {
  const auto header = readImageHeader(picture);
  if (!header) return header.error();
  const auto image = decodeImage(picture, *header);
  if (!image) return image.error();
  double sum = 0.0;
  for (size_t i = 0; i < image->rgba8.size(); ++i) sum += i % 4 < 3 ? image->rgba8[i] : 0.0;
  return sum > kDark * 3.0 * double(image->width) * double(image->height);
}

}  // namespace limn::bench
