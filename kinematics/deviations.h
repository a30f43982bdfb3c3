// What the effects of a robot say of a block of configurations, at the geometry of its file.
#pragma once

#include <memory>
#include <vector>

#include "kinematics/effect.h"
#include "kinematics/robot.h"

namespace selfcal {

using Effects = std::vector<std::unique_ptr<Effect>>;

/// Of one lane: the regressors of all effects side by side, and the body as seen from the tip (m,
/// world).
struct LaneDeviation {
  Regressor by;
  Eigen::Vector3d arm;
};

/// By lane; lanes past the block's count share the last one's.
std::vector<LaneDeviation> deviations_of(const Robot& geometry, const Effects& effects,
                                         const ConfigurationBlock& block, Body body);

}  // namespace selfcal
