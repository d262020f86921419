#pragma once
#include <string>
#include <vector>

namespace limn::server {

/// What limnd's main() does with the words after the program's name. Returns the exit code.
int runDaemon(const std::vector<std::string>& words);

}  // namespace limn::server
