// QR in a given order: modified Gram-Schmidt, each column projected twice ("twice is enough",
// Parlett), on the columns of a square R, which has the same column space geometry as W.
#include "constraints/identifiability/identifiability.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr double kStraight = 1e-9;  ///< cosine that only rounding leaves

/// An orthonormal basis that grows column by column, with R of the columns taken.
class Basis {
 public:
  Basis(Eigen::Index rows, Eigen::Index most)
      : Q_(rows, most), R_(Eigen::MatrixXd::Zero(most, most)) {}

  struct Projection {
    Eigen::VectorXd coefficients, rest;
  };
  Projection project(const Eigen::VectorXd& v) const {
    const auto Q = Q_.leftCols(count_);
    Projection p{Q.transpose() * v, {}};
    p.rest = v - Q * p.coefficients;
    const Eigen::VectorXd again = Q.transpose() * p.rest;
    p.rest -= Q * again;
    p.coefficients += again;
    return p;
  }
  void take(const Projection& p) {
    const double length = p.rest.norm();
    R_.col(count_).head(count_) = p.coefficients;
    R_(count_, count_) = length;
    Q_.col(count_++) = p.rest / length;
  }
  /// Coefficients of the taken columns themselves.
  Eigen::VectorXd combination(const Projection& p) const {
    return R_.topLeftCorner(count_, count_).triangularView<Eigen::Upper>().solve(p.coefficients);
  }
  /// Summed lengths of the multiples of the taken columns that make it up.
  double parts(const Projection& p) const {
    if (count_ == 0) return 0;
    return combination(p).cwiseAbs().dot(
        R_.topLeftCorner(count_, count_).colwise().norm().transpose());
  }

 private:
  Eigen::MatrixXd Q_, R_;
  Eigen::Index count_ = 0;
};

/// Length beyond the columns before it that a column must exceed. Structural: tau of 11.28, with
/// the largest column for max |R_ii|, as no diagonal element is larger; where the columns before it
/// make it up of parts that nearly cancel, the rounding of those parts.
class Threshold {
 public:
  Threshold(const Eigen::MatrixXd& R, const std::vector<int>& order, const RankRule& rule)
      : rule_(rule) {
    for (const int c : order) largest_ = std::max(largest_, R.col(c).norm());
  }
  double of(int column, const Basis& before, const Basis::Projection& p) const {
    if (rule_.rows > 0)
      return rule_.rows * std::numeric_limits<double>::epsilon() *
             std::max(largest_, before.parts(p));
    return 1 / (rule_.least.empty() ? rule_.least_sigma : rule_.least[column]);
  }

 private:
  const RankRule& rule_;
  double largest_ = 0;
};

/// Coefficients smaller than this say nothing (structural: rounding; real data: noise).
double least_coefficient(const RankRule& rule) { return rule.rows == 0 ? 1e-2 : 1e-7; }

/// The carrier that makes up most of the column; coefficients alone have different units.
std::pair<int, double> largest_share(const Eigen::MatrixXd& R, const std::vector<int>& order,
                                     const std::vector<int>& taken, const Eigen::VectorXd& c) {
  Eigen::VectorXd share(c.size());
  for (Eigen::Index k = 0; k < c.size(); ++k)
    share[k] = std::abs(c[k]) * R.col(order[taken[k]]).norm();
  Eigen::Index most = 0;
  share.maxCoeff(&most);
  return {taken[most], c[most]};
}

/// Own values of `set` that a step of its own freedoms moves, each with how far.
void add_own_values(const Equations& equations, const State& state, int set,
                    const Eigen::VectorXd& step, std::vector<Carrier>& carriers) {
  const Set& each = equations.data().sets[set];
  const Eigen::VectorXd* reference = each.reference < 0 ? nullptr : &state.nuisance[each.reference];
  for (const NuisanceReport& report : each.method->report(state.nuisance[set], reference)) {
    const double moved = report.D_own.dot(step);
    const bool moves = std::abs(moved) > kStraight * report.D_own.norm() * step.norm();
    if (!report.derived && moves) carriers.push_back({each.name + "." + report.name, moved});
  }
}

}  // namespace

std::vector<ColumnRank> rank_columns(const Eigen::MatrixXd& R, const std::vector<int>& order,
                                     int leading, const RankRule& rule) {
  const Threshold threshold(R, order, rule);
  Basis basis(R.rows(), static_cast<Eigen::Index>(order.size()));
  std::vector<int> taken;  // positions in order
  std::vector<ColumnRank> ranks;
  for (int i = 0; i < static_cast<int>(order.size()); ++i) {
    const Eigen::VectorXd column = R.col(order[i]);
    const Basis::Projection p = basis.project(column);
    const double tau = threshold.of(order[i], basis, p);
    const bool independent = p.rest.norm() > tau;
    if (i >= leading) ranks.emplace_back();
    if (independent) {
      basis.take(p);
      taken.push_back(i);
    } else if (i >= leading) {
      ColumnRank& rank = ranks.back();
      rank.status = column.norm() > tau ? Status::grouped : Status::no_effect;
      if (rank.status == Status::no_effect) continue;
      const Eigen::VectorXd c = basis.combination(p);
      for (Eigen::Index k = 0; k < c.size(); ++k)
        if (std::abs(c[k]) > least_coefficient(rule)) rank.carriers.emplace_back(taken[k], c[k]);
      if (rank.carriers.empty()) rank.carriers.push_back(largest_share(R, order, taken, c));
    }
  }
  return ranks;
}

int Identifiability::total() const {
  return static_cast<int>(std::count(status.begin(), status.end(), Status::identified));
}

Identifiability identifiability(const Equations& equations, const Eigen::MatrixXd& R,
                                const State& state, const std::vector<char>& free_mask,
                                const RankRule& rule) {
  const Robot& robot = equations.robot();
  const int leading = equations.nuisance_columns();
  std::vector<int> order(leading);
  std::iota(order.begin(), order.end(), equations.robot_columns());
  for (const int p : robot.preference())
    if (free_mask[p]) order.push_back(p);
  RankRule of_robot = rule;
  of_robot.least.assign(equations.columns(), rule.least_sigma);
  const double size = size_of(robot);
  for (int c = equations.robot_columns(); c < equations.columns(); ++c)
    of_robot.least[c] *= equations.nuisance_unit(c);
  for (size_t i = 0; i < robot.parameters().size(); ++i) {
    const Parameter& p = robot.parameters()[i];
    if (p.quantity == Quantity::length) of_robot.least[i] *= size;
    if (p.quantity == Quantity::ratio) of_robot.least[i] = rule.least_ratio_sigma;
    if (p.part == Part::effect) of_robot.least[i] = p.tolerance;  // no better than its prior
  }
  const std::vector<ColumnRank> ranks = rank_columns(R, order, leading, of_robot);

  Identifiability result;
  result.status.assign(robot.parameters().size(), Status::fixed);
  result.grouped_with.resize(robot.parameters().size());
  for (size_t i = 0; i < ranks.size(); ++i) {
    const int p = order[leading + i];
    result.status[p] = ranks[i].status;
    Eigen::VectorXd nuisance = Eigen::VectorXd::Zero(equations.nuisance_columns());
    for (const auto& [at, coefficient] : ranks[i].carriers) {
      if (at >= leading)
        result.grouped_with[p].push_back({robot.parameters()[order[at]].name, coefficient});
      else
        nuisance[at] = coefficient;  // own freedoms lead in the order of their columns
    }
    for (int s = 0; s < static_cast<int>(equations.data().sets.size()); ++s) {
      const Eigen::Index first = equations.own_at(s) - equations.robot_columns();
      const Eigen::VectorXd step = nuisance.segment(first, equations.tangent_dimension(s));
      if (!step.isZero(0)) add_own_values(equations, state, s, step, result.grouped_with[p]);
    }
  }
  return result;
}

}  // namespace selfcal
