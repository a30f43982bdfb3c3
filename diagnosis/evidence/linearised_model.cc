#include "diagnosis/evidence/linearised_model.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include "constraints/measurement_context.h"
#include "diagnosis/constants.h"
#include "diagnosis/evidence/fine_waves.h"
#include "diagnosis/evidence/rows.h"
#include "diagnosis/evidence/usual_masses.h"
#include "diagnosis/options.h"
#include "kinematics/corrected_robot.h"
#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
Options geometry_options(const DiagnosisOptions& options) {
  Options geometry;
  geometry.most_outliers = options.most_outliers;
  geometry.seed = options.seed;
  geometry.gears = true;  // a ratio that is off is geometry: it must not be taken for a cause
  return geometry;
}

namespace {

/// State of the geometry's fit as one of the robot with every candidate, whose parameters are zero.
State extended(const State& state, Eigen::Index parameters) {
  State wide = state;
  wide.xi.conservativeResize(parameters);
  wide.xi.tail(parameters - state.xi.size()).setZero();
  return wide;
}

}  // namespace

LinearisedModel::LinearisedModel(std::shared_ptr<const Robot> robot, const DataSet& data,
                                 const DiagnosisOptions& options, const Progress& progress)
    : data_(data),
      most_outliers_(options.most_outliers),
      given_(geometry_of(std::move(robot))),
      geometry_(with_mass_of_its_size(given_)),
      context_(context_of(*geometry_, data)),
      candidates_(selfcal::candidates(*geometry_, data, context_)),
      equations_(std::make_unique<Equations>(*geometry_, data, Use::fit)),
      adjusted_(adjust(*equations_, geometry_options(options), progress)) {
  const Fit& fitted = adjusted_.fitted;
  noise_ = pooled_noise(data, fitted);
  bound_noise();
  held_ = weighed_rows(data.rows, static_cast<double>(fitted.at.equations),
                       kDiagnosis.validation.most_grown);
  linearise();
  outlier_ = fitted.noise.outlier;
  left_ = all_.y;
  weigh(kDiagnosis.rows.most_weighed);
  steps_ = credible_steps(data.rows.q, by_joint());
}

void LinearisedModel::linearise() {
  Problems problems;
  std::vector<Node> entries;
  for (const ShapedEffect& each : candidates_.made) entries.push_back(entry_of(each));
  everything_ = correct(geometry_, entries, context_, problems);
  expects(everything_ != nullptr, "every candidate is an effect that the robot can have");
  parameters_.clear();
  for (const Effect* effect : effects_of(*everything_))
    parameters_.insert(parameters_.end(), effect->parameters().begin(), effect->parameters().end());
  all_equations_ = std::make_unique<Equations>(*everything_, data_, Use::fit);
  std::vector<char> left_out(held_.size());
  std::ranges::transform(held_, left_out.begin(), std::logical_not());
  all_.W.resize(0, 0);  // before there is a second one
  all_ = all_equations_->dense(
      extended(adjusted_.fitted.state, static_cast<Eigen::Index>(everything_->parameters().size())),
      noise_, left_out);
  before_ = rows_before(*equations_, adjusted_.fitted.state, noise_, left_out, all_);
  nuisance_ = nuisance(adjusted_, all_equations_->robot_columns(), all_.W.cols());
}

bool LinearisedModel::try_moments_near(const std::vector<ShapedEffect>& steps) {
  std::vector<ShapedEffect>& tried = hints_.steps;
  const size_t before = tried.size();
  for (const ShapedEffect& step : steps)
    if (std::ranges::none_of(tried, [&](const ShapedEffect& each) {
          return each.effect == step.effect && each.at == step.at;
        }))
      tried.push_back(step);
  if (tried.size() == before) return false;
  try_hints();
  return true;
}

bool LinearisedModel::try_fine_waves() {
  const std::vector<int> equations = equations_of(all_, taking_part());
  const Eigen::MatrixXd by_joint = reading_errors().by_joint;
  const Eigen::VectorXd left = left_(equations);
  bool found = false;
  hints_.fine_waves.resize(geometry_->joints().size());
  for (size_t j = 0; j < hints_.fine_waves.size(); ++j) {
    if (geometry_->joints()[j].quantity != Quantity::angle) continue;
    Eigen::VectorXd q = Eigen::VectorXd::Zero(left.size()), by = q;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const int row = all_.row[static_cast<size_t>(equations[static_cast<size_t>(i)])];
      // Equations of two rows have two readings, and take no part.
      if (row < 0 || (!before_.of.empty() && before_.of[static_cast<size_t>(row)] >= 0)) continue;
      q[i] = data_.rows.q(row, static_cast<Eigen::Index>(j));
      by[i] = by_joint(i, static_cast<Eigen::Index>(j));
    }
    for (const double k : fine_waves(q, by, left)) {
      std::vector<double>& known = hints_.fine_waves[j];
      if (std::ranges::find(known, k) != known.end()) continue;
      known.push_back(k);
      found = true;
    }
  }
  if (found) try_hints();
  return found;
}

void LinearisedModel::try_hints() {
  candidates_ = selfcal::candidates(*geometry_, data_, context_, hints_);
  linearise();
}

Eigen::VectorXd LinearisedModel::scales(const std::vector<int>& equations) const {
  Eigen::VectorXd scales(static_cast<Eigen::Index>(equations.size()));
  for (Eigen::Index i = 0; i < scales.size(); ++i) {
    const auto at = static_cast<size_t>(equations[static_cast<size_t>(i)]);
    const int row = all_.row[at];
    scales[i] = scale_;
    if (row >= 0) scales[i] *= relative_[data_.rows.set[row]].of(all_.quantity[at]);
  }
  return scales;
}

void LinearisedModel::weigh(double most) {
  std::vector<int> rows;
  for (size_t row = 0; row < held_.size(); ++row)
    if (held_[row]) rows.push_back(static_cast<int>(row));
  const std::vector<char> take =
      weighed_rows(taken(data_.rows, rows), static_cast<double>(all_.row.size()), most);
  weighed_.assign(held_.size(), 0);
  for (size_t i = 0; i < rows.size(); ++i) weighed_[rows[i]] = take[i];
}

std::vector<char> LinearisedModel::taking_part() const {
  std::vector<char> take = weighed_;
  for (size_t row = 0; row < take.size(); ++row) take[row] = take[row] && !outlier_[row];
  return take;
}

DenseEquations LinearisedModel::kept() const {
  const std::vector<int> equations = equations_of(all_, taking_part());
  DenseEquations some{{}, all_.y(equations), all_.shift(equations, Eigen::all), {}, {}};
  add_labels(all_, equations, some);
  return some;
}

Eigen::VectorXd LinearisedModel::left() const { return left_(equations_of(all_, taking_part())); }

Whitened LinearisedModel::of(const std::vector<int>& equations,
                             const std::vector<int>& effects) const {
  std::vector<int> columns = effects;
  for (int& each : columns) each += static_cast<int>(geometry_->parameters().size());
  const Eigen::ArrayXd over = scales(equations);
  Whitened out;
  out.A = all_.W(equations, nuisance_.columns).array().colwise() / over;
  out.C = all_.W(equations, columns).array().colwise() / over;
  out.y = all_.y(equations).array() / over;
  out.weight = nuisance_.weight;
  out.pull = nuisance_.pull;
  out.least = least();
  return out;
}

Whitened LinearisedModel::whitened() const {
  std::vector<int> effects(parameters_.size());
  std::iota(effects.begin(), effects.end(), 0);
  return of(equations_of(all_, taking_part()), effects);
}

Whitened LinearisedModel::whitened_geometry() const {
  return of(equations_of(all_, taking_part()), {});
}

std::vector<Eigen::Isometry3d> LinearisedModel::ends() const {
  return selfcal::ends(*geometry_, data_.rows);
}

Eigen::MatrixXd LinearisedModel::tips() const { return selfcal::tips(*geometry_, data_.rows); }

std::vector<int> reading_columns(const Robot& robot) {
  std::vector<int> columns;
  for (int j = 0; j < static_cast<int>(robot.joints().size()); ++j)
    columns.push_back(robot.variable_parameter(j));
  return columns;
}

ReadingErrors LinearisedModel::reading_errors() const {
  const Eigen::ArrayXd over = scales(equations_of(all_, taking_part()));
  return {by_joint().array().colwise() / over, steps_};
}

JointErrors LinearisedModel::joint_errors() const {
  JointErrors errors{.readings = reading_errors(),
                     .alike = comparable_readings(*geometry_, data_.rows.q),
                     .by_load = by_load()};
  if (before_.of.empty()) return errors;
  const std::vector<int> equations = equations_of(all_, taking_part());
  errors.by_before =
      before_.by_joint(equations, Eigen::all).array().colwise() / scales(equations).array();
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const int row = all_.row[static_cast<std::size_t>(equations[i])];
    errors.before.push_back(row < 0 ? -1 : before_.of[static_cast<std::size_t>(row)]);
    // What either of two loads moves is not known apart.
    if (errors.before.back() >= 0) errors.by_load.row(static_cast<Eigen::Index>(i)).setZero();
  }
  return errors;
}

Eigen::MatrixXd LinearisedModel::by_load() const {
  const std::vector<int> equations = equations_of(all_, taking_part());
  Eigen::MatrixXd by = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(equations.size()),
                                             static_cast<Eigen::Index>(geometry_->joints().size()));
  for (const Candidate& each : candidates_.list)
    if (each.effect == "joint_compliance" && each.joint >= 0 && !each.shape.lumps)
      by.col(each.joint) = of(equations, each.main).C.col(0);
  return by;
}

Eigen::MatrixXd LinearisedModel::by_joint() const {
  return all_.W(equations_of(all_, taking_part()), reading_columns(*geometry_));
}

Eigen::VectorXd LinearisedModel::residuals(const std::vector<int>& effects,
                                           const Eigen::VectorXd& prior) const {
  std::vector<int> own(effects.size());
  std::iota(own.begin(), own.end(), 0);
  const Eigen::VectorXd x = best_fit(of(equations_of(all_, taking_part()), effects), own, prior);
  std::vector<int> columns = nuisance_.columns;
  for (const int each : effects)
    columns.push_back(each + static_cast<int>(geometry_->parameters().size()));
  // Column by column, without a copy of so many.
  Eigen::VectorXd left = all_.y;
  for (size_t c = 0; c < columns.size(); ++c)
    left -= x[static_cast<Eigen::Index>(c)] * all_.W.col(columns[c]);
  std::vector<int> every(all_.row.size());
  std::iota(every.begin(), every.end(), 0);
  return left.cwiseQuotient(scales(every));
}

Eigen::VectorXd LinearisedModel::geometry_residuals(const Whitened& rows) const {
  return left_of(rows, rows, {}, Eigen::VectorXd());
}

Eigen::VectorXd LinearisedModel::geometry_leaves(const Whitened& rows) const {
  const Eigen::MatrixXd Q =
      orthogonal_columns(over_priors(rows.A, rows.weight)).Q.topRows(rows.A.rows());
  return (1 - Q.rowwise().squaredNorm().array()).max(0);
}

}  // namespace selfcal
