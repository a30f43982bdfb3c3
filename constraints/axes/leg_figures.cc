// Residual of chain i and its derivatives, of a measured location (p, R) of the platform:
//   r_i = |p + R b_i - c_i| - l_i                                                          (11.64)
//   dr_i = n_i . (R db_i - dc_i) - dl_i,   n_i along the chain                              (11.63)
// Seven numbers a leg, nine a chain of a Hexa Slide: Gauss-Newton, a step halved where it would not
// fit better.
#include "constraints/axes/leg_figures.h"

#include <algorithm>
#include <cmath>

#include "kinematics/linear_algebra.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kSteps = 100, kHalvings = 30;
constexpr double kStill = 1e-14;  // of the robot's size: what a step that is none moves

struct ChainFit {
  const platform::Platform& robot;
  const DataSet& data;
  const std::vector<int>& rows;
  int chain;

  Location measured(int row) const {
    const auto q = data.rows.orientation.row(row);
    return {Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix(),
            data.rows.position.row(row).transpose()};
  }

  /// Residuals and, unless null, their derivatives to the chain's parameters.
  Eigen::VectorXd residuals(const Eigen::VectorXd& xi, Eigen::MatrixXd* W) const {
    const auto n = static_cast<Eigen::Index>(rows.size());
    Eigen::VectorXd r(n);
    if (W) W->resize(n, robot.chain_parameters());
    for (Eigen::Index i = 0; i < n; ++i) {
      const int row = rows[static_cast<size_t>(i)];
      const Location X = measured(row);
      const platform::Six q = data.rows.q.row(row).transpose();
      const platform::Chains at = robot.chains(xi, q, platform::Six::Zero());
      const Eigen::Vector3d along = X.p + X.R * at.joint.col(chain) - at.carrier.col(chain);
      r[i] = along.norm() - at.length[chain];
      if (!W) continue;
      const platform::ChainDerivatives by = robot.derivatives(xi, chain, q[chain], 0);
      W->row(i) = along.normalized().transpose() * (X.R * by.joint - by.carrier) - by.length;
    }
    return r;
  }

  /// Moves the chain's parameters in `xi` to the best fit; the residuals' sum of squares there.
  double run(Eigen::VectorXd& xi) const {
    const Eigen::Index m = robot.chain_parameters(), at = chain * m;
    Eigen::MatrixXd W;
    double cost = residuals(xi, nullptr).squaredNorm();
    for (int i = 0; i < kSteps; ++i) {
      const Eigen::VectorXd r = residuals(xi, &W);
      Eigen::VectorXd step = -least_squares(W, r);
      const double moves = (W * step).cwiseAbs().maxCoeff();
      bool better = false;
      for (int k = 0; k < kHalvings && !better; ++k, step /= 2) {
        Eigen::VectorXd next = xi;
        next.segment(at, m) += step;
        const double then = residuals(next, nullptr).squaredNorm();
        better = then < cost;
        if (!better) continue;
        cost = then;
        xi = next;
      }
      if (!better || moves < kStill * size_of(robot)) break;
    }
    return cost;
  }
};

}  // namespace

bool of_locations_alone(const DataSet& data) {
  bool any = false;
  for (int row = 0; row < data.rows.rows(); ++row) {
    if (data.rows.check[static_cast<size_t>(row)]) continue;
    const Method& method =
        *data.sets[static_cast<size_t>(data.rows.set[static_cast<size_t>(row)])].method;
    if (method.name() != "location" || method.frame_unknown()) return false;
    any = true;
  }
  return any;
}

LegFigures leg_figures(const platform::Platform& robot, const DataSet& data,
                       const Eigen::VectorXd& start) {
  std::vector<int> rows;
  for (int row = 0; row < data.rows.rows(); ++row)
    if (!data.rows.check[static_cast<size_t>(row)]) rows.push_back(row);
  LegFigures found;
  found.rows = static_cast<int>(rows.size());
  if (found.rows <= robot.chain_parameters()) {
    found.problem = std::to_string(found.rows) + " locations are too few for the " +
                    std::to_string(robot.chain_parameters()) + " parameters of a chain";
    return found;
  }
  found.xi = start;
  double cost = 0;
  for (int chain = 0; chain < platform::kChains; ++chain)
    cost += ChainFit{robot, data, rows, chain}.run(found.xi);
  found.rms = std::sqrt(cost / (platform::kChains * found.rows));
  if (!found.xi.allFinite()) found.problem = "the chains' figures cannot be told from these rows";
  return found;
}

}  // namespace selfcal
