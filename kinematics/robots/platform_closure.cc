// Where a platform stands that six chains carry. With n_i along chain i,
//   d|p + R b_i - c_i| = n_i . dp + (R b_i x n_i) . turn,
// six equations for a step (dp, turn). Where their volume vanishes the platform can go either way:
// such places part the assembly modes from each other, and no step may cross one.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "kinematics/robots/platform.h"
#include "kinematics/rotation.h"

namespace selfcal::platform {
namespace {

constexpr int kSteps = 60, kHalvings = 12, kMostParts = 16;
constexpr double kLongestTurn = 0.3;   // rad a step; as far in sizes of the platform
constexpr double kClosed = 1e-13;      // of the longest chain: what rounding leaves of the lengths
constexpr double kSingular = 1e-7;     // volume of a place where the platform is loose
constexpr double kFarthestTurn = 2.1;  // rad from home: beyond, the chains are wound up
constexpr double kBetter = 1 - 1e-3;   // of the misfit, what counts as closing

/// The chains with the platform at X: R b_i, p + R b_i - c_i, and how long these are.
struct Reached {
  Centres arm, way;
  Six length;
};

Reached reached(const Chains& chains, const Location& X) {
  Reached at;
  for (int i = 0; i < kChains; ++i) {
    at.arm.col(i) = X.R * chains.joint.col(i);
    at.way.col(i) = X.p + at.arm.col(i) - chains.carrier.col(i);
    at.length[i] = at.way.col(i).norm();
  }
  return at;
}

std::string does_not_close(const Six& f) {
  Six::Index worst = 0;
  f.cwiseAbs().maxCoeff(&worst);
  char text[120];
  std::snprintf(text, sizeof text,
                "no location of the platform: the lengths do not fit together, %.2g mm are left at "
                "chain %d",
                1e3 * std::abs(f[worst]), static_cast<int>(worst) + 1);
  return text;
}

}  // namespace

void Elimination::compute(const Square& A) {
  lu_ = A;
  for (int k = 0; k < kChains; ++k) {
    int row = k;
    for (int i = k + 1; i < kChains; ++i)
      if (std::abs(lu_(i, k)) > std::abs(lu_(row, k))) row = i;
    exchanged_[static_cast<std::size_t>(k)] = row;
    if (row != k) lu_.row(k).swap(lu_.row(row));
    per_[k] = 1 / lu_(k, k);
    if (lu_(k, k) == 0) continue;
    for (int i = k + 1; i < kChains; ++i) lu_(i, k) *= per_[k];
    for (int j = k + 1; j < kChains; ++j)
      for (int i = k + 1; i < kChains; ++i) lu_(i, j) -= lu_(i, k) * lu_(k, j);
  }
}

Six Elimination::solve(const Six& b) const {
  Six x = b;
  for (int k = 0; k < kChains; ++k) std::swap(x[k], x[exchanged_[static_cast<std::size_t>(k)]]);
  for (int k = 0; k < kChains; ++k)
    for (int i = k + 1; i < kChains; ++i) x[i] -= lu_(i, k) * x[k];
  for (int k = kChains - 1; k >= 0; --k) {
    x[k] *= per_[k];
    for (int i = 0; i < k; ++i) x[i] -= lu_(i, k) * x[k];
  }
  return x;
}

Elimination::Square Elimination::inverse() const {
  Square all;
  for (int k = 0; k < kChains; ++k) all.col(k) = solve(Six::Unit(k));
  return all;
}

double Elimination::determinant() const {
  double product = 1;
  for (int k = 0; k < kChains; ++k)
    product *= exchanged_[static_cast<std::size_t>(k)] == k ? lu_(k, k) : -lu_(k, k);
  return product;
}

double size_of(const Chains& chains) {
  const Eigen::Vector3d middle = chains.joint.rowwise().mean();
  return (chains.joint.colwise() - middle).colwise().norm().mean();
}

namespace {

/// What closes at X, of a platform of `size`.
ClosedChains placed(const Reached& chains, const Location& X, double size) {
  ClosedChains at;
  at.X = X;
  Elimination::Square A;
  for (int i = 0; i < kChains; ++i) {
    at.n.col(i) = chains.way.col(i) / chains.length[i];
    A.row(i) << at.n.col(i).transpose(),
        Eigen::Vector3d(chains.arm.col(i)).cross(Eigen::Vector3d(at.n.col(i))).transpose();
  }
  at.A.compute(A);
  at.volume = at.A.determinant() / (size * size * size);
  return at;
}

/// One Newton step from `at`, shortened until the lengths fit better; false where none does.
bool step(const Chains& chains, const AssemblyMode* mode, double size, ClosedChains& at, Six& f,
          bool& barred) {
  const Six dX = at.A.solve(-f);
  if (!dX.allFinite()) return false;
  const double reach = std::max(dX.tail<3>().norm(), dX.head<3>().norm() / size);
  double share = std::min(1.0, kLongestTurn / std::max(reach, 1e-300));
  for (int i = 0; i < kHalvings; ++i, share /= 2) {
    const Location X{exp_rotation(share * dX.tail<3>()) * at.X.R, at.X.p + share * dX.head<3>()};
    const Reached there = reached(chains, X);
    const Six g = there.length - chains.length;
    if (!(g.norm() < kBetter * f.norm())) continue;
    ClosedChains next = placed(there, X, size);
    if (mode && !(std::copysign(next.volume, next.volume * mode->volume) > kSingular)) {
      barred = true;
      continue;
    }
    at = std::move(next);
    f = g;
    return true;
  }
  return false;
}

}  // namespace

ClosedChains at_pose(const Chains& chains, const Location& X) {
  return placed(reached(chains, X), X, size_of(chains));
}

bool belongs(const Chains& chains, const Location& start, const AssemblyMode& mode) {
  return at_pose(chains, start).volume * mode.volume > 0 &&
         log_rotation(start.R * mode.home.R.transpose()).norm() <= kFarthestTurn;
}

ClosedChains close_near(const Chains& chains, const Location& start, const AssemblyMode* mode) {
  const double size = size_of(chains), fits = kClosed * chains.length.cwiseAbs().maxCoeff();
  const Reached from = reached(chains, start);
  ClosedChains at = placed(from, start, size);
  if ((chains.length.array() <= 0).any()) {
    at.open = "no location of the platform: a chain has no length";
    return at;
  }
  Six f = from.length - chains.length;
  bool barred = false;
  for (int i = 0; i < kSteps && !(f.cwiseAbs().maxCoeff() < fits / 100); ++i)
    if (!step(chains, mode, size, at, f, barred)) break;
  if (!(f.cwiseAbs().maxCoeff() < fits)) {
    at.open = barred ? "no location of the platform on its side of the singular places: another "
                       "assembly mode"
                     : does_not_close(f);
  } else if (std::abs(at.volume) < kSingular) {
    at.open = "the platform is loose there: a singular place";
  } else if (mode && log_rotation(at.X.R * mode->home.R.transpose()).norm() > kFarthestTurn) {
    at.open = "the platform would be turned over: another assembly mode";
  }
  return at;
}

ClosedChains close(const Chains& chains, const Location& start, const AssemblyMode* mode) {
  ClosedChains at = close_near(chains, start, mode);
  if (at.open.empty() || !mode || (chains.length.array() <= 0).any()) return at;
  const Six from = reached(chains, start).length;
  Chains between = chains;
  ClosedChains last = at_pose(chains, start);
  double share = 0;
  for (int parts = 4; parts <= kMostParts; parts *= 4)
    while (share < 1) {
      between.length = from + (chains.length - from) * (share + 1.0 / parts);
      ClosedChains next = close_near(between, last.X, mode);
      if (!next.open.empty()) break;
      last = std::move(next);
      share += 1.0 / parts;
    }
  return share < 1 ? at : last;
}

Location pose_between(const Chains& chains, double side) {
  const Eigen::Vector3d below = chains.carrier.rowwise().mean(),
                        above = chains.joint.rowwise().mean();
  const Centres c = chains.carrier.colwise() - below, b = chains.joint.colwise() - above;
  Location X;
  X.R = nearest_rotation(c * b.transpose());
  const double across = (c - X.R * b).colwise().squaredNorm().mean();
  const double up = std::sqrt(
      std::max(chains.length.squaredNorm() / kChains - across, 0.01 * std::max(across, 1e-12)));
  X.p = below + side * up * Eigen::Vector3d::UnitZ() - X.R * above;
  return X;
}

Eigen::Matrix3d link_frame(const Eigen::Vector3d& n) {
  const Eigen::Vector3d e = Eigen::Vector3d::UnitX();
  Eigen::Matrix3d R;
  R.col(2) = n;
  R.col(0) = (e - e.dot(n) * n).normalized();
  R.col(1) = n.cross(R.col(0));
  return R;
}

/// n x dn, and about n what keeps x towards e: y . dx = -(e . n)(y . dn) / |e - (e . n) n|.
Eigen::MatrixXd link_turns(const Eigen::Matrix3d& frame, const Eigen::MatrixXd& dn) {
  const Eigen::Vector3d n = frame.col(2), y = frame.col(1);
  const double along = n.x(), across = std::sqrt(std::max(1 - along * along, 1e-30));
  return skew(n) * dn - n * ((along / across) * (y.transpose() * dn));
}

}  // namespace selfcal::platform
