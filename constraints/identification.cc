// The whole identification, in the order in which a person would check it: what is free, how far
// the nominal robot is off, the fit, the gauge, the priors' own test, the rank, the judge.
#include "constraints/identification.h"

#include <algorithm>
#include <cmath>

#include "constraints/endpoint_sigma.h"
#include "constraints/excitation.h"
#include "constraints/fit.h"
#include "constraints/gauge.h"
#include "constraints/identifiability.h"
#include "constraints/judgement.h"
#include "constraints/observability.h"
#include "constraints/results.h"
#include "constraints/statistics.h"

namespace selfcal {
namespace {

constexpr double kPriorTest = 0.01;  // probability under which the priors are widened

bool is_placed(const Parameter& p) { return p.part == Part::base || p.part == Part::tool; }

class Identification {
 public:
  Identification(const Robot& robot, const DataSet& data, const Options& options,
                 const Progress& progress)
      : robot_(robot),
        data_(data),
        options_(options),
        progress_(progress),
        equations_(robot, data, Use::fit) {
    prior_.use = options.priors;
    prior_.centre = nominal_values(robot);
    prior_.sigma.resize(prior_.centre.size());
    for (Eigen::Index i = 0; i < prior_.sigma.size(); ++i)
      prior_.sigma[i] = robot.parameters()[i].tolerance;
    choose_free();
  }

  Solution run() {
    State start{starting_values(), {}, {}};
    equations_.start(start);
    before_ = fit_placed(start);
    start_ = start;
    fitted_ = fit_all();
    hold_scale();
    widen_priors();
    return assemble();
  }

 private:
  const std::vector<Parameter>& parameters() const { return robot_.parameters(); }

  void choose_free() {
    for (const Parameter& p : parameters()) prior_.free.push_back(p.free);
    for (const std::string& name : options_.free)
      for (const int i : match_parameters(robot_, name)) prior_.free[i] = 1;
    for (const std::string& name : options_.fix)
      for (const int i : match_parameters(robot_, name)) prior_.free[i] = 0;
    candidate_ = prior_.free;
    for (const Note& note : held_base(robot_, equations_)) hold(note);
  }

  void hold(const Note& note) {
    const int i = find_parameter(robot_, note.parameter);
    if (!prior_.free[i]) return;
    prior_.free[i] = 0;
    gauge_.push_back(note);
  }

  /// Maker's figures for what is free, the model's own values for the rest.
  Eigen::VectorXd starting_values() const {
    Eigen::VectorXd xi = values(robot_);
    for (size_t i = 0; i < prior_.free.size(); ++i)
      if (prior_.free[i] || !candidate_[i]) xi[i] = candidate_[i] ? prior_.centre[i] : xi[i];
    return xi;
  }

  Fit run_fit(const State& start, const Prior& prior, std::string_view stage) {
    FitRule rule;
    rule.most_iterations = options_.most_iterations;
    rule.most_rejected = options_.most_rejected;
    return fit(equations_, start, prior, rule, [&](int iteration) {
      if (progress_) progress_(stage, 1 - std::exp(-iteration / 8.0));
    });
  }

  /// Base, tool and the sets' own unknowns alone: the robot as its maker says.
  Fit fit_placed(const State& start) {
    Prior prior = prior_;
    for (size_t i = 0; i < parameters().size(); ++i)
      prior.free[i] = prior_.free[i] && is_placed(parameters()[i]);
    return run_fit(start, prior, "placing the nominal robot");
  }

  Fit fit_all() { return run_fit(start_, prior_, "identifying"); }

  void hold_scale() {
    const std::vector<Note> notes = held_scale(equations_, fitted_.at.R, prior_.free);
    if (notes.empty()) return;
    for (const Note& note : notes) {
      scale_ = find_parameter(robot_, note.parameter);
      hold(note);
    }
    fitted_ = fit_all();
  }

  struct Chi2 {
    double value = 0, freedom = 0;
  };
  /// Squares of the moves over the maker's tolerances, and how many of them the rows determine.
  Chi2 prior_chi2() const {
    Chi2 chi2;
    for (size_t i = 0; i < parameters().size(); ++i) {
      const Parameter& p = parameters()[i];
      if (!prior_.free[i] || is_placed(p)) continue;
      chi2.value += std::pow((fitted_.state.xi[i] - p.nominal) / p.tolerance, 2);
      chi2.freedom += 1 - fitted_.covariance(i, i) / std::pow(prior_.sigma[i], 2);
    }
    return chi2;
  }

  /// One factor for the robot's own priors when their chi-square says that they are too narrow: the
  /// one that makes it one a degree of freedom. Not repeated: touches of a small patch would run
  /// away.
  void widen_priors() {
    chi2_ = prior_chi2();
    if (!options_.priors || chi2_.freedom < 0.5) return;
    priors_fail_ = chi_square_exceeds(chi2_.value, chi2_.freedom) < kPriorTest;
    if (!priors_fail_) return;
    widening_ = std::sqrt(chi2_.value / chi2_.freedom);
    for (size_t i = 0; i < parameters().size(); ++i)
      if (!is_placed(parameters()[i])) prior_.sigma[i] = widening_ * parameters()[i].tolerance;
    fitted_ = run_fit(fitted_.state, prior_, "identifying with wider priors");
  }

  /// Posterior of every parameter, with the prior of the length held for the scale carried along.
  Eigen::MatrixXd covariance(const Eigen::MatrixXd& R) const {
    Eigen::MatrixXd C = fitted_.covariance;
    if (scale_ >= 0) {
      const auto columns = R.leftCols(equations_.columns());
      Eigen::VectorXd follow = -C * (columns.transpose() * R.col(scale_));
      follow[scale_] = 1;
      C += prior_.sigma[scale_] * prior_.sigma[scale_] * follow * follow.transpose();
    }
    return C;
  }

  Solution assemble();
  void add_warnings(Solution& solution) const;

  const Robot& robot_;
  const DataSet& data_;
  const Options& options_;
  const Progress& progress_;
  Equations equations_;
  Prior prior_;
  std::vector<char> candidate_;  ///< not fixed by the user or by default
  std::vector<Note> gauge_;
  int scale_ = -1;  ///< parameter held for the scale
  State start_;
  Fit before_, fitted_;
  Chi2 chi2_;
  bool priors_fail_ = false;
  double widening_ = 1;
};

Solution Identification::assemble() {
  if (progress_) progress_("judging", 0.9);
  Solution solution;
  solution.converged = fitted_.converged;
  solution.stop_reason = fitted_.stop_reason;
  solution.iterations = fitted_.iterations;
  solution.values = fitted_.state.xi;
  solution.gauge = gauge_;
  solution.prior_chi2 = chi2_.value;
  solution.prior_dof = chi2_.freedom;
  solution.prior_widening = widening_;

  const Weighting weighting{fitted_.noise.used, fitted_.noise.put_aside};
  const Eigen::MatrixXd R = equations_.linearise(fitted_.state, weighting, true).R;
  const Eigen::MatrixXd C = covariance(R);
  const Identifiability rank = identifiability(equations_, R, prior_.free, {});
  solution.parameters =
      parameter_results(robot_, fitted_.state.xi, C, rank, candidate_, prior_.free);
  std::tie(solution.covariance_order, solution.covariance) =
      covariance_result(solution.parameters, C);
  solution.observability = identified_observability(equations_, R, rank, fitted_.noise);
  solution.unexcited = unexcited(robot_, data_, rank, candidate_);

  const Judged before = judge(robot_, data_, equations_, before_);
  const Judged after = judge(robot_, data_, equations_, fitted_);
  solution.residual = residual_figures(data_, before, after, fitted_.noise.put_aside);
  solution.rejected = rejected_rows(data_, after, fitted_.noise.put_aside);
  solution.sets = set_results(equations_, fitted_, C, after);

  EndpointQuestion question;
  question.robot = &robot_;
  question.xi = fitted_.state.xi;
  question.covariance = C.topLeftCorner(equations_.robot_columns(), equations_.robot_columns());
  question.unseen = unseen_motions(equations_, R);
  question.point_unknown = point_is_unknown(equations_);
  question.data = &data_.rows;
  question.seed = options_.seed;
  solution.endpoint = endpoint_sigma(question);
  solution.verdict = verdict(before, after, solution.residual, solution.endpoint, data_.target,
                             fitted_.converged, !priors_fail_);
  add_warnings(solution);
  if (progress_) progress_("done", 1);
  return solution;
}

void Identification::add_warnings(Solution& solution) const {
  if (widening_ != 1)
    solution.warnings.push_back(
        "the robot differs from the maker's figures more than their tolerances allow (chi2 " +
        format_number(std::round(chi2_.value)) + " for " +
        format_number(std::round(chi2_.freedom)) + " degrees of freedom): priors widened by " +
        format_number(std::round(widening_ * 100) / 100));
  for (const ParameterResult& each : solution.parameters) {
    const double moved = std::abs(each.value - each.parameter.nominal) / each.parameter.tolerance;
    if (moved > 4 && each.status != Status::fixed)
      solution.warnings.push_back(each.parameter.name + " (" + each.parameter.frame + "." +
                                  each.parameter.field + ") moved by " +
                                  format_number(std::round(moved * 10) / 10) + " tolerances");
  }
  add_set_warnings(data_, fitted_, solution);
}

Solution without_rows(const Robot& robot) {
  Solution solution;
  solution.stop_reason = "no rows to identify from";
  solution.verdict.why = solution.stop_reason;
  solution.values = values(robot);
  return solution;
}

}  // namespace

std::string_view to_string(Status status) {
  switch (status) {
    case Status::identified:
      return "identified";
    case Status::grouped:
      return "grouped";
    case Status::no_effect:
      return "no-effect";
    case Status::held:
      return "held";
    case Status::fixed:
      return "fixed";
  }
  return "";
}

std::string_view to_string(Answer answer) {
  switch (answer) {
    case Answer::improved:
      return "improved";
    case Answer::not_improved:
      return "not-improved";
    case Answer::not_determined:
      return "not-determined";
  }
  return "";
}

Solution identify(const Robot& robot, const DataSet& data, const Options& options,
                  const Progress& progress) {
  const auto& check = data.rows.check;
  if (std::count(check.begin(), check.end(), char{0}) == 0) return without_rows(robot);
  return Identification(robot, data, options, progress).run();
}

}  // namespace selfcal
