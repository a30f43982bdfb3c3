// Iterative pseudo-inverse with damping behind it (Khalil and Dombre 11.31, 11.32, 11.4.3).
//
// Each iteration solves min |W_f s - z|^2 + |(xi + s - centre) / sigma|^2 + lambda |D s|^2, lambda
// zero unless a step failed to lower the cost: by the Cholesky factor of the normal equations,
// which the priors keep regular, or where even these leave a direction to rounding by a QR of the
// rows themselves. What an iteration finds is the same to rounding, for the gradient is; what is
// told of the last one comes of a QR in any case.
#include "constraints/fitting/fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "constraints/fitting/masked_outlier.h"
#include "kinematics/description.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

/// Of nuisance parameters, in the robot's size or rad, where a step must be short.
constexpr double kShortStep = 50e-3;
constexpr int kRegroupings = 20;
constexpr int kAttempts = 14;        ///< dampings tried before an iteration gives up
constexpr int kBarred = 3;           ///< of them barred by a loop that does not close
constexpr double kRounding = 1e-13;  ///< a step this short (of the robot's size, or rad) is nothing
constexpr double kNear = 1e-3;       ///< sigmas a parameter: where only rounding may be left
/// Of a pivot of the normal equations over its diagonal, which rounding blurs by some 1e-15: the
/// step of a direction is then good to a thousandth, and the next iteration does the rest.
constexpr double kLeastPivot = 1e-12;

/// What the noise is estimated from; it only goes forward.
enum class NoiseStage {
  robust,    ///< medians of all rows, one noise for all sets of a kind: the geometry still moves
  pooled,    ///< far rows put aside, one noise for all sets of a kind
  nuisance,  ///< far rows put aside, each set's own, which is then kept
};

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

class Iteration {
 public:
  Iteration(const Equations& equations, const State& start, const Prior& prior, const FitRule& rule)
      : equations_(equations),
        prior_(prior),
        rule_(rule),
        columns_(free_columns(equations, prior)),
        units_(units_of_columns(equations)) {
    fit_.state = start;
    if (rule.near) stage_ = NoiseStage::pooled;
    fit_.noise = estimate_noise(equations, equations.norms(start), noise_rule(stage_, 0));
    relinearise();
  }

  Fit run(const OnIteration& on_iteration) {
    while (!done_ && fit_.iterations < rule_.most_iterations) {
      iterate();
      if (on_iteration) on_iteration(fit_.iterations);
    }
    if (!done_)
      fit_.stop_reason =
          "no convergence within " + std::to_string(rule_.most_iterations) + " iterations";
    if (!by_factor_) {
      by_factor_ = true;
      relinearise();
    }
    fit_.covariance = covariance();
    fit_.at = std::move(factor_);
    fit_.objective = cost_;
    count_rows();
    NoiseRule told = noise_rule(stage_, freedom(fit_.covariance));
    told.pool = false;  // each set's own
    fit_.noise.estimated = estimate_noise(equations_, fit_.at.norms, told).estimated;
    fit_.at.norms = {};
    return std::move(fit_);
  }

 private:
  /// What noise they are weighed with is part of the objective.
  void count_rows() {
    for (int s = 0; s < static_cast<int>(equations_.data().sets.size()); ++s) {
      const std::vector<SetPlan::Item>& items = equations_.plan(s).items;
      fit_.rows.push_back(static_cast<int>(items.size()));
      const auto used = static_cast<double>(std::ranges::count_if(
          items, [&](const auto& item) { return !fit_.noise.outlier[item.row]; }));
      for (const Quantity quantity : equations_.data().sets[s].method->equations())
        if (used > 0) fit_.objective += 2 * used * std::log(fit_.noise.used[s].of(quantity));
    }
  }

  NoiseRule noise_rule(NoiseStage stage, double freedom) const {
    NoiseRule rule;
    rule.global_freedom = freedom;
    rule.most_outliers = rule_.most_outliers;
    rule.reject = stage != NoiseStage::robust;
    rule.pool = stage != NoiseStage::nuisance;
    return rule;
  }

  Weighting weighting() const { return {fit_.noise.used, fit_.noise.outlier}; }

  const Passed& at() const {
    if (by_factor_) return factor_;
    return products_;
  }

  void relinearise() {
    if (by_factor_)
      factor_ = equations_.linearise(fit_.state, weighting());
    else
      products_ = equations_.normal_equations(fit_.state, weighting(), columns_);
    cost_ = at().cost + prior_cost(fit_.state);
  }

  State stepped(const Eigen::VectorXd& step) const {
    return by_factor_ ? equations_.stepped(fit_.state, factor_, step)
                      : equations_.stepped(fit_.state, products_, step);
  }

  double prior_cost(const State& state) const {
    double cost = 0;
    for (const int c : columns_)
      if (c < equations_.robot_columns() && prior_.use)
        cost += std::pow((state.xi[c] - prior_.centre[c]) / prior_.sigma[c], 2);
    return cost;
  }

  /// Triangular [W | z] of the rows and the priors at the state.
  Eigen::MatrixXd triangle() {
    if (!by_factor_) {
      const Eigen::VectorXd b =
          products_.H.col(products_.H.cols() - 1).head(products_.H.rows() - 1);
      Eigen::MatrixXd T = root(products_.H, b + pull(), 0);
      if (T.size() > 0) return T;
      by_factor_ = true;
      relinearise();
    }
    return triangle_with_priors(equations_, prior_, columns_, factor_.R, fit_.state.xi, true);
  }

  /// What the priors add to W^T z.
  Eigen::VectorXd pull() const {
    Eigen::VectorXd b = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(columns_.size()));
    for (Eigen::Index i = 0; i < b.size(); ++i)
      if (const int c = columns_[static_cast<size_t>(i)]; c < equations_.robot_columns())
        b[i] = std::pow(prior_weight(equations_, prior_, c), 2) *
               (prior_.centre[c] - fit_.state.xi[c]);
    return b;
  }

  /// [L^T | L^-1 b] of the normal equations L L^T with the priors, damped by lambda; empty where
  /// they are not regular.
  Eigen::MatrixXd root(const Eigen::MatrixXd& H, const Eigen::VectorXd& b, double lambda) const {
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

  /// Least-squares step of a triangle, damped by lambda; spread to all columns.
  Eigen::VectorXd step(const Eigen::MatrixXd& of, double lambda) const {
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

  /// `v` with half its geodesic acceleration (Transtrum and Sethna), which bends the step along a
  /// curved valley of the residual; `v` alone where that is no small correction and so says little.
  Eigen::VectorXd with_geodesic_acceleration(const Eigen::VectorXd& v, double lambda) const {
    const NormalEquations at =
        by_factor_ ? equations_.normal_equations(fit_.state, weighting(), columns_) : products_;
    const Eigen::VectorXd b = equations_.geodesic_acceleration(fit_.state, weighting(), at, v);
    const Eigen::MatrixXd T = root(at.H, b, lambda);
    if (T.size() == 0) return v;
    const Eigen::VectorXd a = step(T, 0);
    return prior_length(a) < 0.75 * prior_length(v) ? Eigen::VectorXd(v + a / 2) : v;
  }

  /// Length of a step in units of the damping.
  double prior_length(const Eigen::VectorXd& s) const {
    return damping().cwiseProduct(s(columns_)).norm();
  }

  /// Scale of the damping: steps are held short against the priors, not against what the rows say,
  /// so that a long move along a curved valley of the residual stays possible.
  Eigen::VectorXd damping() const {
    Eigen::VectorXd D(static_cast<Eigen::Index>(columns_.size()));
    for (Eigen::Index i = 0; i < D.size(); ++i)
      D[i] = 1 / (columns_[i] < equations_.robot_columns() ? prior_.sigma[columns_[i]]
                                                           : kShortStep * units_[columns_[i]]);
    return D;
  }

  /// Length of a step in the posterior sigmas of a triangle.
  double whitened(const Eigen::MatrixXd& triangle, const Eigen::VectorXd& step) const {
    const Eigen::Index n = triangle.cols() - 1;
    Eigen::VectorXd s(n);
    for (Eigen::Index i = 0; i < n; ++i) s[i] = step[columns_[i]];
    return (triangle.topLeftCorner(n, n).triangularView<Eigen::Upper>() * s).norm();
  }

  void iterate() {
    const Eigen::MatrixXd Rz = triangle();
    ++fit_.iterations;
    const double free = std::sqrt(std::max<double>(1, static_cast<double>(columns_.size())));
    // How far the minimum is: the step without damping, which a short damped one does not tell.
    const Eigen::VectorXd whole = step(Rz, 0);
    if (!whole.allFinite()) return stop(false, "the system of equations is singular");
    const double distance = whitened(Rz, whole);
    int barred = 0;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      if (barred == kBarred && put_open_rows_aside()) return;
      const Eigen::VectorXd s =
          lambda_ > 0 ? with_geodesic_acceleration(step(Rz, lambda_), lambda_) : whole;
      if (take(stepped(s))) {
        lambda_ = lambda_ < 1e-3 ? 0 : lambda_ / 10;
        // A tenth of a sigma a parameter left: the geometry has settled for these weights.
        if (distance < 0.1 * free) settle(arrival(distance / free, whole));
        return;
      }
      barred += std::isinf(trial_cost_);
      if (distance < kNear * free)
        return settle("no step lowers the residual, and the minimum is within " +
                      format_number(kNear) + " sigma");
      lambda_ = lambda_ == 0 ? 1e-2 : lambda_ * 10;
    }
    stop(false, "no step lowers the residual");
  }

  /// Goes to `trial` if its cost is none the higher.
  bool take(State trial) {
    Linearised factor;
    NormalEquations products;
    if (by_factor_)
      factor = equations_.linearise(trial, weighting());
    else
      products = equations_.normal_equations(trial, weighting(), columns_);
    const double cost = (by_factor_ ? factor.cost : products.cost) + prior_cost(trial);
    trial_cost_ = cost;
    if (!(std::isfinite(cost) && cost <= cost_ * (1 + 1e-9) + 1e-9)) {
      tried_ = std::move((by_factor_ ? static_cast<Passed&>(factor) : products).norms);
      return false;
    }
    fit_.state = std::move(trial);
    factor_ = std::move(factor);
    products_ = std::move(products);
    cost_ = cost;
    return true;
  }

  /// One posture at the edge of what the robot reaches must not bar the way of all others: those
  /// rows whose loops the step before left open, where they are few. They come back with the next
  /// estimate of the noise that finds them closed.
  bool put_open_rows_aside() {
    std::vector<char> outlier = fit_.noise.outlier;
    const RowNorm* norm = tried_.data();
    double rows = 0, open = 0;
    for (int s = 0; s < static_cast<int>(equations_.data().sets.size()); ++s)
      for (const SetPlan::Item& item : equations_.plan(s).items) {
        ++rows;
        if (!std::isinf((norm++)->length) || outlier[item.row]) continue;
        outlier[item.row] = 1;
        ++open;
      }
    if (open == 0 || open > rule_.most_outliers * rows) return false;
    fit_.noise.outlier = std::move(outlier);
    lambda_ = 0;
    relinearise();
    return true;
  }

  /// Why a step of `distance` sigmas a parameter is the last one; nothing when it is not.
  std::optional<std::string> arrival(double distance, const Eigen::VectorXd& step) const {
    if (distance < rule_.step_tolerance)
      return "step below " + format_number(rule_.step_tolerance) + " sigma";
    if (step.cwiseQuotient(units_).norm() < kRounding) return "the step is down to rounding";
    return std::nullopt;
  }

  /// Re-estimates noise and rows put aside: one noise for all sets of a kind until the residuals
  /// agree with it, then each set's own, once; then the noise is kept. Iterated further, the set
  /// that happens to fit best would take the weight of all others. Ends when nothing changes and
  /// the iteration has arrived, for that reason.
  void settle(const std::optional<std::string>& arrived) {
    const double freedoms = freedom(covariance());
    const NoiseStage before = stage_;
    if (before == NoiseStage::robust)
      stage_ = NoiseStage::pooled;
    else if (agrees(freedoms))
      stage_ = NoiseStage::nuisance;
    const Noise noise = estimate_noise(equations_, at().norms, noise_rule(stage_, freedoms));
    const bool keep = before == NoiseStage::nuisance;
    const bool same_rows = noise.outlier == fit_.noise.outlier;
    const bool same_noise = before != NoiseStage::robust && (keep || change(noise) < 1e-3);
    if (arrived && same_rows && same_noise) {
      if (put_masked_outlier_aside()) return;
      return stop(true, *arrived);
    }
    if (keep && (same_rows || ++regroupings_ > kRegroupings)) return;
    if (!keep) fit_.noise.used = noise.used;
    fit_.noise.outlier = noise.outlier;
    fit_.noise.at_bound = noise.at_bound;
    relinearise();
  }

  /// The noise is found anew without it; it comes back where that finds it among the others.
  bool put_masked_outlier_aside() {
    if (!rule_.unmask) return false;
    const std::optional<int> row = masked_outlier(equations_, fit_.state, fit_.noise, prior_);
    if (!row || unmasked_.contains(*row)) return false;
    unmasked_.insert(*row);
    fit_.noise.outlier[static_cast<std::size_t>(*row)] = 1;
    stage_ = NoiseStage::pooled;
    relinearise();
    return true;
  }

  /// The residuals are as large as the noise that they are weighed with.
  bool agrees(double freedoms) const {
    const double ratio = at().cost / std::max(at().equations - freedoms, 1.0);
    return ratio > 0.8 && ratio < 1.25;
  }

  /// Largest relative change of a set's noise.
  double change(const Noise& noise) const {
    double largest = 0;
    for (size_t s = 0; s < noise.used.size(); ++s) {
      largest = std::max(largest, std::abs(noise.used[s].length / fit_.noise.used[s].length - 1));
      largest = std::max(largest, std::abs(noise.used[s].angle / fit_.noise.used[s].angle - 1));
    }
    return largest;
  }

  void stop(bool converged, std::string reason) {
    done_ = true;
    fit_.converged = converged;
    fit_.stop_reason = std::move(reason);
  }

  /// Freedoms that the rows determine: own ones, and of each parameter the share that is not the
  /// prior's.
  double freedom(const Eigen::MatrixXd& covariance) const {
    double sum = equations_.nuisance_columns();
    for (const int c : columns_)
      if (c < equations_.robot_columns())
        sum += 1 - covariance(c, c) * std::pow(prior_weight(equations_, prior_, c), 2);
    return sum;
  }

  /// (R^T R)^-1 (11.35, whitened), spread to all columns.
  Eigen::MatrixXd covariance() {
    const Eigen::MatrixXd Rz = triangle();
    const Eigen::Index n = Rz.cols() - 1;
    Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(equations_.columns(), equations_.columns());
    spread(columns_, columns_) = inverse_of_square(Rz.topLeftCorner(n, n));
    return spread;
  }

  const Equations& equations_;
  const Prior& prior_;
  const FitRule& rule_;
  std::vector<int> columns_;
  const Eigen::VectorXd units_;
  Fit fit_;
  bool by_factor_ = false;  ///< the normal equations would leave a direction to rounding
  Linearised factor_;
  NormalEquations products_;
  double cost_ = 0, lambda_ = 0, trial_cost_ = 0;
  std::vector<RowNorm> tried_;  ///< of the last step that was not taken
  NoiseStage stage_ = NoiseStage::robust;
  bool done_ = false;
  std::set<int> unmasked_;  ///< rows that were put aside as masked outliers
  int regroupings_ = 0;     ///< changes of the rows put aside since the noise is kept
};

}  // namespace

Fit fit(const Equations& equations, const State& start, const Prior& prior, const FitRule& rule,
        const OnIteration& on_iteration) {
  return Iteration(equations, start, prior, rule).run(on_iteration);
}

}  // namespace selfcal
