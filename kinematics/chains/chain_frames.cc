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

/// `name`, or one like it that no joint has.
std::string free_name(std::string name, const JointChain& chain) {
  while (std::ranges::find(chain.joints, name, &ChainJoint::name) != chain.joints.end())
    name += "_";
  return name;
}

bool mimics(const ChainJoint& joint) { return joint.mimicry.has_value(); }

void add_mimicry(const JointChain& chain, serial::Model& model) {
  if (std::ranges::none_of(chain.joints, &mimics)) return;
  const Coupling coupling = coupling_of(chain);
  model.coupling = coupling.matrix;
  for (size_t j = 0; j < chain.joints.size(); ++j) {
    Frame& frame = model.frames[j + 1];  // after the base
    frame.value[frame.motion == serial::Motion::revolute ? serial::kTheta : serial::kR] +=
        coupling.offset[static_cast<Eigen::Index>(j)];
    if (!mimics(chain.joints[j])) continue;
    frame.lower = -kStill;
    frame.upper = kStill;
  }
}

}  // namespace

Isometry3d axis_frame(const ChainJoint& joint) {
  Isometry3d X = joint.X_WJ;
  if (joint.axis.z() > -1 + 1e-12)
    X.rotate(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), joint.axis));
  else
    X.rotate(Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX()));
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

serial::Model frames_of(const JointChain& chain) {
  expects(!chain.joints.empty(), "a chain has a joint");
  serial::Model model;
  model.name = chain.name;
  model.frames.push_back(whole_pose(free_name("base", chain), axis_frame(chain.joints.front())));
  const auto line = [&](size_t j) {
    const Isometry3d X = axis_frame(chain.joints[j]);
    return AxisLine{X.translation(), X.linear().col(2)};
  };
  Isometry3d A = serial::pose_in_parent(model.frames.front(), 0), F = A;
  Frame leading = named_frame("", serial::Motion::fixed);
  for (size_t j = 0; j < chain.joints.size(); ++j) {
    const ChainJoint& joint = chain.joints[j];
    Frame frame = named_frame(joint.name, joint.motion);
    frame.value = leading.value;
    const bool last = j + 1 == chain.joints.size();
    const Isometry3d own = axis_frame(joint);
    const Stand at = last ? Stand{own.translation(), own.linear().col(0)}
                          : stand(line(j), line(j + 1), A, joint.x.value_or(A.linear().col(0)));
    turn_on(A, at, frame);
    F = F * serial::pose_in_parent(frame, 0);
    frame.lower = joint.lower;
    frame.upper = joint.upper;
    frame.mass = joint.mass;
    if (joint.mass) frame.com = (F.inverse() * (joint.X_WJ * joint.com)).unaryExpr(&rounded_length);
    model.frames.push_back(frame);
    if (last) break;
    leading.value.setZero();
    lead_on(F, line(j + 1), at.parallel, leading);
    A = F * serial::pose_in_parent(leading, 0);
  }
  model.frames.push_back(whole_pose(free_name("tool", chain), F.inverse() * chain.X_WT));
  add_mimicry(chain, model);
  for (Frame& frame : model.frames) frame.nominal = frame.value;
  return model;
}

}  // namespace selfcal
