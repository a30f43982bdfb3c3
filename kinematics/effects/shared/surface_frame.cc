#include "kinematics/effects/shared/surface_frame.h"

namespace selfcal {

void SurfaceFrame::describe(Node& node) const {
  node.set("center", Node::of(Eigen::VectorXd(centre)));
  node.set("normal", Node::of(Eigen::VectorXd(normal)));
}

SurfaceFrame surface_frame(const EffectPlan& plan, int set) {
  SurfaceFrame frame;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  if (set >= 0) {
    frame.centre = plan.context.sets[set].centre;
    normal = plan.context.sets[set].normal;
  }
  if (const auto given = plan.fields.numbers("center", 3)) frame.centre = *given;
  if (const auto given = plan.fields.numbers("normal", 3)) normal = *given;
  if (normal.norm() > 1e-6)
    frame.normal = normal.normalized();
  else
    plan.fields.fail("normal", "a normal, or a set of touches");
  int least = 0;
  frame.normal.cwiseAbs().minCoeff(&least);
  frame.u = (Eigen::Vector3d::Unit(least) - frame.normal[least] * frame.normal).normalized();
  frame.v = frame.normal.cross(frame.u);
  return frame;
}

}  // namespace selfcal
