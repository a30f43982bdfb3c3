#include "constraints/planning/touch_rows.h"

#include <algorithm>
#include <cmath>

#include "constraints/identifiability/given_doubt.h"
#include "constraints/methods/shared/unit_normal.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr double kNoise = 2e-5;          // m, where a set does not say its own
constexpr double kAngleNoise = 2e-5;     // rad, as well
constexpr double kLeastVariance = 1e-9;  // of a column's own, in any direction
constexpr double kLeastSeen = 1e-9;      // of the largest, of a motion that no row sees

/// The set whose surface or sockets are those of set `s`.
int place_of(const std::vector<Set>& sets, int s) {
  return sets[s].reference < 0 ? s : sets[s].reference;
}

/// Variance of the lengths that the set's entry gives.
double variance_of_lengths(const Set& set, bool opposite) {
  double variance = 0;
  for (const KnownLength& each : set.method->known_lengths())
    variance += std::pow(each.sigma, 2) + std::pow(doubt_of_length(set, each, opposite), 2);
  return variance;
}

/// Rows of a touch in the unknowns of its surface or socket, of the step from another face
/// (`step`, -1 without), and of the robot, whose body moves with `psi`.
Eigen::MatrixXd touch_row(const PossibleTouch& each, const PlaceUnknowns& nuisance, int step,
                          int columns, const Eigen::MatrixXd& psi, const Eigen::Vector3d& p) {
  const bool socket = each.group >= 0;
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(socket ? 3 : 1, columns);
  const Eigen::MatrixXd moves = psi.topRows<3>();
  W.leftCols(moves.cols()) = socket ? moves : Eigen::MatrixXd(nuisance.normal.transpose() * moves);
  if (socket)
    W.middleCols(nuisance.column, 3) = -Eigen::Matrix3d::Identity();
  else
    W.middleCols(nuisance.column, 3) << p.transpose() * tangents(nuisance.normal), -1;
  if (step >= 0) W(0, step) = -1;
  return W;
}

/// Of a lock: the leg's direction turns off the unknown one, dr_a = (u x e_a) . turn.
Eigen::MatrixXd lock_rows(const PlaceUnknowns& nuisance, int columns, const Eigen::MatrixXd& psi) {
  const auto E = tangents(nuisance.normal);
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(2, columns);
  for (int a = 0; a < 2; ++a) {
    const Eigen::Vector3d turn = nuisance.normal.cross(E.col(a));
    W.row(a).head(psi.cols()) = turn.transpose() * psi.bottomRows<3>();
    W(a, nuisance.column + a) = -1;
  }
  return W;
}

}  // namespace

PlaceColumns::PlaceColumns(const Robot& robot, const std::vector<Set>& sets)
    : first_(static_cast<int>(robot.parameters().size())),
      sets_(sets),
      place_variance_(kPlaceVariance * std::pow(size_of(robot), 2)) {}

void PlaceColumns::add(const PossibleTouch& touch) {
  (void)of(touch);
  (void)step_of(touch);
}

PlaceUnknowns PlaceColumns::of(const PossibleTouch& touch) {
  const int place = place_of(sets_, touch.set);
  const auto [found, added] =
      at_.try_emplace({place, touch.group}, PlaceUnknowns{end(), touch.outward});
  if (added) {
    const Set& set = sets_[place];
    const bool known = set.method->place_known();
    // A surface's first two turn it, all three of a socket shift it.
    const bool shifts = set.method->planned() == Planned::places;
    const double turn = known    ? std::pow(doubt_of_turn(set), 2)
                        : shifts ? place_variance_
                                 : kPlaceVariance;
    variances_.insert(variances_.end(), 2, turn);
    variances_.push_back(known ? variance_of_lengths(set, false) : place_variance_);
  }
  return found->second;
}

int PlaceColumns::step_of(const PossibleTouch& touch) {
  const Set& set = sets_[touch.set];
  if (set.reference < 0 || touch.group >= 0) return -1;
  const bool opposite = of(touch).normal.dot(touch.outward) < 0;
  const auto [found, added] = step_.try_emplace(touch.set, end());
  if (added) variances_.push_back(variance_of_lengths(set, opposite));
  return found->second;
}

bool PlaceColumns::is_step(Eigen::Index column) const {
  return std::ranges::any_of(step_, [&](const auto& each) { return each.second == column; });
}

double touch_noise(const Set& set) { return set.noise > 0 ? set.noise : kNoise; }

double angle_noise(const Set& set) { return set.noise_angle > 0 ? set.noise_angle : kAngleNoise; }

Eigen::MatrixXd inverse_of_covariance(const Eigen::MatrixXd& C) {
  const Eigen::VectorXd by = C.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd one = by.asDiagonal() * C * by.asDiagonal();
  return by.asDiagonal() *
         inverse_of_positive(one + kLeastVariance * Eigen::MatrixXd::Identity(C.rows(), C.cols())) *
         by.asDiagonal();
}

std::vector<Eigen::MatrixXd> touch_rows(const Robot& robot, const Eigen::VectorXd& xi,
                                        const std::vector<Set>& sets,
                                        const std::vector<PossibleTouch>& touches,
                                        PlaceColumns& columns) {
  for (const PossibleTouch& each : touches) columns.add(each);
  const auto parameters = static_cast<Eigen::Index>(robot.parameters().size());
  std::vector<Eigen::MatrixXd> rows;
  ConfigurationBlock block{Eigen::ArrayXXd(kLanes, static_cast<int>(robot.joints().size())), 0};
  Locations X;
  PsiBlock psi;
  for (std::size_t first = 0; first < touches.size(); first += block.count) {
    const Body body = sets[touches[first].set].method->body();
    block.count = 0;
    while (block.count < kLanes && first + block.count < touches.size() &&
           sets[touches[first + block.count].set].method->body() == body)
      ++block.count;
    for (int lane = 0; lane < kLanes; ++lane)
      block.q.row(lane) = touches[first + std::min(lane, block.count - 1)].q.transpose().array();
    robot.locate(block, xi, body, X, &psi);
    for (int lane = 0; lane < block.count; ++lane) {
      const PossibleTouch& each = touches[first + lane];
      Eigen::MatrixXd moves(6, parameters);
      for (int c = 0; c < 6; ++c) moves.row(c) = psi.row(c * kLanes + lane);
      const Set& set = sets[each.set];
      if (set.method->planned() == Planned::lock)
        rows.push_back(lock_rows(columns.of(each), columns.end(), moves) / angle_noise(set));
      else
        rows.push_back(touch_row(each, columns.of(each), columns.step_of(each), columns.end(),
                                 moves, X.p(lane)) /
                       touch_noise(set));
    }
  }
  return rows;
}

Eigen::MatrixXd covariance_before(const Robot& robot, const Eigen::MatrixXd& given,
                                  const PlaceColumns& columns) {
  const auto parameters = static_cast<Eigen::Index>(robot.parameters().size());
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(columns.end(), columns.end());
  if (given.rows() > 0) C.topLeftCorner(parameters, parameters) = given;
  for (Eigen::Index i = 0; i < parameters; ++i) {
    const Parameter& each = robot.parameters()[static_cast<std::size_t>(i)];
    if (!each.free && C(i, i) <= 0) C(i, i) = std::pow(doubt_of_fixed(each), 2);
    if (each.free && given.rows() == 0) C(i, i) = std::pow(each.tolerance, 2);
  }
  Eigen::Index at = parameters;
  for (const double variance : columns.variances()) {
    C(at, at) = variance;
    ++at;
  }
  return C;
}

Eigen::MatrixXd unseen_by_touches(const Robot& robot, const Eigen::VectorXd& xi,
                                  const std::vector<Set>& sets,
                                  const std::vector<PossibleTouch>& touches) {
  Eigen::MatrixXd seen = Eigen::MatrixXd::Zero(6, 6);  // of the motions that rows would tell
  for (const PossibleTouch& each : touches) {
    if (!sets[place_of(sets, each.set)].method->place_known()) continue;
    const Eigen::Vector3d p = locate(robot, xi, each.q).p;
    Eigen::Matrix<double, 6, 1> row;
    row << each.outward, p.cross(each.outward);
    seen += row * row.transpose();
  }
  const Symmetric eigen = symmetric_eigen(seen);
  const double least = kLeastSeen * std::max(1.0, eigen.values.maxCoeff());
  const Eigen::Index unseen = (eigen.values.array() <= least).count();
  return eigen.vectors.leftCols(unseen);  // the values come in increasing order
}

Eigen::MatrixXd covariance_after(const Robot& robot, const Eigen::VectorXd& xi,
                                 const std::vector<Set>& sets,
                                 const std::vector<PossibleTouch>& touches,
                                 const Eigen::MatrixXd& prior) {
  PlaceColumns columns(robot, sets);
  const std::vector<Eigen::MatrixXd> rows = touch_rows(robot, xi, sets, touches, columns);
  Eigen::MatrixXd C = covariance_before(robot, prior, columns);
  for (const Eigen::MatrixXd& W : rows)
    for (Eigen::Index a = 0; a < W.rows(); ++a) {
      const Eigen::VectorXd gain = C * W.row(a).transpose();
      C -= gain * gain.transpose() / (1 + W.row(a).dot(gain));
    }
  const auto parameters = static_cast<Eigen::Index>(robot.parameters().size());
  return C.topLeftCorner(parameters, parameters);
}

}  // namespace selfcal
