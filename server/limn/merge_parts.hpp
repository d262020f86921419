#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/base/result.hpp"
#include "renderer/film/film_image.hpp"

namespace limn {

/// Samples [first, end) of every pixel, as "limn:samples" says them: "first:end".
struct SampleRange {
  uint64_t first = 0, end = 0;
  uint64_t count() const { return end - first; }
};
/// Nothing unless the text is A:B with A < B.
bool parseSampleRange(const std::string& text, SampleRange& range);
std::string sampleRangeText(const SampleRange& range);

/// One part of a render, known by its header: `image` has layers without data.
struct MergePart {
  std::string place;             ///< file name, for errors
  FilmImage image;
  SampleRange range;
};

/// Reads the range from the metadata. Errors: "bad-part" when it is absent or unreadable.
Result<MergePart> mergePartOf(FilmImage header, const std::string& place);

/// The parts in sample order; not empty. Errors name the files and what is wrong: "mismatch" (size, layers, scene,
/// seed, technique, parameters, view differ), "overlap" (also a part given twice), "gap" (also when sample 0 lacks).
Result<std::vector<MergePart>> orderParts(std::vector<MergePart> parts);

/// Adds up parts in sample order, in double: every layer is the mean weighted by each pixel's sample count ("samples",
/// else the length of the range); samples add up; the standard error is that of the union. [Chan, Golub, LeVeque 1979]
/// A part whose depth at a pixel is 0 has hit nothing there and has no say in that pixel's depth.
class PartMerger {
 public:
  explicit PartMerger(const MergePart& first);
  /// `image` belongs to `part` and has data. Errors: "mismatch" when it is not what the header promised.
  Result<void> add(const MergePart& part, const FilmImage& image);
  /// The union, with the first part's metadata, the whole sample range and the sum of the seconds.
  FilmImage finish() const;

 private:
  struct Sum {
    FilmLayer layer;              ///< name and channels
    std::vector<double> weighted; ///< sum of weight * value
    std::vector<double> weight;   ///< a pixel
  };
  void addMoments(const FilmImage& image, const std::vector<double>& weight);

  FilmImage m_header;
  SampleRange m_range;
  double m_seconds = 0.0;
  std::vector<Sum> m_sums;
  std::vector<double> m_count, m_luminance, m_squares;  ///< of each pixel: n, mean, sum of squared deviations
};

}  // namespace limn
