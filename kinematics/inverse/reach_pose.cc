#include "kinematics/inverse/reach_pose.h"

#include <algorithm>
#include <cmath>

#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/rotation.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kMostSteps = 100;
constexpr double kThere = 1e-9;       // of the robot's size; rad
constexpr double kWhole = 0.2;        // of the robot's size: what a turn weighs beside a shift
constexpr double kBeside = 1e-5;      // the same at last, where the orientation cannot be had
constexpr double kLighter = 30;       // so many times from one weight to the next
constexpr double kSettled = 0.999;    // of what was left before: as near as this weight brings it
constexpr double kLongestStep = 0.5;  // units of the readings
constexpr double kFirstDamping = 1e-4, kMostDamping = 1e6, kLeastDamping = 1e-12;

/// One lane on its way.
struct Lane {
  Eigen::VectorXd q, e;  ///< where it is, and what is left there, over the robot's size
  Eigen::MatrixXd J;     ///< of e, by units of the readings
  double damping = kFirstDamping;
  double weight = kWhole;  ///< of a turn
  ReachedPose best;
  bool done = false;
};

class DampedSteps {
 public:
  DampedSteps(const Robot& robot, const Eigen::VectorXd& xi, const Location& wanted,
              const OperatingPoint& at)
      : robot_(robot),
        xi_(xi),
        wanted_(wanted),
        at_(at),
        size_(size_of(robot)),
        units_(units_of_readings(robot)),
        whole_(robot.joints().size() >= 6) {}

  std::vector<ReachedPose> run(const Eigen::MatrixXd& starts) {
    std::vector<Lane> lanes(static_cast<std::size_t>(starts.rows()));
    for (std::size_t i = 0; i < lanes.size(); ++i)
      lanes[i].q = starts.row(static_cast<Eigen::Index>(i)).transpose();
    std::vector<Eigen::VectorXd> proposed;
    for (const Lane& lane : lanes) proposed.push_back(lane.q);
    for (int step = 0; step <= kMostSteps; ++step) {
      evaluate(proposed);
      bool any = false;
      for (std::size_t i = 0; i < lanes.size(); ++i) {
        if (!lanes[i].done) take(static_cast<int>(i), step, proposed[i], lanes[i]);
        if (lanes[i].done) continue;
        any = true;
        proposed[i] = next(lanes[i]);
      }
      if (!any) break;
    }
    std::vector<ReachedPose> list;
    for (Lane& lane : lanes) list.push_back(std::move(lane.best));
    return list;
  }

 private:
  void evaluate(const std::vector<Eigen::VectorXd>& proposed) {
    ConfigurationBlock block;
    block.count = static_cast<int>(proposed.size());
    block.q.resize(kLanes, proposed.front().size());
    for (int lane = 0; lane < kLanes; ++lane)
      block.q.row(lane) =
          proposed[std::min(static_cast<std::size_t>(lane), proposed.size() - 1)].transpose();
    // A load pulls as the tool is turned: where it is to be or, of one that cannot be had, was
    // last.
    block.conditions = conditions_at(at_, robot_, kLanes, [&](int lane) -> Eigen::Matrix3d {
      return whole_ || psi_.rows() == 0 ? wanted_.R : X_.R(lane);
    });
    closure_ = robot_.locate(block, xi_, Body::endpoint, X_, &psi_);
    robot_.joint_jacobian(block, xi_, Body::endpoint, psi_, J_);
  }

  /// Takes the proposal where it is better than where the lane is, else damps more.
  void take(int i, int step, const Eigen::VectorXd& proposed, Lane& lane) {
    if (!closure_.closes(i)) return refuse(lane);
    const Eigen::Vector3d shift = wanted_.p - X_.p(i);
    const Eigen::Vector3d turn = log_rotation(wanted_.R * X_.R(i).transpose());
    Eigen::VectorXd e(6);
    e << shift / size_, lane.weight * turn;
    const bool first = lane.e.size() == 0;
    if (!first && !(e.norm() < lane.e.norm())) return refuse(lane);
    const bool settled = !first && e.norm() > kSettled * lane.e.norm();
    if (!first) lane.damping = std::max(lane.damping / 10, kLeastDamping);
    lane.q = proposed;
    lane.e = e;
    lane.J.resize(6, J_.cols());
    for (int c = 0; c < 6; ++c)
      lane.J.row(c) = (c < 3 ? 1 / size_ : lane.weight) *
                      J_.row(c * kLanes + i).cwiseProduct(units_.matrix().transpose());
    const bool placed = shift.norm() < kThere * size_, turned = turn.norm() < kThere;
    lane.best = {proposed, shift.norm(), turn.norm(), step, placed && (turned || !whole_)};
    lane.done = placed && turned;
    if (settled && !whole_ && !lane.done) lighten(lane);
  }

  void refuse(Lane& lane) const {
    lane.damping *= 10;
    if (lane.e.size() == 0) {
      lane.done = true;
    } else if (lane.damping > kMostDamping) {
      whole_ ? void(lane.done = true) : lighten(lane);
    }
  }

  /// Where the whole pose cannot be had, the orientation comes as near as it goes while the
  /// position weighs the more from one weight to the next: at the last one alone, the way round the
  /// position would be as bent as it is.
  static void lighten(Lane& lane) {
    const double lighter = std::max(lane.weight / kLighter, kBeside);
    lane.done = lighter == lane.weight;
    lane.e.tail(3) *= lighter / lane.weight;
    lane.J.bottomRows(3) *= lighter / lane.weight;
    lane.weight = lighter;
    lane.damping = kFirstDamping;
  }

  Eigen::VectorXd next(const Lane& lane) const {
    const Eigen::Index n = lane.J.cols();
    Eigen::MatrixXd A(6 + n, n);
    A.topRows(6) = lane.J;
    A.bottomRows(n) = std::sqrt(lane.damping) * Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(6 + n);
    b.head(6) = lane.e;
    Eigen::VectorXd dq = least_squares(A, b);
    if (dq.norm() > kLongestStep) dq *= kLongestStep / dq.norm();
    return lane.q + units_.matrix().cwiseProduct(dq);
  }

  const Robot& robot_;
  const Eigen::VectorXd& xi_;
  const Location& wanted_;
  const OperatingPoint& at_;
  const double size_;           ///< m
  const Eigen::ArrayXd units_;  ///< of readings
  bool whole_;                  ///< position and orientation can be had
  Closure closure_;
  Locations X_;
  PsiBlock psi_;
  Eigen::MatrixXd J_;
};

}  // namespace

std::vector<ReachedPose> reach_pose(const Robot& robot, const Eigen::VectorXd& xi,
                                    const Location& wanted, const Eigen::MatrixXd& starts,
                                    const OperatingPoint& at) {
  expects(starts.rows() >= 1 && starts.rows() <= kLanes, "one to kLanes starts");
  return DampedSteps(robot, xi, wanted, at).run(starts);
}

}  // namespace selfcal
