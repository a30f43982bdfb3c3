// A number for the lengths and one for the angles of every part of a machine.
#pragma once

#include "kinematics/description.h"
#include "kinematics/parameter.h"

namespace selfcal {

struct ByPart {
  double length = 0, angle = 0;  ///< of the links (m, rad)
  double base_length = 0, base_angle = 0;
  double tool_length = 0, tool_angle = 0;

  /// That of a parameter; of gear ratios and effects the links' angle.
  double of(const Parameter& parameter) const;
};

/// Reads `into`, each number by its own name and from 0 to `most`.
void read_by_part(Fields& fields, double most, ByPart& into);

}  // namespace selfcal
