// The axes are found by themselves, then all rows are met at once from there.
#include "app/commands/support/circle_robot.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "kinematics/expects.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

Failure bad_circles(const LoadedDataSet& loaded, const std::vector<std::string>& problems) {
  std::string all;
  for (const std::string& each : problems) all += (all.empty() ? "" : "\n") + each;
  return {kBadInput, loaded.name + ": " + all};
}

/// Tolerances that a link may be from what its robot's file says: more is no manufacture.
constexpr double kFarFromFile = 10, kSigmas = 3;

void set_tolerances(serial::Model& model, double tolerance) {
  for (serial::Frame& frame : model.frames) frame.tolerance.setConstant(tolerance);
  model.frames.back().tolerance.setConstant(-1);  // no axis tells of the tool
}

/// What the file believes of a frame's field, of the widest of its frame where it has another one.
double tolerance_of(const Robot& file, const std::string& frame, const std::string& field) {
  double own = 0, widest = 0;
  for (const Parameter& p : file.parameters()) {
    if (p.part != Part::link || p.frame != frame) continue;
    if (p.field == field) own = p.tolerance;
    widest = std::max(widest, p.tolerance);
  }
  return own > 0 ? own : widest > 0 ? widest : serial::kLinkTolerance;
}

/// "r4 is 12794 mm by these rows, where …", of the link that is farthest from what the robot's file
/// says over its tolerance; empty where all are near, or where the file gives no lengths at all.
std::string far_from_file(const Robot& file, const Solution& solution) {
  const auto is_length = [](const Parameter& p) {
    return p.part == Part::link && p.quantity == Quantity::length && p.nominal != 0;
  };
  if (std::ranges::none_of(file.parameters(), is_length)) return {};
  const ParameterResult* worst = nullptr;
  double most = kFarFromFile;
  for (const ParameterResult& each : solution.parameters) {
    const Parameter& p = each.parameter;
    if (p.part != Part::link || each.status != Status::identified) continue;
    const double away = (std::abs(each.value - p.nominal) - kSigmas * each.sigma) /
                        tolerance_of(file, p.frame, p.field);
    if (!(away > most)) continue;
    most = away;
    worst = &each;
  }
  if (!worst) return {};
  const std::string unit(worst->parameter.unit());
  return worst->parameter.name + " is " + in_readable_unit(worst->value, unit) +
         " by these rows, and " + in_readable_unit(worst->parameter.nominal, unit) +
         " by the robot's file: look at the files first (metres? the signs and zeros of the "
         "joints? another robot?); where the file does not know, it says so by a wide tolerance";
}

}  // namespace

Result<CircleRobot> circle_robot(const LoadedDataSet& loaded) {
  const Robot& robot = *loaded.robot;
  if (robot.kind() != "serial")
    return bad_input(loaded.name + ": circle points tell the axes of a serial robot, and " +
                     robot.name() + " is of kind " + std::string(robot.kind()));
  Problems problems;
  const serial::Model file =
      serial::read(robot.text().describe(values(robot)).without({"effects"}), problems);
  if (problems.any()) return bad_input(problems);
  std::vector<std::string> lacking;
  std::optional<AxisModel> model = axis_model(file, loaded.data, lacking);
  if (!model) return tl::unexpected(bad_circles(loaded, lacking));
  set_tolerances(model->found, kLittleKnown);
  auto found = robot_of(write_yaml(serial::write(model->found)), "the robot of the axes");
  if (!found) return tl::unexpected(found.error());
  return CircleRobot{std::move(*found), std::move(*model), loaded.robot};
}

void compare_with_file(const CircleRobot& start, Solution& solution) {
  const std::vector<Parameter> made = serial::parameters(start.model.made);
  constexpr double kTurn = 2 * std::numbers::pi;
  for (ParameterResult& each : solution.parameters) {
    const auto same = std::ranges::find(made, each.parameter.name, &Parameter::name);
    if (same == made.end()) continue;
    const bool angle = each.parameter.quantity == Quantity::angle;
    const double turns = angle ? std::round((each.value - same->value) / kTurn) : 0;
    each.parameter.nominal = same->value + kTurn * turns;
  }
  const std::string apart = far_from_file(*start.file, solution);
  if (apart.empty()) return;
  solution.warnings.insert(solution.warnings.begin(), apart);
  solution.verdict.answer = Answer::not_determined;
  solution.verdict.why += "; " + apart;
}

std::string nominal_text(const CircleRobot& start, const Solution& solution) {
  Problems problems;
  serial::Model model =
      serial::read(start.robot->text().describe(solution.values).without({"effects"}), problems);
  expects(!problems.any(), "a robot's own text is read again");
  set_tolerances(model, -1);
  for (serial::Frame& frame : model.frames) {
    frame.nominal = frame.value;
    frame.rpy_nominal = frame.rpy;
    frame.gear_nominal = frame.gear;
    for (const ParameterResult& each : solution.parameters) {
      // Nearer to kLittleKnown are figures that other ones make up for: a choice, not a doubt.
      if (each.parameter.frame != frame.name || each.sigma < serial::kLinkTolerance ||
          each.sigma > kLittleKnown / 2)
        continue;
      const auto names = serial::field_names(frame.whole);
      const auto field = std::ranges::find(names, each.parameter.field);
      if (field != names.end()) frame.tolerance[field - names.begin()] = each.sigma;
    }
  }
  return write_yaml(serial::write(model));
}

}  // namespace selfcal
