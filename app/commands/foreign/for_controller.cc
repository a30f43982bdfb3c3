#include "app/commands/foreign/for_controller.h"

#include <memory>

#include "app/commands/foreign/convert_notes.h"
#include "app/commands/foreign/foreign_robot.h"
#include "app/report/format.h"
#include "constraints/sampling/random_poses.h"
#include "io/files/file.h"
#include "io/models/controller_text.h"
#include "io/models/delta_firmware.h"
#include "io/models/ur_kinematics.h"
#include "kinematics/inverse/controller_fit.h"
#include "kinematics/make_robot.h"

namespace selfcal {
namespace {

constexpr int kFitPoses = 500;  // half of them judge
constexpr unsigned long long kFitSeed = 1;
constexpr double kSameEnd = 1e-7;  // m: beyond what a fit leaves
constexpr std::size_t kMostKinematicsBytes = std::size_t{1} << 20;

/// A robot file's robot, and the same without its effects.
struct RobotPair {
  std::unique_ptr<const Robot> real, geometry;
};

Result<RobotPair> robots_of(const Node& robot) {
  Problems problems;
  RobotPair pair{make_robot(robot, problems), make_robot(robot.without({"effects"}), problems)};
  if (problems.any()) return bad_input(problems);
  return pair;
}

/// What a controller is best told, and how far off that and the maker's figures leave it, over
/// poses that were not fitted.
struct Told {
  Eigen::VectorXd xi;
  EndsApart before, after;
};

Told fitted(const RobotPair& robots, const ControllerNumbers& numbers,
            const Eigen::VectorXd& makers) {
  const Eigen::MatrixXd q =
      closing_poses(*robots.real, values(*robots.real),
                    random_poses(*robots.geometry, nullptr, kFitPoses, kFitSeed));
  const Eigen::MatrixXd fits = q.topRows(q.rows() / 2), judges = q.bottomRows(q.rows() / 2);
  Told told{fit_controller(*robots.geometry, numbers, *robots.real, fits), {}, {}};
  told.before = ends_apart(*robots.geometry, makers, *robots.real, judges);
  told.after = ends_apart(*robots.geometry, told.xi, *robots.real, judges);
  return told;
}

/// The maker's figures as a table holds them, which has no beta, and how far off the maker's robot
/// they are.
struct MakersTable {
  Eigen::VectorXd xi;
  EndsApart off;
};

Result<MakersTable> makers_table(const Robot& geometry, ControllerNumbers numbers) {
  Problems problems;
  const auto maker = make_robot(geometry.text().describe(numbers.start), problems);
  if (problems.any()) return bad_input(problems);
  for (std::size_t i = 0; i < geometry.parameters().size(); ++i)
    if (const Parameter& p = geometry.parameters()[i]; p.part == Part::link && p.field == "beta")
      numbers.start[static_cast<Eigen::Index>(i)] = 0;
  const Eigen::MatrixXd q = random_poses(geometry, nullptr, kFitPoses, kFitSeed);
  const Eigen::VectorXd xi = fit_controller(geometry, numbers, *maker, q);
  return MakersTable{xi, ends_apart(geometry, xi, *maker, q)};
}

/// What a person wants to know of it before it is typed in.
std::string head_of(const std::string& what, const Told& fit) {
  return what + "\n" +
         printed(
             "Over %d poses all over the joints' ranges the end is %s mm (rms; %s at most) off "
             "the calibrated robot with the maker's figures,\nand %s mm (%s at most) with "
             "these, fitted to as many other poses.\n",
             fit.before.poses, mm(fit.before.rms).c_str(), mm(fit.before.most).c_str(),
             mm(fit.after.rms).c_str(), mm(fit.after.most).c_str());
}

/// Indices of the parameters that the format holds of a serial robot.
std::vector<int> taken_by(const std::string& to, const Robot& robot) {
  std::vector<int> taken;
  for (std::size_t i = 0; i < robot.parameters().size(); ++i) {
    const Parameter& p = robot.parameters()[i];
    const bool link = p.part == Part::link && (to == "ur" || (to == "dh" && p.field != "beta"));
    if (p.part == Part::base || p.part == Part::tool || link) taken.push_back(static_cast<int>(i));
  }
  if (to == "offsets")
    for (std::size_t j = 0; j < robot.joints().size(); ++j)
      taken.push_back(robot.variable_parameter(static_cast<int>(j)));
  return taken;
}

/// The serial robot of a file with what its controller is best told, and with what undoes that.
struct ToldRobot {
  serial::Model model, before;
  Told fit;
  EndsApart before_off;  ///< of `before` from the maker's robot
};

Result<ToldRobot> told_robot(const Node& robot, const ControllerFormat& format) {
  const auto model = serial_model(robot, format.file, format.to);
  if (!model) return tl::unexpected(model.error());
  note_effects(robot);
  note_gears(*model);
  const auto robots = robots_of(robot);
  if (!robots) return tl::unexpected(robots.error());
  ControllerNumbers numbers =
      numbers_of_parameters(*robots->geometry, taken_by(format.to, *robots->geometry));
  ToldRobot told;
  if (format.to == "dh") {
    const auto table = makers_table(*robots->geometry, numbers);
    if (!table) return tl::unexpected(table.error());
    numbers.start = table->xi;
    told.before_off = table->off;
  }
  told.fit = fitted(*robots, numbers, numbers.start);
  Problems problems;
  told.model = serial::read(robots->geometry->text().describe(told.fit.xi), problems);
  told.before = serial::read(robots->geometry->text().describe(numbers.start), problems);
  if (problems.any()) return bad_input(problems);
  note_transmissions(told.model, false);
  return told;
}

Result<std::string> to_offsets(const Node& robot, const ControllerFormat& format) {
  const auto told = told_robot(robot, format);
  if (!told) return tl::unexpected(told.error());
  return controller_offsets_text(
      told->model, head_of("Joint offsets, base and tool frame of " + told->model.name +
                               ", for a controller that takes no more of a calibration.",
                           told->fit));
}

Result<std::string> to_dh(const Node& robot, const ControllerFormat& format) {
  const auto told = told_robot(robot, format);
  if (!told) return tl::unexpected(told.error());
  std::string head =
      head_of("Denavit and Hartenberg's numbers of " + told->model.name + ".", told->fit);
  if (told->before_off.most > kSameEnd)
    head += printed(
        "The maker's angles beta are in no row: those that undo it leave the end %s mm (rms; %s at "
        "most) off the maker's robot.\n",
        mm(told->before_off.rms).c_str(), mm(told->before_off.most).c_str());
  return dh_table_text(told->model, told->before, format.convention, head, format.file);
}

Result<std::string> to_ur(const Node& robot, const ControllerFormat& format) {
  const auto text = read_file(format.like, kMostKinematicsBytes);
  if (!text) return tl::unexpected(text.error());
  const auto original = read_ur_kinematics(*text, format.like);
  if (!original) return tl::unexpected(original.error());
  const auto told = told_robot(robot, format);
  if (!told) return tl::unexpected(told.error());
  const auto chain = corrected_by(told->model, format.file, original->chain, format.like);
  if (!chain) return tl::unexpected(chain.error());
  note_base(*chain);
  note_left_out(chain->left_out);
  std::string head = head_of("Kinematics of " + told->model.name + ", calibrated.", told->fit);
  const Eigen::Isometry3d tool = tool_frame(told->model).correction();
  if ((tool.matrix() - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff() > 1e-12) {
    note(
        "left out: the tool's correction, for the file ends at wrist_3: set the TCP as its head "
        "says");
    head +=
        "That is with another TCP. C is " + pose_in_words(tool) +
        ": where the robot's file ends at the flange, set C times the TCP that is set; where it "
        "ends at that TCP, the TCP times C.\n";
  }
  note(
      "give it to the driver as kinematics_params_file: it holds the offsets of the joints, too, "
      "so no corrected URDF and no offsets beside it");
  return commented(head) + ur_kinematics_text(chain->chain, original->hash) +
         commented("To undo it, " + format.like + ":\n" + *text);
}

Result<std::string> to_delta(const Node& robot, const ControllerFormat& format) {
  if (robot.find("kind")->text != "linear-delta")
    return bad_input(format.file + ": a robot of kind " + robot.find("kind")->text +
                     " is no linear-delta, which the firmwares of delta printers are for");
  Problems problems;
  const linear_delta::Delta delta = linear_delta::read(robot.without({"effects"}), problems);
  if (problems.any()) return bad_input(problems);
  note_effects(robot);
  const auto robots = robots_of(robot);
  if (!robots) return tl::unexpected(robots.error());
  const Told fit = fitted(*robots, firmware_numbers(delta), makers_firmware_numbers(delta));
  const auto made =
      delta_firmware(delta, fit.xi, head_of("Of " + delta.name + ".", fit), format.file);
  if (!made) return tl::unexpected(made.error());
  note_left_out(made->left_out);
  return made->text;
}

}  // namespace

Result<std::string> for_controller(const Node& robot, const ControllerFormat& format) {
  if (format.to == "offsets") return to_offsets(robot, format);
  if (format.to == "dh") return to_dh(robot, format);
  if (format.to == "ur") return to_ur(robot, format);
  return to_delta(robot, format);
}

}  // namespace selfcal
