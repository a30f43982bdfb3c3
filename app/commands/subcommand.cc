#include "app/commands/subcommand.h"

#include <cstdio>

#include "io/files/data_set_file.h"
#include "kinematics/readable.h"

namespace selfcal {

int tell(const Failure& failure) {
  std::fprintf(stderr, "selfcal: %s\n", shown(failure.what).c_str());
  return failure.exit_status;
}

int wrong_usage(const std::string& what) {
  std::fprintf(stderr, "selfcal: %s\n", shown(what).c_str());
  return kWrongUsage;
}

void print_notices(const LoadedDataSet& loaded) {
  for (const std::string& notice : loaded.notices)
    std::fprintf(stderr, "selfcal: note: %s\n", shown(notice).c_str());
}

}  // namespace selfcal
