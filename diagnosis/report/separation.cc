#include "diagnosis/report/separation.h"

#include <cmath>

#include "kinematics/corrected_robot.h"
#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

/// 1 over the largest whitened change that any column may explain: it holds what no row tells.
constexpr double kRidge = 1e-5;

/// Values of all parameters of the entries' effects.
std::vector<double> values_of(const LinearisedModel& linearised, const std::vector<Node>& entries) {
  std::vector<double> list;
  Problems problems;
  for (const Node& entry : entries) {
    const auto effect = make_effect(entry, linearised.geometry(), linearised.context(), problems);
    expects(effect != nullptr, "causes that were weighed are effects that the robot can have");
    for (const EffectParameter& each : effect->parameters()) list.push_back(each.value);
  }
  return list;
}

}  // namespace

Separation::Separation(const LinearisedModel& linearised, const std::vector<Node>& cause,
                       const std::vector<Node>& other, const DataSet& data, int first)
    : first_(first) {
  std::vector<Node> entries = cause;
  entries.insert(entries.end(), other.begin(), other.end());
  Problems problems;
  const auto robot = correct(linearised.shared_geometry(), entries, linearised.context(), problems);
  expects(robot != nullptr, "causes that were weighed are effects that the robot can have");
  const Equations equations(*robot, data, Use::fit);
  State state = linearised.adjusted().fitted.state;
  const Eigen::Index geometry = state.xi.size();
  state.xi.conservativeResize(static_cast<Eigen::Index>(robot->parameters().size()));
  state.xi.tail(state.xi.size() - geometry).setZero();
  const DenseEquations dense =
      equations.dense(state, linearised.noise_of_sets(),
                      std::vector<char>(static_cast<size_t>(data.rows.rows()), 0));
  const std::vector<double> value = values_of(linearised, cause);
  const auto own = static_cast<Eigen::Index>(value.size());
  const Eigen::VectorXd t =
      dense.W.middleCols(geometry, own) * Eigen::Map<const Eigen::VectorXd>(value.data(), own);
  std::vector<int> others;
  for (int c = 0; c < dense.W.cols(); ++c)
    if (c < geometry ? linearised.adjusted().prior.free[c] != 0 : c >= geometry + own)
      others.push_back(c);
  Eigen::MatrixXd X = dense.W(Eigen::all, others);
  const auto n = X.cols();
  R_ = kRidge * Eigen::MatrixXd::Identity(n, n);
  z_.setZero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double size = X.col(i).norm();
    if (size > 0) X.col(i) /= size;
    if (const int c = others[static_cast<size_t>(i)]; c < geometry && size > 0)
      R_(i, i) = std::hypot(kRidge, 1 / (size * linearised.adjusted().prior.sigma[c]));
  }
  std::vector<std::vector<int>> of_row(static_cast<size_t>(data.rows.rows() - first));
  std::vector<int> counted;
  for (int e = 0; e < X.rows(); ++e) {
    if (const int row = dense.row[static_cast<size_t>(e)]; row >= first)
      of_row[static_cast<size_t>(row - first)].push_back(e);
    else
      counted.push_back(e);
  }
  for (const std::vector<int>& each : of_row) further_.push_back({X(each, Eigen::all), t(each)});
  add(X(counted, Eigen::all), t(counted));
}

void Separation::add(const Eigen::MatrixXd& X, const Eigen::VectorXd& t) {
  const Eigen::Index n = R_.cols(), more = X.rows();
  Eigen::MatrixXd all(n + more, n + 1);
  all << R_, z_, X, t;
  triangularise(all);
  R_ = all.topLeftCorner(n, n);
  z_ = all.topRightCorner(n, 1);
  if (more > 0) left_ += all(n, n) * all(n, n);
}

double Separation::gain(int row) const {
  const RowEquations& further = further_[static_cast<size_t>(row - first_)];
  const Eigen::Index k = further.t.size();
  if (k == 0) return 0;
  const Eigen::MatrixXd S =
      R_.transpose().triangularView<Eigen::Lower>().solve(further.X.transpose());
  const Eigen::VectorXd off = further.t - S.transpose() * z_;
  const Eigen::MatrixXd spread = Eigen::MatrixXd::Identity(k, k) + S.transpose() * S;
  return off.dot(spread.llt().solve(off));
}

void Separation::take(int row) {
  const RowEquations& further = further_[static_cast<size_t>(row - first_)];
  if (further.t.size() > 0) add(further.X, further.t);
}

void Separation::take_all() {
  for (size_t i = 0; i < further_.size(); ++i) take(first_ + static_cast<int>(i));
}

}  // namespace selfcal
