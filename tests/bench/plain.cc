#include "tests/bench/plain.h"

#include <cmath>

namespace selfcal::bench {

Eigen::VectorXd solve_plainly(const Task& task) {
  constexpr int kMostSteps = 20, kChunk = 64;
  constexpr double kSettled = 1e-10, kSoft = 3;  // as Ceres'
  const Arm arm(example_robot());
  const Observations& rows = task.data.rows;
  Eigen::VectorXd xi = task.xi;
  Eigen::Matrix3Xd J;
  Eigen::MatrixXd W(3 * kChunk, kUnknowns);
  Eigen::VectorXd y(3 * kChunk);
  double before = HUGE_VAL;
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(kUnknowns, kUnknowns);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(kUnknowns);
    double cost = 0;
    for (int first = 0; first < rows.rows(); first += kChunk) {
      const int count = std::min(kChunk, rows.rows() - first);
      W.setZero();
      y.setZero();
      for (int i = 0; i < count; ++i) {
        const Eigen::VectorXd q = rows.q.row(first + i).transpose();
        const Eigen::Vector3d r = (rows.position.row(first + i).transpose() -
                                   endpoint_and_jacobian(arm, xi, q.data(), J)) /
                                  kMeasured;
        const double t = r.norm(), weight = t > kSoft ? std::sqrt(kSoft / t) : 1;
        cost += t > kSoft ? kSoft * (2 * t - kSoft) : t * t;
        W.middleRows<3>(3 * i) = weight / kMeasured * J(Eigen::all, task.unknowns);
        y.segment<3>(3 * i) = weight * r;
      }
      H.selfadjointView<Eigen::Lower>().rankUpdate(W.transpose());
      b += W.transpose() * y;
    }
    if (std::abs(before - cost) < kSettled * cost) break;
    before = cost;
    xi(task.unknowns) += H.selfadjointView<Eigen::Lower>().llt().solve(b);
  }
  return xi(task.unknowns);
}

}  // namespace selfcal::bench
