#pragma once
#include <string>
#include <vector>

namespace limn::server::testing {

/// A message that a server must refuse, and how.
struct WrongMessage {
  const char* name;
  std::string text;
  const char* code;
  const char* place;   ///< of the error; empty: it names none
};

/// Sent one after the other behind a hello with seq 1. The scene has fewer than 99 materials.
const std::vector<WrongMessage>& wrongMessages();

}  // namespace limn::server::testing
