// The whole identification: the adjustment, then what is told of it: rank, certainty, the judge.
#include "constraints/estimation/identification.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "constraints/estimation/adjustment.h"
#include "constraints/estimation/angles.h"
#include "constraints/estimation/covariance_sources.h"
#include "constraints/estimation/frame_step.h"
#include "constraints/estimation/judgement.h"
#include "constraints/estimation/lock_slip.h"
#include "constraints/estimation/prediction.h"
#include "constraints/estimation/results.h"
#include "constraints/estimation/robot_scale.h"
#include "constraints/estimation/uncertainty.h"
#include "constraints/identifiability/endpoint_sigma.h"
#include "constraints/identifiability/excitation.h"
#include "constraints/identifiability/gauge.h"
#include "constraints/identifiability/identifiability.h"
#include "constraints/sampling/random_poses.h"
#include "constraints/sampling/workspace_poses.h"
#include "constraints/statistics.h"
#include "kinematics/expects.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kPoses = 500;           ///< at which the end position is judged
constexpr double kMostStrays = 0.01;  ///< of the robot's size, from its best geometry: no robot's

/// The rows say something of the robot, but nothing against its maker's figures: the moves stay
/// within the tolerances, and the fitted rows are no better than the extra parameters explain (F
/// test), both at 99 %.
bool nominal_explains(const Adjusted& adjusted, const Identifiability& rank, const Figures& fit) {
  const double extra = adjusted.chi2.freedom;
  const double left = adjusted.fitted.at.equations - 2 * extra;
  if (adjusted.priors_fail || rank.total() == 0 || extra < 0.5 || left < 1) return false;
  const double after = std::pow(fit.rms_after, 2);
  const double gain = std::pow(fit.rms_before, 2) - after;
  if (gain <= 0 || after <= 0) return gain <= 0;  // nothing left is no noise to compare with
  return f_exceeds(gain / extra / (after / left), extra, left) > 0.01;
}

/// All rows that identify, two and more, are repeats of one configuration.
bool at_one_configuration(const Observations& rows) {
  if (rows.repeat.empty()) return false;
  const std::vector<int> configuration = configurations(rows);
  int one = -1, count = 0;
  for (int row = 0; row < rows.rows(); ++row) {
    if (rows.check[static_cast<size_t>(row)]) continue;
    const int own = configuration[static_cast<size_t>(row)];
    if (count++ > 0 && own != one) return false;
    one = own;
  }
  return count > 1;
}

/// Most `poses` (a row each) have a joint beyond its least or its most reading of the rows that
/// identify.
bool lie_beyond(const Observations& rows, const Eigen::MatrixXd& poses) {
  Eigen::RowVectorXd least = Eigen::RowVectorXd::Constant(poses.cols(), INFINITY), most = -least;
  for (Eigen::Index row = 0; row < rows.q.rows(); ++row)
    if (rows.check[static_cast<std::size_t>(row)] == 0) {
      least = least.cwiseMin(rows.q.row(row));
      most = most.cwiseMax(rows.q.row(row));
    }
  Eigen::Index within = 0;
  for (const auto& pose : poses.rowwise())
    within += (pose.array() >= least.array()).all() && (pose.array() <= most.array()).all();
  return 2 * within < poses.rows();
}

bool nothing_free(const Adjusted& adjusted) {
  const std::vector<char>& free = adjusted.prior.free;
  return std::find(free.begin(), free.end(), char{1}) == free.end();
}

EndpointQuestion endpoint_question(const Equations& equations, const Adjusted& adjusted,
                                   const Eigen::MatrixXd& R, unsigned long long seed) {
  EndpointQuestion question;
  question.robot = &equations.robot();
  question.xi = adjusted.fitted.state.xi;
  question.unseen = unseen_motions(equations, R);
  question.point_unknown = point_is_unknown(equations);
  question.poses =
      closing_poses(equations.robot(), question.xi,
                    random_poses(equations.robot(), &equations.data().rows, kPoses, seed));
  return question;
}

/// What the fit itself tells.
Solution fit_figures(const Adjusted& adjusted) {
  const Fit& fitted = adjusted.fitted;
  Solution solution;
  solution.converged = fitted.converged;
  solution.stop_reason = fitted.stop_reason;
  solution.iterations = fitted.iterations;
  solution.values = fitted.state.xi;
  solution.gauge = adjusted.gauge;
  solution.prior_chi2 = adjusted.chi2.value;
  solution.prior_dof = adjusted.chi2.freedom;
  solution.prior_widening = adjusted.widening;
  return solution;
}

/// The posterior of every parameter: rank, sigma, covariance. `R` is whitened, with the columns
/// beside the unknowns.
Identifiability add_posterior(const Equations& equations, const Adjusted& adjusted,
                              const Eigen::MatrixXd& R, const Eigen::MatrixXd& C,
                              Solution& solution) {
  const Fit& fitted = adjusted.fitted;
  const Robot& robot = equations.robot();
  Identifiability rank = identifiability(equations, R, fitted.state, adjusted.prior.free, {});
  solution.parameters =
      parameter_results(robot, fitted.state.xi, C, rank, adjusted.candidate, adjusted.prior.free);
  std::tie(solution.covariance_order, solution.covariance) =
      covariance_result(solution.parameters, C);
  solution.observability = identified_observability(equations, R, rank, fitted.noise);
  solution.unexcited = unexcited(robot, equations.data(), rank, adjusted.candidate);
  return rank;
}

Solution assemble(const Equations& equations, const Adjusted& adjusted, const Options& options,
                  const Progress& progress) {
  const Robot& robot = equations.robot();
  const DataSet& data = equations.data();
  const Fit& fitted = adjusted.fitted;
  if (progress) progress("judging", 0.9);
  Solution solution = fit_figures(adjusted);

  const Weighting weighting{fitted.noise.used, fitted.noise.outlier};
  const Eigen::MatrixXd R = equations.linearise(fitted.state, weighting, true).R;
  const EndpointQuestion question = endpoint_question(equations, adjusted, R, options.seed);
  const bool nothing = nothing_free(adjusted);
  EndpointQuestion where_it_counts = question;
  where_it_counts.poses =
      workspace_poses(robot, question.xi, data.workspace, data.rows.q, kPoses, options.seed);
  const auto deviations = [&](const EndpointQuestion& asked) {
    return nothing ? EndpointDeviations{} : endpoint_deviations(asked);
  };
  const EndpointDeviations everywhere = deviations(question), there = deviations(where_it_counts);
  std::vector<CovarianceSource> sources = covariance_sources(
      equations, adjusted, R, there.shift.rows() > 0 ? there.weight : everywhere.weight);
  const ScaleJudgement scale =
      nothing ? ScaleJudgement{} : judge_scale(equations, adjusted, R, everywhere.weight);
  for (const Eigen::VectorXd& doubt : scale.doubts)
    sources.push_back({"a length given that is contradicted", doubt * doubt.transpose()});
  const Eigen::MatrixXd C = sum(sources);
  solution.scale = scale.scale;
  const Identifiability rank = add_posterior(equations, adjusted, R, C, solution);

  const Judged before = judge(robot, data, equations, adjusted.before, true);
  Judged after = judge(robot, data, equations, fitted);
  after.foreseen = foreseen(data, equations, C, after);
  solution.residual = residual_figures(data, before, after, fitted.noise.outlier);
  solution.outliers = outlier_rows(data, after, fitted.noise.outlier);
  solution.sets = set_results(equations, fitted, C, after);
  solution.slips = lock_slips(data, after);
  solution.frame_steps = frame_steps(robot, solution.values, data, solution.residual.rows);
  const std::vector<std::string> turned = gross_angles(robot, data, before, after);
  add_warnings(equations, adjusted, solution);
  std::ranges::copy(scale.scale.contradictions, std::back_inserter(solution.warnings));
  std::ranges::copy(turned, std::back_inserter(solution.warnings));
  std::ranges::transform(solution.slips, std::back_inserter(solution.warnings), slip_words);
  std::ranges::transform(solution.frame_steps, std::back_inserter(solution.warnings), step_words);
  if (std::string what = hardly_reached(data.workspace, where_it_counts.poses.rows(), kPoses);
      !what.empty())
    solution.warnings.push_back(std::move(what));
  if (progress) progress("done", 1);
  if (nothing) {  // certain of what was given, not of what is true
    solution.verdict.why = "nothing was identified: every parameter is fixed or held";
    return solution;
  }
  const Eigen::MatrixXd of_robot =
      C.topLeftCorner(equations.robot_columns(), equations.robot_columns());
  solution.endpoint = endpoint_sigma(everywhere, of_robot);
  solution.workspace = endpoint_sigma(there, of_robot);
  solution.uncertainty =
      uncertainty(equations, adjusted, sources, after, where_it_counts, there, solution.workspace);
  solution.orientation_seen = orientation_is_seen(equations);
  Grounds grounds{solution.endpoint,
                  solution.workspace,
                  data.target,
                  solution.orientation_seen,
                  fitted.converged,
                  nominal_explains(adjusted, rank, solution.residual.fit),
                  lie_beyond(data.rows, question.poses),
                  turned,
                  solution.strays = strays(equations, solution.sets),
                  kMostStrays * size_of(robot)};
  // Given lengths that only differ among themselves are a warning while the end position bears it.
  if (scale.scale.against_maker || !known_to(solution.workspace, data.target))
    std::ranges::copy(scale.scale.contradictions, std::back_inserter(grounds.contradictions));
  if (at_one_configuration(data.rows))
    grounds.contradictions.emplace_back(
        "the rows that identify all stand at one configuration, which tells no length from "
        "another");
  if (std::string why = untold_noise(equations, adjusted); !why.empty()) {
    solution.warnings.push_back(why);
    grounds.contradictions.push_back(std::move(why));
  }
  for (const FrameStep& step : solution.frame_steps)
    if (step.shift > data.target) grounds.contradictions.push_back(step_words(step));
  solution.verdict = verdict(before, solution.residual, grounds);
  return solution;
}

/// `open`: the rows that there would have been.
Solution without_rows(const Robot& robot, const DataSet& data,
                      const std::vector<OpenRow>& open = {}) {
  Solution solution;
  solution.stop_reason = "no rows to identify from";
  if (!open.empty()) solution.stop_reason += ": " + open.front().why;
  Judged judged;
  judged.open = open;
  solution.outliers = outlier_rows(data, judged, {});
  solution.verdict.why = solution.stop_reason;
  solution.values = values(robot);
  const std::vector<char> none(robot.parameters().size(), 0);
  solution.parameters = parameter_results(robot, solution.values, {}, {}, none, none);
  return solution;
}

}  // namespace

Solution identify(const Robot& robot, const DataSet& data, const Options& options,
                  const Progress& progress) {
  expects(data.rows.rows() == 0 ||
              data.rows.q.cols() == static_cast<Eigen::Index>(robot.joints().size()),
          "every row has a reading of every joint");
  for (const std::vector<std::string>* names : {&options.fix, &options.free})
    for (const std::string& name : *names)
      expects(name == "*" || !match_parameters(robot, name).empty(),
              "names in the options are parameters of the robot");
  const auto& check = data.rows.check;
  if (std::count(check.begin(), check.end(), char{0}) == 0) return without_rows(robot, data);
  const Equations equations(robot, data, Use::fit);
  bool any = false;
  for (int s = 0; s < static_cast<int>(data.sets.size()); ++s)
    any = any || !equations.plan(s).items.empty();
  if (!any) return without_rows(robot, data, equations.open_rows());
  return assemble(equations, adjust(equations, options, progress), options, progress);
}

Solution judge_as_it_is(const Robot& robot, const DataSet& data, const Progress& progress) {
  Options nothing_moves;
  nothing_moves.fix = {"*"};
  return identify(robot, data, nothing_moves, progress);
}

}  // namespace selfcal
