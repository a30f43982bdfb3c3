// F tests and the information criterion on what geometry, with its priors, leaves of the rows and
// of each candidate's columns.
#include "diagnosis/trials/baselines.h"

#include <algorithm>
#include <cmath>

#include "constraints/statistics.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr double kSignificance = 0.05;
constexpr size_t kMostCauses = 3;
constexpr double kLeastLeft =
    1e-3;  // share of a column that geometry leaves, below which it is none

/// What geometry leaves of the rows and of each candidate's columns.
class Regression {
 public:
  Regression(const std::shared_ptr<const Robot>& robot, const DataSet& data)
      : linearised_(robot, data, options_, {}) {
    const Whitened rows = linearised_.whitened();
    const Eigen::Index n = rows.A.rows(), k = rows.A.cols();
    const Eigen::MatrixXd onto = over_priors(rows.A, rows.weight);
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n + k, rows.C.cols() + 1);
    M.topLeftCorner(n, rows.C.cols()) = rows.C;
    M.col(rows.C.cols()) << rows.y, rows.pull;
    const Eigen::MatrixXd rest = beyond(onto, M);
    C_ = rest.leftCols(rows.C.cols());
    y_ = rest.col(rows.C.cols());
    for (Eigen::Index c = 0; c < C_.cols(); ++c)
      if (C_.col(c).norm() < kLeastLeft * rows.C.col(c).norm()) C_.col(c).setZero();
    // Each prior determines the share of its parameter that the rows do not.
    freedom_ = static_cast<double>(n) - orthogonal_columns(onto).Q.topRows(n).squaredNorm();
    equations_ = static_cast<double>(n);
    // How far the geometry strains its priors says nothing of the noise.
    squares_ = y_.head(n).squaredNorm();
  }

  const Candidate& candidate(size_t i) const { return linearised_.candidates().list[i]; }
  size_t candidates() const { return linearised_.candidates().list.size(); }
  double freedom() const { return freedom_; }
  double equations() const { return equations_; }

  double squares() const { return squares_; }
  /// Sum of squares left with a candidate's columns, and how many of these count.
  struct Left {
    double squares = 0;
    int columns = 0;
  };
  Left with(size_t i) const {
    const OrthogonalColumns basis = orthogonal_columns(C_(Eigen::all, candidate(i).main));
    Left left{squares_, 0};
    if (C_(Eigen::all, candidate(i).main).norm() == 0) return left;
    left.columns = static_cast<int>(basis.Q.cols());
    left.squares -= (basis.Q.transpose() * y_).squaredNorm();
    return left;
  }
  /// Projects a candidate out.
  void take(size_t i) {
    const OrthogonalColumns basis = orthogonal_columns(C_(Eigen::all, candidate(i).main));
    const Eigen::VectorXd explained = basis.Q.transpose() * y_;
    squares_ -= explained.squaredNorm();
    y_ -= basis.Q * explained;
    C_ -= basis.Q * (basis.Q.transpose() * C_).eval();
    for (Eigen::Index c = 0; c < C_.cols(); ++c)
      if (C_.col(c).norm() < 1e-9) C_.col(c).setZero();
    freedom_ -= static_cast<double>(basis.Q.cols());
  }

 private:
  DiagnosisOptions options_;
  LinearisedModel linearised_;
  Eigen::MatrixXd C_;
  Eigen::VectorXd y_;
  double freedom_ = 0, equations_ = 0, squares_ = 0;
};

TrialCauseNamed baseline_cause(const Candidate& candidate, double probability) {
  TrialCauseNamed cause{candidate.effect};
  if (!candidate.at.empty()) cause.where = {candidate.at};
  cause.probability = probability;
  return cause;
}

/// The first cause is the verdict.
TrialAnswer answer(std::vector<TrialCauseNamed> causes, double none) {
  if (causes.empty()) causes.push_back({kNone, {}, none});
  return {causes.front(), causes};
}

TrialAnswer stepwise(const std::shared_ptr<const Robot>& robot, const DataSet& data) {
  Regression regression(robot, data);
  std::vector<TrialCauseNamed> causes;
  double least = 1;
  while (causes.size() < kMostCauses) {
    size_t best = 0;
    least = 1;
    for (size_t i = 0; i < regression.candidates(); ++i) {
      const Regression::Left left = regression.with(i);
      const double below = regression.freedom() - left.columns;
      if (left.columns == 0 || below < 1) continue;
      const double F =
          (regression.squares() - left.squares) / left.columns / (left.squares / below);
      const double p = f_exceeds(F, left.columns, below);
      if (p < least) {
        least = p;
        best = i;
      }
    }
    const double corrected = least * static_cast<double>(regression.candidates());
    if (corrected > kSignificance) break;
    causes.push_back(baseline_cause(regression.candidate(best), 1 - corrected));
    regression.take(best);
  }
  return answer(std::move(causes),
                std::min(1.0, least * static_cast<double>(regression.candidates())));
}

/// Probabilities as the criterion's weights among the first step's candidates and none.
TrialAnswer bic(const std::shared_ptr<const Robot>& robot, const DataSet& data) {
  Regression regression(robot, data);
  const double n = regression.equations();
  std::vector<TrialCauseNamed> causes;
  double none = 1;
  while (causes.size() < kMostCauses) {
    const double now = n * std::log(regression.squares() / n);
    size_t best = 0;
    double least = 0, sum = 1;
    for (size_t i = 0; i < regression.candidates(); ++i) {
      const Regression::Left left = regression.with(i);
      if (left.columns == 0) continue;
      const double change = n * std::log(left.squares / n) + left.columns * std::log(n) - now;
      sum += std::exp(-change / 2);
      if (change < least) {
        least = change;
        best = i;
      }
    }
    if (causes.empty()) none = 1 / sum;
    if (least >= 0) break;
    const double weight = std::isfinite(sum) ? std::exp(-least / 2) / sum : 1;
    causes.push_back(baseline_cause(regression.candidate(best), weight));
    regression.take(best);
  }
  return answer(std::move(causes), none);
}

TrialAnswer compliance(const std::shared_ptr<const Robot>& robot, const DataSet&) {
  const size_t second = std::min<size_t>(1, robot->joints().size() - 1);
  return answer({{"joint_compliance", {robot->joints()[second].name}, 1}}, 0);
}

constexpr std::pair<std::string_view, Baseline> kBaselines[] = {
    {"stepwise", stepwise}, {"bic", bic}, {"compliance", compliance}};

}  // namespace

std::vector<std::string> baseline_names() {
  std::vector<std::string> names;
  for (const auto& [name, method] : kBaselines) names.emplace_back(name);
  return names;
}

std::optional<Baseline> find_baseline(std::string_view name) {
  for (const auto& [known, method] : kBaselines)
    if (known == name) return method;
  return std::nullopt;
}

}  // namespace selfcal
