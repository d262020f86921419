#pragma once
#include <cstdlib>
#include <optional>
#include <string>

namespace limn::test {

/// A variable in the environment of this process, and of the programs it starts, while the object lives; then it is as
/// it was before.
class EnvironmentVariable {
 public:
  EnvironmentVariable(const char* name, const std::string& value) : m_name(name) {
    if (const char* before = std::getenv(name)) m_before = before;
    setenv(name, value.c_str(), 1);
  }
  ~EnvironmentVariable() {
    if (m_before) setenv(m_name, m_before->c_str(), 1);
    else unsetenv(m_name);
  }
  EnvironmentVariable(const EnvironmentVariable&) = delete;
  EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

 private:
  const char* m_name;
  std::optional<std::string> m_before;
};

}  // namespace limn::test
