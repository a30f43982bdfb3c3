// One subcommand of the program: each has app/commands/NAME.cc and a line in main.cc.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "io/result.h"

namespace selfcal {

struct LoadedDataSet;

/// Exit statuses, the same for every command.
enum ExitStatus : int {
  kDone = 0,        ///< done; for identify: improved
  kAnswerIsNo = 1,  ///< not improved, not determined, not converged, refused
  kWrongUsage = 2,
  kInputIsBad = kBadInput,
  kDeviceIsBad = kDeviceFailed,
  kBug = 5,
};

/// Adds a subcommand whose callback puts its exit status into `status`.
void add_identify(CLI::App& app, int& status);
void add_diagnose(CLI::App& app, int& status);
void add_identifiable(CLI::App& app, int& status);
void add_plan(CLI::App& app, int& status);
void add_compensate(CLI::App& app, int& status);
void add_simulate(CLI::App& app, int& status);
void add_trial(CLI::App& app, int& status);
void add_robot(CLI::App& app, int& status);
/// Part of `robot`, which it is given.
void add_robot_convert(CLI::App& robot, int& status);
void add_data(CLI::App& app, int& status);
void add_serve(CLI::App& app, int& status);
void add_bridge(CLI::App& app, int& status);
void add_monitor(CLI::App& app, int& status);
void add_command(CLI::App& app, int& status);
void add_history(CLI::App& app, int& status);
void add_report(CLI::App& app, int& status);

/// Says `failure` on standard error and returns its exit status.
int tell(const Failure& failure);
/// Says what is wrong with the arguments and returns kWrongUsage.
int wrong_usage(const std::string& what);
/// Says on standard error what a person should know of a data set that was accepted.
void print_notices(const LoadedDataSet& loaded);

}  // namespace selfcal
