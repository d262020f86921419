#include "server/limn/merge_parts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderer/base/luminance.hpp"
#include "server/arguments.hpp"

namespace limn {
namespace {

constexpr const char* kSamples = "limn:samples";
constexpr const char* kSeconds = "limn:seconds";

/// What one render's parts have in common; the first three must be there.
constexpr const char* kIdentity[] = {"limn:sceneHash", "limn:seed", "limn:technique", "limn:parameters", "limn:view",
                                     "limn:version"};
constexpr size_t kRequiredIdentity = 3;

const std::string* findMetadata(const FilmImage& image, const std::string& key) {
  for (const auto& [name, value] : image.metadata)
    if (name == key) return &value;
  return nullptr;
}

void setMetadata(FilmImage& image, const std::string& key, const std::string& value) {
  for (auto& [name, present] : image.metadata)
    if (name == key) present = value;
}

bool sameLayers(const std::vector<FilmLayer>& a, const std::vector<FilmLayer>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const FilmLayer& x, const FilmLayer& y) {
    return x.name == y.name && x.channels == y.channels;
  });
}

std::optional<Error> identityDiffers(const MergePart& a, const MergePart& b) {
  const auto mismatch = [&](const std::string& what) {
    return Error{"mismatch", "does not belong with " + a.place + ": " + what, b.place};
  };
  if (a.image.width != b.image.width || a.image.height != b.image.height) return mismatch("another size");
  for (const char* key : kIdentity) {
    const std::string* left = findMetadata(a.image, key);
    const std::string* right = findMetadata(b.image, key);
    const std::string name = std::string(key).substr(5);
    if ((left == nullptr) != (right == nullptr)) return mismatch(name + " is known of one only");
    if (left && *left != *right) return mismatch(name + " " + *right + " instead of " + *left);
  }
  if (!sameLayers(a.image.layers, b.image.layers)) return mismatch("other layers");
  return std::nullopt;
}

}  // namespace

bool parseSampleRange(const std::string& text, SampleRange& range) {
  const size_t colon = text.find(':');
  return colon != text.npos && parseInteger(std::string_view(text).substr(0, colon), range.first) &&
         parseInteger(std::string_view(text).substr(colon + 1), range.end) && range.first < range.end;
}

std::string sampleRangeText(const SampleRange& range) {
  return std::to_string(range.first) + ":" + std::to_string(range.end);
}

Result<MergePart> mergePartOf(FilmImage header, const std::string& place) {
  const std::string* samples = findMetadata(header, kSamples);
  if (!samples) return Error{"bad-part", "says no sample range; limn render --samples A:B writes one", place};
  MergePart part{place, {}, {}};
  if (!parseSampleRange(*samples, part.range))
    return Error{"bad-part", "its sample range '" + *samples + "' is not A:B with A < B", place};
  for (size_t i = 0; i < kRequiredIdentity; ++i)
    if (!findMetadata(header, kIdentity[i])) return Error{"bad-part", std::string("lacks ") + kIdentity[i], place};
  part.image = std::move(header);
  return part;
}

Result<std::vector<MergePart>> orderParts(std::vector<MergePart> parts) {
  LIMN_CHECK(!parts.empty());
  for (const MergePart& part : parts)
    if (std::optional<Error> differs = identityDiffers(parts.front(), part)) return *differs;
  std::stable_sort(parts.begin(), parts.end(),
                   [](const MergePart& a, const MergePart& b) { return a.range.first < b.range.first; });
  uint64_t next = 0;
  std::string before = "the start";
  for (const MergePart& part : parts) {
    if (part.range.first < next)
      return Error{"overlap", "samples " + sampleRangeText(part.range) + " overlap those of " + before, part.place};
    if (part.range.first > next)
      return Error{"gap", "samples " + sampleRangeText({next, part.range.first}) + " are in no part", ""};
    next = part.range.end;
    before = part.place;
  }
  return parts;
}

PartMerger::PartMerger(const MergePart& first) : m_header(first.image), m_range(first.range) {
  const size_t pixels = size_t(m_header.width) * m_header.height;
  for (const FilmLayer& layer : m_header.layers)
    m_sums.push_back({{layer.name, layer.channels, {}}, std::vector<double>(pixels * layer.channels),
                      std::vector<double>(pixels)});
  m_count.resize(pixels);
  m_luminance.resize(pixels);
  m_squares.resize(pixels);
  m_range.end = m_range.first;
}

Result<void> PartMerger::add(const MergePart& part, const FilmImage& image) {
  const bool asPromised = image.width == m_header.width && image.height == m_header.height &&
                          sameLayers(image.layers, m_header.layers);
  if (!asPromised) return Error{"mismatch", "changed while it was read", part.place};

  std::vector<double> weight(m_count.size(), double(part.range.count()));
  if (const FilmLayer* samples = image.find("samples")) weight.assign(samples->data.begin(), samples->data.end());
  for (size_t l = 0; l < m_sums.size(); ++l) {
    const FilmLayer& layer = image.layers[l];
    Sum& sum = m_sums[l];
    for (size_t p = 0; p < weight.size(); ++p) {
      if (weight[p] == 0.0 || (layer.name == "depth" && layer.data[p] == 0.0f)) continue;
      for (size_t c = 0; c < layer.channels; ++c)
        sum.weighted[p * layer.channels + c] += weight[p] * double(layer.data[p * layer.channels + c]);
      sum.weight[p] += weight[p];
    }
  }
  addMoments(image, weight);
  if (const std::string* seconds = findMetadata(image, kSeconds)) {
    double value = 0.0;
    if (parseReal(*seconds, value)) m_seconds += value;
  }
  m_range.end = part.range.end;
  return {};
}

void PartMerger::addMoments(const FilmImage& image, const std::vector<double>& weight) {
  const FilmLayer* beauty = image.find("beauty");
  const FilmLayer* error = image.find("error");
  for (size_t p = 0; p < weight.size(); ++p) {
    const double n = weight[p], before = m_count[p];
    if (n == 0.0) continue;
    m_count[p] = before + n;
    if (!beauty || beauty->channels != 3 || !error) continue;
    const double standardError = error->data[p];
    const double difference = luminance(&beauty->data[p * 3]) - m_luminance[p];
    m_squares[p] += standardError * standardError * n * (n - 1.0) + difference * difference * before * n / m_count[p];
    m_luminance[p] += difference * n / m_count[p];
  }
}

FilmImage PartMerger::finish() const {
  FilmImage merged{m_header.width, m_header.height, {}, m_header.metadata};
  for (const Sum& sum : m_sums) {
    FilmLayer layer{sum.layer.name, sum.layer.channels, std::vector<float>(sum.weighted.size(), 0.0f)};
    for (size_t i = 0; i < layer.data.size(); ++i) {
      const size_t p = i / layer.channels;
      const double n = m_count[p];
      if (layer.name == "samples") layer.data[i] = float(n);
      else if (layer.name == "error") layer.data[i] = n > 1.0 ? float(std::sqrt(m_squares[p] / (n - 1.0) / n)) : 0.0f;
      else if (sum.weight[p] > 0.0) layer.data[i] = float(sum.weighted[i] / sum.weight[p]);
    }
    merged.layers.push_back(std::move(layer));
  }
  setMetadata(merged, kSamples, sampleRangeText(m_range));
  setMetadata(merged, kSeconds, std::to_string(m_seconds));
  return merged;
}

}  // namespace limn
