// selfcal simulate SCENARIO.yaml: a data set from a simulated robot; its truth apart, if asked.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands/subcommand.h"
#include "app/commands/support/signals.h"
#include "app/commands/support/simulated_robot.h"
#include "app/report/format.h"
#include "io/files/data_set_writer.h"
#include "io/files/file.h"
#include "io/files/robot_file.h"
#include "sim/data_set_maker.h"
#include "sim/truth_json.h"

namespace selfcal {
namespace {

struct SimulateArguments {
  std::string scenario, out, truth, live, touches;
};

constexpr std::size_t kMostRobotBytes = 4 << 20;

Result<void> write_simulated(const SimulateArguments& arguments, const Scenario& scenario,
                             const std::filesystem::path& robot_path, const Robot& robot,
                             const Simulated& made) {
  const Result<std::string> text = read_file(robot_path, kMostRobotBytes);
  if (!text) return tl::unexpected(text.error());
  const std::string robot_file = robot_path.filename().string();
  if (auto done = write_data_set(arguments.out, {data_set_description(scenario, robot_file),
                                                 robot_file, *text, &made.data});
      !done)
    return done;
  if (arguments.truth.empty()) return {};
  return write_file_atomically(arguments.truth, truth_json(scenario, robot, made).dump(1) + "\n");
}

/// Plays the machine until it is told to stop; then says what it was.
int play_command(const SimulateArguments& arguments) {
  const auto config = load_config(arguments.live);
  if (!config) return tell(config.error());
  if (!arguments.touches.empty() && !paced(*config))
    return wrong_usage("--touches needs encoders and a trigger that the kernel stamps");
  const auto machine = load_machine(arguments.scenario, *config);
  if (!machine) return tell(machine.error());
  listen_to_signals();
  if (const auto played = play(**machine, *config, arguments.touches); !played)
    return tell(played.error());
  if (arguments.truth.empty()) return kDone;
  const auto written = write_file_atomically(arguments.truth, machine_truth(**machine));
  return written ? kDone : tell(written.error());
}

int simulate_command(const SimulateArguments& arguments) {
  if (arguments.live.empty() == arguments.out.empty())
    return wrong_usage("give --out FOLDER for a data set, or --live CONFIG to play the robot");
  if (arguments.live.empty() && !arguments.touches.empty())
    return wrong_usage("--touches needs --live");
  if (!arguments.live.empty()) return play_command(arguments);
  const Result<Scenario> scenario = load_scenario(arguments.scenario);
  if (!scenario) return tell(scenario.error());
  const std::filesystem::path robot_path =
      std::filesystem::path(arguments.scenario).parent_path() / scenario->robot;
  const auto robot = load_robot(robot_path);
  if (!robot) return tell(robot.error());
  // Before the work, not after it.
  if (const auto free = check_replaceable(arguments.out); !free) return tell(free.error());
  Problems problems;
  const Simulated made = make_data_set(*scenario, **robot, problems);
  if (problems.any()) return tell(bad_input(problems).value());
  if (!made.unreached.empty()) {
    std::fprintf(stderr, "selfcal: %s: %s\n", arguments.scenario.c_str(), made.unreached.c_str());
    return kAnswerIsNo;
  }
  if (auto done = write_simulated(arguments, *scenario, robot_path, **robot, made); !done)
    return tell(done.error());
  int check = 0;
  for (const char each : made.data.rows.check) check += each;
  std::printf("%s: %s in %s, %d of them to check\n", arguments.out.c_str(),
              counted(made.data.rows.rows(), "row").c_str(),
              counted(static_cast<std::int64_t>(made.data.sets.size()), "set").c_str(), check);
  return kDone;
}

}  // namespace

void add_simulate(CLI::App& app, int& status) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command = app.add_subcommand("simulate", "Make a data set with a simulated robot");
  command
      ->add_option("SCENARIO", arguments->scenario,
                   "SCENARIO.yaml: the robot, its errors, the sets (see man selfcal-config)")
      ->required();
  command->add_option("--out", arguments->out,
                      "Folder of the data set; new, empty or a simulated data set to be replaced");
  command->add_option("--live", arguments->live,
                      "CONFIG.yaml of a service: play its robot until interrupted");
  command->add_option(
      "--touches", arguments->touches,
      "File for every edge that the played robot drove and the truth of its moment");
  command->add_option("--truth", arguments->truth, "File for the truth (JSON); not kept otherwise");
  command->callback([arguments, &status] { status = simulate_command(*arguments); });
}

}  // namespace selfcal
