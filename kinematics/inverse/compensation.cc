#include "kinematics/inverse/compensation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "kinematics/corrected_robot.h"
#include "kinematics/expects.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr double kFarFromNominal = 0.3;  // of a joint's unit, that a correction may move it
constexpr double kTwins = 1e-6;          // of the same, between two commands that are one
constexpr unsigned kStartsSeed = 1;      // the same poses give the same commands

/// In units of the readings.
double apart(const Robot& robot, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return ((a - b).array() / units_of_readings(robot)).abs().maxCoeff();
}

Eigen::VectorXd middle_of(const Robot& robot) {
  Eigen::VectorXd q(static_cast<Eigen::Index>(robot.joints().size()));
  for (std::size_t j = 0; j < robot.joints().size(); ++j)
    q[static_cast<Eigen::Index>(j)] =
        robot.joints()[j].limited() ? (robot.joints()[j].lower + robot.joints()[j].upper) / 2 : 0;
  return q;
}

/// Readings all over the range that both can take, fewer than kLanes.
Eigen::MatrixXd starts_of(const Robot& nominal, const Robot& calibrated) {
  std::mt19937_64 random(kStartsSeed);
  const auto uniform = [&] { return std::generate_canonical<double, 53>(random); };
  const std::vector<Joint>& joints = nominal.joints();
  Eigen::MatrixX2d span(static_cast<Eigen::Index>(joints.size()), 2);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double half = joints[j].range() / 2;
    span.row(static_cast<Eigen::Index>(j)) << (joints[j].limited() ? joints[j].lower : -half),
        (joints[j].limited() ? joints[j].upper : half);
  }
  const auto closes = [](const Robot& robot, const Eigen::VectorXd& q) {
    Locations X;
    return robot.locate(block_of(q), values(robot), Body::endpoint, X, nullptr).closes(0);
  };
  Eigen::MatrixXd starts(0, span.rows());
  for (int i = 0; i < kLanes - 1; ++i) {
    const Eigen::VectorXd q = nominal.draw(span, uniform);
    if (!closes(nominal, q) || !closes(calibrated, q)) continue;
    starts.conservativeResize(starts.rows() + 1, Eigen::NoChange);
    starts.bottomRows<1>() = q.transpose();
  }
  return starts;
}

Eigen::VectorXd geometry_values(const Robot& corrected, const Robot& geometry) {
  return values(corrected).head(static_cast<Eigen::Index>(geometry.parameters().size()));
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
                           std::shared_ptr<const Robot> calibrated, const OperatingPoint& at)
    : nominal_(std::move(nominal)),
      calibrated_(std::move(calibrated)),
      at_(at),
      xi_nominal_(values(*nominal_)),
      xi_calibrated_(values(*calibrated_)),
      middle_(middle_of(*nominal_)),
      starts_(starts_of(*nominal_, *calibrated_)),
      exact_(exact_inverse(nominal_, xi_nominal_)) {
  expects(nominal_->joints().size() == calibrated_->joints().size(), "robots of the same joints");
  if (!calibrated_->has_loops()) return;
  const std::shared_ptr<const Robot> geometry = geometry_of(calibrated_);
  exact_calibrated_ = exact_inverse(geometry, geometry_values(*calibrated_, *geometry));
}

/// By damped steps, from `near` and, where these end elsewhere or all are wanted, from all over the
/// range.
std::vector<ReachedPose> Compensation::searched(const Location& wanted, const Eigen::VectorXd& near,
                                                bool all) const {
  const auto from = [&](const Eigen::MatrixXd& starts) {
    return reach_pose(*nominal_, xi_nominal_, wanted, starts);
  };
  if (!all) {
    std::vector<ReachedPose> list = from(near.transpose());
    if (list.front().there && within_limits(*nominal_, list.front().q)) return list;
  }
  return from(starts_from(near));
}

Eigen::MatrixXd Compensation::starts_from(const Eigen::VectorXd& near) const {
  Eigen::MatrixXd starts(starts_.rows() + 1, starts_.cols());
  starts << near.transpose(), starts_;
  return starts;
}

/// Nearest first.
std::vector<ReachedPose> Compensation::nominal_solutions(const Location& wanted,
                                                         const Eigen::VectorXd& near,
                                                         bool all) const {
  std::vector<ReachedPose> list;
  if (exact_)
    for (const Eigen::VectorXd& q : exact_(wanted, near))
      for (ReachedPose& each : reach_pose(*nominal_, xi_nominal_, wanted, q.transpose()))
        list.push_back(std::move(each));
  const auto reached = [](const ReachedPose& each) { return each.there; };
  if (std::ranges::none_of(list, reached)) list = searched(wanted, near, all);
  std::erase_if(list, [](const ReachedPose& each) { return each.q.size() == 0; });
  const auto key = [&](const ReachedPose& each) {
    return std::tuple(!each.there, each.there ? 0 : each.error, !within_limits(*nominal_, each.q),
                      apart(*nominal_, each.q, near));
  };
  std::ranges::sort(list, {}, key);
  return list;
}

Command Compensation::corrected(const Location& wanted, const ReachedPose& nominal) const {
  Command command = corrected_from(wanted, nominal.q, nominal.there);
  if (command.status != Reach::limit) return command;
  // What the nominal robot has within the limits the corrections may bring beyond one.
  const Eigen::VectorXd turned = turned_within(command.q);
  command.q.resize(0);
  if (!within_limits(*nominal_, turned)) return command;
  Command other = corrected_from(wanted, turned, nominal.there);
  other.iterations += command.iterations;
  return other.status == Reach::reached ? other : command;
}

/// Readings `q` with every joint that turns and is beyond its limit a whole turn back.
Eigen::VectorXd Compensation::turned_within(const Eigen::VectorXd& q) const {
  PsiBlock psi;
  Locations X;
  Eigen::MatrixXd J;
  calibrated_->locate(block_of(q), xi_calibrated_, Body::endpoint, X, &psi);
  calibrated_->joint_jacobian(block_of(q), xi_calibrated_, Body::endpoint, psi, J);
  Eigen::VectorXd turned = q;
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    const Joint& joint = nominal_->joints()[static_cast<std::size_t>(j)];
    const double turn_of_reading = J.col(j).tail<3>().norm();
    if (joint.quantity != Quantity::angle || joint.allows(q[j]) || !(turn_of_reading > 0)) continue;
    const double turn = 2 * std::numbers::pi / turn_of_reading;
    turned[j] += q[j] > joint.upper ? -turn : turn;
  }
  return turned;
}

/// From readings `near`, where the nominal robot may be `there`; with its readings beyond a limit,
/// too.
Command Compensation::corrected_from(const Location& wanted, const Eigen::VectorXd& near,
                                     bool there) const {
  Eigen::VectorXd start = near;
  if (exact_calibrated_)
    for (const Eigen::VectorXd& q : exact_calibrated_(wanted, near)) start = q;
  const ReachedPose found =
      reach_pose(*calibrated_, xi_calibrated_, wanted, start.transpose(), at_).front();
  Command command;
  command.iterations = found.steps;
  command.error = found.error;
  command.error_angle = found.error_angle;
  if (!found.there || apart(*nominal_, found.q, near) > kFarFromNominal) {
    command.status = there ? Reach::singular : Reach::out_of_reach;
    return command;
  }
  command.status = within_limits(*nominal_, found.q) ? Reach::reached : Reach::limit;
  command.q = found.q;
  return command;
}

/// Of the nominal robot's solutions, nearest first, the first whose correction gets there; else
/// what is in the way of the best way there is.
Command Compensation::best_of(const Location& wanted,
                              const std::vector<ReachedPose>& solutions) const {
  std::optional<Command> first;
  for (const ReachedPose& solution : solutions) {
    if (first && !solution.there) break;
    const Command command = corrected(wanted, solution);
    if (command.status == Reach::reached) return command;
    if (!first || first->error > command.error) first = command;
  }
  return first ? *first : Command{};
}

/// Of the calibrated robot's own solutions within the limits to which steps from `starts` come, the
/// one that is nearest to `near`, `at_most` so far from it.
std::optional<Command> Compensation::own_solution(const Location& wanted,
                                                  const Eigen::MatrixXd& starts,
                                                  const Eigen::VectorXd& near,
                                                  double at_most) const {
  std::optional<Command> nearest;
  for (const ReachedPose& each : reach_pose(*calibrated_, xi_calibrated_, wanted, starts, at_)) {
    if (!each.there || !within_limits(*nominal_, each.q)) continue;
    const double away = apart(*nominal_, each.q, near);
    if (away > at_most) continue;
    at_most = away;
    nearest = {Reach::reached, each.q, each.steps, each.error, each.error_angle};
  }
  return nearest;
}

/// Near a singularity the corrections of the nominal robot's nearest solution may end where another
/// one is nearer: the calibrated robot's own there, where `command` is far from `near`.
std::optional<Command> Compensation::nearer_own(const Location& wanted, const Command& command,
                                                const Eigen::VectorXd& near) const {
  if (apart(*nominal_, command.q, near) <= kFarFromNominal) return std::nullopt;
  return own_solution(wanted, near.transpose(), near, kFarFromNominal);
}

Command Compensation::command(const Location& wanted,
                              const std::optional<Eigen::VectorXd>& near) const {
  const Eigen::VectorXd& from = near ? *near : middle_;
  std::vector<ReachedPose> solutions = nominal_solutions(wanted, from, false);
  Command command = best_of(wanted, solutions);
  if (command.status != Reach::reached && !exact_) {
    // All of them, where the nearest one has led nowhere.
    solutions = nominal_solutions(wanted, from, true);
    command = best_of(wanted, solutions);
  }
  // Chain by chain there is one solution, which is looked at already.
  if (exact_calibrated_) return command;
  if (command.status == Reach::reached) {
    const auto nearer = near ? nearer_own(wanted, command, *near) : std::nullopt;
    return nearer ? *nearer : command;
  }
  // At the edge of what it reaches the calibrated robot gets to places that the nominal one does
  // not, or far from where that does: there it may be near what was asked for.
  const bool nominal_gets_there = std::ranges::any_of(solutions, [&](const ReachedPose& each) {
    return each.there && within_limits(*nominal_, each.q);
  });
  if (nominal_gets_there && !near) return command;
  const auto own = own_solution(wanted, starts_from(from), from,
                                nominal_gets_there ? kFarFromNominal : HUGE_VAL);
  return own ? *own : command;
}

std::vector<Command> Compensation::commands(const Location& wanted,
                                            const std::optional<Eigen::VectorXd>& near) const {
  std::vector<Command> list;
  for (const ReachedPose& solution : nominal_solutions(wanted, near ? *near : middle_, true)) {
    if (!solution.there) continue;
    Command command = corrected(wanted, solution);
    if (command.status != Reach::reached) continue;
    const bool twin = std::ranges::any_of(
        list, [&](const Command& other) { return apart(*nominal_, other.q, command.q) < kTwins; });
    if (!twin) list.push_back(std::move(command));
  }
  if (list.empty()) return {command(wanted, near)};
  if (!near || exact_calibrated_) return list;
  if (auto nearer = nearer_own(wanted, list.front(), *near)) {
    std::erase_if(
        list, [&](const Command& other) { return apart(*nominal_, other.q, nearer->q) < kTwins; });
    list.insert(list.begin(), *std::move(nearer));
  }
  return list;
}

}  // namespace selfcal
