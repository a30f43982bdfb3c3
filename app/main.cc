// The program selfcal: one binary, a subcommand for each job.
#include <malloc.h>

#include <cstdio>
#include <exception>
#include <string>

#include "app/commands/subcommand.h"
#include "app/commands/support/suggestion.h"
#include "kinematics/blas_kernels.h"

namespace selfcal {
namespace {

constexpr int kKept = 16 << 20;  // bytes

/// An option that is given without a name of a file or folder would do nothing.
void refuse_empty_names(CLI::App& command) {
  const CLI::Validator named(
      [](std::string& text) {
        return text.empty() ? std::string("the name of a file or folder is wanted") : std::string();
      },
      "");
  for (CLI::App* each : command.get_subcommands({})) {
    for (CLI::Option* option : each->get_options())
      if (option->check_lname("out") || option->check_lname("next")) option->check(named);
    refuse_empty_names(*each);
  }
}

int run(int argc, char** argv) {
  CLI::App app{"Self-calibration of robots from their own joint readings", "selfcal"};
  app.set_version_flag("--version", std::string("selfcal ") + SELFCAL_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Files are in SI units; what a person reads is in mm, mrad and um.\n"
      "Exit status: 0 done (identify: improved), 1 the answer is no, 2 wrong usage,\n"
      "3 bad input, 4 device or disk, 5 a bug.");
  int status = kDone;
  add_identify(app, status);
  add_diagnose(app, status);
  add_simulate(app, status);
  add_trial(app, status);
  add_identifiable(app, status);
  add_plan(app, status);
  add_compensate(app, status);
  add_robot(app, status);
  add_data(app, status);
  add_serve(app, status);
  add_bridge(app, status);
  add_monitor(app, status);
  add_command(app, status);
  add_history(app, status);
  add_report(app, status);
  refuse_empty_names(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0)
      if (const std::string what = unknown_word(app, {argv + 1, argv + argc}); !what.empty())
        return wrong_usage(what);
    return app.exit(error) == 0 ? kDone : kWrongUsage;
  }
  return status;
}

}  // namespace
}  // namespace selfcal

int main(int argc, char** argv) {
  // Blocks of rows come and go by the thousand: what is freed stays with the process, up to 16 MiB,
  // in place of going back to the kernel each time.
  mallopt(M_TRIM_THRESHOLD, selfcal::kKept);
  mallopt(M_MMAP_THRESHOLD, selfcal::kKept);
  selfcal::suit_blas_to_processor();
  try {
    const int status = selfcal::run(argc, argv);
    if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return status;
    std::fprintf(stderr, "selfcal: standard output could not be written to its end\n");
    return selfcal::kDeviceFailed;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "selfcal: a bug: %s\n", error.what());
    return selfcal::kBug;
  }
}
