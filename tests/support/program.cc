#include "tests/support/program.h"

#include <sys/wait.h>

#include <array>
#include <cstdio>

namespace selfcal {
namespace {

Ran run(const std::string& command) {
  Ran ran;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    ran.out.append(buffer.data(), n);
  ran.status = WEXITSTATUS(pclose(pipe));
  return ran;
}

}  // namespace

Ran run_selfcal(const std::string& arguments, bool quiet) {
  return run(std::string(SELFCAL_BINARY) + " " + arguments + (quiet ? " 2>/dev/null" : " 2>&1"));
}

Ran run_in_bash(const std::string& script) { return run("bash -c '" + script + "' 2>&1"); }

}  // namespace selfcal
