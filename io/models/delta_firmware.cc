//   carriage height at the endstop = height above the bed + sqrt(arm^2 - radius^2)
// so that a tower's endstop comes to e = endstop - sqrt(rod^2 - radius^2) above our base plane.
// RepRapFirmware parts e into H, the mean, and M666, the rest; Klipper has it as position_endstop.
// Marlin backs off each endstop by its M666, which is never positive, and stands at H then: H is
// the least e, M666 = H - e (its set_axis_is_at_home and homeaxis; M665.cpp for the letters).
#include "io/models/delta_firmware.h"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "io/models/controller_text.h"

namespace selfcal {
namespace {

using namespace linear_delta;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kTowerAngles[kTowers] = {210, 330, 90};  // X, Y, Z or A, B, C
constexpr double kMostTrim = 10;                          // degrees

std::string rounded(double value) {
  char text[32];
  const double to_last_digit = std::round(value * 1e4) / 1e4;
  std::snprintf(text, sizeof text, "%.4f", to_last_digit + 0.0);  // no sign at zero
  return text;
}

/// Degrees from where firmwares have the tower, within half a turn.
double trim(const Eigen::VectorXd& xi, int t) {
  return std::remainder(xi[index(t, kAngle)] / kDegree - kTowerAngles[t], 360);
}

/// What firmwares are told, mm and degrees.
struct FirmwareNumbers {
  double radius = 0;
  Eigen::Vector3d rod, trim, stop;  ///< stop: e above
};

FirmwareNumbers numbers_of(const Eigen::VectorXd& xi) {
  FirmwareNumbers n;
  for (int t = 0; t < kTowers; ++t) n.radius += 1e3 * xi[index(t, kRadius)] / kTowers;
  for (int t = 0; t < kTowers; ++t) {
    n.rod[t] = 1e3 * xi[index(t, kRod)];
    n.trim[t] = trim(xi, t);
    n.stop[t] = 1e3 * (xi[index(t, kEndstop)] + xi[kTool + 2]) -
                std::sqrt(n.rod[t] * n.rod[t] - n.radius * n.radius);
  }
  return n;
}

/// " X1.0000 Y2.0000 Z3.0000"
std::string lettered(const Eigen::Vector3d& v, const char* letters) {
  std::string text;
  for (int t = 0; t < kTowers; ++t) text += " " + std::string(1, letters[t]) + rounded(v[t]);
  return text;
}

std::string reprap_lines(const FirmwareNumbers& n) {
  return "M665 L" + rounded(n.rod[0]) + ":" + rounded(n.rod[1]) + ":" + rounded(n.rod[2]) + " R" +
         rounded(n.radius) + " H" + rounded(n.stop.mean()) + lettered(n.trim, "XYZ") + "\nM666" +
         lettered(n.stop.array() - n.stop.mean(), "XYZ") + "\n";
}

std::string marlin_lines(const FirmwareNumbers& n) {
  const double height = n.stop.minCoeff(), rod = n.rod.mean();
  return "M665 L" + rounded(rod) + " R" + rounded(n.radius) + " H" + rounded(height) +
         lettered(n.trim, "XYZ") + lettered(n.rod.array() - rod, "ABC") + "\nM666" +
         lettered(height - n.stop.array(), "XYZ") + "\n";
}

std::string klipper_lines(const FirmwareNumbers& n) {
  std::string text = "[printer]\ndelta_radius: " + rounded(n.radius) + "\n";
  for (int t = 0; t < kTowers; ++t)
    text += "\n[stepper_" + std::string(1, "abc"[t]) +
            "]\nposition_endstop: " + rounded(n.stop[t]) + "\narm_length: " + rounded(n.rod[t]) +
            "\nangle: " + rounded(kTowerAngles[t] + n.trim[t]) + "\n";
  return text;
}

/// `lines`, and behind comment signs those of the `before`, which undo them.
std::string with_undo(const std::string& lines, const std::string& before, char sign) {
  return lines + commented("To undo it, the maker's figures:\n" + before, sign);
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
       "radii of single towers, up to " + rounded(1e3 * radii) + " mm from that of all");
  lack(tilt, "tilts of towers, up to " + rounded(1e3 * tilt) + " mrad");
  lack(scale, "scales of towers, up to " + rounded(1e6 * scale) +
                  " ppm: divide the steps per mm by them, and multiply again to undo it");
  lack(delta.value.segment<2>(kEffector).norm(), "the effector's tilt");
  const Eigen::Vector2d across = 1e3 * delta.value.segment<2>(kTool);
  lack(across.norm(),
       "the tool's offset across, x " + rounded(across.x()) + " y " + rounded(across.y()) + " mm");
  return lacks;
}

}  // namespace

ControllerNumbers firmware_numbers(const Delta& delta) {
  ControllerNumbers numbers{delta.nominal, Eigen::MatrixXd::Zero(kParameters, 1 + 3 * kTowers)};
  double radius = 0;
  for (int t = 0; t < kTowers; ++t) radius += delta.nominal[index(t, kRadius)] / kTowers;
  for (int t = 0; t < kTowers; ++t) {
    numbers.start[index(t, kRadius)] = radius;
    numbers.start.segment<2>(index(t, kTiltX)).setZero();
    numbers.start[index(t, kScale)] = delta.value[index(t, kScale)];
    numbers.basis(index(t, kRadius), 0) = 1;
    int column = 1 + 3 * t;
    for (const Field each : {kAngle, kRod, kEndstop}) numbers.basis(index(t, each), column++) = 1;
  }
  numbers.start.segment<2>(kEffector).setZero();
  return numbers;
}

Eigen::VectorXd makers_firmware_numbers(const Delta& delta) {
  Eigen::VectorXd makers = firmware_numbers(delta).start;
  for (int t = 0; t < kTowers; ++t) makers[index(t, kScale)] = delta.nominal[index(t, kScale)];
  return makers;
}

Result<FirmwareText> delta_firmware(const Delta& delta, const Eigen::VectorXd& told,
                                    const std::string& head, const std::string& file) {
  for (int t = 0; t < kTowers; ++t)
    if (std::abs(trim(told, t)) > kMostTrim)
      return bad_input(file + ": " + tower_name(t) + " stands " + rounded(trim(told, t)) +
                       " degrees from where firmwares have it (210, 330, 90 in this order)");
  const FirmwareNumbers now = numbers_of(told), before = numbers_of(delta.nominal);
  for (const FirmwareNumbers* each : {&now, &before})
    if (!(each->rod.minCoeff() > each->radius))
      return bad_input(file + ": a rod of " + rounded(each->rod.minCoeff()) +
                       " mm does not reach over the radius of " + rounded(each->radius) +
                       " mm: no firmware has such a machine");
  FirmwareText out;
  out.text =
      "; RepRapFirmware (config.g). Heights are above the base plane: take the bed's off.\n" +
      commented(head, ';') + with_undo(reprap_lines(now), reprap_lines(before), ';') +
      "\n; Marlin, then G28 and M500. Heights as above. A B C are the rods' trims; where M665 "
      "has none\n; (B is the calibration radius there), leave them out.\n" +
      with_undo(marlin_lines(now), marlin_lines(before), ';') + "\n# Klipper (printer.cfg)\n" +
      commented(head, '#') + with_undo(klipper_lines(now), klipper_lines(before), '#');
  out.left_out = firmware_lacks(delta, now.radius * 1e-3);
  return out;
}

}  // namespace selfcal
