#include "kinematics/deviations.h"

#include <algorithm>
#include <limits>

#include "kinematics/statics.h"

namespace selfcal {
namespace {

RegressorInput input_of(const Robot& geometry, const ConfigurationBlock& block, int lane) {
  const MeasurementConditions& c = block.conditions;
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  RegressorInput at;
  at.mechanics = geometry.statics() ? &geometry.statics()->mechanics() : nullptr;
  at.q = block.q.row(lane).matrix().transpose();
  at.poses = seen_poses(geometry, at.q);
  if (c.wrench.rows() > 0 && c.wrench.row(lane).allFinite()) {
    const Eigen::Matrix3d R = at.poses.back().linear();
    at.wrench.force = R * c.wrench.row(lane).head<3>().transpose();
    at.wrench.moment = R * c.wrench.row(lane).tail<3>().transpose();
  }
  const auto n = static_cast<int>(geometry.joints().size());
  at.torque.setConstant(n, unknown);
  for (int j = 0; at.mechanics && j < n; ++j)
    at.torque[j] = joint_torque(*at.mechanics, at.poses, at.wrench, j);
  at.gravity = gravity_of(geometry);
  at.velocity = c.velocity.rows() > 0 ? Eigen::VectorXd(c.velocity.row(lane).transpose())
                                      : Eigen::VectorXd::Constant(n, unknown);
  at.variable_velocity = geometry.variables_per_reading(values(geometry)) * at.velocity;
  at.temperature = c.temperature.size() > 0 ? c.temperature[lane] : unknown;
  at.time = c.time.size() > 0 ? c.time[lane] : unknown;
  at.normal = c.normal.rows() > 0 ? Eigen::Vector3d(c.normal.row(lane).transpose())
                                  : Eigen::Vector3d::Constant(unknown);
  at.set = c.set.empty() ? -1 : c.set[static_cast<size_t>(lane)];
  return at;
}

/// Origin of the last moving link.
Eigen::Vector3d last_link(const Robot& geometry, const RegressorInput& at) {
  if (!at.mechanics) return locate(geometry, values(geometry), at.q, Body::last_link).p;
  return at.poses[at.mechanics->link_of(static_cast<int>(geometry.joints().size()) - 1)]
      .translation();
}

LaneDeviation deviation(const Robot& geometry, const Effects& effects, const RegressorInput& at,
                        Body body) {
  const auto n = static_cast<Eigen::Index>(geometry.joints().size());
  Eigen::Index count = 0;
  for (const auto& effect : effects)
    count += static_cast<Eigen::Index>(effect->parameters().size());
  LaneDeviation all{{Eigen::MatrixXd::Zero(n, count), Eigen::MatrixXd::Zero(6, count)},
                    Eigen::Vector3d::Zero()};
  if (body == Body::last_link) all.arm = last_link(geometry, at) - at.poses.back().translation();
  Eigen::Index column = 0;
  for (const auto& effect : effects) {
    const auto own = static_cast<Eigen::Index>(effect->parameters().size());
    Regressor part{Eigen::MatrixXd::Zero(n, own), Eigen::MatrixXd::Zero(6, own)};
    effect->regressor(at, part);
    all.by.joints.middleCols(column, own) = part.joints;
    all.by.tip.middleCols(column, own) = part.tip;
    column += own;
  }
  // What bends the tip leaves the base and the links alone.
  if (body == Body::first_link || body >= Body::first_passive) all.by.tip.setZero();
  return all;
}

/// `psi` and `work` (of the weights, per parameter) are those of the block's readings with the
/// file's own values.
void see_legs(const Robot& geometry, const PsiBlock& psi, const Eigen::MatrixXd& work, int lane,
              RegressorInput& at) {
  const auto n = static_cast<Eigen::Index>(geometry.joints().size());
  at.legs.resize(6, n);
  at.leg_weights.resize(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const int length = geometry.leg_parameter(static_cast<int>(j));
    for (int c = 0; c < 6; ++c) at.legs(c, j) = psi(c * (psi.rows() / 6) + lane, length);
    at.leg_weights[j] = work(lane, length);
  }
  at.leg_lengths = geometry.leg_lengths(values(geometry), at.q);
}

/// The same of the joints' torques, of a machine that is no chain.
void see_torques(const Robot& geometry, const PsiBlock& psi, const Eigen::MatrixXd& work, int lane,
                 RegressorInput& at) {
  Eigen::Matrix<double, 6, 1> wrench;
  wrench << at.wrench.force, at.wrench.moment;
  Eigen::RowVectorXd all = work.row(lane);
  for (int c = 0; c < 6; ++c) all += wrench[c] * psi.row(c * (psi.rows() / 6) + lane);
  for (Eigen::Index j = 0; j < at.torque.size(); ++j)
    at.torque[j] = all.dot(geometry.variable_change(values(geometry), static_cast<int>(j)));
}

}  // namespace

std::vector<LaneDeviation> deviations_of(const Robot& geometry, const Effects& effects,
                                         const ConfigurationBlock& block, Body body) {
  std::vector<LaneDeviation> all;
  const auto any = [&](auto asks) { return std::ranges::any_of(effects, asks); };
  const bool of_legs = any([](const auto& effect) { return effect->of_legs(); });
  const bool of_torques =
      !geometry.statics() && any([](const auto& effect) { return effect->of_torques(); });
  PsiBlock psi;
  Eigen::MatrixXd work;
  if (of_legs || of_torques) {
    ConfigurationBlock plain;
    plain.q = block.q;
    plain.count = block.count;
    plain.start = block.start;
    Locations X;
    geometry.locate(plain, values(geometry), Body::endpoint, X, &psi);
    work = work_of_weights(geometry, plain, values(geometry));
  }
  for (int lane = 0; lane < block.lanes(); ++lane) {
    if (lane >= std::max(block.count, 1)) {
      all.push_back(all.back());
      continue;
    }
    RegressorInput at = input_of(geometry, block, lane);
    if (of_legs) see_legs(geometry, psi, work, lane, at);
    if (of_torques) see_torques(geometry, psi, work, lane, at);
    all.push_back(deviation(geometry, effects, at, body));
  }
  return all;
}

}  // namespace selfcal
