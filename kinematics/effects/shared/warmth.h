// What goes with the temperature: by how much it is above T0, the `reference` of an entry (C). It
// may lag behind the thermometer, `lag` dT/dt = T_measured - T (s; 0: at once).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinematics/effect.h"
#include "kinematics/suppositions.h"

namespace selfcal {

class Warmth {
 public:
  enum class Follows { at_once, with_lag };
  explicit Warmth(const EffectPlan& plan, Follows how = Follows::at_once);

  /// K; 0 where the temperature is not known.
  double above(const RegressorInput& at) const;
  void describe(Node& node) const;

 private:
  double temperature(const RegressorInput& at) const;

  std::optional<double> reference_;
  std::optional<double> lag_;  ///< nothing of what follows at once
  std::vector<double> times_, temperatures_;
};

/// Of an entry with `by: temperature`; nothing without `by`, and a problem where it is another.
std::optional<Warmth> warmth_by(const EffectPlan& plan,
                                Warmth::Follows how = Warmth::Follows::at_once);

/// Lags that a search looks for beside none, over a time of so many seconds.
std::vector<double> supposed_lags(const MeasurementContext& context);

}  // namespace selfcal
