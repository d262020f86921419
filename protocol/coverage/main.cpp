#include <cstdio>

#include "protocol/traffic.hpp"

/// limn_traffic_coverage DIR: says which messages no recorder that wrote into DIR has seen; exit 1 when there is one.
int main(int count, char** words) {
  if (count != 2) {
    std::fprintf(stderr, "usage: limn_traffic_coverage DIR\n");
    return 64;
  }
  const auto seen = limn::protocol::seenIn(words[1]);
  int missing = 0;
  for (const std::string& item : limn::protocol::everyMessage()) {
    if (seen.contains(item)) continue;
    std::fprintf(stderr, "no test sends \"%s\"\n", item.c_str());
    ++missing;
  }
  return missing ? 1 : 0;
}
