#include "diagnosis/view.h"

#include <algorithm>
#include <cmath>

#include "constraints/site.h"
#include "constraints/statistics.h"
#include "diagnosis/diagnosis.h"
#include "diagnosis/rows.h"
#include "kinematics/corrected_robot.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

Options geometry_options(const DiagnosisOptions& options) {
  Options geometry;
  geometry.most_rejected = options.most_rejected;
  geometry.seed = options.seed;
  geometry.free = {"K*"};  // a ratio that is off is geometry: it must not be taken for a cause
  return geometry;
}

/// State of the geometry's fit as one of the robot with every candidate, whose parameters are zero.
State extended(const State& state, Eigen::Index parameters) {
  State wide = state;
  wide.xi.conservativeResize(parameters);
  wide.xi.tail(parameters - state.xi.size()).setZero();
  return wide;
}

}  // namespace

View::View(std::shared_ptr<const Robot> robot, const DataSet& data, const DiagnosisOptions& options,
           const Progress& progress)
    : data_(data),
      most_rejected_(options.most_rejected),
      geometry_(geometry_of(std::move(robot))),
      site_(site_of(*geometry_, data)),
      candidates_(selfcal::candidates(*geometry_, data, site_)),
      equations_(std::make_unique<Equations>(*geometry_, data, Use::fit)),
      adjusted_(adjust(*equations_, geometry_options(options), progress)) {
  Problems problems;
  everything_ = correct(geometry_, candidates_.entries, site_, problems);
  for (const Effect* effect : effects_of(*everything_))
    parameters_.insert(parameters_.end(), effect->parameters().begin(), effect->parameters().end());
  all_equations_ = std::make_unique<Equations>(*everything_, data, Use::fit);
  const Fit& fitted = adjusted_.fitted;
  noise_ = pooled_noise(data, fitted);
  bound_noise();
  all_ = all_equations_->dense(
      extended(fitted.state, static_cast<Eigen::Index>(everything_->parameters().size())), noise_,
      std::vector<char>(static_cast<size_t>(data.rows.rows()), 0));
  put_aside_ = fitted.noise.put_aside;
  weigh(kMostWeighed);

  const auto geometry = static_cast<int>(geometry_->parameters().size());
  for (int c = 0; c < geometry; ++c)
    if (adjusted_.prior.free[c]) columns_.push_back(c);
  const auto free = static_cast<Eigen::Index>(columns_.size());
  for (Eigen::Index c = all_equations_->robot_columns(); c < all_.W.cols(); ++c)
    columns_.push_back(static_cast<int>(c));
  weight_.setZero(static_cast<Eigen::Index>(columns_.size()));
  pull_ = weight_;
  for (Eigen::Index i = 0; i < free; ++i) {
    const int c = columns_[i];
    weight_[i] = 1 / adjusted_.prior.sigma[c];
    pull_[i] = weight_[i] * (adjusted_.prior.centre[c] - fitted.state.xi[c]);
  }
}

void View::bound_noise() {
  const std::vector<Scale> declared = declared_noise(data_);
  for (size_t s = 0; s < noise_.size(); ++s) {
    if (declared[s].length > noise_[s].length) quieter_.push_back(static_cast<int>(s));
    noise_[s] = {std::max(noise_[s].length, declared[s].length),
                 std::max(noise_[s].angle, declared[s].angle)};
  }
  double sum = 0, rows = 0;
  for (const RowResidual& row : adjusted_.fitted.at.residuals) {
    sum += std::pow(declared[row.set].length / noise_[row.set].length, 2);
    rows += 1;
  }
  least_ = rows > 0 ? sum / rows : 0;
}

void View::weigh(double most) {
  weighed_ = weighed_rows(data_.rows, static_cast<double>(all_.row.size()), most);
}

DenseEquations View::kept() const {
  std::vector<char> take = weighed_;
  for (size_t row = 0; row < take.size(); ++row) take[row] = take[row] && !put_aside_[row];
  return selfcal::kept(all_, take);
}

Whitened View::of(const DenseEquations& rows) const {
  Whitened out;
  out.A = rows.W(Eigen::all, columns_) / scale_;
  out.C = rows.W.middleCols(static_cast<Eigen::Index>(geometry_->parameters().size()),
                            static_cast<Eigen::Index>(parameters_.size())) /
          scale_;
  out.y = rows.y / scale_;
  out.weight = weight_;
  out.pull = pull_;
  out.least = least_ / (scale_ * scale_);
  return out;
}

Whitened View::whitened() const { return of(kept()); }

Eigen::MatrixXd View::tips() const { return selfcal::tips(*geometry_, data_.rows); }

std::vector<int> reading_columns(const Robot& robot) {
  std::vector<int> columns;
  for (int j = 0; j < static_cast<int>(robot.joints().size()); ++j)
    columns.push_back(robot.variable_parameter(j));
  return columns;
}

Eigen::MatrixXd View::by_joint(const DenseEquations& kept) const {
  return kept.W(Eigen::all, reading_columns(*geometry_)) / scale_;
}

std::vector<Scale> View::noise_of_sets() const {
  std::vector<Scale> noise = noise_;
  for (Scale& each : noise) {
    each.length *= scale_;
    each.angle *= scale_;
  }
  return noise;
}

double View::noise() const {
  double squares = 0;
  int rows = 0;
  for (const RowResidual& r : adjusted_.fitted.at.residuals) {
    squares += std::pow(scale_ * noise_[r.set].length, 2);
    ++rows;
  }
  return std::sqrt(squares / std::max(rows, 1));
}

Eigen::VectorXd View::residuals(const std::vector<int>& effects,
                                const Eigen::VectorXd& prior) const {
  const auto solve = [&](const Whitened& rows) {
    const Eigen::Index n = rows.A.cols(), k = static_cast<Eigen::Index>(effects.size());
    Eigen::MatrixXd M(rows.A.rows() + n + k, n + k);
    M.setZero();
    M.topLeftCorner(rows.A.rows(), n) = rows.A;
    M.topRightCorner(rows.A.rows(), k) = rows.C(Eigen::all, effects) * prior.asDiagonal();
    M.block(rows.A.rows(), 0, n, n).diagonal() = rows.weight;
    M.bottomRightCorner(k, k).setIdentity();
    Eigen::VectorXd z = Eigen::VectorXd::Zero(M.rows());
    z.head(rows.y.size()) = rows.y;
    z.segment(rows.y.size(), n) = rows.pull;
    return least_squares(M, z);
  };
  const Eigen::VectorXd x = solve(whitened());
  const Whitened every = of(all_);
  return every.y - every.A * x.head(every.A.cols()) -
         every.C(Eigen::all, effects) * prior.cwiseProduct(x.tail(prior.size()));
}

namespace {

/// The geometry's columns over its priors.
Eigen::MatrixXd with_priors(const Whitened& rows) {
  const Eigen::Index n = rows.A.cols();
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(rows.A.rows() + n, n);
  M.topRows(rows.A.rows()) = rows.A;
  M.bottomRows(n).diagonal() = rows.weight;
  return M;
}

}  // namespace

Eigen::VectorXd View::geometry_residuals(const Whitened& rows) const {
  Eigen::VectorXd z(rows.y.size() + rows.pull.size());
  z << rows.y, rows.pull;
  return rows.y - rows.A * least_squares(with_priors(rows), z);
}

Eigen::VectorXd View::geometry_leaves(const Whitened& rows) const {
  const Eigen::MatrixXd Q = orthogonal_columns(with_priors(rows)).Q.topRows(rows.A.rows());
  return (1 - Q.rowwise().squaredNorm().array()).max(0);
}

bool View::refine(const Eigen::VectorXd& residuals, double variance) {
  std::vector<char> put_aside = far_rows(all_, residuals, static_cast<double>(columns_.size()),
                                         put_aside_.size(), most_rejected_);
  if (put_aside == put_aside_ && std::abs(variance - 1) < 0.1) return false;
  put_aside_ = std::move(put_aside);
  scale_ *= std::sqrt(variance);
  return true;
}

}  // namespace selfcal
