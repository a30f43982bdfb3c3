#include "kinematics/by_part.h"

namespace selfcal {

double ByPart::of(const Parameter& parameter) const {
  const bool is_length = parameter.quantity == Quantity::length;
  switch (parameter.part) {
    case Part::base:
      return is_length ? base_length : base_angle;
    case Part::tool:
      return is_length ? tool_length : tool_angle;
    case Part::link:
      return is_length ? length : angle;
    case Part::gear:
    case Part::effect:
      return angle;
  }
  return 0;
}

void read_by_part(Fields& fields, double most, ByPart& into) {
  const auto read = [&](const char* key, double& value) {
    value = fields.number(key, value, 0, most);
  };
  read("length", into.length);
  read("angle", into.angle);
  read("base_length", into.base_length);
  read("base_angle", into.base_angle);
  read("tool_length", into.tool_length);
  read("tool_angle", into.tool_angle);
}

}  // namespace selfcal
