// selfcal compensate CALIBRATED --nominal ROBOT POSES.csv: what to command so that the calibrated
// robot is where it is wanted.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>

#include "app/commands/subcommand.h"
#include "constraints/sampling/random_poses.h"
#include "io/files/file.h"
#include "io/files/poses_csv.h"
#include "io/files/robot_file.h"
#include "kinematics/inverse/compensation.h"
#include "kinematics/robot_text.h"

namespace selfcal {
namespace {

constexpr int kStarts = kLanes - 1;
constexpr unsigned long long kSeed = 1;  // of the starts: the same poses give the same commands

struct CompensateArguments {
  std::string calibrated, nominal, poses, out;
};

std::string row_of(const WantedPose& wanted, const Command& command, Eigen::Index joints) {
  std::string row = wanted.text;
  for (Eigen::Index j = 0; j < joints; ++j)
    row += "," + (command.q.size() > 0 ? format_number(command.q[j]) : std::string());
  return row + "," + std::to_string(command.iterations) + "," + format_number(command.error) + "," +
         format_number(command.error_angle) + "," + std::string(to_string(command.status)) + "\n";
}

struct Tally {
  std::map<std::string, int, std::less<>> by_status;
  double largest = 0, largest_angle = 0;  ///< m, rad, of those reached
  std::vector<Eigen::VectorXd> reached;

  void add(const Command& command) {
    ++by_status[std::string(to_string(command.status))];
    if (command.status != Reach::reached) return;
    largest = std::max(largest, command.error);
    largest_angle = std::max(largest_angle, command.error_angle);
    reached.push_back(command.q);
  }
};

/// How far off a controller is that takes its usual parameters alone.
void tell_controller(const Robot& nominal, const Robot& calibrated, const Tally& tally) {
  const std::vector<int> taken = controller_parameters(nominal);
  Eigen::VectorXd part = values(nominal);
  const Eigen::VectorXd whole = values(calibrated);
  std::string names;
  for (const int i : taken) {
    const int there = find_parameter(calibrated, nominal.parameters()[i].name);
    if (there < 0) continue;
    part[i] = whole[there];
    names += (names.empty() ? "" : " ") + nominal.parameters()[i].name;
  }
  double squares = 0, most = 0;
  int count = 0;
  for (const Eigen::VectorXd& q : tally.reached) {
    Locations X;
    if (!nominal.locate(block_of(q), part, Body::endpoint, X, nullptr).closes(0)) continue;
    const double off = (X.p(0) - locate(calibrated, whole, q).p).norm();
    squares += off * off;
    most = std::max(most, off);
    ++count;
  }
  if (count == 0) return;
  std::fprintf(stderr,
               "a controller that takes no more than these, as they stand, is off by %.3g mm rms, "
               "%.3g mm at most: %s\n",
               1e3 * std::sqrt(squares / count), 1e3 * most, names.c_str());
}

int compensate_command(const CompensateArguments& arguments) {
  std::shared_ptr<const Robot> robots[2];
  const std::string* files[2] = {&arguments.nominal, &arguments.calibrated};
  for (int i = 0; i < 2; ++i) {
    auto robot = load_robot(*files[i]);
    if (!robot) return tell(robot.error());
    robots[i] = *std::move(robot);
  }
  const auto& [nominal, calibrated] = robots;
  if (nominal->text().identity() != calibrated->text().identity())
    return tell({kInputIsBad, arguments.calibrated + ": is no calibration of the robot in " +
                                  arguments.nominal + ": the maker's figures differ"});
  const auto joints = static_cast<Eigen::Index>(nominal->joints().size());
  const auto wanted = read_poses(arguments.poses, static_cast<int>(joints));
  if (!wanted) return tell(wanted.error());
  const Compensation compensation(nominal, calibrated,
                                  closing_poses(*calibrated, values(*calibrated),
                                                random_poses(*nominal, nullptr, kStarts, kSeed)));
  std::string text = std::string(kPoseColumns);
  for (Eigen::Index j = 0; j < joints; ++j) text += ",q" + std::to_string(j + 1);
  text += ",iterations,error,error_angle,status\n";
  Tally tally;
  std::optional<Eigen::VectorXd> before;
  for (const WantedPose& each : *wanted) {
    const Command command =
        compensation.command(each.location, each.near.size() > 0 ? each.near : before);
    if (command.status == Reach::reached) before = command.q;
    tally.add(command);
    text += row_of(each, command, joints);
  }
  if (arguments.out.empty())
    std::fputs(text.c_str(), stdout);
  else if (const auto written = write_file_atomically(arguments.out, text); !written)
    return tell(written.error());
  for (const auto& [status, count] : tally.by_status)
    std::fprintf(stderr, "%d of %zu poses: %s\n", count, wanted->size(), status.c_str());
  if (!tally.reached.empty())
    std::fprintf(stderr, "those reached are left %.2g um and %.2g urad off at most\n",
                 1e6 * tally.largest, 1e6 * tally.largest_angle);
  tell_controller(*nominal, *calibrated, tally);
  return tally.reached.size() == wanted->size() ? kDone : kAnswerIsNo;
}

}  // namespace

void add_compensate(CLI::App& app, int& status) {
  auto arguments = std::make_shared<CompensateArguments>();
  CLI::App* command =
      app.add_subcommand("compensate", "Joint commands that put the calibrated robot at poses");
  command->add_option("CALIBRATED", arguments->calibrated, "Robot file of a calibration")
      ->required();
  command->add_option("POSES", arguments->poses, "CSV of poses: x y z qw qx qy qz (, q1 ... qn)")
      ->required();
  command->add_option("--nominal", arguments->nominal, "Robot file that the controller has")
      ->required();
  command->add_option("--out", arguments->out, "CSV file for the commands");
  command->callback([arguments, &status] { status = compensate_command(*arguments); });
}

}  // namespace selfcal
