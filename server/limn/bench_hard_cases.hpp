#pragma once
#include <string>
#include <vector>

#include "renderer/base/result.hpp"

namespace limn::bench {

/// A measured value, the bound that techniques promise for it, and whether it is kept.
struct HardFigure {
  double value = 0.0, bound = 0.0;
  bool good = false;
};

/// One technique on one hard case, as the tests found it (tests/support/hard_case.hpp).
struct HardCell {
  std::string name, claim, technique;
  std::string unit;                    ///< of the deviation: "sigma", "relMSE", "leak"
  HardFigure deviation, energy, discarded, fireflies;
  bool sound = false;                  ///< every number of the film is finite
  bool good = false;                   ///< all of the above
  std::string reason;                  ///< why a promise is broken, where that is known
};

/// The file that the tests leave in their build directory; none for an empty name. Errors: "io", "limit", "bad-file" with the cell.
Result<std::vector<HardCell>> readHardCases(const std::string& file);

/// The table of hard cases and techniques for the page; empty for none.
std::string hardCasesSection(const std::vector<HardCell>& cells);

}  // namespace limn::bench
