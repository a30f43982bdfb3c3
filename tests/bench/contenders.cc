#include "tests/bench/contenders.h"

#include <ceres/ceres.h>

#include <memory>

#include "kinematics/expects.h"

namespace selfcal::bench {
namespace {

/// The unknowns in their places among all values.
template <class T>
struct Values {
  const Task& task;
  const std::array<int, 64>& place;
  const T* unknowns;
  T operator()(int i) const {
    const int at = place[static_cast<std::size_t>(i)];
    return at < 0 ? T(task.xi[i]) : unknowns[at];
  }
};

struct Shared {
  const Task& task;
  Arm arm{example_robot()};
  std::array<int, 64> place{};
  explicit Shared(const Task& of) : task(of) {
    place.fill(-1);
    for (std::size_t i = 0; i < task.unknowns.size(); ++i)
      place[static_cast<std::size_t>(task.unknowns[i])] = static_cast<int>(i);
  }
};

struct Position {
  const Shared& shared;
  Eigen::VectorXd q;
  Eigen::Vector3d measured;

  template <class T>
  bool operator()(const T* unknowns, T* residual) const {
    const Eigen::Matrix<T, 3, 1> p =
        endpoint_of<T>(shared.arm, Values<T>{shared.task, shared.place, unknowns}, q.data());
    for (int i = 0; i < 3; ++i) residual[i] = (p[i] - T(measured[i])) / T(kMeasured);
    return true;
  }
};

class AnalyticPosition final : public ceres::SizedCostFunction<3, kUnknowns> {
 public:
  AnalyticPosition(const Shared& shared, Eigen::VectorXd q, Eigen::Vector3d measured)
      : shared_(shared), q_(std::move(q)), measured_(std::move(measured)) {}

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Task& task = shared_.task;
    Eigen::VectorXd xi = task.xi;
    for (std::size_t i = 0; i < task.unknowns.size(); ++i) xi[task.unknowns[i]] = parameters[0][i];
    Eigen::Matrix3Xd J;
    const Eigen::Vector3d p = endpoint_and_jacobian(shared_.arm, xi, q_.data(), J);
    Eigen::Map<Eigen::Vector3d>{residuals} = (p - measured_) / kMeasured;
    if (jacobians && jacobians[0]) {
      Eigen::Map<Eigen::Matrix<double, 3, kUnknowns, Eigen::RowMajor>> out(jacobians[0]);
      out = J(Eigen::all, task.unknowns) / kMeasured;
    }
    return true;
  }

 private:
  const Shared& shared_;
  Eigen::VectorXd q_;
  Eigen::Vector3d measured_;
};

}  // namespace

Eigen::VectorXd solve_by_ceres(const Task& task, Derivatives derivatives, Solver solver) {
  const Shared shared(task);
  Eigen::VectorXd unknowns = task.xi(task.unknowns);
  ceres::Problem problem;
  const Observations& rows = task.data.rows;
  for (int row = 0; row < rows.rows(); ++row) {
    const Eigen::VectorXd q = rows.q.row(row).transpose();
    const Eigen::Vector3d measured = rows.position.row(row).transpose();
    ceres::CostFunction* cost = nullptr;
    if (derivatives == Derivatives::automatic)
      cost = new ceres::AutoDiffCostFunction<Position, 3, kUnknowns>(
          new Position{shared, q, measured});
    else
      cost = new AnalyticPosition(shared, q, measured);
    problem.AddResidualBlock(cost, new ceres::HuberLoss(3), unknowns.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type =
      solver == Solver::qr ? ceres::DENSE_QR : ceres::DENSE_NORMAL_CHOLESKY;
  options.num_threads = 1;
  options.function_tolerance = 1e-10;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  expects(summary.IsSolutionUsable(), "Ceres solves the task");
  return unknowns;
}

std::function<double()> automatic_row(const Task& task) {
  const auto shared = std::make_shared<const Shared>(task);
  const auto cost = std::make_shared<const ceres::AutoDiffCostFunction<Position, 3, kUnknowns>>(
      new Position{*shared, task.data.rows.q.row(0).transpose(),
                   task.data.rows.position.row(0).transpose()});
  const Eigen::VectorXd unknowns = task.xi(task.unknowns);
  return [shared, cost, unknowns] {
    std::array<double, 3> residuals;
    std::array<double, 3 * kUnknowns> jacobian;
    double* jacobians[] = {jacobian.data()};
    const double* parameters[] = {unknowns.data()};
    cost->Evaluate(parameters, residuals.data(), jacobians);
    return residuals[0] + jacobian.back();
  };
}

}  // namespace selfcal::bench
