// From axes to frames. Frame j has z along axis j; the next frame follows by
//   T = Rot(y, beta) Rot(x, alpha) Trans(x, d) Rot(z, theta) Trans(z, r) (11.3)
// so that o_j, the origin of frame j, and its x direction decide what alpha, d and beta have to be:
// the next axis must cross the line from o_j along Rot(y, beta) x at a right angle. This holds for
// the foot P of the perpendicular from o_j on the next axis, when x points to it (within the plane
// normal to z_j). Where o_j is the foot of the common normal beta is zero; for parallel axes, whose
// common normal is anywhere or far away, o_j stays where it is (r = 0) and beta takes the rest
// (Hayati, Robot arm geometric link parameter estimation, CDC 1983).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/chains/joint_chain.h"
#include "kinematics/expects.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using serial::Frame;

constexpr double kRoundAngle = 1e-10, kRoundLength = 1e-11;
constexpr double kDigits = 1e12;  // what is less than 1 / kDigits is the computation's own
constexpr double kQuarter = std::numbers::pi / 2;
constexpr double kClear = 1e-6;  // cosine from which on two directions are nearer than opposed

double rounded_angle(double angle) {
  const double turns = std::round(angle / kQuarter);
  return std::abs(angle - turns * kQuarter) < kRoundAngle ? turns * kQuarter + 0.0
                                                          : std::round(angle * kDigits) / kDigits;
}

double rounded_length(double length) {
  return std::abs(length) < kRoundLength ? 0 : std::round(length * kDigits) / kDigits;
}

/// A line with its direction, in W.
struct AxisLine {
  Vector3d p, z;
};

Vector3d foot(const AxisLine& line, const Vector3d& from) {
  return line.p + line.z * line.z.dot(from - line.p);
}

/// Where frame j stands on its axis.
struct Stand {
  Vector3d o, x;
  bool parallel = false;  ///< to the next axis
};

/// `x` or its opposite, whichever is nearer to `to`; where neither is, as it is.
Vector3d nearer(const Vector3d& x, const Vector3d& to) { return x.dot(to) < -kClear ? -x : x; }

/// Frame j on `axis`, for `next` to follow, x rather along `before`; A is the frame before its
/// theta and r.
Stand stand(const AxisLine& axis, const AxisLine& next, const Isometry3d& A,
            const Vector3d& before) {
  const Vector3d n = axis.z.cross(next.z);
  const double sine = n.norm(), cosine = axis.z.dot(next.z);
  if (sine < kParallel) {
    Vector3d to = foot(next, A.translation()) - A.translation();
    to -= axis.z * axis.z.dot(to);
    const bool apart = to.norm() > kRoundLength;
    return {A.translation(), apart ? nearer(to.normalized(), before) : before, true};
  }
  const Vector3d between = next.p - axis.p;
  const double along = (between.dot(axis.z) - cosine * between.dot(next.z)) / (sine * sine);
  const Vector3d o = axis.p + along * axis.z;
  const double d = (foot(next, o) - o).dot(n) / sine;
  const Vector3d x = (d < -kRoundLength ? -n : n) / sine;
  return {o, nearer(x, before), false};
}

/// alpha, d and beta with which `next` follows frame F.
void lead_on(const Isometry3d& F, const AxisLine& next, bool parallel, Frame& frame) {
  const Vector3d z = F.linear().transpose() * next.z;
  const Vector3d P = F.inverse() * foot(next, F.translation());
  const double side = z.z() < 0 ? -1 : 1;
  const double beta = parallel ? rounded_angle(std::atan2(side * z.x(), side * z.z())) : 0;
  const double rest = parallel ? side * std::hypot(z.x(), z.z()) : z.z();
  frame.value[serial::kBeta] = beta;
  frame.value[serial::kAlpha] = rounded_angle(std::atan2(-z.y(), rest));
  frame.value[serial::kD] = rounded_length(P.x() * std::cos(beta) - P.z() * std::sin(beta));
}

/// theta and r that take A to `to` on its axis.
void turn_on(const Isometry3d& A, const Stand& to, Frame& frame) {
  const Vector3d x = A.linear().transpose() * to.x;
  frame.value[serial::kTheta] = rounded_angle(std::atan2(x.y(), x.x()));
  frame.value[serial::kR] = rounded_length((A.inverse() * to.o).z());
}

Frame named_frame(const std::string& name, serial::Motion motion) {
  Frame frame;
  frame.name = name;
  frame.motion = motion;
  return frame;
}

Frame whole_pose(const std::string& name, const Isometry3d& X) {
  Frame frame = named_frame(name, serial::Motion::fixed);
  frame.whole = true;
  frame.value = frame.nominal = Eigen::VectorXd::Zero(serial::kPoseFields);
  frame.tolerance = Eigen::VectorXd::Constant(serial::kPoseFields, -1);
  frame.value.head<3>() = X.translation().unaryExpr(&rounded_length);
  frame.nominal = frame.value;
  frame.rpy = frame.rpy_nominal = rpy_of(X.linear()).unaryExpr(&rounded_angle);
  return frame;
}

/// `name`, or one like it that no frame has.
std::string free_name(std::string name, const serial::Model& model, const JointChain& chain,
                      FixedJoints fixed) {
  while (std::ranges::find(chain.joints, name, &ChainJoint::name) != chain.joints.end() ||
         (fixed == FixedJoints::kept &&
          std::ranges::find(chain.fixed, name, &FixedJoint::name) != chain.fixed.end()) ||
         std::ranges::find(model.frames, name, &Frame::name) != model.frames.end())
    name += "_";
  return name;
}

bool mimics(const ChainJoint& joint) { return joint.mimicry.has_value(); }

void add_mimicry(const JointChain& chain, serial::Model& model) {
  if (std::ranges::none_of(chain.joints, &mimics)) return;
  const Coupling coupling = coupling_of(chain);
  model.coupling = coupling.matrix;
  const std::vector<int> moving = serial::moving_frames(model);
  for (size_t j = 0; j < chain.joints.size(); ++j) {
    Frame& frame = model.frames[moving[j]];
    frame.value[frame.motion == serial::Motion::revolute ? serial::kTheta : serial::kR] +=
        coupling.offset[static_cast<Eigen::Index>(j)];
    if (!mimics(chain.joints[j])) continue;
    frame.lower = -kStill;
    frame.upper = kStill;
  }
}

/// One frame of the robot to be: a moving joint, or a fixed one that is kept.
struct Station {
  const ChainJoint* joint = nullptr;  ///< none: fixed
  std::string name;
  Isometry3d own;  ///< z along the axis
  AxisLine line() const { return {own.translation(), own.linear().col(2)}; }
};

std::vector<Station> stations_of(const JointChain& chain, FixedJoints fixed) {
  std::vector<Station> stations;
  auto next = chain.fixed.begin();
  const auto end = fixed == FixedJoints::kept ? chain.fixed.end() : next;
  for (size_t j = 0; j <= chain.joints.size(); ++j) {
    for (; next != end && next->behind <= j; ++next)
      stations.push_back({nullptr, next->name, next->X_WF});
    if (j == chain.joints.size()) break;
    const ChainJoint& joint = chain.joints[j];
    stations.push_back({&joint, joint.name, axis_frame(joint)});
  }
  return stations;
}

/// A frame that stands at `at` and follows F, by way of A, which `leading` leads to, where it
/// moves.
Frame frame_at(const Station& here, const Stand& at, const Isometry3d& F, const Isometry3d& A,
               const Frame& leading) {
  if (!here.joint) {
    const Vector3d z = here.line().z;
    Isometry3d X = Isometry3d::Identity();
    X.linear() << at.x, z.cross(at.x), z;
    X.translation() = at.o;
    return whole_pose(here.name, F.inverse() * X);
  }
  Frame frame = named_frame(here.name, here.joint->motion);
  frame.value = leading.value;
  turn_on(A, at, frame);
  frame.lower = here.joint->lower;
  frame.upper = here.joint->upper;
  frame.mass = here.joint->mass;
  return frame;
}

}  // namespace

Isometry3d axis_frame(const ChainJoint& joint) {
  Isometry3d X = joint.X_WJ;
  X.rotate(turn_onto(Vector3d::UnitZ(), joint.axis));
  return X;
}

Coupling coupling_of(const JointChain& chain) {
  const auto n = static_cast<Eigen::Index>(chain.joints.size());
  Coupling coupling{Eigen::MatrixXd::Identity(n, n), Eigen::VectorXd::Zero(n)};
  for (Eigen::Index j = 0; j < n; ++j) {
    double factor = 1;
    const ChainJoint* joint = &chain.joints[static_cast<size_t>(j)];
    for (Eigen::Index steps = 0; mimics(*joint); ++steps) {
      expects(steps < n, "a mimicry leads to itself");
      const Mimicry& mimicry = *joint->mimicry;
      coupling.offset[j] += factor * mimicry.offset;
      factor *= mimicry.multiplier;
      joint = &chain.joints[static_cast<size_t>(mimicry.leader)];
      if (!mimics(*joint)) coupling.matrix(j, mimicry.leader) += factor;
    }
  }
  return coupling;
}

serial::Model frames_of(const JointChain& chain, FixedJoints fixed) {
  expects(!chain.joints.empty(), "a chain has a joint");
  serial::Model model;
  model.name = chain.name;
  const std::vector<Station> stations = stations_of(chain, fixed);
  Isometry3d F = Isometry3d::Identity();
  if (stations.front().joint) {
    model.frames.push_back(
        whole_pose(free_name("base", model, chain, fixed), stations.front().own));
    F = serial::pose_in_parent(model.frames.front(), 0);
  }
  Isometry3d A = F;
  Frame leading = named_frame("", serial::Motion::fixed);
  for (size_t i = 0; i < stations.size(); ++i) {
    const Station& here = stations[i];
    const Station* next =
        i + 1 < stations.size() && stations[i + 1].joint ? &stations[i + 1] : nullptr;
    if (!here.joint) A = here.own;
    const Vector3d before = A.linear().col(0);
    const Stand at = next ? stand(here.line(), next->line(), A,
                                  here.joint ? here.joint->x.value_or(before) : before)
                          : Stand{here.own.translation(), here.own.linear().col(0)};
    Frame frame = frame_at(here, at, F, A, leading);
    F = F * serial::pose_in_parent(frame, 0);
    if (frame.mass)
      frame.com = (F.inverse() * (here.joint->X_WJ * here.joint->com)).unaryExpr(&rounded_length);
    model.frames.push_back(frame);
    if (!next) continue;
    leading.value.setZero();
    lead_on(F, next->line(), at.parallel, leading);
    A = F * serial::pose_in_parent(leading, 0);
  }
  if (stations.back().joint)
    model.frames.push_back(
        whole_pose(free_name("tool", model, chain, fixed), F.inverse() * chain.X_WT));
  add_mimicry(chain, model);
  for (Frame& frame : model.frames) frame.nominal = frame.value;
  return model;
}

}  // namespace selfcal
