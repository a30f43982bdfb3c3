#include "constraints/planning/plan_system.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "constraints/identifiability/endpoint_sigma.h"
#include "constraints/identifiability/gauge.h"
#include "constraints/identifiability/identifiability.h"
#include "constraints/identifiability/observability.h"
#include "constraints/planning/touch_rows.h"
#include "constraints/sampling/configurations.h"
#include "constraints/sampling/random_poses.h"
#include "constraints/sampling/workspace_poses.h"
#include "constraints/statistics.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr int kPlanPoses = 500;  // at which the end position is judged
constexpr unsigned long long kPosesSeed = 1;
constexpr double kLoudest = 5;  // of the median norm
// A condition beyond this is rounding: some of the parameters are not seen at all.
constexpr double kNotSeen = 1e12;

Eigen::MatrixXd stacked(const std::vector<Eigen::MatrixXd>& parts, Eigen::Index columns) {
  Eigen::Index rows = 0;
  for (const Eigen::MatrixXd& each : parts) rows += each.rows();
  Eigen::MatrixXd W(rows, columns);
  Eigen::Index at = 0;
  for (const Eigen::MatrixXd& each : parts) {
    W.middleRows(at, each.rows()) = each;
    at += each.rows();
  }
  return W;
}

}  // namespace

PlanSystem::PlanSystem(const Robot& robot, const PoolRequest& request, const Workspace& workspace,
                       int count, Pool& pool)
    : robot_(robot), request_(request), equations_(robot, pool.data.sets, pool.state) {
  drop_units(pool);
  given_ = given(pool.data);
  tolerance_ = equations_.tolerance();
  take_columns(pool, workspace, count);
  take_prior();
}

Eigen::Index PlanSystem::robot_columns() const {
  return static_cast<Eigen::Index>(robot_.parameters().size());
}

void PlanSystem::drop_units(Pool& pool) {
  const std::vector<Eigen::MatrixXd> rows = equations_.of_units(pool.data, pool.units);
  const auto set_of = [&](std::size_t unit) {
    return pool.data.rows.set[pool.units[unit].front()];
  };
  std::vector<std::vector<double>> norms(pool.data.sets.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].rows() > 0) norms[set_of(i)].push_back(rows[i].norm());
  for (const std::vector<double>& each : norms)
    most_.push_back(each.empty() ? 0 : kLoudest * median(each));
  std::vector<Unit> kept;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].rows() > 0 && rows[i].norm() <= most_[set_of(i)]) kept.push_back(pool.units[i]);
  pool.units = std::move(kept);
}

/// Rows taken already, and those that no row of a data set carries.
Eigen::MatrixXd PlanSystem::given(const DataSet& data) const {
  std::vector<Eigen::MatrixXd> parts{equations_.of_none(data)};
  DataSet taken = request_.taken;
  Unit all(static_cast<std::size_t>(taken.rows.rows()));
  std::iota(all.begin(), all.end(), 0);
  if (!all.empty()) {
    measure_rows(robot_, equations_.state(), all, taken);
    parts.push_back(equations_.of_units(taken, {all}).front());
  }
  return stacked(parts, equations_.columns());
}

void PlanSystem::take_columns(const Pool& pool, const Workspace& workspace, int count) {
  const Equations equations(robot_, pool.data, Use::fit);
  const Weighting weighting{equations_.scale(pool.data.sets),
                            std::vector<char>(pool.data.rows.set.size(), 0)};
  const double share = std::sqrt(std::min(1.0, count / static_cast<double>(pool.units.size())));
  const Eigen::MatrixXd R = share * equations.linearise(pool.state, weighting, true).R;
  std::vector<char> free;
  for (const Parameter& each : robot_.parameters()) free.push_back(each.free);
  const Identifiability rank = identifiability(equations, R, pool.state, free, {});
  for (int c = 0; c < static_cast<int>(equations_.columns()); ++c) {
    const bool own = c >= static_cast<int>(robot_columns());
    const auto at = static_cast<std::size_t>(c);
    if (own || tolerance_[c] > 0) open_.push_back(c);
    if (own || rank.status[at] == Status::identified) identified_.push_back(c);
  }
  parameters_ = rank.total();
  take_weight(workspace, unseen_motions(equations, R), point_is_unknown(equations));
}

void PlanSystem::take_weight(const Workspace& workspace, const Eigen::MatrixXd& unseen,
                             bool point_unknown) {
  EndpointQuestion question;
  question.robot = &robot_;
  question.xi = equations_.state().xi;
  question.unseen = unseen;
  question.point_unknown = point_unknown;
  question.poses = workspace.box
                       ? workspace_poses(robot_, question.xi, workspace, {}, kPlanPoses, kPosesSeed)
                       : closing_poses(robot_, question.xi,
                                       random_poses(robot_, nullptr, kPlanPoses, kPosesSeed));
  aligned_ = unseen.cols() > 0 || point_unknown;
  if (question.poses.rows() == 0) return;
  weight_.setZero(equations_.columns(), equations_.columns());
  weight_.topLeftCorner(robot_columns(), robot_columns()) = endpoint_deviations(question).weight;
}

void PlanSystem::take_prior() {
  const auto count = static_cast<Eigen::Index>(open_.size());
  prior_ = Eigen::MatrixXd::Identity(count, count);
  if (request_.prior.rows() == 0) return;
  const Eigen::Index robot =
      std::ranges::count_if(open_, [&](int c) { return c < static_cast<int>(robot_columns()); });
  const std::vector<int> columns(open_.begin(), open_.begin() + robot);
  Eigen::MatrixXd C = request_.prior(columns, columns);
  // What the matrix takes as exact is believed no further than without it.
  for (Eigen::Index i = 0; i < robot; ++i)
    if (C(i, i) <= 0) C(i, i) = std::pow(tolerance_[columns[i]], 2);
  const Eigen::VectorXd per = tolerance_(columns).cwiseInverse();
  prior_.topLeftCorner(robot, robot) =
      inverse_of_covariance(per.asDiagonal() * C * per.asDiagonal());
}

std::string PlanSystem::lacking() const {
  if (parameters_ == 0) return "these methods tell nothing of this robot";
  return weight_.rows() == 0 ? "the robot reaches no pose of the workspace" : std::string();
}

const std::vector<int>& PlanSystem::columns(Criterion criterion) const {
  return criterion == Criterion::sigma ? open_ : identified_;
}

Objective PlanSystem::objective(Criterion criterion) const {
  const std::vector<int>& chosen = columns(criterion);
  Objective objective;
  objective.criterion = criterion;
  objective.nuisance = equations_.columns() - robot_columns();
  objective.prior = given_.transpose() * given_;
  if (criterion == Criterion::sigma) objective.weight = weight_(chosen, chosen);
  objective.prior = objective.prior(chosen, chosen).eval();
  const Eigen::VectorXd per = tolerance_(open_).cwiseInverse();
  if (criterion == Criterion::sigma)
    objective.prior += per.asDiagonal() * prior_ * per.asDiagonal();
  return objective;
}

std::vector<Eigen::MatrixXd> PlanSystem::rows(const DataSet& data, const std::vector<Unit>& units,
                                              Criterion criterion) const {
  std::vector<Eigen::MatrixXd> list = equations_.of_units(data, units);
  for (Eigen::MatrixXd& each : list) each = each(Eigen::all, columns(criterion)).eval();
  return list;
}

/// 1 sigma of the quietest set, of its lengths if it has any.
double PlanSystem::quietest() const {
  const std::vector<Scale> scale = equations_.scale(request_.sets);
  double least = HUGE_VAL;
  for (std::size_t s = 0; s < scale.size(); ++s)
    least =
        std::min(least, request_.sets[s].method->has_lengths() ? scale[s].length : scale[s].angle);
  return least;
}

/// Those of the units and what is given.
Eigen::MatrixXd PlanSystem::all_rows(const DataSet& data, const std::vector<Unit>& units) const {
  std::vector<Eigen::MatrixXd> parts = equations_.of_units(data, units);
  parts.push_back(given_);
  return stacked(parts, equations_.columns());
}

/// WᵀW of the open columns, each over its tolerance, so that the priors are ones.
Eigen::MatrixXd PlanSystem::priced_information(const Eigen::MatrixXd& W) const {
  const Eigen::VectorXd unit = tolerance_(open_);
  const Eigen::MatrixXd priced = W(Eigen::all, open_) * unit.asDiagonal();
  return priced.transpose() * priced;
}

Eigen::MatrixXd PlanSystem::priced_weight() const {
  const Eigen::VectorXd unit = tolerance_(open_);
  return unit.asDiagonal() * weight_(open_, open_) * unit.asDiagonal();
}

double PlanSystem::sigma_beyond(const Pool& pool, const DataSet& chosen_data,
                                const std::vector<Unit>& chosen) const {
  // In units in which what is known beforehand is a one in every direction.
  const Eigen::MatrixXd L = cholesky_root(prior_);
  const auto in_units = [&](const Eigen::MatrixXd& A) -> Eigen::MatrixXd {
    return solve_lower(L, solve_lower(L, A).transpose());
  };
  const Symmetric eigen =
      symmetric_eigen(in_units(priced_information(all_rows(pool.data, pool.units)) +
                               priced_information(all_rows(chosen_data, chosen))));
  const Eigen::MatrixXd weight = in_units(priced_weight());
  double variance = 0;
  for (Eigen::Index i = 0; i < eigen.values.size() && eigen.values[i] < 1; ++i)
    variance += eigen.vectors.col(i).dot(weight * eigen.vectors.col(i)) /
                (1 + std::max(0.0, eigen.values[i]));
  return std::sqrt(std::max(0.0, variance));
}

PlanFigures PlanSystem::figures(const DataSet& data, const std::vector<Unit>& units) const {
  const Eigen::MatrixXd W = all_rows(data, units);
  const Eigen::MatrixXd information = priced_information(W);
  const Eigen::MatrixXd C = inverse_of_positive(information + prior_);
  PlanFigures result;
  result.sigma = std::sqrt(priced_weight().cwiseProduct(C).sum());
  if (W.rows() < static_cast<Eigen::Index>(identified_.size())) return result;
  const Eigen::MatrixXd interest = W(Eigen::all, identified_).leftCols(parameters_);
  const Observability seen =
      observability(quietest() * beyond(W.rightCols(W.cols() - robot_columns()), interest),
                    static_cast<int>(units.size()) + request_.taken.rows.rows());
  if (seen.condition < kNotSeen) result.observability = seen;
  return result;
}

}  // namespace selfcal
