#include <cstdio>

#include "server/limn/bench_page.hpp"
#include "tests/bench/projection_report.hpp"

namespace limn::projection {
namespace {

constexpr const char* kHead =
    "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Limn: point projection</title><style>"
    "body{font:15px/1.45 sans-serif;max-width:78rem;margin:2rem auto;padding:0 1rem;color:#1c1c1c;background:#fff}"
    "h2{margin-top:2.5rem;border-bottom:1px solid #ccc}table{border-collapse:collapse;margin:.8rem 0}"
    "th,td{padding:.2rem .6rem;border:1px solid #ddd;text-align:right}th:first-child,td:first-child{text-align:left}"
    "th{background:#f3f3f3}figure{display:inline-block;margin:.3rem}figcaption{font-size:13px;color:#444}"
    "img{max-width:100%;image-rendering:pixelated}</style></head><body>\n<h1>Point projection against truth</h1>\n";

constexpr const char* kMicroText =
    "<h3>Micro-buffers</h3>\n<p>What five pixels see, with direct light at the surface points. From left to right: all "
    "points; by importance with adaptive splats; at random with adaptive splats; by importance with splats of 1, 2 and "
    "3 texels. Blue sees nothing. [Maletz et al., figs. 7 and 9]</p>\n";
constexpr const char* kGatherHead =
    "<tr><th>against all points</th><th>relMSE</th><th>with every quotient</th>"
    "<th>mean square over that of the reference</th><th>relMSE of irradiance</th><th>texels left empty</th></tr>\n";
constexpr const char* kLightText =
    "<h3>Indirect light against paths</h3>\n<p>Indirect light alone; relMSE as <code>limn compare --halves</code> "
    "takes it, so that the noise of the paths adds nothing. [fig. 8]</p>\n";
constexpr const char* kLightHead =
    "<tr><th>bounces</th><th>bounces of paths</th><th>filter</th><th>relMSE</th><th>with every quotient</th>"
    "<th>energy over that of paths</th><th>noise of paths</th></tr>\n";
constexpr const char* kPlacementText =
    "<h3>Adaptive samples</h3>\n<p>Seconds since the first step, nothing known of light or points. Green: gathered; "
    "orange: interpolated. [fig. 11]</p>\n";

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string row(const std::vector<std::string>& cells) {
  std::string line = "<tr>";
  for (const std::string& cell : cells) line += "<td>" + cell + "</td>";
  return line + "</tr>\n";
}

std::string figure(const Picture& picture) {
  return "<figure><img alt=\"" + picture.caption + "\" src=\"data:image/png;base64," + bench::base64(picture.png) +
         "\"><figcaption>" + picture.caption + "</figcaption></figure>\n";
}

std::string microSection(const MicroBufferReport& report) {
  std::string text = kMicroText;
  for (const Picture& picture : report.pictures) text += figure(picture);
  text += "<p>Errors over the " + std::to_string(report.gridPixels) + " pixels of a grid that see a surface:</p>\n";
  text += std::string("<table>\n") + kGatherHead;
  for (const GatherError& e : report.errors)
    text += row({e.way, number(e.texels), number(e.texelsAll), number(e.square), number(e.irradiance),
                 number(100.0 * e.holes) + " %"});
  return text + "</table>\n";
}

std::string lightSection(const std::vector<LightReport>& reports) {
  std::string text = std::string(kLightText) + "<table>\n" + kLightHead;
  for (const LightReport& r : reports) {
    const std::string filter = r.filterSize > 1 ? std::to_string(r.filterSize) + " pixels" : "none";
    text += row({std::to_string(r.bounces), std::to_string(r.pathBounces), filter, number(r.relMse),
                 number(r.relMseAll), number(r.energy), number(r.pathNoise)});
  }
  text += "</table>\n";
  for (const LightReport& r : reports) {
    text += "<p>" + std::to_string(r.bounces) + " bounces, filter of " + std::to_string(r.filterSize) + ":</p>\n<div>";
    for (const Picture& picture : r.pictures) text += figure(picture);
    text += "</div>\n";
  }
  return text;
}

std::string placementSection(const std::vector<PlacementReport>& reports) {
  std::string text = kPlacementText;
  for (const PlacementReport& report : reports) text += figure(report.picture);
  return text;
}

}  // namespace

std::string reportPage(const ValidationReport& report) {
  const ValidationOptions& o = report.options;
  std::string text = std::string(kHead) + "<p>" + report.device + ", pictures of " + std::to_string(o.size.width) +
                     "x" + std::to_string(o.size.height) + " pixels, " + std::to_string(o.points) + " points, " +
                     std::to_string(o.projections) + " projections a pixel, " + std::to_string(o.passes) +
                     " passes against " + std::to_string(2 * o.pathSamples) + " paths a pixel.</p>\n";
  for (const SceneReport& scene : report.scenes)
    text += "<h2>" + scene.name + "</h2>\n" + microSection(scene.microBuffers) + lightSection(scene.light) +
            placementSection(scene.placement);
  return text + "</body></html>\n";
}

}  // namespace limn::projection
