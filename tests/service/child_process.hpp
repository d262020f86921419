#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

namespace limn::server::testing {

/// A program of ours run beside the test; killed when the object ends.
class ChildProcess {
 public:
  /// Its standard output and error are pipes that the test reads.
  ChildProcess(const std::string& program, const std::vector<std::string>& arguments);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// The next line of standard output; empty at its end.
  std::string readLine();
  void signal(int number) const;
  pid_t pid() const { return m_pid; }
  /// Waits for the end; the exit status, or minus the number of the signal that ended it.
  int wait();
  /// Everything it wrote to standard error; after wait().
  std::string errors() const { return m_errors; }

 private:
  pid_t m_pid = -1;
  int m_out = -1, m_err = -1;
  std::string m_buffer, m_errors;
};

}  // namespace limn::server::testing
