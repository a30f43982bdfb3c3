#include "constraints/sampling/random_poses.h"

#include <random>
#include <vector>

namespace selfcal {

Eigen::MatrixXd random_poses(const Robot& robot, const Observations* data, int count,
                             unsigned long long seed) {
  std::mt19937_64 random(seed);
  const auto& joints = robot.joints();
  Eigen::MatrixXd q(count, joints.size());
  Eigen::MatrixX2d span(q.cols(), 2);
  for (size_t j = 0; j < joints.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    span.row(column) << joints[j].lower, joints[j].upper;
    if (joints[j].limited()) continue;
    const double reach = joints[j].range() / 2;
    span(column, 0) = data ? data->q.col(column).minCoeff() : -reach;
    span(column, 1) = data ? data->q.col(column).maxCoeff() : reach;
  }
  const auto uniform = [&] { return std::generate_canonical<double, 53>(random); };
  for (int i = 0; i < count; ++i) q.row(i) = robot.draw(span, uniform).transpose();
  return q;
}

Eigen::MatrixXd closing_poses(const Robot& robot, const Eigen::VectorXd& xi,
                              const Eigen::MatrixXd& q) {
  if (!robot.has_loops()) return q;
  std::vector<Eigen::Index> closing;
  Locations X;
  for (Eigen::Index i = 0; i < q.rows(); ++i)
    if (robot.locate(block_of(q.row(i).transpose()), xi, Body::endpoint, X, nullptr).closes())
      closing.push_back(i);
  return q(closing, Eigen::all);
}

}  // namespace selfcal
