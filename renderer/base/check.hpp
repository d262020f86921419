#pragma once
#include <sstream>
#include <string>

namespace limn {

/// Prints the failed condition with its place and aborts. A failed check is a bug of ours, never bad input.
[[noreturn]] void checkFailed(const char* file, int line, const char* condition, const std::string& detail);

template <class A, class B>
std::string checkDetail(const A& a, const B& b) {
  std::ostringstream out;
  out << a << " against " << b;
  return out.str();
}

}  // namespace limn

#define LIMN_CHECK(condition) \
  do { if (!(condition)) ::limn::checkFailed(__FILE__, __LINE__, #condition, ""); } while (false)
#define LIMN_CHECK_EQ(a, b) \
  do { if (!((a) == (b))) ::limn::checkFailed(__FILE__, __LINE__, #a " == " #b, ::limn::checkDetail(a, b)); } while (false)
#define LIMN_CHECK_LE(a, b) \
  do { if (!((a) <= (b))) ::limn::checkFailed(__FILE__, __LINE__, #a " <= " #b, ::limn::checkDetail(a, b)); } while (false)
