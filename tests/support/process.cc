#include "tests/support/process.h"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <utility>

namespace selfcal {

Running::Running(const std::vector<std::string>& arguments, const std::filesystem::path& log,
                 const std::string& preload) {
  const std::string path = log;
  std::vector<char*> argv = {const_cast<char*>(SELFCAL_BINARY)};
  for (const std::string& each : arguments) argv.push_back(const_cast<char*>(each.c_str()));
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ != 0) return;
  const int file = ::open(path.c_str(), O_CREAT | O_WRONLY | O_APPEND, 0600);
  dup2(file, STDOUT_FILENO);
  dup2(file, STDERR_FILENO);
  if (!preload.empty()) setenv("LD_PRELOAD", preload.c_str(), 1);
  execv(SELFCAL_BINARY, argv.data());
  _exit(127);
}

int Running::end(int signal) {
  ::kill(pid_, signal);
  return wait();
}

int Running::wait() {
  int status = 0;
  ::waitpid(std::exchange(pid_, 0), &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

bool Running::alive() {
  siginfo_t ended{};
  return pid_ > 0 &&
         ::waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         ended.si_pid == 0;
}

Running::~Running() {
  if (pid_ > 0) end(SIGKILL);
}

double cpu_seconds(pid_t pid, bool first_thread) {
  const std::string id = std::to_string(pid);
  std::ifstream file("/proc/" + id + (first_thread ? "/task/" + id : "") + "/stat");
  std::string text;
  std::getline(file, text);
  std::istringstream fields(text.substr(text.rfind(')') + 2));
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  double user = 0, system = 0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

}  // namespace selfcal
