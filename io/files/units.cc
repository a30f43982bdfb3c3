// The table of units. An inch is 25.4 mm exactly; 0 degrees Celsius are 273.15 K.
#include "io/files/units.h"

#include <numbers>

namespace selfcal {
namespace {

struct KnownUnit {
  std::string_view text;
  Dimension dimension;
  Unit unit;
};

constexpr double kOneDegree = std::numbers::pi / 180;

constexpr KnownUnit kKnownUnits[] = {
    {"rad", Dimension::angle, {}},
    {"mrad", Dimension::angle, {1e-3}},
    {"deg", Dimension::angle, {kOneDegree}},
    {"°", Dimension::angle, {kOneDegree}},
    {"m", Dimension::length, {}},
    {"mm", Dimension::length, {1e-3}},
    {"um", Dimension::length, {1e-6}},
    {"µm", Dimension::length, {1e-6}},
    {"inch", Dimension::length, {0.0254}},
    {"rad/s", Dimension::angular_speed, {}},
    {"deg/s", Dimension::angular_speed, {kOneDegree}},
    {"°/s", Dimension::angular_speed, {kOneDegree}},
    {"m/s", Dimension::speed, {}},
    {"mm/s", Dimension::speed, {1e-3}},
    {"N", Dimension::force, {}},
    {"kN", Dimension::force, {1e3}},
    {"Nm", Dimension::torque, {}},
    {"N m", Dimension::torque, {}},
    {"kNm", Dimension::torque, {1e3}},
    {"degC", Dimension::temperature, {}},
    {"°C", Dimension::temperature, {}},
    {"K", Dimension::temperature, {1, -273.15}},
    {"s", Dimension::time, {}},
    {"ms", Dimension::time, {1e-3}},
};

}  // namespace

std::optional<Unit> unit_of(std::string_view text, Dimension dimension) {
  for (const KnownUnit& each : kKnownUnits)
    if (each.text == text && each.dimension == dimension) return each.unit;
  return std::nullopt;
}

std::string units_in_words(Dimension dimension) {
  std::string list;
  for (const KnownUnit& each : kKnownUnits)
    if (each.dimension == dimension) list += (list.empty() ? "" : ", ") + std::string(each.text);
  return list;
}

}  // namespace selfcal
