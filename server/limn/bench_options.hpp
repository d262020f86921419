#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/techniques/technique_info.hpp"
#include "server/arguments.hpp"

namespace limn::bench {

/// When a picture is taken: a time from the first step, or a number of passes.
struct Budget {
  std::string text;                    ///< as it was written; names files and columns
  double seconds = 0.0;                ///< 0: counted in passes
  uint32_t steps = 0;
};

/// A value for one technique, or for every technique that has such a parameter.
struct Setting {
  std::string technique;               ///< empty: all
  std::string parameter;
  double value = 0.0;
};

/// The command line of `limn bench`, checked as far as it can be without a device.
struct BenchOptions {
  std::vector<std::string> scenes;     ///< files, in the order of the report
  std::vector<std::string> techniques; ///< names
  std::vector<Budget> budgets;         ///< ascending
  std::string output, references;      ///< directories
  std::string pictures;                ///< list of another renderer's pictures; empty: none
  std::string hardCases;               ///< what the tests measured on hard cases; empty: nothing
  uint32_t width = 256, height = 256;  ///< [pixel]
  uint32_t seeds = 3;
  double referenceSeconds = 200.0;     ///< most time for one scene's reference [s]
  std::vector<Setting> settings;
  bool growth = false, ablation = false;
  uint32_t convergence = 0;            ///< seeds of small pictures for slope and spread; 0: not measured
};

CommandSpec benchSpec();

/// Errors: "usage" for what is malformed, "unsupported" for an unknown technique or parameter, "out-of-range", "io" for
/// a scene or list that is not there.
Result<BenchOptions> benchOptions(const Arguments& arguments);

/// The parameters that a technique runs with beside its defaults. Adaptive sampling is off unless it is asked for:
/// a curve of error over samples needs pixels that go on.
std::vector<std::pair<std::string, double>> parametersOf(const TechniqueInfo& technique,
                                                         const std::vector<Setting>& settings);

/// Sets one of them, in place of a value that it has.
void setParameter(std::vector<std::pair<std::string, double>>& parameters, const std::string& name, double value);
/// Has the technique take samples for as long as it can: steps that come after its end are none.
void putOffTheEnd(std::vector<std::pair<std::string, double>>& parameters, const TechniqueInfo& technique);

}  // namespace limn::bench
