// Names, priors and the order of preference of a linear delta's parameters.
//
// The order decides which member of a dependent group is identified (Khalil and Dombre, 11.4.2.1):
// what a firmware takes over directly comes first, as scales and endstops, then the radius, the
// rods, the towers' angles, what only some firmwares know (tilts), and what no touch can tell from
// the towers (the tool, for the effector never turns). The longest rod comes last among the
// lengths: it is the one held when the rows leave the scale free, where its tolerance costs least.
#include <algorithm>
#include <cstdio>

#include "kinematics/robots/linear_delta.h"

namespace selfcal::linear_delta {
namespace {

constexpr double kPlacedTolerance = 50e-3;  // of the tool: m or rad
constexpr double kScaleTolerance = 1.0e-4;
constexpr const char* kDeltaFields[kFields] = {"radius", "angle",  "rod",  "endstop",
                                               "tilt_x", "tilt_y", "scale"};

Parameter tower_parameter(const Delta& model, int t, int field) {
  Parameter p;
  p.name = kDeltaFields[field] + std::to_string(t + 1);
  p.frame = tower_name(t);
  p.field = kDeltaFields[field];
  const int at = index(t, field);
  if (field == kScale) {
    p.quantity = Quantity::ratio;
    p.part = Part::gear;
    p.free = model.tolerance[at] > 0;
    take_figures(model, at, kScaleTolerance, p);
    return p;
  }
  const bool angle = field == kAngle || field == kTiltX || field == kTiltY;
  p.quantity = angle ? Quantity::angle : Quantity::length;
  p.link_length = field == kRadius || field == kRod;
  take_figures(model, at, kOwnTolerance, p);
  return p;
}

/// Held unless its tolerance is given: the effector never turns, so that no touch tells it from the
/// towers.
Parameter placed(const Delta& model, const char* frame, const char* field, Quantity quantity,
                 int at) {
  Parameter p;
  p.name = std::string(frame) + "_" + field;
  p.frame = frame;
  p.field = field;
  p.quantity = quantity;
  p.part = Part::tool;
  p.free = model.tolerance[at] > 0;
  take_figures(model, at, kPlacedTolerance, p);
  return p;
}

}  // namespace

std::vector<Parameter> parameters(const Delta& model) {
  std::vector<Parameter> list;
  for (int t = 0; t < kTowers; ++t)
    for (int field = 0; field < kFields; ++field) list.push_back(tower_parameter(model, t, field));
  list.push_back(placed(model, "effector", "rx", Quantity::angle, kEffector));
  list.push_back(placed(model, "effector", "ry", Quantity::angle, kEffector + 1));
  list.push_back(placed(model, "tool", "x", Quantity::length, kTool));
  list.push_back(placed(model, "tool", "y", Quantity::length, kTool + 1));
  list.push_back(placed(model, "tool", "z", Quantity::length, kTool + 2));
  return list;
}

std::vector<int> preference(const Delta& model) {
  std::vector<int> order;
  for (const int field : {kScale, kEndstop, kRadius})
    for (int t = 0; t < kTowers; ++t) order.push_back(index(t, field));
  std::vector<int> rods;
  for (int t = 0; t < kTowers; ++t) rods.push_back(index(t, kRod));
  std::stable_sort(rods.begin(), rods.end(),
                   [&](int a, int b) { return model.nominal[a] < model.nominal[b]; });
  order.insert(order.end(), rods.begin(), rods.end());
  for (const int field : {kAngle, kTiltX, kTiltY})
    for (int t = 0; t < kTowers; ++t) order.push_back(index(t, field));
  for (const int at : {kTool + 2, kTool + 0, kTool + 1, kEffector + 0, kEffector + 1})
    order.push_back(at);
  return order;
}

std::vector<std::string> remarks(const Delta& model) {
  const Eigen::VectorXd xi = model.value;
  std::vector<std::string> lines;
  char text[160];
  std::snprintf(text, sizeof text,
                "working radius %.1f mm: farther out a rod lies flatter than 3 across 1 high",
                1e3 * working_radius(xi));
  lines.emplace_back(text);
  Eigen::Vector3d home = Eigen::Vector3d::Zero();
  const auto level = readings_at(xi, Eigen::Vector3d::Zero());
  if (!level) {
    lines.emplace_back("the rods are too short to reach the middle: radius and rod do not fit");
    return lines;
  }
  // In the middle, readings and height rise together.
  home.z() = -(xi[index(0, kScale)] * (*level)[0]);
  for (int t = 1; t < kTowers; ++t)
    home.z() = std::min(home.z(), -(xi[index(t, kScale)] * (*level)[t]));
  std::snprintf(text, sizeof text, "in the middle the effector's joints go up to %.1f mm",
                1e3 * home.z());
  lines.emplace_back(text);
  for (int t = 0; t < kTowers; ++t)
    if (model.lower[static_cast<size_t>(t)] < model.upper[static_cast<size_t>(t)]) {
      std::snprintf(
          text, sizeof text, "  with %s at its lower limit they stand at %.1f mm",
          tower_name(t).c_str(),
          1e3 * xi[index(t, kScale)] * (model.lower[static_cast<size_t>(t)] - (*level)[t]));
      lines.emplace_back(text);
    }
  return lines;
}

}  // namespace selfcal::linear_delta
