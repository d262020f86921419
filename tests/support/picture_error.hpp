#pragma once
#include <string>

#include "renderer/film/film_image.hpp"

namespace limn::test {

/// Two pictures of one scene by one technique and different seeds: what differs between them is noise, what they share is
/// truth or bias.
struct PicturePair {
  FilmImage a, b;
};

/// relMSE = mean((x−r)² / (r² + 0.01·mean(r)²)) of a layer, cleared of the noise of both pairs: the bias alone. A little
/// below 0 where there is none.
double biasOf(const PicturePair& pair, const PicturePair& reference, const std::string& layer);
/// The same of one picture, cleared of the noise of the reference alone.
double relMseOf(const FilmImage& picture, const PicturePair& reference, const std::string& layer);

/// How far the means of a layer lie apart, in standard errors of their difference: of the whole picture, and the largest of
/// all tiles of 16x16 pixels. `rounding` is the relative error that both may have without noise.
struct Deviation {
  double whole = 0.0, worstTile = 0.0;
  size_t tiles = 0;
};
Deviation deviationOf(const PicturePair& pair, const PicturePair& reference, const std::string& layer, double rounding = 1e-5);

double meanOf(const FilmImage& picture, const std::string& layer);
double largestOf(const FilmImage& picture, const std::string& layer);
/// Whether every number of every layer is finite and no radiance is negative by more than rounding.
bool isSound(const FilmImage& picture);
/// Pixels whose beauty is brighter than `factor` times the brightest of the reference's 3x3 pixels around, and than a tenth of
/// its mean.
int firefliesOf(const FilmImage& picture, const FilmImage& reference, double factor);

}  // namespace limn::test
