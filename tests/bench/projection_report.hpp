#pragma once
#include "tests/bench/projection_results.hpp"

namespace limn::projection {

/// What all scenes were measured with, and what came out.
struct ValidationReport {
  std::string device;
  ValidationOptions options;
  std::vector<SceneReport> scenes;
};

/// Everything but pictures.
std::string reportJson(const ValidationReport& report);
/// One HTML page that needs nothing else.
std::string reportPage(const ValidationReport& report);
/// Pictures, results.json and index.html in the options' directory, which is made. Errors: "io".
Result<void> writeReport(const ValidationReport& report);

}  // namespace limn::projection
