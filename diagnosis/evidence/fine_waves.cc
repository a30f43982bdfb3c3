#include "diagnosis/evidence/fine_waves.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "diagnosis/constants.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

/// By k from 0 on: the periodogram.
std::vector<double> periodogram(const Eigen::VectorXd& q, const Eigen::VectorXd& by,
                                const Eigen::VectorXd& left, int most) {
  const double expected =
      left.squaredNorm() / static_cast<double>(left.size()) * by.squaredNorm() / 2;
  const Eigen::VectorXcd turn =
      (std::complex<double>(0, 1) * q.cast<std::complex<double>>()).array().exp();
  Eigen::VectorXcd term = by.cwiseProduct(left).cast<std::complex<double>>();
  std::vector<double> power;
  for (int k = 0; k <= most; ++k, term.array() *= turn.array())
    power.push_back(expected > 0 ? std::norm(term.sum()) / expected : 0);
  return power;
}

/// `left` without what these waves of the joint explain of it.
Eigen::VectorXd without(double waves, const Eigen::VectorXd& q, const Eigen::VectorXd& by,
                        const Eigen::VectorXd& left) {
  Eigen::MatrixXd columns(q.size(), 2);
  columns.col(0) = by.array() * (waves * q.array()).sin();
  columns.col(1) = by.array() * (waves * q.array()).cos();
  return left - columns * least_squares(columns, left);
}

}  // namespace

std::vector<double> fine_waves(const Eigen::VectorXd& q, const Eigen::VectorXd& by,
                               const Eigen::VectorXd& left) {
  const DiagnosisConstants::Shapes& rules = kDiagnosis.shapes;
  if (q.size() == 0) return {};
  const double asked = rules.most_fine_waves - rules.most_waves;
  const double far = 2 * std::log(asked / rules.fine_by_chance);
  std::vector<double> waves;
  Eigen::VectorXd rest = left;
  while (waves.size() < rules.most_hinted) {
    const std::vector<double> power = periodogram(q, by, rest, rules.most_fine_waves);
    const auto best = std::max_element(power.begin() + rules.most_waves + 1, power.end());
    if (*best < far) break;
    waves.push_back(static_cast<double>(best - power.begin()));
    rest = without(waves.back(), q, by, rest);
  }
  return waves;
}

}  // namespace selfcal
