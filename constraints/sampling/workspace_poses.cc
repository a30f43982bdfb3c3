// A place p of the box is reached from random readings by Newton's steps of least length,
//   dq = J_v^+ (p - X(q)),   J_v the first three rows of the joint Jacobian,
// kLanes places at a time; what ends outside the limits or the cone is drawn again.
#include "constraints/sampling/workspace_poses.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "constraints/sampling/random_poses.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kReachSteps = 20;
constexpr double kThere = 1e-6;  ///< of the robot's size, from the place drawn
/// Draws for each pose wanted before what was found must do.
constexpr int kMostDraws = 100;

using Uniform = std::uniform_real_distribution<double>;

/// `rows` ordered by their readings, so that what is drawn between them is the same in whichever
/// order they were written.
Eigen::MatrixXd sorted(const Eigen::MatrixXd& rows) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(rows.rows()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, [&](Eigen::Index a, Eigen::Index b) {
    const auto one = rows.row(a), other = rows.row(b);
    return std::lexicographical_compare(one.begin(), one.end(), other.begin(), other.end());
  });
  return rows(order, Eigen::all);
}

/// The places that the box gives.
class InBox {
 public:
  InBox(const Robot& robot, const Eigen::VectorXd& xi, const Workspace& workspace)
      : robot_(robot), xi_(xi), workspace_(workspace), there_(kThere * size_of(robot)) {}

  /// Appends what kLanes random starts `q` reach.
  void reach(const Eigen::MatrixXd& q, std::mt19937_64& random,
             std::vector<Eigen::VectorXd>& found) {
    ConfigurationBlock block{q.array(), kLanes};
    const std::vector<Eigen::Vector3d> places = draw(random);
    for (int step = 0; step < kReachSteps; ++step) {
      closure_ = robot_.locate(block, xi_, Body::endpoint, X_, &psi_);
      robot_.joint_jacobian(block, xi_, Body::endpoint, psi_, J_);
      for (int lane = 0; lane < kLanes; ++lane) move(lane, places[lane], block);
    }
    closure_ = robot_.locate(block, xi_, Body::endpoint, X_, nullptr);
    for (int lane = 0; lane < kLanes; ++lane) {
      const Eigen::VectorXd there = block.q.row(lane).matrix().transpose();
      if (counts(lane, places[lane]) && within_limits(robot_, there)) found.push_back(there);
    }
  }

 private:
  std::vector<Eigen::Vector3d> draw(std::mt19937_64& random) const {
    Uniform uniform;
    std::vector<Eigen::Vector3d> places(kLanes);
    for (Eigen::Vector3d& p : places) {
      const Eigen::Vector3d share(uniform(random), uniform(random), uniform(random));
      p = workspace_.box->min() + share.cwiseProduct(workspace_.box->sizes());
    }
    return places;
  }

  void move(int lane, const Eigen::Vector3d& place, ConfigurationBlock& block) const {
    const Eigen::Vector3d miss = place - X_.p(lane);
    if (!closure_.closes(lane) || miss.norm() < there_) return;
    Eigen::MatrixXd J(3, J_.cols());
    for (int i = 0; i < 3; ++i) J.row(i) = J_.row(i * kLanes + lane);
    block.q.row(lane) += least_squares(J, miss).transpose().array();
  }

  bool counts(int lane, const Eigen::Vector3d& place) const {
    if (!closure_.closes(lane) || !((X_.p(lane) - place).norm() < there_)) return false;
    if (!workspace_.cone) return true;
    const double cosine = workspace_.approach.dot(X_.R(lane) * robot_.tool_axis());
    return cosine >= std::cos(*workspace_.cone);
  }

  const Robot& robot_;
  const Eigen::VectorXd& xi_;
  const Workspace& workspace_;
  double there_;
  Closure closure_;
  Locations X_;
  PsiBlock psi_;
  Eigen::MatrixXd J_;
};

std::vector<Eigen::VectorXd> in_box(const Robot& robot, const Eigen::VectorXd& xi,
                                    const Workspace& workspace, int count,
                                    unsigned long long seed) {
  InBox box(robot, xi, workspace);
  std::mt19937_64 random(seed);
  std::vector<Eigen::VectorXd> found;
  for (int drawn = 0; drawn < kMostDraws * count && static_cast<int>(found.size()) < count;
       drawn += kLanes)
    box.reach(random_poses(robot, nullptr, kLanes, random()), random, found);
  return found;
}

std::vector<Eigen::VectorXd> between(const Robot& robot, const Eigen::VectorXd& xi,
                                     const Eigen::MatrixXd& unsorted, int count,
                                     unsigned long long seed) {
  std::vector<Eigen::VectorXd> found;
  if (unsorted.rows() == 0) return found;
  const Eigen::MatrixXd rows = sorted(unsorted);
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<Eigen::Index> any(0, rows.rows() - 1);
  Uniform uniform;
  for (int drawn = 0; drawn < kMostDraws * count && static_cast<int>(found.size()) < count;
       ++drawn) {
    const Eigen::Index a = any(random), b = any(random);
    const double share = uniform(random);
    const Eigen::MatrixXd q = (1 - share) * rows.row(a) + share * rows.row(b);
    if (closing_poses(robot, xi, q).rows() > 0) found.push_back(q.row(0).transpose());
  }
  return found;
}

}  // namespace

Eigen::MatrixXd workspace_poses(const Robot& robot, const Eigen::VectorXd& xi,
                                const Workspace& workspace, const Eigen::MatrixXd& rows, int count,
                                unsigned long long seed) {
  const std::vector<Eigen::VectorXd> found = workspace.box
                                                 ? in_box(robot, xi, workspace, count, seed)
                                                 : between(robot, xi, rows, count, seed);
  const auto poses = std::min<Eigen::Index>(count, static_cast<Eigen::Index>(found.size()));
  Eigen::MatrixXd q(poses, static_cast<Eigen::Index>(robot.joints().size()));
  for (Eigen::Index i = 0; i < poses; ++i)
    q.row(i) = found[static_cast<std::size_t>(i)].transpose();
  return q;
}

}  // namespace selfcal
