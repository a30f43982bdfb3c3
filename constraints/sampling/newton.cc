#include "constraints/sampling/newton.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinematics/linear_algebra.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kNewtonSteps = 40;
constexpr int kPatience = 8;          // steps in which no start comes half as near as it was
constexpr double kLongestStep = 0.5;  // units of readings
constexpr double kExact = 1e-13;      // size of a miss that is none

// Least diagonal of the factor of products of rows of length one: less is left to the slower way.
constexpr double kIndependent = 1e-3;

/// Where (a, b) of a lower triangle stands among its columns.
Eigen::Index place(Eigen::Index a, Eigen::Index b) { return a * (a + 1) / 2 + b; }

/// The multipliers y with A A' y = b in every lane, A's few rows made of length one on the way, by
/// the products of these rows with each other (lower triangle, see place()); false in `independent`
/// where the rows are nearly dependent. A row of zeros has a multiplier of zero.
Eigen::ArrayXXd multipliers(const Eigen::ArrayXXd& products, const Eigen::ArrayXXd& b,
                            Eigen::Array<bool, Eigen::Dynamic, 1>& independent) {
  const Eigen::Index lanes = b.rows(), k = b.cols();
  Eigen::ArrayXXd per(lanes, k), L(lanes, products.cols()), y(lanes, k);
  for (Eigen::Index a = 0; a < k; ++a) {
    const auto square = products.col(place(a, a));
    per.col(a) = (square > 0).select(square.rsqrt(), 0);
  }
  independent.setConstant(lanes, true);
  for (Eigen::Index c = 0; c < k; ++c) {
    for (Eigen::Index r = c; r < k; ++r) {
      auto entry = L.col(place(r, c));
      entry = products.col(place(r, c)) * per.col(r) * per.col(c);
      for (Eigen::Index j = 0; j < c; ++j) entry -= L.col(place(r, j)) * L.col(place(c, j));
      if (r > c)
        entry /= L.col(place(c, c));
      else
        entry = (per.col(c) > 0).select(entry, 1).sqrt();
    }
    independent = independent && L.col(place(c, c)) > kIndependent;
    y.col(c) = b.col(c) * per.col(c);
    for (Eigen::Index j = 0; j < c; ++j) y.col(c) -= L.col(place(c, j)) * y.col(j);
    y.col(c) /= L.col(place(c, c));
  }
  for (Eigen::Index a = k - 1; a >= 0; --a) {
    for (Eigen::Index r = a + 1; r < k; ++r) y.col(a) -= L.col(place(r, a)) * y.col(r);
    y.col(a) /= L.col(place(a, a));
  }
  return y * per;
}

}  // namespace

NewtonStep::NewtonStep(const Robot& robot, const DataSet& data, const State& truth,
                       std::vector<int> rows, const Locations& before, const std::vector<int>& held)
    : robot_(robot),
      data_(data),
      truth_(truth),
      before_(before),
      held_(held),
      set_(data.rows.set[rows.front()]),
      quantities_(data.sets[set_].method->equations()),
      size_(size_of(robot)),
      rows_(std::move(rows)) {
  rows_.resize(kLanes, rows_.back());
}

void NewtonStep::evaluate(const ConfigurationBlock& block) {
  const Method& method = *data_.sets[set_].method;
  const int reference = data_.sets[set_].reference;
  if (robot_.has_loops()) {
    // Newton's next readings are near its last ones.
    const Locations last = X_;
    ConfigurationBlock at = block;
    if (evaluated_) at.near = &last;
    closure_ = robot_.locate(at, truth_.xi, method.body(), X_, &psi_);
    evaluated_ = true;
  } else {
    closure_ = robot_.locate(block, truth_.xi, method.body(), X_, &psi_);
  }
  robot_.joint_jacobian(block, truth_.xi, method.body(), psi_, J_);
  out_.resize(static_cast<int>(quantities_.size()), method.tangent_dimension(),
              reference < 0 ? 0 : data_.sets[reference].method->tangent_dimension(),
              method.group_freedom());
  MethodInput in;
  in.count = block.count;
  in.data = &data_.rows;
  in.rows = rows_.data();
  in.now = &X_;
  in.before = &before_;
  in.nuisance = &truth_.nuisance[set_];
  in.reference = reference < 0 ? nullptr : &truth_.nuisance[reference];
  in.groups = &truth_.groups[set_];
  method.evaluate(in, out_);
  for (const int j : held_) J_.col(j).setZero();
  const bool lengths_alone = method.constrains() && !method.measures().empty();
  const Eigen::Index lanes = J_.rows() / 6, joints = J_.cols();
  const auto k = static_cast<Eigen::Index>(quantities_.size());
  GJ_.setZero(lanes, k * joints);
  for (Eigen::Index a = 0; a < k; ++a) {
    if (lengths_alone && quantities_[static_cast<std::size_t>(a)] != Quantity::length) {
      out_.r.col(a).setZero();
      continue;
    }
    for (Eigen::Index c = 0; c < 6; ++c) {
      const Lanes g = out_.G_now.col(6 * a + c).head(lanes);
      if ((g == 0).all()) continue;
      for (Eigen::Index j = 0; j < joints; ++j)
        GJ_.col(a * joints + j) += g * J_.col(j).segment(c * lanes, lanes).array();
    }
  }
  products_.setZero(lanes, k * (k + 1) / 2);
  for (Eigen::Index a = 0; a < k; ++a)
    for (Eigen::Index b = 0; b <= a; ++b)
      for (Eigen::Index j = 0; j < joints; ++j)
        products_.col(place(a, b)) += GJ_.col(a * joints + j) * GJ_.col(b * joints + j);
}

Eigen::ArrayXXd NewtonStep::misses(const Eigen::ArrayXXd& wanted) const {
  const Eigen::Index lanes = J_.rows() / 6;
  return wanted.topRows(lanes) - out_.r.topRows(lanes);
}

Lanes NewtonStep::sizes_of(const Eigen::ArrayXXd& misses) const {
  const Lanes length = X_.position.matrix().rowwise().norm().array().max(size_);
  Lanes squares = Lanes::Zero(misses.rows());
  for (Eigen::Index a = 0; a < misses.cols(); ++a) {
    const bool angle = quantities_[static_cast<std::size_t>(a)] == Quantity::angle;
    const Lanes part = angle ? Lanes(misses.col(a)) : Lanes(misses.col(a) / length);
    squares += part.square();
  }
  return squares.sqrt();
}

Eigen::ArrayXXd NewtonStep::steps(const Eigen::ArrayXXd& misses) const {
  Eigen::Array<bool, Eigen::Dynamic, 1> independent;
  const Eigen::ArrayXXd y = multipliers(products_, misses, independent);
  const Eigen::Index joints = J_.cols(), k = misses.cols();
  Eigen::ArrayXXd dq = Eigen::ArrayXXd::Zero(misses.rows(), joints);
  for (Eigen::Index a = 0; a < k; ++a)
    for (Eigen::Index j = 0; j < joints; ++j) dq.col(j) += GJ_.col(a * joints + j) * y.col(a);
  for (int lane = 0; lane < static_cast<int>(misses.rows()); ++lane)
    if (closes(lane) && !independent[lane]) {
      Eigen::MatrixXd GJ(k, joints);
      for (Eigen::Index a = 0; a < k; ++a) GJ.row(a) = GJ_.row(lane).segment(a * joints, joints);
      dq.row(lane) = least_squares(GJ, misses.row(lane).matrix().transpose()).transpose().array();
    }
  return dq;
}

std::vector<int> NewtonStep::reach(const Eigen::VectorXd& wanted, int enough,
                                   ConfigurationBlock& block) {
  const Eigen::ArrayXd units = units_of_readings(robot_);
  const Eigen::ArrayXXd everywhere = wanted.transpose().replicate(kLanes, 1).array();
  Lanes left = Lanes::Constant(kLanes, HUGE_VAL), least = left;
  std::vector<char> lost(kLanes, 0);
  for (int at = 0, gained = 0; at < kNewtonSteps && at - gained <= kPatience; ++at) {
    evaluate(block);
    const Eigen::ArrayXXd off = misses(everywhere);
    const Lanes far = sizes_of(off);
    Eigen::ArrayXXd dq = steps(off);
    const Lanes length =
        (dq.rowwise() / units.transpose()).matrix().rowwise().norm().array().max(kLongestStep);
    dq.colwise() *= kLongestStep / length;
    int going = -1;
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto l = static_cast<std::size_t>(lane);
      if (lost[l] || !closes(lane)) {
        lost[l] = 1;
        left[lane] = HUGE_VAL;
        // Loops that do not close are the dearest ones.
        if (going >= 0) block.q.row(lane) = block.q.row(going);
        continue;
      }
      going = lane;
      left[lane] = far[lane];
      if (left[lane] < least[lane] / 2) {
        least[lane] = left[lane];
        gained = at;
      }
      if (left[lane] < kExact / 10) continue;
      block.q.row(lane) += dq.row(lane);
    }
    if (going < 0 || (left < kExact / 10).count() >= enough) break;
  }
  std::vector<int> reached;
  for (int lane = 0; lane < kLanes; ++lane)
    if (left[lane] < kExact) reached.push_back(lane);
  // Once more: down to rounding, by which a structural rank is judged.
  evaluate(block);
  const Eigen::ArrayXXd last = steps(misses(everywhere));
  for (const int lane : reached) block.q.row(lane) += last.row(lane);
  robot_.locate(block, truth_.xi, data_.sets[set_].method->body(), X_, nullptr);
  return reached;
}

}  // namespace selfcal
