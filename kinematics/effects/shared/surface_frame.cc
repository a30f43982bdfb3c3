#include "kinematics/effects/shared/surface_frame.h"

namespace selfcal {

void SurfaceFrame::describe(Node& node) const {
  if (centre_known) node.set("center", Node::of(Eigen::VectorXd(centre)));
  if (normal_known) node.set("normal", Node::of(Eigen::VectorXd(normal)));
}

SurfaceFrame surface_frame(const EffectPlan& plan, int set) {
  const std::optional<Eigen::VectorXd> centre = plan.fields.numbers("center", 3);
  const std::optional<Eigen::VectorXd> normal = plan.fields.numbers("normal", 3);
  MeasuredSet rows;
  rows.without_rows = true;
  if (set >= 0) rows = plan.context.sets[set];
  SurfaceFrame frame;
  frame.centre = centre.value_or(rows.centre);
  frame.centre_known = centre || !rows.without_rows;
  frame.normal_known = normal || !rows.without_rows;
  if (frame.normal_known) frame.normal = normal.value_or(rows.normal);
  if (frame.normal.norm() > 1e-6)
    frame.normal.normalize();
  else
    plan.fields.fail("normal", "a normal, or a set of touches");
  int least = 0;
  frame.normal.cwiseAbs().minCoeff(&least);
  frame.u = (Eigen::Vector3d::Unit(least) - frame.normal[least] * frame.normal).normalized();
  frame.v = frame.normal.cross(frame.u);
  return frame;
}

}  // namespace selfcal
