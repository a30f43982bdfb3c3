#include "constraints/sampling/newton.h"

#include <algorithm>
#include <cmath>
#include <optional>

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

/// x of least length with A x = b, by the products of A's few rows; nothing where these are nearly
/// dependent. `products`: by lane, (a, b) of the lower triangle in column a (a + 1) / 2 + b.
template <int rows>
std::optional<Eigen::VectorXd> by_products(const Eigen::MatrixXd& A,
                                           const Eigen::ArrayXXd& products, int lane,
                                           const Eigen::VectorXd& b) {
  constexpr int most = rows == Eigen::Dynamic ? kMostEquations : rows;
  using Square = Eigen::Matrix<double, rows, rows, 0, most, most>;
  using Column = Eigen::Matrix<double, rows, 1, 0, most, 1>;
  Square P(b.size(), b.size());
  for (Eigen::Index r = 0, at = 0; r < b.size(); ++r)
    for (Eigen::Index c = 0; c <= r; ++c, ++at) P(r, c) = P(c, r) = products(lane, at);
  const Column length = A.rowwise().norm();
  if (!(length.minCoeff() > 0)) return std::nullopt;
  const Column per = length.cwiseInverse();
  P = (per.asDiagonal() * P * per.asDiagonal()).eval();
  const Eigen::LLT<Square> factor(P);
  if (factor.info() != Eigen::Success || !(factor.matrixLLT().diagonal().minCoeff() > kIndependent))
    return std::nullopt;
  Column x = per.cwiseProduct(b);
  const Square& L = factor.matrixLLT();
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    x[i] /= L(i, i);
    for (Eigen::Index r = i + 1; r < x.size(); ++r) x[r] -= x[i] * L(r, i);
  }
  factor.matrixU().solveInPlace(x);
  return A.transpose() * per.cwiseProduct(x);
}

}  // namespace

NewtonStep::NewtonStep(const Robot& robot, const DataSet& data, const State& truth, int row,
                       const Locations& before, const std::vector<int>& held)
    : robot_(robot),
      data_(data),
      truth_(truth),
      before_(before),
      held_(held),
      set_(data.rows.set[row]),
      quantities_(data.sets[set_].method->equations()),
      size_(size_of(robot)),
      rows_(kLanes, row) {}

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
  const Eigen::Index lanes = J_.rows() / 6;
  GJ_.setZero(static_cast<Eigen::Index>(quantities_.size()) * lanes, J_.cols());
  for (Eigen::Index a = 0; a < static_cast<Eigen::Index>(quantities_.size()); ++a) {
    if (lengths_alone && quantities_[static_cast<std::size_t>(a)] != Quantity::length) {
      out_.r.col(a).setZero();
      continue;
    }
    for (Eigen::Index c = 0; c < 6; ++c) {
      const auto g = out_.G_now.col(6 * a + c).head(lanes);
      if ((g == 0).all()) continue;
      for (Eigen::Index j = 0; j < J_.cols(); ++j)
        GJ_.col(j).segment(a * lanes, lanes).array() +=
            g * J_.col(j).segment(c * lanes, lanes).array();
    }
  }
  const auto k = static_cast<Eigen::Index>(quantities_.size());
  products_.setZero(lanes, k * (k + 1) / 2);
  for (Eigen::Index j = 0; j < GJ_.cols(); ++j)
    for (Eigen::Index a = 0, at = 0; a < k; ++a)
      for (Eigen::Index b = 0; b <= a; ++b, ++at)
        products_.col(at) += GJ_.col(j).segment(a * lanes, lanes).array() *
                             GJ_.col(j).segment(b * lanes, lanes).array();
}

Eigen::VectorXd NewtonStep::miss(int lane, const Eigen::VectorXd& wanted) const {
  return wanted - out_.r.row(lane).matrix().transpose();
}

double NewtonStep::size_of_miss(int lane, const Eigen::VectorXd& miss) const {
  const double length = std::max(size_, X_.p(lane).norm());
  double squares = 0;
  for (Eigen::Index a = 0; a < miss.size(); ++a) {
    const bool angle = quantities_[static_cast<std::size_t>(a)] == Quantity::angle;
    squares += std::pow(angle ? miss[a] : miss[a] / length, 2);
  }
  return std::sqrt(squares);
}

Eigen::VectorXd NewtonStep::step(int lane, const Eigen::VectorXd& miss) const {
  const Eigen::MatrixXd GJ = GJ_(Eigen::seqN(lane, miss.size(), J_.rows() / 6), Eigen::all);
  const std::optional<Eigen::VectorXd> by =
      miss.size() == 3   ? by_products<3>(GJ, products_, lane, miss)
      : miss.size() == 1 ? by_products<1>(GJ, products_, lane, miss)
                         : by_products<Eigen::Dynamic>(GJ, products_, lane, miss);
  return by ? *by : least_squares(GJ, miss);
}

std::vector<int> NewtonStep::reach(const Eigen::VectorXd& wanted, int enough,
                                   ConfigurationBlock& block) {
  const Eigen::ArrayXd units = units_of_readings(robot_);
  Lanes left = Lanes::Constant(kLanes, HUGE_VAL), least = left;
  std::vector<char> lost(kLanes, 0);
  for (int at = 0, gained = 0; at < kNewtonSteps && at - gained <= kPatience; ++at) {
    evaluate(block);
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
      const Eigen::VectorXd off = miss(lane, wanted);
      left[lane] = size_of_miss(lane, off);
      if (left[lane] < least[lane] / 2) {
        least[lane] = left[lane];
        gained = at;
      }
      if (left[lane] < kExact / 10) continue;
      Eigen::VectorXd dq = step(lane, off);
      const double length = (dq.array() / units).matrix().norm();
      if (length > kLongestStep) dq *= kLongestStep / length;
      block.q.row(lane) += dq.transpose().array();
    }
    if (going < 0 || (left < kExact / 10).count() >= enough) break;
  }
  std::vector<int> reached;
  for (int lane = 0; lane < kLanes; ++lane)
    if (left[lane] < kExact) reached.push_back(lane);
  // Once more: down to rounding, by which a structural rank is judged.
  evaluate(block);
  for (const int lane : reached)
    block.q.row(lane) += step(lane, miss(lane, wanted)).transpose().array();
  robot_.locate(block, truth_.xi, data_.sets[set_].method->body(), X_, nullptr);
  return reached;
}

}  // namespace selfcal
