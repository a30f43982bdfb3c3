#include "kinematics/inverse/compensation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/expects.h"

namespace selfcal {
namespace {

constexpr double kFarFromNominal = 0.3;  // rad or m that a correction may move a joint
constexpr double kQuarter = 1e-6;        // rad from a multiple of a quarter turn that count as one

double apart(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

Eigen::VectorXd middle_of(const Robot& robot) {
  Eigen::VectorXd q(static_cast<Eigen::Index>(robot.joints().size()));
  for (std::size_t j = 0; j < robot.joints().size(); ++j)
    q[static_cast<Eigen::Index>(j)] =
        robot.joints()[j].limited() ? (robot.joints()[j].lower + robot.joints()[j].upper) / 2 : 0;
  return q;
}

bool multiple_of_a_quarter(double angle) {
  return std::abs(std::remainder(angle, std::numbers::pi / 2)) < kQuarter;
}

}  // namespace

std::string_view to_string(Reach reach) {
  switch (reach) {
    case Reach::reached:
      return "reached";
    case Reach::out_of_reach:
      return "out-of-reach";
    case Reach::limit:
      return "limit";
    case Reach::singular:
      return "singular";
  }
  broken("a known status");
}

Compensation::Compensation(std::shared_ptr<const Robot> nominal,
                           std::shared_ptr<const Robot> calibrated, const Eigen::MatrixXd& starts)
    : nominal_(std::move(nominal)),
      calibrated_(std::move(calibrated)),
      xi_nominal_(values(*nominal_)),
      xi_calibrated_(values(*calibrated_)),
      middle_(middle_of(*nominal_)),
      starts_(starts.topRows(std::min<Eigen::Index>(starts.rows(), kLanes - 1))) {
  expects(nominal_->joints().size() == calibrated_->joints().size(), "robots of the same joints");
}

/// Nearest first.
std::vector<ReachedPose> Compensation::nominal_solutions(const Location& wanted,
                                                         const Eigen::VectorXd& near) const {
  std::vector<ReachedPose> list = reach_pose(*nominal_, xi_nominal_, wanted, near.transpose());
  if (!list.front().there || !within_limits(*nominal_, list.front().q)) {
    Eigen::MatrixXd all(starts_.rows() + 1, starts_.cols());
    all << near.transpose(), starts_;
    list = reach_pose(*nominal_, xi_nominal_, wanted, all);
  }
  std::erase_if(list, [](const ReachedPose& each) { return each.q.size() == 0; });
  const auto key = [&](const ReachedPose& each) {
    return std::tuple(!each.there, each.there ? 0 : each.error, !within_limits(*nominal_, each.q),
                      apart(each.q, near));
  };
  std::ranges::sort(list, {}, key);
  return list;
}

Command Compensation::corrected(const Location& wanted, const ReachedPose& nominal) const {
  const ReachedPose found =
      reach_pose(*calibrated_, xi_calibrated_, wanted, nominal.q.transpose()).front();
  Command command;
  command.iterations = found.steps;
  command.error = found.error;
  command.error_angle = found.error_angle;
  if (!found.there || apart(found.q, nominal.q) > kFarFromNominal) {
    command.status = nominal.there ? Reach::singular : Reach::out_of_reach;
  } else if (!within_limits(*nominal_, found.q)) {
    command.status = Reach::limit;
  } else {
    command.status = Reach::reached;
    command.q = found.q;
  }
  return command;
}

Command Compensation::command(const Location& wanted,
                              const std::optional<Eigen::VectorXd>& near) const {
  std::optional<Command> first;
  for (const ReachedPose& solution : nominal_solutions(wanted, near ? *near : middle_)) {
    if (first && !solution.there) break;
    const Command command = corrected(wanted, solution);
    if (command.status == Reach::reached) return command;
    // What is in the way of the best way there is told.
    if (!first || first->error > command.error) first = command;
  }
  return first ? *first : Command{};
}

std::vector<int> controller_parameters(const Robot& nominal) {
  std::vector<int> list;
  const Eigen::VectorXd xi = nominal_values(nominal);
  const std::vector<Parameter>& parameters = nominal.parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& p = parameters[i];
    const auto index = static_cast<int>(i);
    if (p.part == Part::effect) continue;
    bool taken = nominal.has_loops() || p.part == Part::base || p.part == Part::tool;
    for (std::size_t j = 0; j < nominal.joints().size(); ++j)
      taken = taken || nominal.variable_parameter(static_cast<int>(j)) == index;
    if (p.part == Part::link && p.quantity == Quantity::length) taken = taken || xi[index] != 0;
    if (p.part == Part::link && p.quantity == Quantity::angle)
      taken = taken || !multiple_of_a_quarter(xi[index]);
    if (taken) list.push_back(index);
  }
  return list;
}

}  // namespace selfcal
