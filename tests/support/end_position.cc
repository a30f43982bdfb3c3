#include "tests/support/end_position.h"

#include <algorithm>

#include "constraints/sampling/random_poses.h"

namespace selfcal {

Eigen::Vector3d endpoint(const Robot& robot, const Eigen::VectorXd& xi, const Eigen::VectorXd& q) {
  return locate(robot, xi, q).p;
}

std::vector<double> aligned_errors(const Robot& robot, const Eigen::VectorXd& xi,
                                   const Eigen::VectorXd& truth) {
  const Eigen::MatrixXd q = random_poses(robot, nullptr, 500, 11);
  Eigen::Matrix3Xd model(3, q.rows()), real(3, q.rows());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    model.col(i) = endpoint(robot, xi, q.row(i));
    real.col(i) = endpoint(robot, truth, q.row(i));
  }
  const Eigen::Isometry3d motion(Eigen::umeyama(model, real, false));
  std::vector<double> errors;
  for (Eigen::Index i = 0; i < q.rows(); ++i)
    errors.push_back((motion * model.col(i) - real.col(i)).norm());
  std::ranges::sort(errors);
  return errors;
}

}  // namespace selfcal
