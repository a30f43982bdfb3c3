// Statics of the true machine: weights and the tool's load about a point, by plain sums.
#include "sim/trials/trial_world.h"

#include <algorithm>
#include <cmath>

#include "kinematics/statics.h"

namespace selfcal {

double AirRecord::at(double time) const {
  const double place = std::clamp(time / step, 0.0, static_cast<double>(celsius.size() - 1));
  const auto i = std::min(static_cast<size_t>(place), celsius.size() - 2);
  const double share = place - static_cast<double>(i);
  return celsius[i] + share * (celsius[i + 1] - celsius[i]);
}

AirRecord AirRecord::lagged(double lag) const {
  AirRecord out = *this;
  for (size_t i = 1; i < celsius.size(); ++i)
    out.celsius[i] =
        out.celsius[i - 1] + (celsius[i - 1] - out.celsius[i - 1]) * -std::expm1(-step / lag);
  return out;
}

AirRecord draw_air(double duration, Random& random) {
  constexpr int kSteps = 400, kSmooth = 10;
  const double rise = uniform(random, 6, 13), settle = uniform(random, 0.2, 0.8) * kSteps;
  AirRecord weather{kSmooth, {}}, air{duration / kSteps, {}};
  double level = 0;
  for (int i = 0; i <= kSteps / kSmooth + 1; ++i)
    weather.celsius.push_back(level = 0.8 * level + 0.6 * normal(random));
  for (int i = 0; i <= kSteps; ++i)
    air.celsius.push_back(21 - rise * std::expm1(-i / settle) + 0.4 * weather.at(i));
  return air;
}

bool runs_on_legs(const Robot& robot) { return robot.leg_parameter(0) >= 0; }

void look(const Robot& robot, const Eigen::VectorXd& xi, Instant& at) {
  if (!runs_on_legs(robot)) {
    at.poses = robot.statics()->link_poses(at.q);
    return;
  }
  Locations X;
  PsiBlock psi;
  robot.locate(block_of(at.q), xi, Body::endpoint, X, &psi);
  at.poses.assign(1, Eigen::Isometry3d::Identity());
  at.poses[0].linear() = X.R(0);
  at.poses[0].translation() = X.p(0);
  at.lengths = robot.leg_lengths(xi, at.q);
  at.legs.resize(6, at.q.size());
  for (int j = 0; j < at.q.size(); ++j)
    for (int c = 0; c < 6; ++c) at.legs(c, j) = psi(c, robot.leg_parameter(j));
}

Eigen::VectorXd with_legs(const Robot& robot, Eigen::VectorXd xi, const Eigen::VectorXd& longer) {
  if (runs_on_legs(robot))
    for (int j = 0; j < longer.size(); ++j) xi[robot.leg_parameter(j)] += longer[j];
  return xi;
}

void TrialWorld::load(const Instant& at, int first, const Eigen::Vector3d& point,
                      Eigen::Vector3d& force, Eigen::Vector3d& moment) const {
  force = at.force;
  moment = at.moment + (at.poses.back().translation() - point).cross(at.force);
  for (size_t k = static_cast<size_t>(first); k < mass.size(); ++k) {
    const Eigen::Vector3d weight = mass[k] * gravity();
    force += weight;
    moment += (at.poses[k] * com[k] - point).cross(weight);
  }
}

Eigen::Vector3d TrialWorld::gravity() const { return gravity_of(*robot); }

double TrialWorld::torque(const Instant& at, int joint) const {
  if (on_legs()) {  // virtual work: a leg's growth times its pull is what the loads do meanwhile
    Eigen::Vector3d force, moment;
    load(at, 0, at.poses.back().translation(), force, moment);
    return at.legs.col(joint).head<3>().dot(force) + at.legs.col(joint).tail<3>().dot(moment);
  }
  const int link = robot->statics()->mechanics().link_of(joint);
  const Eigen::Isometry3d& pose = at.poses[static_cast<size_t>(link)];
  Eigen::Vector3d force, moment;
  load(at, link, pose.translation(), force, moment);
  const Eigen::Vector3d axis = pose.linear().col(2);
  return links()[static_cast<size_t>(link)].turns ? axis.dot(moment) : axis.dot(force);
}

double TrialWorld::largest_torque(int joint) const {
  double most = 1e-9;
  for (const Instant& each : rows) most = std::max(most, std::abs(torque(each, joint)));
  return most;
}

Eigen::Vector3d tip_of(const Robot& robot, const Eigen::VectorXd& xi, const Eigen::VectorXd& q,
                       Eigen::MatrixXd* J, const Eigen::VectorXd& added) {
  Locations X;
  PsiBlock psi;
  ConfigurationBlock block = block_of(q);
  if (added.size() > 0) {
    block.added.resize(block.lanes(), added.size());
    block.added.rowwise() = added.transpose().array();
  }
  robot.locate(block, xi, Body::endpoint, X, J ? &psi : nullptr);
  if (J) {
    Eigen::MatrixXd all;
    robot.joint_jacobian(block, xi, Body::endpoint, psi, all);
    J->resize(3, q.size());
    for (int c = 0; c < 3; ++c) J->row(c) = all.row(c);
  }
  return X.p(0);
}

double uniform(Random& random, double least, double most) {
  return std::uniform_real_distribution<double>(least, most)(random);
}
double log_uniform(Random& random, double least, double most) {
  return std::exp(uniform(random, std::log(least), std::log(most)));
}
double normal(Random& random) { return std::normal_distribution<double>()(random); }
int pick(Random& random, int count) {
  return std::uniform_int_distribution<int>(0, count - 1)(random);
}
bool chance(Random& random, double probability) { return uniform(random, 0, 1) < probability; }

}  // namespace selfcal
