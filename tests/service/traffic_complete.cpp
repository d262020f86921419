// Run by CTest after the service's other tests: a message that none of them sent or heard fails the suite.
#include <cstdio>

#include "protocol/traffic.hpp"

int main() {
  const std::set<std::string> seen = limn::protocol::seenIn(LIMN_TRAFFIC_DIR);
  int missing = 0;
  for (const std::string& item : limn::protocol::everyMessage())
    if (seen.count(item) == 0) {
      std::printf("no test has seen: %s\n", item.c_str());
      ++missing;
    }
  std::printf("%zu kinds of messages seen, %d missing\n", seen.size(), missing);
  return missing == 0 ? 0 : 1;
}
