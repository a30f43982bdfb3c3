// A surface as effects at it see it: its middle, its outward normal and two tangents.
#pragma once

#include "kinematics/effect.h"

namespace selfcal {

/// u: the world axis that is least along the normal, made perpendicular to it; v: normal x u.
struct SurfaceFrame {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::UnitZ(), u, v;
  bool centre_known = false, normal_known = false;  ///< by the entry or by rows

  void describe(Node& node) const;  ///< what is known of it
};

/// From the entry's `center` and `normal`, else from the set's rows, if there are any. Notes a
/// problem where these are no touches of a plane, and the entry does not say.
SurfaceFrame surface_frame(const EffectPlan& plan, int set);

}  // namespace selfcal
