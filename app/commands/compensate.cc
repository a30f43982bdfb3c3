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
#include "kinematics/inverse/controller_fit.h"
#include "kinematics/readable.h"
#include "kinematics/robot_text.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kEverywhere =
    500;                     // configurations all over the range that a controller is fitted to
constexpr int kHere = 2000;  // of those reached, beside them
constexpr unsigned long long kSeed = 1;
constexpr double kFarAway = 100;  // sizes of the robot, a hall: a thousand are millimetres

struct CompensateArguments {
  std::string calibrated, nominal, poses, out, controller;
  double payload = 0;
  std::vector<double> centre, temperature;
  bool all = false;
};

std::string row_of(const WantedPose& wanted, const Command& command, Eigen::Index joints) {
  std::string row = wanted.text;
  for (Eigen::Index j = 0; j < joints; ++j)
    row += "," + (command.q.size() > 0 ? format_number(command.q[j]) : std::string());
  return row + "," + std::to_string(command.iterations) + "," + format_number(command.error) + "," +
         format_number(command.error_angle) + "," + std::string(to_string(command.status)) + "\n";
}

/// What is below a thousandth is nothing to a person.
std::string figure(double value) { return std::abs(value) < 1e-3 ? "0" : plain_figure(value); }

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

Eigen::MatrixXd rows_of_vectors(const std::vector<Eigen::VectorXd>& list) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(list.size()), list.front().size());
  for (std::size_t i = 0; i < list.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) = list[i].transpose();
  return rows;
}

OperatingPoint operating_point(const CompensateArguments& arguments) {
  OperatingPoint at;
  at.mass = arguments.payload;
  if (!arguments.centre.empty())
    at.centre = Eigen::Map<const Eigen::Vector3d>(arguments.centre.data());
  if (!arguments.temperature.empty()) at.temperature = arguments.temperature.front();
  return at;
}

/// Configurations that a controller is fitted to: those reached, evenly taken, and some all over
/// the range, so that few poses do not decide alone.
Eigen::MatrixXd fitted_configurations(const Robot& nominal, const Robot& calibrated,
                                      const std::vector<Eigen::VectorXd>& reached) {
  const Eigen::MatrixXd everywhere = closing_poses(
      calibrated, values(calibrated), random_poses(nominal, nullptr, kEverywhere, kSeed));
  const std::size_t step = 1 + reached.size() / kHere, here = (reached.size() + step - 1) / step;
  Eigen::MatrixXd q(everywhere.rows() + static_cast<Eigen::Index>(here), everywhere.cols());
  q.topRows(everywhere.rows()) = everywhere;
  for (std::size_t i = 0; i < here; ++i)
    q.row(everywhere.rows() + static_cast<Eigen::Index>(i)) = reached[i * step].transpose();
  return q;
}

/// What a controller can take of the calibration, and how far off that leaves it at the poses; to a
/// file where one is asked for.
Result<void> tell_controller(const CompensateArguments& arguments, const Robot& nominal,
                             const Robot& calibrated, const Tally& tally) {
  const OperatingPoint at = operating_point(arguments);
  const Eigen::MatrixXd q = fitted_configurations(nominal, calibrated, tally.reached);
  if (q.rows() == 0) return {};
  const std::vector<int> taken = controller_parameters(nominal);
  const ControllerNumbers numbers = numbers_of_parameters(nominal, taken);
  const Eigen::VectorXd xi = fit_controller(nominal, numbers, calibrated, q, at);
  const Eigen::MatrixXd judged = tally.reached.empty() ? q : rows_of_vectors(tally.reached);
  const auto error = [&](const Eigen::VectorXd& of) {
    return ends_apart(nominal, of, calibrated, judged, at);
  };
  const EndsApart maker = error(numbers.start),
                  found = error(as_found(nominal, numbers, calibrated)), fitted = error(xi);
  if (!arguments.controller.empty())
    if (auto written = write_file_atomically(arguments.controller, robot_text(nominal, xi));
        !written)
      return written;
  if (maker.most == 0) {
    std::fprintf(stderr, "%s is the nominal robot itself: there is nothing to compensate\n",
                 arguments.calibrated.c_str());
    return {};
  }
  std::fprintf(
      stderr,
      "a controller that takes parameters in place of these commands is off by %s mm rms, %s mm at "
      "most (%s mrad rms) with those below, by %s mm rms with their identified values, by %s mm "
      "rms with the maker's\n",
      figure(1e3 * fitted.rms).c_str(), figure(1e3 * fitted.most).c_str(),
      figure(1e3 * fitted.rms_angle).c_str(), figure(1e3 * found.rms).c_str(),
      figure(1e3 * maker.rms).c_str());
  std::fprintf(stderr, "  %-12s %12s %12s\n", "parameter", "maker's", "to set");
  for (const int i : taken) {
    const Parameter& each = nominal.parameters()[static_cast<std::size_t>(i)];
    const ReadableUnit unit = readable_unit(std::string(each.unit()), 1);
    std::fprintf(stderr, "  %-12s %12.4f %12.4f %s\n", each.name.c_str(),
                 unit.factor * numbers.start[i], unit.factor * xi[i], unit.name.c_str());
  }
  return {};
}

/// Asks for the unit where a pose is beyond all that a robot of `size` reaches; empty elsewhere.
std::string doubt_of_unit(const WantedPose& wanted, double size, std::size_t number) {
  const double away = wanted.location.p.norm();
  if (away < kFarAway * size) return {};
  return "pose " + std::to_string(number) + " is " + plain_figure(away) +
         " m from the world's origin: are these millimetres?";
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
  const auto wanted = read_poses(arguments.poses, nominal->joints());
  if (!wanted) return tell(wanted.error());
  const Compensation compensation(nominal, calibrated, operating_point(arguments));
  std::string text = std::string(kPoseColumns);
  for (Eigen::Index j = 0; j < joints; ++j) text += ",q" + std::to_string(j + 1);
  text += ",iterations,error,error_angle,status\n";
  Tally tally;
  std::string doubt;
  const double size = size_of(*nominal);
  std::optional<Eigen::VectorXd> before;
  for (const WantedPose& each : *wanted) {
    const std::optional<Eigen::VectorXd> near = each.near.size() > 0 ? each.near : before;
    const std::vector<Command> commands =
        arguments.all ? compensation.commands(each.location, near)
                      : std::vector<Command>{compensation.command(each.location, near)};
    if (commands.front().status == Reach::reached) before = commands.front().q;
    if (commands.front().status == Reach::out_of_reach && doubt.empty())
      doubt = doubt_of_unit(each, size, static_cast<std::size_t>(&each - wanted->data()) + 1);
    tally.add(commands.front());
    for (const Command& command : commands) text += row_of(each, command, joints);
  }
  if (arguments.out.empty())
    std::fputs(text.c_str(), stdout);
  else if (const auto written = write_file_atomically(arguments.out, text); !written)
    return tell(written.error());
  for (const auto& [status, count] : tally.by_status)
    std::fprintf(stderr, "%d of %zu poses: %s\n", count, wanted->size(), status.c_str());
  if (!doubt.empty())
    std::fprintf(stderr, "selfcal: %s: %s\n", arguments.poses.c_str(), doubt.c_str());
  if (!tally.reached.empty())
    std::fprintf(stderr, "those reached are left %s um and %s urad off at most\n",
                 figure(1e6 * tally.largest).c_str(), figure(1e6 * tally.largest_angle).c_str());
  if (const auto told = tell_controller(arguments, *nominal, *calibrated, tally); !told)
    return tell(told.error());
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
  CLI::Option* payload =
      command->add_option("--payload", arguments->payload, "Mass that the tool carries (kg)")
          ->check(CLI::Range(0.0, 1e5));
  command
      ->add_option("--payload-centre", arguments->centre,
                   "Where its centre is in the tool's frame: X Y Z (m)")
      ->expected(3)
      ->needs(payload);
  command->add_option("--temperature", arguments->temperature, "Of the robot at present (C)")
      ->expected(1)
      ->check(CLI::Range(-100.0, 200.0));
  command->add_flag("--all", arguments->all, "Every solution, the nearest first, a row each");
  command->add_option("--controller", arguments->controller,
                      "Robot file for what the controller can take of the calibration, alone");
  command->add_option("--out", arguments->out, "CSV file for the commands");
  command->callback([arguments, &status] { status = compensate_command(*arguments); });
}

}  // namespace selfcal
