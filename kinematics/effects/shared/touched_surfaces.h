// The outward normal at a touch, of rows that carry none too.
#pragma once

#include <vector>

#include "kinematics/effect.h"

namespace selfcal {

class TouchedSurfaces {
 public:
  explicit TouchedSurfaces(const MeasurementContext& context) : sets_(context.sets) {}

  bool touched(const RegressorInput& at) const;
  bool on_ball(const RegressorInput& at) const;
  /// World, unit: the row's own, else that of its set's plane; NaN where neither is known.
  Eigen::Vector3d normal(const RegressorInput& at) const;

 private:
  const MeasuredSet* set_of(const RegressorInput& at) const;

  std::vector<MeasuredSet> sets_;
};

}  // namespace selfcal
