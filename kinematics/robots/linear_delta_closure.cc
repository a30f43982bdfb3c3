// Where the effector of a linear delta is for its readings, and the readings for where it is.
//
// It is where three spheres about the carriages meet. With e_x from c_1 to c_2, e_y in the plane of
// the three, e_z across, d = |c_2 - c_1|, (i, j) = c_3 - c_1 in e_x, e_y:
//   x = (l_1^2 - l_2^2 + d^2) / 2 d,   y = (l_1^2 - l_3^2 + i^2 + j^2 - 2 i x) / 2 j,
//   h^2 = l_1^2 - x^2 - y^2,           p = c_1 + x e_x + y e_y +- h e_z, the lower one.
// The other way each rod is on its own: along its tower, the root of rod^2 less the distance
// across.
#include <algorithm>
#include <cmath>

#include "kinematics/robots/linear_delta.h"
#include "kinematics/rotation.h"

namespace selfcal::linear_delta {
namespace {

/// Rods whose common perpendicular is shorter than this share of the first lie flat: the effector
/// could go either way, and its derivatives have no bound.
constexpr double kFlat = 1e-4;

std::string rods(int a, int b) {
  return "no position of the effector: rods " + std::to_string(a + 1) + " and " +
         std::to_string(b + 1) + " cannot meet";
}

/// Pairs that are too far apart, or one within the other's sphere.
std::string apart(const Eigen::Matrix3d& c, const Eigen::Vector3d& rod) {
  for (int a = 0; a < kTowers; ++a)
    for (int b = a + 1; b < kTowers; ++b) {
      const double far = (c.col(a) - c.col(b)).norm();
      if (!(far < rod[a] + rod[b] && far > std::abs(rod[a] - rod[b]))) return rods(a, b);
    }
  return {};
}

void meet(const Eigen::Vector3d& rod, ClosedLoops& at) {
  at.open = apart(at.carriage, rod);
  if (!at.open.empty()) return;
  const Eigen::Vector3d c1 = at.carriage.col(0);
  const Eigen::Vector3d a = at.carriage.col(1) - c1, b = at.carriage.col(2) - c1;
  const double d = a.norm(), i = a.dot(b) / d;
  const Eigen::Vector3d across = b - i * a / d;
  const double j = across.norm();
  if (j < kFlat * rod[0]) {
    at.open = "no position of the effector: the carriages stand in one line";
    return;
  }
  const Eigen::Vector3d ex = a / d, ey = across / j;
  const double x = (rod[0] * rod[0] - rod[1] * rod[1] + d * d) / (2 * d);
  const double y = (rod[0] * rod[0] - rod[2] * rod[2] + i * i + j * j - 2 * i * x) / (2 * j);
  const double h2 = rod[0] * rod[0] - x * x - y * y;
  if (h2 < std::pow(kFlat * rod[0], 2)) {
    at.open = "no position of the effector: the three rods do not meet in one point";
    return;
  }
  Eigen::Vector3d ez = ex.cross(ey);
  if (ez.z() > 0) ez = -ez;
  at.down = ez;
  at.p = c1 + x * ex + y * ey + std::sqrt(h2) * ez;
}

}  // namespace

Eigen::Vector3d tilt_of(const Eigen::VectorXd& xi, int at) { return {xi[at], xi[at + 1], 0}; }

ClosedLoops close(const Eigen::VectorXd& xi, const std::array<Tower, kTowers>& towers,
                  const Eigen::Vector3d& q, const Eigen::Vector3d& added) {
  ClosedLoops at;
  at.towers = towers;
  Eigen::Vector3d rod;
  for (int t = 0; t < kTowers; ++t) {
    at.height[t] = xi[index(t, kEndstop)] + xi[index(t, kScale)] * q[t] + added[t];
    at.carriage.col(t) = towers[t].foot + at.height[t] * towers[t].u;
    rod[t] = xi[index(t, kRod)];
  }
  meet(rod, at);
  return at;
}

Tower tower(const Eigen::VectorXd& xi, int t) {
  const double radius = xi[index(t, kRadius)], angle = xi[index(t, kAngle)];
  return {{radius * std::cos(angle), radius * std::sin(angle), 0},
          exp_rotation(tilt_of(xi, index(t, kTiltX))).col(2)};
}

std::optional<Eigen::Vector3d> readings_at(const Eigen::VectorXd& xi, const Eigen::Vector3d& p) {
  Eigen::Vector3d q;
  for (int t = 0; t < kTowers; ++t) {
    const Tower of = tower(xi, t);
    const Eigen::Vector3d from = p - of.foot;
    const double along = from.dot(of.u), across2 = from.squaredNorm() - along * along;
    const double up2 = std::pow(xi[index(t, kRod)], 2) - across2;
    if (up2 < 0) return std::nullopt;
    q[t] = (along + std::sqrt(up2) - xi[index(t, kEndstop)]) / xi[index(t, kScale)];
  }
  return q;
}

double working_radius(const Eigen::VectorXd& xi) {
  const double flattest = 3 / std::sqrt(10.0);
  double most = HUGE_VAL;
  for (int t = 0; t < kTowers; ++t) {
    const double radius = xi[index(t, kRadius)];
    most = std::min({most, radius, flattest * xi[index(t, kRod)] - radius});
  }
  return std::max(most, 0.0);
}

}  // namespace selfcal::linear_delta
