#include "tests/service/child_process.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "renderer/base/check.hpp"

namespace limn::server::testing {

ChildProcess::ChildProcess(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<char*> words{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  int out[2], err = fileno(tmpfile());   // a file, so that a full pipe never stops the child
  LIMN_CHECK(pipe2(out, O_CLOEXEC) == 0);
  m_err = err;
  m_pid = fork();
  LIMN_CHECK(m_pid >= 0);
  if (m_pid == 0) {
    dup2(out[1], STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    execv(program.c_str(), words.data());
    _exit(127);
  }
  close(out[1]);
  m_out = out[0];
}

ChildProcess::~ChildProcess() {
  if (m_pid > 0) {
    signal(SIGKILL);
    wait();
  }
  close(m_out);
  close(m_err);
}

std::string ChildProcess::readLine() {
  while (m_buffer.find('\n') == std::string::npos) {
    char bytes[512];
    const ssize_t got = read(m_out, bytes, sizeof bytes);
    if (got <= 0) return "";
    m_buffer.append(bytes, size_t(got));
  }
  const size_t end = m_buffer.find('\n');
  std::string line = m_buffer.substr(0, end);
  m_buffer.erase(0, end + 1);
  return line;
}

void ChildProcess::signal(int number) const { kill(m_pid, number); }

int ChildProcess::wait() {
  int status = 0;
  waitpid(m_pid, &status, 0);
  m_pid = -1;
  lseek(m_err, 0, SEEK_SET);
  char bytes[4096];
  for (ssize_t got; (got = read(m_err, bytes, sizeof bytes)) > 0;) m_errors.append(bytes, size_t(got));
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

}  // namespace limn::server::testing
