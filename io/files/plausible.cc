// The rules and their thresholds: generous enough that no right file fails, tight enough that
// degrees and millimetres do.
#include "io/files/plausible.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

#include "constraints/statistics.h"

namespace selfcal {
namespace {

constexpr double kRounding = 1e-3;                // of the limits' range
constexpr double kFarOutside = 0.1;               // of the limits' range
constexpr double kColdRoom = 59, kHotRoom = 104;  // degrees Fahrenheit: 15 and 40 Celsius

/// How far beyond the joint's limits, 0 inside or without limits.
double excess(const Joint& joint, double reading) {
  if (!joint.limited()) return 0;
  return std::max({joint.lower - reading, reading - joint.upper, 0.0});
}

std::string limits_of(const Joint& joint) {
  return "the limits [" + format_number(joint.lower) + ", " + format_number(joint.upper) +
         "] of joint " + joint.name;
}

/// A question that names the likely slip, or nothing.
std::string likely_slip(const Joint& joint, double reading) {
  const double size = std::abs(reading);
  const double reach = std::max(std::abs(joint.lower), std::abs(joint.upper));
  // A gear of two, or a sign, takes a reading no farther than twice its limits.
  if (joint.quantity == Quantity::angle && size > 2 * std::max(reach, std::numbers::pi)) {
    return " (degrees instead of radians?)";
  }
  if (joint.quantity == Quantity::length && size > 100 * reach) {
    return " (millimetres instead of metres?)";
  }
  return {};
}

}  // namespace

std::optional<std::string> metres_fault(double value) {
  if (std::abs(value) <= kFarthestPlace) return std::nullopt;
  return format_number(value) + " is too large, metres expected (millimetres?)";
}

std::optional<std::string> celsius_fault(double value) {
  if (value >= kColdest && value <= kHottest) return std::nullopt;
  return format_number(value) + " is no temperature of a robot at work, degrees Celsius expected" +
         (value > kHottest ? " (kelvin?)" : "");
}

std::optional<std::string> celsius_doubt(const Eigen::VectorXd& temperatures) {
  std::vector<double> told;
  std::ranges::copy_if(temperatures, std::back_inserter(told),
                       [](double t) { return std::isfinite(t); });
  if (told.empty()) return std::nullopt;
  const double middle = median(std::move(told));
  if (middle < kColdRoom || middle > kHotRoom) return std::nullopt;
  return "temperatures of about " + format_number(std::round(middle)) +
         " are read as degrees Celsius: were they Fahrenheit, all growth with them would be told "
         "1.8 "
         "times too small";
}

std::optional<std::string> joint_fault(const Joint& joint, double reading, Readings readings) {
  if (joint.quantity == Quantity::length) {
    if (auto fault = metres_fault(reading)) return fault;
  } else if (std::abs(reading) > kMostTurned) {
    return format_number(reading) + " is more than four turns (degrees instead of radians?)";
  }
  if (readings == Readings::any ||
      excess(joint, reading) <= kFarOutside * (joint.upper - joint.lower))
    return std::nullopt;
  return format_number(reading) + " is far outside " + limits_of(joint) +
         likely_slip(joint, reading);
}

bool outside_limits(const Joint& joint, double reading) {
  return excess(joint, reading) > kRounding * (joint.upper - joint.lower) + 1e-9;
}

std::optional<std::string> make_unit(std::span<double> vector, double tolerance,
                                     const std::string& what) {
  double squares = 0;
  for (const double component : vector) squares += component * component;
  const double length = std::sqrt(squares);
  if (!(std::abs(length - 1) <= tolerance)) {
    return what + " has length " + format_number(length) + ", expected 1";
  }
  for (double& component : vector) component /= length;
  return std::nullopt;
}

}  // namespace selfcal
