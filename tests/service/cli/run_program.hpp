#pragma once
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace limn::test {

/// A directory of this process, removed at its end.
class ScratchDirectory {
 public:
  ScratchDirectory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "limn-test-XXXXXX").string();
    m_path = mkdtemp(pattern.data());
  }
  ~ScratchDirectory() { std::filesystem::remove_all(m_path); }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  std::string file(const std::string& name) const { return (m_path / name).string(); }

 private:
  std::filesystem::path m_path;
};

inline std::string readText(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

struct ProgramRun {
  int exitCode = -1;  ///< -1 when a signal ended it
  std::string out, err;
};

/// Runs `program` with `words`, each passed as it is.
inline ProgramRun runProgram(const std::string& program, const std::vector<std::string>& words) {
  const ScratchDirectory scratch;
  std::string line = "'" + program + "'";
  for (const std::string& word : words) {
    std::string quoted;
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line.append(" '").append(quoted).append("'");
  }
  line.append(" >").append(scratch.file("out")).append(" 2>").append(scratch.file("err")).append(" </dev/null");
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readText(scratch.file("out")), readText(scratch.file("err"))};
}

}  // namespace limn::test
