//   carriage height at the endstop = height above the bed + sqrt(arm^2 - radius^2)
// so that a tower's endstop comes to e = endstop - sqrt(rod^2 - radius^2) above our base plane.
// RepRapFirmware parts e into H, the mean, and M666, the rest; Klipper has it as position_endstop.
#include "io/models/delta_firmware.h"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace selfcal {
namespace {

using namespace linear_delta;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kTowerAngles[kTowers] = {210, 330, 90};  // X, Y, Z or A, B, C
constexpr double kMostTrim = 10;                          // degrees

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4f", value == 0 ? 0 : value);
  return text;
}

/// Degrees from where firmwares have the tower, within half a turn.
double trim(const Delta& delta, int t) {
  return std::remainder(delta.value[index(t, kAngle)] / kDegree - kTowerAngles[t], 360);
}

std::vector<std::string> firmware_lacks(const Delta& delta, double radius) {
  double radii = 0, tilt = 0, scale = 0;
  for (int t = 0; t < kTowers; ++t) {
    radii = std::max(radii, std::abs(delta.value[index(t, kRadius)] - radius));
    tilt = std::max(tilt, delta.value.segment<2>(index(t, kTiltX)).norm());
    scale = std::max(scale, std::abs(delta.value[index(t, kScale)] - 1));
  }
  std::vector<std::string> lacks;
  const auto lack = [&](double size, const std::string& what) {
    if (size > 0) lacks.push_back(what);
  };
  lack(radii > 1e-9 ? radii : 0,
       "radii of single towers: their mean stands, up to " + rounded(1e3 * radii) + " mm off");
  lack(tilt, "tilts of towers, up to " + rounded(1e3 * tilt) + " mrad");
  lack(scale, "scales of towers, up to " + rounded(1e6 * scale) +
                  " ppm: multiply the steps per mm by them");
  lack(delta.value.segment<2>(kEffector).norm(), "the effector's tilt");
  lack(delta.value.segment<3>(kTool).norm(), "the tool's offset: take its z off the heights");
  return lacks;
}

}  // namespace

Result<FirmwareText> delta_firmware(const Delta& delta, const std::string& file) {
  double radius = 0, height = 0;
  for (int t = 0; t < kTowers; ++t) {
    if (std::abs(trim(delta, t)) > kMostTrim)
      return bad_input(file + ": " + tower_name(t) + " stands " + rounded(trim(delta, t)) +
                       " degrees from where firmwares have it (210, 330, 90 in this order)");
    radius += delta.value[index(t, kRadius)] / kTowers;
  }
  double e[kTowers];
  for (int t = 0; t < kTowers; ++t) {
    const double rod = delta.value[index(t, kRod)];
    e[t] = delta.value[index(t, kEndstop)] - std::sqrt(rod * rod - radius * radius);
    height += e[t] / kTowers;
  }
  std::string arms, trims, stops, steppers;
  for (int t = 0; t < kTowers; ++t) {
    const std::string axis(1, "XYZ"[t]), rod = rounded(1e3 * delta.value[index(t, kRod)]);
    arms += (t > 0 ? ":" : "") + rod;
    trims += " " + axis + rounded(trim(delta, t));
    stops += " " + axis + rounded(1e3 * (e[t] - height));
    steppers += "\n[stepper_" + std::string(1, "abc"[t]) +
                "]\nposition_endstop: " + rounded(1e3 * e[t]) + "\narm_length: " + rod +
                "\nangle: " + rounded(kTowerAngles[t] + trim(delta, t)) + "\n";
  }
  FirmwareText out;
  out.text =
      "; RepRapFirmware (config.g). Heights are above the base plane: take the bed's off.\n"
      "M665 L" +
      arms + " R" + rounded(1e3 * radius) + " H" + rounded(1e3 * height) + trims + "\nM666" +
      stops + "\n\n# Klipper (printer.cfg)\n[printer]\ndelta_radius: " + rounded(1e3 * radius) +
      "\n" + steppers;
  out.left_out = firmware_lacks(delta, radius);
  return out;
}

}  // namespace selfcal
