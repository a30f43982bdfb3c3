// Statics of a chain:
//   moment about P = (p_tip - P) x F + M + sum over carried links of (c - P) x m g
//   torque_j = z_j . moment about O_j (revolute), z_j . force (prismatic)
#include "kinematics/mechanics.h"

#include <algorithm>
#include <utility>

#include "kinematics/readable.h"

namespace selfcal {

bool Mechanics::masses_known() const {
  return std::any_of(links.begin(), links.end(), [](const Link& link) { return link.mass > 0.0; });
}

std::string strange_masses(const Mechanics& mechanics) {
  double carries = 0, tool = 0;  // what moves but for the tool, and what is fixed to the last of it
  bool moves = false;
  for (const Link& link : mechanics.links) {
    moves = moves || link.joint >= 0;
    if (!moves) continue;
    if (link.joint >= 0 && !link.mass) return {};
    if (link.joint >= 0) carries += std::exchange(tool, 0);
    (link.joint >= 0 ? carries : tool) += link.mass.value_or(0);
  }
  if (mechanics.masses_assumed || carries <= 0 || std::max(tool, mechanics.payload) <= carries)
    return {};
  return std::string(tool > carries ? "the tool weighs" : "the payload is") +
         with_figures(" %.3g kg in the robot's file, ", std::max(tool, mechanics.payload)) +
         with_figures("all that carries it %.3g kg: is one of them in grams or pounds?", carries);
}

int Mechanics::link_of(int j) const {
  const auto found =
      std::find_if(links.begin(), links.end(), [&](const Link& link) { return link.joint == j; });
  return static_cast<int>(found - links.begin());
}

Load load_about(const Mechanics& mechanics, const std::vector<Eigen::Isometry3d>& poses,
                const Load& wrench, int first, const Eigen::Vector3d& point) {
  Load load = wrench;
  load.moment += (poses.back().translation() - point).cross(wrench.force);
  for (size_t k = static_cast<size_t>(first); k < mechanics.links.size(); ++k) {
    const Link& link = mechanics.links[k];
    const Eigen::Vector3d weight = link.mass.value_or(0) * mechanics.gravity;
    load.force += weight;
    load.moment += (poses[k] * link.com - point).cross(weight);
  }
  return load;
}

double joint_torque(const Mechanics& mechanics, const std::vector<Eigen::Isometry3d>& poses,
                    const Load& wrench, int j) {
  const int first = mechanics.link_of(j);
  const Eigen::Isometry3d& pose = poses[first];
  const Load load = load_about(mechanics, poses, wrench, first, pose.translation());
  const Eigen::Vector3d z = pose.linear().col(2);
  return z.dot(mechanics.links[first].turns ? load.moment : load.force);
}

}  // namespace selfcal
