// An instrument that reads (1 + e) of every length measures a robot all of whose lengths l are so
// much longer. With e as one more unknown, of the column sum l dr/dl, and the unknowns x with their
// priors eliminated from
//   [W  sum l dr/dl | Delta Y]
//   [L        0     | L (centre - x)],   L the priors' weights,
// b e = c is left: the maker's lengths say e to 1 / |b|, about (sum (l / tolerance)^2)^-1/2. Where
// the shape alone is beyond the tolerances they are widened first.
#include "constraints/fitting/instrument_scale.h"

#include <cmath>

#include "constraints/statistics.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr double kLinear = 0.1;  // rows that ask for more are of another robot or unit altogether
constexpr double kImitated = 2e-3;            // a robot that sags may seem larger by so much
constexpr double kDoubtedInstruments = 0.01;  // of healthy robots and instruments

bool reads_every_length(const Equations& equations) {
  bool any = false;
  for (std::size_t s = 0; s < equations.data().sets.size(); ++s) {
    if (equations.plan(static_cast<int>(s)).items.empty()) continue;
    if (equations.data().sets[s].method->may_leave_scale_free()) return false;
    any = true;
  }
  return any;
}

bool is_length(const Robot& robot, int column) {
  return robot.parameters()[static_cast<std::size_t>(column)].quantity == Quantity::length;
}

struct Solved {
  double b = 0, c = 0;
  Eigen::VectorXd x;         ///< of the free unknowns, beyond where they are
  Eigen::VectorXd variance;  ///< of these
};

Solved solve(const Equations& equations, const Prior& prior, const Eigen::VectorXd& xi,
             const Eigen::MatrixXd& R) {
  const std::vector<int> columns = free_columns(equations, prior);
  const auto n = static_cast<Eigen::Index>(columns.size()), K = R.rows();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(K + n, n + 2);
  A.topLeftCorner(K, n) = R(Eigen::all, columns);
  A.topRightCorner(K, 1) = R.rightCols(1);
  for (int i = 0; i < equations.robot_columns(); ++i)
    if (is_length(equations.robot(), i)) A.col(n).head(K) += xi[i] * R.col(i);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int column = columns[static_cast<std::size_t>(i)];
    A(K + i, i) = prior_weight(equations, prior, column);
    if (column < equations.robot_columns())
      A(K + i, n + 1) = A(K + i, i) * (prior.centre[column] - xi[column]);
  }
  triangularise(A);
  const Eigen::MatrixXd inverse = inverse_of_triangle(A.topLeftCorner(n + 1, n + 1));
  const Eigen::VectorXd x = inverse * A.col(n + 1).head(n + 1);
  Solved solved{A(n, n), A(n, n + 1), Eigen::VectorXd::Zero(equations.columns()),
                Eigen::VectorXd::Zero(equations.columns())};
  solved.x(columns) = x.head(n);
  const Eigen::VectorXd variance = inverse.rowwise().squaredNorm();
  solved.variance(columns) = variance.head(n);
  return solved;
}

}  // namespace

bool InstrumentScale::beyond() const {
  return std::abs(excess) > kImitated && std::abs(excess) < kLinear &&
         std::abs(excess) > chi_quantile(1, 1 - kDoubtedInstruments) * sigma;
}

std::optional<InstrumentScale> instrument_scale(const Equations& equations, const Prior& prior,
                                                const Eigen::VectorXd& xi,
                                                const Eigen::MatrixXd& R) {
  if (!reads_every_length(equations) || equations.known_lengths() > 0) return std::nullopt;
  const Robot& robot = equations.robot();
  Solved solved = solve(equations, prior, xi, R);
  const double wider = widening(
      prior_chi2(robot, prior, xi + solved.x.head(equations.robot_columns()), solved.variance));
  if (wider > 1) {
    Prior widened = prior;
    for (std::size_t i = 0; i < robot.parameters().size(); ++i)
      if (is_own(robot.parameters()[i])) widened.sigma[static_cast<Eigen::Index>(i)] *= wider;
    solved = solve(equations, widened, xi, R);
  }
  if (!(std::abs(solved.b) > 0)) return std::nullopt;
  return InstrumentScale{solved.c / solved.b, 1 / std::abs(solved.b)};
}

}  // namespace selfcal
