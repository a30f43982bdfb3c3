// The program as a process of its own.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace selfcal {

/// The program as a process of its own, ended with this.
class Running {
 public:
  /// Standard output and error are appended to `log`; `preload` is loaded before the program.
  Running(const std::vector<std::string>& arguments, const std::filesystem::path& log,
          const std::string& preload = {});
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running();
  /// Sends `signal` and returns the exit status; -1 when it was killed by it.
  int end(int signal);
  /// Waits until it ends by itself.
  int wait();
  bool alive();
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = 0;
};

/// Processor time so far of a process, or of its first thread alone (s).
double cpu_seconds(pid_t pid, bool first_thread = false);

}  // namespace selfcal
