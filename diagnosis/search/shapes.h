// Effects asked for by name, EFFECT[@PLACE], each in the shape that the rows favour.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "kinematics/effect_shape.h"
#include "kinematics/robot.h"

namespace selfcal {

struct ChosenEffects {
  std::vector<ShapedEffect> effects;
  std::string problem;  ///< why there are none; empty otherwise
};

/// Of every effect asked for, at its place or, without one, at each where it may act: the moment,
/// the waves, the lag with the best evidence once the geometry is fitted.
ChosenEffects choose_effects(const std::shared_ptr<const Robot>& robot, const DataSet& data,
                             const std::vector<std::string>& asked);

}  // namespace selfcal
