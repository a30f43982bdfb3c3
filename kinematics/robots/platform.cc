// Location and generalized Jacobian of a platform by implicit differentiation of its closure:
//   A (dp, turn) = d l_i + n_i . (d c_i - R d b_i)
// and of the link of chain k, seen from the base and from the platform:
//   dn = (1 - n n^T) (dp + turn x R b + R d b - d c) / |p + R b - c|,   d(R^T n) = R^T (dn - turn x
//   n)
#include "kinematics/robots/platform.h"

#include <algorithm>
#include <cmath>

#include "kinematics/expects.h"
#include "kinematics/rotation.h"

namespace selfcal::platform {
namespace {

Six row_of(const Eigen::ArrayXXd& of, int lane) {
  return of.rows() > 0 ? Six(of.row(lane).matrix().transpose()) : Six(Six::Zero());
}

bool within(double angle, double limit) { return !(limit > 0) || angle <= limit; }

double between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The lane is at the configuration of the one before.
bool repeats(const ConfigurationBlock& block, int lane) {
  const auto same = [lane](const Eigen::ArrayXXd& of) {
    return of.rows() == 0 || (of.row(lane) == of.row(lane - 1)).all();
  };
  return same(block.q) && same(block.added);
}

/// Writes to the lane what the one before has.
void repeat(int lane, Closure& closure, Locations& X, PsiBlock* psi) {
  if (!closure.closes(lane - 1)) closure.leave_open(lane, closure.why[lane - 1]);
  X.rotation.row(lane) = X.rotation.row(lane - 1);
  X.position.row(lane) = X.position.row(lane - 1);
  const Eigen::Index lanes = X.position.rows();
  for (int c = 0; psi && c < 6; ++c) psi->row(c * lanes + lane) = psi->row(c * lanes + lane - 1);
}

/// A pose about `home`: up to `shift` along each axis (m), `turn` about each (rad).
Location about(const Location& home, double shift, double turn,
               const std::function<double()>& uniform) {
  Eigen::Vector3d p, phi;
  for (double& v : p) v = shift * (2 * uniform() - 1);
  for (double& v : phi) v = turn * (2 * uniform() - 1);
  return {exp_rotation(phi) * home.R, home.p + p};
}

}  // namespace

std::string Platform::take_mode(const std::optional<Location>& home, double side,
                                const std::array<Swing, kChains>& swing,
                                std::string_view chain_name) {
  Six middle;
  for (int i = 0; i < kChains; ++i)
    middle[i] =
        (joints()[static_cast<size_t>(i)].lower + joints()[static_cast<size_t>(i)].upper) / 2;
  const Chains at_middle = chains(nominal_values(*this), middle, Six::Zero());
  const ClosedChains at = close(at_middle, home ? *home : pose_between(at_middle, side), nullptr);
  if (!at.open.empty()) return at.open;
  mode_ = {at.X, at.volume};
  rest_universal_ = at.n;
  rest_spherical_ = at.X.R.transpose() * at.n;
  for (int i = 0; i < kChains; ++i) {
    const std::string name = std::string(chain_name) + std::to_string(i + 1);
    const Swing& of = swing[static_cast<size_t>(i)];
    passive_.push_back({name + ".universal", i, PassiveKind::universal, of.universal});
    passive_.push_back({name + ".spherical", i, PassiveKind::spherical, of.spherical});
  }
  return {};
}

ClosedChains Platform::closed(const Chains& at, const Location* near,
                              const ClosedChains* before) const {
  if (near) {
    const ClosedChains warm = close_near(at, *near, &mode_);
    if (warm.open.empty()) return warm;
  }
  if (before && before->open.empty()) {
    const ClosedChains warm = close(at, before->X, &mode_);
    if (warm.open.empty()) return warm;
  }
  return close(at, mode_.home, &mode_);
}

bool Platform::swings(const ClosedChains& at) const {
  for (const PassiveJoint& joint : passive_) {
    const bool base = joint.kind == PassiveKind::universal;
    const Eigen::Vector3d n = at.n.col(joint.chain);
    if (!within(base ? between(n, rest_universal_.col(joint.chain))
                     : between(at.X.R.transpose() * n, rest_spherical_.col(joint.chain)),
                joint.swing))
      return false;
  }
  return true;
}

Eigen::VectorXd Platform::leg_lengths(const Eigen::VectorXd& xi, const Eigen::VectorXd& q) const {
  return chains(xi, q, Six::Zero()).length;
}

bool Platform::within_passive_limits(const Eigen::VectorXd& q) const {
  if (std::none_of(passive_.begin(), passive_.end(),
                   [](const PassiveJoint& joint) { return joint.swing > 0; }))
    return true;
  const ClosedChains at = closed(chains(nominal_values(*this), q, Six::Zero()), nullptr, nullptr);
  return at.open.empty() && swings(at);
}

Stand Platform::stand_at(const Eigen::VectorXd& xi, const Six& q, const Location& X) const {
  const Chains at = chains(xi, q, Six::Zero());
  if (!belongs(at, X, mode_)) return Stand::other_mode;
  return swings(at_pose(at, X)) ? Stand::free : Stand::beyond_swing;
}

Closure Platform::locate(const ConfigurationBlock& block, const Eigen::VectorXd& xi, Body body,
                         Locations& X, PsiBlock* psi) const {
  expects(body < Body::first_passive || has_body(*this, body), "a body of the robot");
  Closure closure;
  X.resize(block.lanes());
  if (psi) psi->setZero(6 * block.lanes(), static_cast<Eigen::Index>(parameters().size()));
  ClosedChains before;
  bool astray = false;
  if (block.start && body != Body::first_link) {
    before.X = *block.start;
    astray = !belongs(chains(xi, row_of(block.q, 0), row_of(block.added, 0)), *block.start, mode_);
  }
  const bool knows_near =
      block.near && (body == Body::endpoint || body == Body::last_link) && !block.start;
  for (int lane = 0; lane < block.lanes(); ++lane) {
    X.rotation.row(lane) = Eigen::Matrix3d::Identity().reshaped().transpose().array();
    X.position.row(lane).setZero();
    if (body == Body::first_link) continue;
    if (astray) {
      closure.leave_open(lane,
                         "no location of the platform: the start is of another assembly mode");
      continue;
    }
    if (lane > 0 && repeats(block, lane)) {
      repeat(lane, closure, X, psi);
      continue;
    }
    const Chains of = chains(xi, row_of(block.q, lane), row_of(block.added, lane));
    const std::optional<Location> near =
        knows_near ? std::optional(block.near->at(lane)) : std::nullopt;
    const ClosedChains at =
        closed(of, near ? &*near : nullptr, lane > 0 || block.start ? &before : nullptr);
    before = at;
    if (!at.open.empty()) {
      closure.leave_open(lane, at.open);
      continue;
    }
    place(of, at, body, lane, X);
    if (psi) differentiate(block, xi, of, at, body, lane, *psi);
  }
  return closure;
}

void Platform::place(const Chains& of, const ClosedChains& at, Body body, int lane,
                     Locations& X) const {
  Location there = at.X;
  if (body >= Body::first_passive) {
    const PassiveJoint& joint = passive_[static_cast<size_t>(passive_index(*this, body))];
    const bool base = joint.kind == PassiveKind::universal;
    const Eigen::Vector3d n = at.n.col(joint.chain);
    there.R = link_frame(base ? n : Eigen::Vector3d(at.X.R.transpose() * n));
    there.p = base ? of.carrier.col(joint.chain) : of.joint.col(joint.chain);
  }
  X.rotation.row(lane) = there.R.reshaped().transpose().array();
  X.position.row(lane) = there.p.transpose().array();
}

void Platform::differentiate(const ConfigurationBlock& block, const Eigen::VectorXd& xi,
                             const Chains& of, const ClosedChains& at, Body body, int lane,
                             PsiBlock& psi) const {
  const Elimination::Square inverse = at.A.inverse();
  const Six q = row_of(block.q, lane), added = row_of(block.added, lane);
  const Eigen::Matrix3d& R = at.X.R;
  const int m = chain_parameters();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(6, kChains * m);
  std::array<ChainDerivatives, kChains> by;
  for (int i = 0; i < kChains; ++i) {
    by[i] = derivatives(xi, i, q[i], added[i]);
    all.middleCols(i * m, m) =
        inverse.col(i) *
        (by[i].length + at.n.col(i).transpose() * (by[i].carrier - R * by[i].joint));
  }
  if (body >= Body::first_passive) {
    const PassiveJoint& joint = passive_[static_cast<size_t>(passive_index(*this, body))];
    const int k = joint.chain;
    const bool base = joint.kind == PassiveKind::universal;
    const Eigen::Vector3d n = at.n.col(k), arm = R * of.joint.col(k);
    Eigen::MatrixXd dn = all.topRows<3>() - skew(arm) * all.bottomRows<3>();
    dn.middleCols(k * m, m) += R * by[k].joint - by[k].carrier;
    dn = (dn - n * (n.transpose() * dn)).eval() / (at.X.p + arm - of.carrier.col(k)).norm();
    if (!base) dn = (R.transpose() * (dn + skew(n) * all.bottomRows<3>())).eval();
    all.topRows<3>().setZero();
    all.block(0, k * m, 3, m) = base ? by[k].carrier : by[k].joint;
    all.bottomRows<3>() = link_turns(link_frame(base ? n : Eigen::Vector3d(R.transpose() * n)), dn);
  }
  for (int c = 0; c < 6; ++c) psi.row(c * (psi.rows() / 6) + lane) = all.row(c);
}

/// Poses about home, by the readings that lead there, well away from singular places; the farther
/// ones give way where the limits leave little room.
Eigen::VectorXd Platform::draw(const Eigen::MatrixX2d& span,
                               const std::function<double()>& uniform) const {
  constexpr int kTries = 400, kBeforeNearer = 50;
  constexpr double kMostTurned = 0.5, kFarFromSingular = 0.3;
  constexpr double kSame = 1e-6;  // of the platform's size
  const Eigen::VectorXd xi = nominal_values(*this);
  const double stroke = (span.col(1) - span.col(0)).mean() / 2;
  double share = 1;
  for (int attempt = 1; attempt <= kTries; ++attempt) {
    const Location X = about(mode_.home, share * stroke, share * kMostTurned, uniform);
    if (attempt % kBeforeNearer == 0) share /= 2;
    const auto q = readings_at(xi, X);
    if (!q || (q->array() < span.col(0).array()).any() || (q->array() > span.col(1).array()).any())
      continue;
    const Chains legs = chains(xi, *q, Six::Zero());
    const ClosedChains at = close(legs, mode_.home, &mode_);
    if (at.open.empty() && (at.X.p - X.p).norm() < kSame * size_of(legs) && swings(at) &&
        at.volume / mode_.volume > kFarFromSingular)
      return *q;
  }
  return span.rowwise().mean();
}

}  // namespace selfcal::platform
