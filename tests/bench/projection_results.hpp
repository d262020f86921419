#pragma once
#include <string>
#include <vector>

#include "renderer/base/result.hpp"
#include "server/arguments.hpp"

namespace limn::projection {

/// What bench_projection was asked for.
struct ValidationOptions {
  std::vector<std::string> scenes;  ///< files
  std::string output;               ///< directory
  PixelSize size{256, 256};         ///< of all pictures [pixel]
  uint32_t points = 262144;         ///< on the scene's surfaces
  uint32_t projections = 3072;      ///< a micro-buffer
  uint32_t pathSamples = 128;       ///< of a pixel, in each half of the path tracer's pictures
  uint32_t passes = 72;             ///< of the technique: by then every pixel was gathered once
  std::vector<double> stamps{0.25, 0.5, 1.0, 2.0, 4.0};  ///< ascending [s]
};

struct Picture {
  std::string file, caption;  ///< name without directory
  std::string png;            ///< bytes
};

/// How far micro-buffers made in one way are from those of all points, over a grid of pixels.
struct GatherError {
  std::string way;
  double texels = 0.0;      ///< relMSE of their radiance
  double texelsAll = 0.0;   ///< the same with every quotient
  double square = 0.0;      ///< mean square of the difference over that of the reference: dark texels do not weigh more
  double irradiance = 0.0;  ///< relMSE of what they bring to the pixels
  double holes = 0.0;       ///< share of the texels that see something in the reference and nothing here
};

/// Micro-buffers of point projection. [IPP figs. 7 and 9]
struct MicroBufferReport {
  std::vector<Picture> pictures;  ///< where the named pixels are, then what each sees
  uint32_t gridPixels = 0;        ///< of the grid that see a surface
  std::vector<GatherError> errors;
};

/// Indirect light of the technique beside that of paths of as many bounces. [IPP fig. 8]
struct LightReport {
  uint32_t bounces = 0, pathBounces = 0;
  uint32_t filterSize = 0;     ///< [pixel] of the technique's filter
  double relMse = 0.0, relMseAll = 0.0;
  double energy = 0.0;         ///< mean over that of paths
  double pathNoise = 0.0;      ///< relMSE of the paths' mean, which adds nothing to the two above
  std::vector<Picture> pictures;
};

/// Which pixels had been gathered at a time. [IPP figs. 5 and 11]
struct PlacementReport {
  double seconds = 0.0;        ///< of rendering, as it really was
  uint32_t passes = 0;
  double sampledShare = 0.0;   ///< of pixels, gathered for themselves
  Picture picture;
};

struct SceneReport {
  std::string name;
  MicroBufferReport microBuffers;
  std::vector<LightReport> light;
  std::vector<PlacementReport> placement;
};

}  // namespace limn::projection
