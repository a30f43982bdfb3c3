// The real program, run to its end.
#pragma once

#include <string>

namespace selfcal {

struct Ran {
  int status = -1;
  std::string out;  ///< standard output and error
};

/// Runs `script`, which has no single quotes, in bash.
Ran run_in_bash(const std::string& script);

/// Runs the program to its end; `arguments` as a shell reads them. `quiet`: without standard error.
Ran run_selfcal(const std::string& arguments, bool quiet = false);

}  // namespace selfcal
