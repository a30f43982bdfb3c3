// What is free, how far the nominal robot is off, the fit and its doubts, the gauge, the priors'
// own test.
#include "constraints/estimation/adjustment.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "constraints/estimation/few_rows.h"
#include "constraints/estimation/shrinkage.h"
#include "constraints/identifiability/gauge.h"

namespace selfcal {
namespace {

constexpr int kOtherStarts = 4;
constexpr double kClearlyBetter = 6;  // of -2 log posterior

class Adjustment {
 public:
  Adjustment(const Equations& equations, const Options& options, const Progress& progress,
             const State* near)
      : robot_(equations.robot()),
        equations_(equations),
        options_(options),
        progress_(progress),
        near_(near) {
    adjusted_.prior.use = options.priors;
    adjusted_.prior.centre = nominal_values(robot_);
    adjusted_.prior.sigma.resize(adjusted_.prior.centre.size());
    for (Eigen::Index i = 0; i < adjusted_.prior.sigma.size(); ++i)
      adjusted_.prior.sigma[i] = tolerance(robot_.parameters()[i]);
    const auto effects = static_cast<Eigen::Index>(options.effect_sigma.size());
    adjusted_.prior.sigma.tail(effects) =
        Eigen::Map<const Eigen::VectorXd>(options.effect_sigma.data(), effects);
    choose_free();
    few_ = few_of(equations.data());
    if (few_) few_equations_.emplace(robot_, *few_, Use::fit);
  }

  Adjusted run() {
    State start{starting_values(), {}, {}};
    if (near_) {
      start.xi.head(near_->xi.size()) = near_->xi;
      start.nuisance = near_->nuisance;
      start.groups = near_->groups;
    } else {
      equations_.start(start);
    }
    adjusted_.before = fit_placed(start);
    if (!near_) place_from_afar(start);
    start_ = start;
    hold_scale(quietest() * adjusted_.before.at.R, adjusted_.before.state.xi);
    adjusted_.before.at = {};
    adjusted_.fitted = fit_all();
    multi_start();
    find_balls_again();
    if (hold_scale(adjusted_.fitted.at.R, adjusted_.fitted.state.xi)) adjusted_.fitted = fit_all();
    widen_priors();
    place_scale();
    if (adjusted_.scale < 0 && options_.priors)
      adjusted_.fitted =
          without_shrinkage(equations_, adjusted_.prior, std::move(adjusted_.fitted));
    return std::move(adjusted_);
  }

 private:
  const std::vector<Parameter>& parameters() const { return robot_.parameters(); }

  double tolerance(const Parameter& p) const {
    return options_.gear_sigma > 0 && p.part == Part::gear
               ? options_.gear_sigma * std::abs(p.nominal)
               : p.tolerance;
  }

  void choose_free() {
    for (const Parameter& p : parameters())
      adjusted_.prior.free.push_back(p.free || (options_.gears && p.part == Part::gear));
    for (const std::string& name : options_.free)
      for (const int i : match_parameters(robot_, name)) adjusted_.prior.free[i] = 1;
    for (const std::string& name : options_.fix)
      for (const int i : match_parameters(robot_, name)) adjusted_.prior.free[i] = 0;
    for (size_t i = 0; i < parameters().size(); ++i)
      if (!(parameters()[i].tolerance > 0)) adjusted_.prior.free[i] = 0;  // exact
    adjusted_.candidate = adjusted_.prior.free;
    for (const Note& note : held_base(robot_, equations_)) hold(note);
    for (const Note& note : held_orientation(robot_, equations_)) hold(note);
  }

  void hold(const Note& note) {
    const int i = find_parameter(robot_, note.parameter);
    if (!adjusted_.prior.free[i]) return;
    adjusted_.prior.free[i] = 0;
    adjusted_.gauge.push_back(note);
  }

  /// Maker's figures for what is free, the model's own values for the rest.
  Eigen::VectorXd starting_values() const {
    Eigen::VectorXd xi = values(robot_);
    for (size_t i = 0; i < adjusted_.prior.free.size(); ++i)
      if (adjusted_.prior.free[i]) xi[static_cast<Eigen::Index>(i)] = adjusted_.prior.centre[i];
    return xi;
  }

  Fit run_fit(const State& start, const Prior& prior, std::string_view stage) {
    FitRule rule;
    rule.unmask = true;
    rule.most_iterations = options_.most_iterations;
    return run_fit(start, prior, rule, stage);
  }

  Fit run_fit(const State& start, const Prior& prior, FitRule rule, std::string_view stage) {
    rule.most_outliers = options_.most_outliers;
    const auto on_iteration = [&](int iteration) {
      if (progress_) progress_(stage, 1 - std::exp(-iteration / 8.0));
    };
    State from = start;
    if (few_equations_) {
      Fit few = fit(*few_equations_, start, prior, rule, on_iteration);
      rule.near = few.converged;
      if (few.converged) from = std::move(few.state);
    }
    return fit(equations_, from, prior, rule, on_iteration);
  }

  /// Base, tool and the sets' nuisance parameters alone: the robot as its maker says.
  Fit fit_placed(const State& start) {
    Prior prior = adjusted_.prior;
    for (size_t i = 0; i < parameters().size(); ++i)
      prior.free[i] = adjusted_.prior.free[i] && is_placed(parameters()[i]);
    FitRule rule;  // what the nominal robot's errors leave is no noise to tell a false row by
    rule.most_iterations = near_ ? 0 : options_.most_iterations;
    return run_fit(start, prior, rule, "placing the nominal robot");
  }

  /// A robot that stands far from what it touches may be placed on its wrong side: it is placed
  /// again from where it comes near, and all goes on from the better place.
  void place_from_afar(State& start) {
    State far = start;
    for (std::size_t s = 0; s < far.nuisance.size(); ++s)
      if (far.nuisance[s].size() > 0)
        far.nuisance[s] = equations_.data().sets[s].method->from_afar(far.nuisance[s]);
    if (far.nuisance == start.nuisance) return;
    State near = fit_placed(far).state;
    equations_.start(near);
    Fit placed = fit_placed(near);
    if (placed.converged && placed.objective < adjusted_.before.objective - kClearlyBetter)
      adjusted_.before = std::move(placed);
    start = adjusted_.before.state;
  }

  Fit fit_all() { return run_fit(start_, adjusted_.prior, "identifying"); }

  /// A fit that strains the maker's tolerances, or does not converge, may sit in a wrong minimum:
  /// it is tried from the placed robot and from robots drawn from the tolerances, and the most
  /// probable one is kept. `near` has been found so.
  void multi_start() {
    const bool strained = widening(moved()) > 1;
    if (near_ || !options_.priors || (adjusted_.fitted.converged && !strained)) return;
    std::mt19937_64 random(options_.seed);
    std::normal_distribution<double> normal;
    State best_start = start_;
    for (int attempt = 0; attempt < kOtherStarts; ++attempt) {
      State other = attempt == 0 ? adjusted_.before.state : start_;
      for (size_t i = 0; attempt > 0 && i < adjusted_.prior.free.size(); ++i)
        if (adjusted_.prior.free[i])
          other.xi[static_cast<Eigen::Index>(i)] +=
              (parameters()[i].part == Part::effect ? 0 : parameters()[i].tolerance) *
              normal(random);
      if (attempt > 0) equations_.start(other);
      const Fit tried = run_fit(other, adjusted_.prior, "identifying from another start");
      const bool better = tried.objective < adjusted_.fitted.objective - kClearlyBetter;
      if (!tried.converged || (adjusted_.fitted.converged && !better)) continue;
      adjusted_.fitted = tried;
      best_start = other;
    }
    start_ = best_start;
  }

  /// Balls were sought by the robot as it is thought to be; by the one that is found, those that
  /// are touched a few times may lie on the other side of their touches.
  void find_balls_again() {
    const auto is_curved = [&](std::size_t s) {
      return equations_.data().sets[s].method->touches() == TouchedSurface::curved &&
             !equations_.plan(static_cast<int>(s)).items.empty();
    };
    bool any = false;
    for (std::size_t s = 0; s < equations_.data().sets.size(); ++s) any = any || is_curved(s);
    if (near_ || !any) return;
    State found = adjusted_.fitted.state, again = found;
    equations_.start(again);
    for (std::size_t s = 0; s < found.nuisance.size(); ++s)
      if (is_curved(s)) found.nuisance[s] = again.nuisance[s];
    Fit tried = run_fit(found, adjusted_.prior, "identifying again");
    if (tried.converged && tried.objective < adjusted_.fitted.objective - kClearlyBetter)
      adjusted_.fitted = std::move(tried);
  }

  /// How much more the rows could weigh than in the placed fit, were their noise the least that it
  /// can be.
  double quietest() const {
    const Scale least = least_noise(robot_);
    double most = 1;
    for (size_t s = 0; s < equations_.data().sets.size(); ++s) {
      if (equations_.plan(static_cast<int>(s)).items.empty()) continue;
      const Method& method = *equations_.data().sets[s].method;
      const Scale& stated = equations_.stated(static_cast<int>(s));
      const Scale& used = adjusted_.before.noise.used[s];
      if (method.has_lengths())
        most = std::max(most, used.length / std::max(stated.length, least.length));
      if (method.has_angles())
        most = std::max(most, used.angle / std::max(stated.angle, least.angle));
    }
    return most;
  }

  /// Holds a length where R says that the scale is free. Asked before the first fit, too: a robot
  /// that may shrink takes many iterations to do so, the more the more rows there are.
  bool hold_scale(const Eigen::MatrixXd& R, const Eigen::VectorXd& xi) {
    const std::optional<int> length = held_scale(equations_, R, xi, adjusted_.prior.free);
    if (!length) return false;
    adjusted_.scale = *length;
    start_.xi[*length] = adjusted_.prior.centre[*length];
    hold({parameters()[*length].name, why_scale_is_held(robot_)});
    return true;
  }

  Chi2 moved() const {
    return prior_chi2(robot_, adjusted_.prior, adjusted_.fitted.state.xi,
                      adjusted_.fitted.covariance.diagonal());
  }

  /// One factor for the robot's own priors when their chi-square says that they are too narrow: the
  /// one that makes it one a degree of freedom. Not repeated: touches of a small patch would run
  /// away.
  void widen_priors() {
    adjusted_.chi2 = moved();
    if (options_.priors) adjusted_.widening = widening(adjusted_.chi2);
    adjusted_.priors_fail = adjusted_.widening > 1;
    if (!adjusted_.priors_fail) return;
    for (size_t i = 0; i < parameters().size(); ++i)
      if (is_own(parameters()[i]))
        adjusted_.prior.sigma[i] = adjusted_.widening * tolerance(parameters()[i]);
    adjusted_.fitted =
        run_fit(adjusted_.fitted.state, adjusted_.prior, "identifying with wider priors");
  }

  /// Puts the length that is held for the scale where the maker's figures together have it: along
  /// the direction in which rows and unknowns follow it, their priors alone speak,
  ///   e = - sum (x - centre) f / sigma^2 / sum f^2 / sigma^2,   sigma_e^2 = 1 / sum f^2 / sigma^2,
  /// with f the change of x for one of the length.
  void place_scale() {
    if (adjusted_.scale < 0) return;
    adjusted_.scale_sigma = adjusted_.prior.sigma[adjusted_.scale];
    if (!options_.priors) return;
    const Fit& fitted = adjusted_.fitted;
    Eigen::VectorXd follow =
        -fitted.covariance *
        (fitted.at.R.leftCols(equations_.columns()).transpose() * fitted.at.R.col(adjusted_.scale));
    follow[adjusted_.scale] = 1;
    double pull = 0, precision = 0;
    for (size_t i = 0; i < parameters().size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      if (at != adjusted_.scale && (!adjusted_.prior.free[i] || !is_own(parameters()[i]))) continue;
      const double sigma = adjusted_.prior.sigma[at];
      pull -= (fitted.state.xi[at] - adjusted_.prior.centre[at]) * follow[at] / (sigma * sigma);
      precision += std::pow(follow[at] / sigma, 2);
    }
    adjusted_.scale_sigma = 1 / std::sqrt(precision);
    State start = fitted.state;
    start.xi[adjusted_.scale] += pull / precision;
    adjusted_.fitted = run_fit(start, adjusted_.prior, "placing the scale");
  }

  const Robot& robot_;
  const Equations& equations_;
  const Options& options_;
  const Progress& progress_;
  const State* near_;
  Adjusted adjusted_;
  State start_;
  std::optional<DataSet> few_;
  std::optional<Equations> few_equations_;
};

}  // namespace

bool is_placed(const Parameter& p) { return p.part == Part::base || p.part == Part::tool; }

Adjusted adjust(const Equations& equations, const Options& options, const Progress& progress,
                const State* near) {
  if (near) {
    Adjusted adjusted = Adjustment(equations, options, progress, near).run();
    if (adjusted.fitted.converged) return adjusted;
  }
  return Adjustment(equations, options, progress, nullptr).run();
}

}  // namespace selfcal
