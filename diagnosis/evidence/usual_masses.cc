// Mass and payload over the reach of data sheets (UR3 to UR10, Panda, iiwa, IRB 1200 to 6700,
// MA1400, RX90): mass = 60 kg/m^2 reach^2 within a factor of two and a half, payload a tenth of the
// mass within two. Only how the mass is spread matters for where a robot gives way; its whole is
// the scale of the compliances.
#include "diagnosis/evidence/usual_masses.h"

#include <cmath>

#include "diagnosis/constants.h"
#include "kinematics/expects.h"
#include "kinematics/make_robot.h"
#include "kinematics/robot_text.h"

namespace selfcal {
namespace {

/// Of the moving links, stretched out (m).
double reach_of(const Robot& robot) {
  const auto n = static_cast<Eigen::Index>(robot.joints().size());
  const Mechanics& mechanics = robot.statics()->mechanics();
  const std::vector<Eigen::Isometry3d> poses =
      robot.statics()->link_poses(Eigen::VectorXd::Zero(n));
  double reach = 0;
  int last = -1;
  for (size_t k = 0; k < mechanics.links.size(); ++k) {
    if (mechanics.links[k].joint < 0) continue;
    if (last >= 0) reach += (poses[k].translation() - poses[last].translation()).norm();
    last = static_cast<int>(k);
  }
  return reach;
}

}  // namespace

std::shared_ptr<const Robot> with_mass_of_its_size(std::shared_ptr<const Robot> robot) {
  const Statics* statics = robot->statics();
  if (!statics || statics->mechanics().masses_known() || statics->mechanics().gravity.norm() == 0)
    return robot;
  const double mass =
      std::round(10 * kDiagnosis.shapes.mass_per_reach * std::pow(reach_of(*robot), 2)) / 10;
  if (!(mass > 0)) return robot;
  Node node = robot->text().describe(values(*robot));
  node.set("mass", Node::of(mass));
  if (!(statics->mechanics().payload > 0))
    node.set("payload", Node::of(kDiagnosis.shapes.payload * mass));
  Problems problems;
  std::shared_ptr<const Robot> heavy = make_robot(node, problems);
  expects(heavy != nullptr, problems.any() ? problems.list.front() : "a file with a mass is read");
  return heavy->statics()->mechanics().masses_known() ? heavy : robot;
}

}  // namespace selfcal
