#pragma once
#include <ctime>

namespace limn::test {

/// Processor time of this process, all threads [s]. Other work on the machine does not count in it.
inline double processorSeconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace limn::test
