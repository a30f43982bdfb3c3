// A surface as effects at it see it: its middle, its outward normal and two tangents.
#pragma once

#include "kinematics/effect.h"

namespace selfcal {

/// u: the world axis that is least along the normal, made perpendicular to it; v: normal x u.
struct SurfaceFrame {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::UnitZ(), u, v;

  void describe(Node& node) const;
};

/// From the entry's `center` and `normal`, else from the set's rows. Notes a problem without
/// either.
SurfaceFrame surface_frame(const EffectPlan& plan, int set);

}  // namespace selfcal
