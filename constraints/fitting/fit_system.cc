// Each step solves min |W_f s - z|^2 + |(xi + s - centre) / sigma|^2 + lambda |D s|^2 by the
// Cholesky factor of the normal equations, which the priors keep regular, or where even these leave
// a direction to rounding by a QR of the rows themselves. What an iteration finds is the same to
// rounding, for the gradient is; the covariance comes of a QR in any case.
#include "constraints/fitting/fit_system.h"

#include <cmath>
#include <utility>

#include "kinematics/linear_algebra.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

/// Of nuisance parameters, in the robot's size or rad, where a step must be short.
constexpr double kShortStep = 50e-3;
/// Of a pivot of the normal equations over its diagonal, which rounding blurs by some 1e-15: the
/// step of a direction is then good to a thousandth, and the next iteration does the rest.
constexpr double kLeastPivot = 1e-12;
/// Of the groups' values, each with the rows' weights of the one before.
constexpr int kSettlings = 2;

/// What a change of each column is measured by: the robot's size where it is a length, else 1.
Eigen::VectorXd units_of_columns(const Equations& equations) {
  Eigen::VectorXd units(equations.columns());
  const double size = size_of(equations.robot());
  for (int c = 0; c < equations.columns(); ++c)
    units[c] =
        c >= equations.robot_columns() ? equations.nuisance_unit(c)
        : equations.robot().parameters()[static_cast<std::size_t>(c)].quantity == Quantity::length
            ? size
            : 1;
  return units;
}

}  // namespace

FitSystem::FitSystem(const Equations& equations, const Prior& prior, State start,
                     Weighting weighting)
    : equations_(equations),
      prior_(prior),
      columns_(free_columns(equations, prior)),
      units_(units_of_columns(equations)),
      has_groups_(equations.nuisance_dimensions() > equations.nuisance_columns()),
      state_(std::move(start)),
      weighting_(std::move(weighting)) {
  linearise();
}

const Passed& FitSystem::passed() const {
  if (by_factor_) return factor_;
  return products_;
}

void FitSystem::weigh(Weighting weighting) {
  weighting_ = std::move(weighting);
  linearise();
}

void FitSystem::linearise() {
  if (by_factor_)
    factor_ = equations_.linearise(state_, weighting_);
  else
    products_ = equations_.normal_equations(state_, weighting_, columns_);
  cost_ = passed().cost + prior_cost(state_);
}

void FitSystem::use_factor() {
  if (by_factor_) return;
  by_factor_ = true;
  linearise();
}

State FitSystem::stepped(const Eigen::VectorXd& step) const {
  return by_factor_ ? equations_.stepped(state_, factor_, step)
                    : equations_.stepped(state_, products_, step);
}

double FitSystem::prior_cost(const State& state) const {
  double cost = 0;
  for (const int c : columns_)
    if (c < equations_.robot_columns() && prior_.use)
      cost += std::pow((state.xi[c] - prior_.centre[c]) / prior_.sigma[c], 2);
  return cost;
}

Eigen::MatrixXd FitSystem::triangle() {
  if (!by_factor_) {
    const Eigen::VectorXd b = products_.H.col(products_.H.cols() - 1).head(products_.H.rows() - 1);
    Eigen::MatrixXd T = root(products_.H, b + pull(), 0);
    if (T.size() > 0) return T;
    use_factor();
  }
  return triangle_with_priors(equations_, prior_, columns_, factor_.R, state_.xi, true);
}

Eigen::VectorXd FitSystem::pull() const {
  Eigen::VectorXd b = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(columns_.size()));
  for (Eigen::Index i = 0; i < b.size(); ++i)
    if (const int c = columns_[static_cast<size_t>(i)]; c < equations_.robot_columns())
      b[i] = std::pow(prior_weight(equations_, prior_, c), 2) * (prior_.centre[c] - state_.xi[c]);
  return b;
}

Eigen::MatrixXd FitSystem::root(const Eigen::MatrixXd& H, const Eigen::VectorXd& b,
                                double lambda) const {
  const Eigen::Index n = b.size();
  Eigen::MatrixXd N = H.topLeftCorner(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    N(i, i) += std::pow(prior_weight(equations_, prior_, columns_[static_cast<size_t>(i)]), 2);
  N.diagonal() += lambda * damping().cwiseAbs2();
  const Eigen::MatrixXd L = cholesky_root(N);
  for (Eigen::Index i = 0; i < n; ++i)
    if (!(L(i, i) * L(i, i) > kLeastPivot * N(i, i))) return {};
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(n + 1, n + 1);
  T.topLeftCorner(n, n) = L.transpose();
  T.col(n).head(n) = solve_lower(L, b);
  return T;
}

Eigen::VectorXd FitSystem::step(const Eigen::MatrixXd& of, double lambda) const {
  const Eigen::Index n = of.cols() - 1;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n + 1, n + 1);
  A.topRows(n + 1) = of;
  if (lambda > 0) {
    A.block(n + 1, 0, n, n).diagonal() = std::sqrt(lambda) * damping();
    triangularise(A);
  }
  const Eigen::VectorXd s =
      A.topLeftCorner(n, n).triangularView<Eigen::Upper>().solve(A.col(n).head(n));
  Eigen::VectorXd all = Eigen::VectorXd::Zero(equations_.columns());
  for (Eigen::Index i = 0; i < n; ++i) all[columns_[i]] = s[i];
  return all;
}

Eigen::VectorXd FitSystem::with_geodesic_acceleration(const Eigen::VectorXd& v,
                                                      double lambda) const {
  const NormalEquations at =
      by_factor_ ? equations_.normal_equations(state_, weighting_, columns_) : products_;
  const Eigen::VectorXd b = equations_.geodesic_acceleration(state_, weighting_, at, v);
  const Eigen::MatrixXd T = root(at.H, b, lambda);
  if (T.size() == 0) return v;
  const Eigen::VectorXd a = step(T, 0);
  return damped_length(a) < 0.75 * damped_length(v) ? Eigen::VectorXd(v + a / 2) : v;
}

double FitSystem::damped_length(const Eigen::VectorXd& s) const {
  return damping().cwiseProduct(s(columns_)).norm();
}

Eigen::VectorXd FitSystem::damping() const {
  Eigen::VectorXd D(static_cast<Eigen::Index>(columns_.size()));
  for (Eigen::Index i = 0; i < D.size(); ++i)
    D[i] = 1 / (columns_[i] < equations_.robot_columns() ? prior_.sigma[columns_[i]]
                                                         : kShortStep * units_[columns_[i]]);
  return D;
}

double FitSystem::whitened(const Eigen::MatrixXd& triangle, const Eigen::VectorXd& step) const {
  const Eigen::Index n = triangle.cols() - 1;
  Eigen::VectorXd s(n);
  for (Eigen::Index i = 0; i < n; ++i) s[i] = step[columns_[i]];
  return (triangle.topLeftCorner(n, n).triangularView<Eigen::Upper>() * s).norm();
}

FitSystem::Trial FitSystem::at(State state) const {
  Trial trial{std::move(state)};
  if (by_factor_)
    trial.factor = equations_.linearise(trial.state, weighting_);
  else
    trial.products = equations_.normal_equations(trial.state, weighting_, columns_);
  trial.cost = (by_factor_ ? trial.factor.cost : trial.products.cost) + prior_cost(trial.state);
  return trial;
}

FitSystem::Trial FitSystem::with_groups_settled(const Trial& trial) const {
  const Eigen::VectorXd stay = Eigen::VectorXd::Zero(equations_.columns());
  return at(by_factor_ ? equations_.stepped(trial.state, trial.factor, stay)
                       : equations_.stepped(trial.state, trial.products, stay));
}

bool FitSystem::go(const Eigen::VectorXd& step) {
  const auto lower = [&](const Trial& trial) {
    return std::isfinite(trial.cost) && trial.cost <= cost_ * (1 + 1e-9) + 1e-9;
  };
  Trial trial = at(stepped(step));
  if (!lower(trial)) {
    tried_ = {trial.cost, (by_factor_ ? static_cast<Passed&>(trial.factor) : trial.products).norms};
    for (int i = 0; has_groups_ && i < kSettlings && std::isfinite(trial.cost) && !lower(trial);
         ++i)
      trial = with_groups_settled(trial);
    if (!lower(trial)) return false;
  }
  state_ = std::move(trial.state);
  factor_ = std::move(trial.factor);
  products_ = std::move(trial.products);
  cost_ = trial.cost;
  return true;
}

Eigen::MatrixXd FitSystem::covariance() {
  const Eigen::MatrixXd Rz = triangle();
  const Eigen::Index n = Rz.cols() - 1;
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(equations_.columns(), equations_.columns());
  spread(columns_, columns_) = inverse_of_square(Rz.topLeftCorner(n, n));
  return spread;
}

}  // namespace selfcal
