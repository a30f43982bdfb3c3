#include "kinematics/robots/serial_chain.h"

#include <cmath>

#include "kinematics/kernels/kernels.h"
#include "kinematics/rotation.h"

namespace selfcal::serial {
namespace {

LaneVector combine(double a, const LaneVector& u, double b, const LaneVector& v) {
  return {a * u.x + b * v.x, a * u.y + b * v.y, a * u.z + b * v.z};
}
LaneVector combine(const Lanes& a, const LaneVector& u, const Lanes& b, const LaneVector& v) {
  return {a * u.x + b * v.x, a * u.y + b * v.y, a * u.z + b * v.z};
}
/// The vector with coordinates `w` in the axes of `pose`.
LaneVector in_axes(const LanePose& pose, const Eigen::Vector3d& w) {
  return {w.x() * pose.x.x + w.y() * pose.y.x + w.z() * pose.z.x,
          w.x() * pose.x.y + w.y() * pose.y.y + w.z() * pose.z.y,
          w.x() * pose.x.z + w.y() * pose.y.z + w.z() * pose.z.z};
}
void advance(LaneVector& p, const Lanes& length, const LaneVector& axis) {
  p.x += length * axis.x;
  p.y += length * axis.y;
  p.z += length * axis.z;
}

/// T = Rot(y, beta) Rot(x, alpha) Trans(x, d) Rot(z, theta) Trans(z, r).
void step_numbers(Motion motion, const Eigen::Ref<const Eigen::VectorXd>& v, const Lanes& variable,
                  LanePose& pose, Axes* axes) {
  const double ca = std::cos(v[kAlpha]), sa = std::sin(v[kAlpha]);
  const double cb = std::cos(v[kBeta]), sb = std::sin(v[kBeta]);
  const LaneVector x = combine(cb, pose.x, -sb, pose.z);
  const LaneVector z = combine(sb, pose.x, cb, pose.z);
  if (axes) {
    axes->turn[0] = pose.y;
    axes->turn[1] = x;
    axes->before = pose.p;
  }
  const LaneVector y = combine(ca, pose.y, sa, z);
  pose.z = combine(-sa, pose.y, ca, z);
  advance(pose.p, Lanes::Constant(kLanes, v[kD]), x);
  if (axes) {
    axes->turn[2] = pose.z;
    axes->at = pose.p;
  }
  Lanes theta = Lanes::Constant(kLanes, v[kTheta]), r = Lanes::Constant(kLanes, v[kR]);
  if (motion == Motion::revolute) theta += variable;
  if (motion == Motion::prismatic) r += variable;
  Lanes c(kLanes), s(kLanes);
  kernels::sine_cosine(theta.data(), kLanes, s.data(), c.data());
  pose.x = combine(c, x, s, y);
  pose.y = combine(c, y, -s, x);
  advance(pose.p, r, pose.z);
}

/// T = Trans(x, y, z) R_0 exp(phi).
void step_whole(const Frame& frame, const Eigen::Ref<const Eigen::VectorXd>& v, LanePose& pose,
                Axes* axes) {
  const Eigen::Vector3d shift = v.head<3>(), phi = v.tail<3>();
  const Eigen::Matrix3d R_0 = rpy_rotation(frame.rpy_nominal), R = R_0 * exp_rotation(phi);
  const LaneVector way = in_axes(pose, shift);
  pose.p = combine(1, pose.p, 1, way);
  if (axes) {
    const Eigen::Matrix3d turns = R_0 * left_jacobian_inverse(phi).inverse();
    for (int i = 0; i < 3; ++i) axes->turn[i] = in_axes(pose, turns.col(i));
    axes->shift = {pose.x, pose.y, pose.z};
    axes->at = pose.p;
  }
  pose = {in_axes(pose, R.col(0)), in_axes(pose, R.col(1)), in_axes(pose, R.col(2)), pose.p};
}

void turn(const LaneVector& a, const LaneVector& o, const LaneVector& end, double* column) {
  Eigen::Map<LaneArray<6>> out(column, kLanes, 6);
  const Lanes lx = end.x - o.x, ly = end.y - o.y, lz = end.z - o.z;
  out.col(0) = a.y * lz - a.z * ly;
  out.col(1) = a.z * lx - a.x * lz;
  out.col(2) = a.x * ly - a.y * lx;
  out.col(3) = a.x;
  out.col(4) = a.y;
  out.col(5) = a.z;
}

void shift(const LaneVector& a, double* column) {
  Eigen::Map<LaneArray<6>> out(column, kLanes, 6);
  out.col(0) = a.x;
  out.col(1) = a.y;
  out.col(2) = a.z;
  out.rightCols<3>().setZero();
}

}  // namespace

LanePose lane_world() {
  const Lanes one = Lanes::Ones(kLanes), zero = Lanes::Zero(kLanes);
  return {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}, {zero, zero, zero}};
}

void step(const Frame& frame, const Eigen::Ref<const Eigen::VectorXd>& values,
          const Lanes& variable, LanePose& pose, Axes* axes) {
  if (frame.whole)
    step_whole(frame, values, pose, axes);
  else
    step_numbers(frame.motion, values, variable, pose, axes);
}

void fill_columns(const Frame& frame, const Axes& axes, const LaneVector& end, int first,
                  PsiBlock& psi) {
  const auto column = [&](int field) { return psi.col(first + field).data(); };
  if (frame.whole) {
    for (int i = 0; i < 3; ++i) {
      shift(axes.shift[i], column(kX + i));
      turn(axes.turn[i], axes.at, end, column(kRx + i));
    }
    return;
  }
  turn(axes.turn[0], axes.before, end, column(kBeta));   // 11.11
  turn(axes.turn[1], axes.before, end, column(kAlpha));  // 11.12
  shift(axes.turn[1], column(kD));                       // 11.13
  turn(axes.turn[2], axes.at, end, column(kTheta));      // 11.14
  shift(axes.turn[2], column(kR));                       // 11.15
}

}  // namespace selfcal::serial
