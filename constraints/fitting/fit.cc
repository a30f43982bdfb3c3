// Iterative pseudo-inverse with damping behind it (Khalil and Dombre 11.31, 11.32, 11.4.3): the
// steps of a FitSystem, without damping unless one failed to lower the cost.
#include "constraints/fitting/fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "constraints/fitting/fit_system.h"
#include "constraints/fitting/fitted_freedoms.h"
#include "constraints/fitting/masked_outlier.h"
#include "kinematics/description.h"

namespace selfcal {
namespace {

/// Changes of the rows put aside, the noise being kept, until these are kept, too: a row may be far
/// without itself and near with itself.
constexpr int kRegroupings = 20;
constexpr int kAttempts = 14;        ///< dampings tried before an iteration gives up
constexpr int kBarred = 3;           ///< of them barred by a loop that does not close
constexpr double kRounding = 1e-13;  ///< a step this short (of the robot's size, or rad) is nothing
constexpr double kNear = 1e-3;       ///< sigmas a parameter: where only rounding may be left

/// What the noise is estimated from; it only goes forward.
enum class NoiseStage {
  robust,    ///< medians of all rows, one noise for all sets of a kind: the geometry still moves
  pooled,    ///< far rows put aside, one noise for all sets of a kind
  nuisance,  ///< far rows put aside, each set's own, which is then kept
};

class Iteration {
 public:
  Iteration(const Equations& equations, const State& start, const Prior& prior, const FitRule& rule)
      : equations_(equations),
        prior_(prior),
        rule_(rule),
        stage_(rule.near ? NoiseStage::pooled : NoiseStage::robust),
        noise_(estimate_noise(equations, equations.norms(start), noise_rule(stage_))),
        system_(equations, prior, start, weighting()) {}

  Fit run(const OnIteration& on_iteration) {
    while (!done_ && fit_.iterations < rule_.most_iterations) {
      iterate();
      if (on_iteration) on_iteration(fit_.iterations);
    }
    if (!done_)
      fit_.stop_reason =
          "no convergence within " + std::to_string(rule_.most_iterations) + " iterations";
    system_.use_factor();
    fit_.covariance = system_.covariance();
    fit_.objective = system_.cost();
    fit_.state = system_.state();
    fit_.at = system_.take_factor();
    count_rows();
    of_lengths_.clear();
    NoiseRule told = noise_rule(stage_, fit_.covariance);
    told.pool = false;  // each set's own
    noise_.estimated = estimate_noise(equations_, fit_.at.norms, told).estimated;
    fit_.noise = std::move(noise_);
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
          items, [&](const auto& item) { return !noise_.outlier[item.row]; }));
      for (const Quantity quantity : equations_.data().sets[s].method->equations())
        if (used > 0) fit_.objective += 2 * used * std::log(noise_.used[s].of(quantity));
    }
  }

  NoiseRule noise_rule(NoiseStage stage) const {
    NoiseRule rule;
    rule.most_outliers = rule_.most_outliers;
    rule.reject = stage != NoiseStage::robust;
    rule.pool = stage != NoiseStage::nuisance;
    return rule;
  }
  NoiseRule noise_rule(NoiseStage stage, const Eigen::MatrixXd& covariance) {
    NoiseRule rule = noise_rule(stage);
    rule.global_freedom = freedom(covariance);
    const FittedFreedoms fitted{equations_, system_.state(), system_.columns(), noise_, covariance};
    rule.fitted = of_small_sets(fitted, rule.global_freedom);
    most_fitted_.resize(rule.fitted.size(), 0);
    for (std::size_t s = 0; s < most_fitted_.size(); ++s)
      most_fitted_[s] = std::max(most_fitted_[s], rule.fitted[s]);
    rule.most_fitted = most_fitted_;
    if (stage != NoiseStage::nuisance) return rule;
    if (of_lengths_.empty())
      for (int s = 0; s < static_cast<int>(equations_.data().sets.size()); ++s)
        of_lengths_.push_back(part_of_lengths(fitted, s));
    rule.of_lengths = of_lengths_;
    return rule;
  }

  Weighting weighting() const { return {noise_.used, noise_.outlier}; }

  void iterate() {
    const Eigen::MatrixXd Rz = system_.triangle();
    ++fit_.iterations;
    const double free =
        std::sqrt(std::max<double>(1, static_cast<double>(system_.columns().size())));
    // How far the minimum is: the step without damping, which a short damped one does not tell.
    const Eigen::VectorXd whole = system_.step(Rz, 0);
    if (!whole.allFinite()) return stop(false, "the system of equations is singular");
    const double distance = system_.whitened(Rz, whole);
    int barred = 0;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      if (barred == kBarred && put_open_rows_aside()) return;
      const Eigen::VectorXd s =
          lambda_ > 0 ? system_.with_geodesic_acceleration(system_.step(Rz, lambda_), lambda_)
                      : whole;
      if (system_.go(s)) {
        lambda_ = lambda_ < 1e-3 ? 0 : lambda_ / 10;
        // A tenth of a sigma a parameter left: the geometry has settled for these weights.
        if (distance < 0.1 * free) settle(arrival(distance / free, whole));
        return;
      }
      barred += std::isinf(system_.tried().cost);
      if (distance < kNear * free)
        return settle("no step lowers the residual, and the minimum is within " +
                      format_number(kNear) + " sigma");
      lambda_ = lambda_ == 0 ? 1e-2 : lambda_ * 10;
    }
    stop(false, "no step lowers the residual");
  }

  /// One posture at the edge of what the robot reaches must not bar the way of all others: those
  /// rows whose loops the step before left open, where they are few. They come back with the next
  /// estimate of the noise that finds them closed.
  bool put_open_rows_aside() {
    std::vector<char> outlier = noise_.outlier;
    const RowNorm* norm = system_.tried().norms.data();
    double rows = 0, open = 0;
    for (int s = 0; s < static_cast<int>(equations_.data().sets.size()); ++s)
      for (const SetPlan::Item& item : equations_.plan(s).items) {
        ++rows;
        if (!std::isinf((norm++)->length) || outlier[item.row]) continue;
        outlier[item.row] = 1;
        ++open;
      }
    if (open == 0 || open > rule_.most_outliers * rows) return false;
    noise_.outlier = std::move(outlier);
    lambda_ = 0;
    system_.weigh(weighting());
    return true;
  }

  /// Why a step of `distance` sigmas a parameter is the last one; nothing when it is not.
  std::optional<std::string> arrival(double distance, const Eigen::VectorXd& step) const {
    if (distance < rule_.step_tolerance)
      return "step below " + format_number(rule_.step_tolerance) + " sigma";
    if (system_.in_units(step) < kRounding) return "the step is down to rounding";
    return std::nullopt;
  }

  /// Re-estimates noise and rows put aside: one noise for all sets of a kind until the residuals
  /// agree with it, then each set's own, once; then the noise is kept. Iterated further, the set
  /// that happens to fit best would take the weight of all others. Ends when nothing changes and
  /// the iteration has arrived, for that reason.
  void settle(const std::optional<std::string>& arrived) {
    const Eigen::MatrixXd covariance = system_.covariance();
    const NoiseStage before = stage_;
    if (before == NoiseStage::robust)
      stage_ = NoiseStage::pooled;
    else if (agrees(freedom(covariance)))
      stage_ = NoiseStage::nuisance;
    const Noise noise =
        estimate_noise(equations_, system_.passed().norms, noise_rule(stage_, covariance));
    const bool keep = before == NoiseStage::nuisance;
    const bool same_rows =
        noise.outlier == noise_.outlier || (keep && regroupings_ == kRegroupings);
    const bool same_noise = before != NoiseStage::robust && (keep || change(noise) < 1e-3);
    if (arrived && same_rows && same_noise) {
      if (put_masked_outliers_aside()) return;
      return stop(true, *arrived);
    }
    if (keep && same_rows) return;
    if (keep)
      ++regroupings_;
    else
      noise_.used = noise.used;
    noise_.outlier = noise.outlier;
    noise_.at_bound = noise.at_bound;
    system_.weigh(weighting());
  }

  /// The noise is found anew without them; those come back that it finds among the others.
  bool put_masked_outliers_aside() {
    if (!rule_.unmask) return false;
    std::vector<int> rows =
        masked_outliers(equations_, system_.state(), noise_, prior_, rule_.most_outliers);
    std::erase_if(rows, [&](int row) { return unmasked_.contains(row); });
    if (rows.empty()) return false;
    for (const int row : rows) {
      unmasked_.insert(row);
      noise_.outlier[static_cast<std::size_t>(row)] = 1;
    }
    stage_ = NoiseStage::pooled;
    system_.weigh(weighting());
    return true;
  }

  /// The residuals are as large as the noise that they are weighed with.
  bool agrees(double freedoms) const {
    const double of_groups = equations_.nuisance_dimensions() - equations_.nuisance_columns();
    const double ratio =
        system_.passed().cost / std::max(system_.passed().equations - freedoms - of_groups, 1.0);
    return ratio > 0.8 && ratio < 1.25;
  }

  /// Largest relative change of a set's noise.
  double change(const Noise& noise) const {
    double largest = 0;
    for (size_t s = 0; s < noise.used.size(); ++s) {
      largest = std::max(largest, std::abs(noise.used[s].length / noise_.used[s].length - 1));
      largest = std::max(largest, std::abs(noise.used[s].angle / noise_.used[s].angle - 1));
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
    for (const int c : system_.columns())
      if (c < equations_.robot_columns())
        sum += 1 - covariance(c, c) * std::pow(prior_weight(equations_, prior_, c), 2);
    return sum;
  }

  const Equations& equations_;
  const Prior& prior_;
  const FitRule& rule_;
  NoiseStage stage_;
  Noise noise_;
  FitSystem system_;
  Fit fit_;
  double lambda_ = 0;
  bool done_ = false;
  /// By set, its part_of_lengths() where the geometry had settled; the end takes it anew.
  std::vector<double> of_lengths_;
  std::vector<double> most_fitted_;  ///< by set, of of_small_sets() so far
  std::set<int> unmasked_;           ///< rows that were put aside as masked outliers
  int regroupings_ = 0;              ///< changes of the rows put aside since the noise is kept
};

}  // namespace

Fit fit(const Equations& equations, const State& start, const Prior& prior, const FitRule& rule,
        const OnIteration& on_iteration) {
  return Iteration(equations, start, prior, rule).run(on_iteration);
}

}  // namespace selfcal
