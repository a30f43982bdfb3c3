#include "app/command.h"

#include <cstdio>

namespace selfcal {

int tell(const Failure& failure) {
  std::fprintf(stderr, "selfcal: %s\n", failure.what.c_str());
  return failure.exit_status;
}

int wrong_usage(const std::string& what) {
  std::fprintf(stderr, "selfcal: %s\n", what.c_str());
  return kWrongUsage;
}

}  // namespace selfcal
