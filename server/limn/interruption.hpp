#pragma once

namespace limn {

/// The code of the Error that a command ends with after it was interrupted. The program exits with 128 + the signal.
constexpr const char* kInterrupted = "interrupted";

/// While it lives, the first SIGINT or SIGTERM is noted instead of ending the process; a second one ends it at once. A
/// signal that was ignored before, as nohup has it, stays so. One at a time; made and asked on one thread.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// The signal that came, of the last Interruption too; 0: none.
  static int signal();
};

}  // namespace limn
