#include "tests/techniques/hard_cases.hpp"
namespace limn::test {
const std::vector<HardCase>& hardCases() { static const std::vector<HardCase> kCases; return kCases; }
const char* hardCaseGroup() { return "material"; }
}
