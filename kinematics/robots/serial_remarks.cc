// What a person checks a robot file by: the frames that cannot be read off it, gravity as the robot
// feels it, static torques.
#include <cstdio>
#include <numbers>

#include "kinematics/robots/serial.h"

namespace selfcal::serial {
namespace {

struct Shown {
  const char* name;
  double value;
};

std::string line(const std::string& name, std::initializer_list<Shown> numbers) {
  std::string text = "  " + name + ":";
  for (const Shown& each : numbers) {
    char number[48];
    std::snprintf(number, sizeof number, " %s %.3f", each.name, each.value);
    text += number;
  }
  return text;
}

/// Whole poses, and the frames that a table was turned into (mm, degrees).
void add_frames(const Model& model, std::vector<std::string>& lines) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  std::vector<std::string> frames;
  for (const Frame& frame : model.frames) {
    const Eigen::VectorXd& v = frame.value;
    const Eigen::Vector3d rpy = kDegrees * frame.rpy;
    if (frame.whole)
      frames.push_back(line(frame.name + " (a whole pose)", {{"x", 1e3 * v[kX]},
                                                             {"y", 1e3 * v[kY]},
                                                             {"z", 1e3 * v[kZ]},
                                                             {"roll", rpy.x()},
                                                             {"pitch", rpy.y()},
                                                             {"yaw", rpy.z()}}));
    else if (model.standard)
      frames.push_back(line(frame.name, {{"alpha", kDegrees * v[kAlpha]},
                                         {"d", 1e3 * v[kD]},
                                         {"theta", kDegrees * v[kTheta]},
                                         {"r", 1e3 * v[kR]}}));
  }
  if (frames.empty()) return;
  lines.emplace_back(model.standard ? "the standard DH table, turned into (mm, degrees):"
                                    : "whole poses (mm, degrees):");
  lines.insert(lines.end(), frames.begin(), frames.end());
}

void add_gravity(const Model& model, std::vector<std::string>& lines) {
  const std::vector<int> moving = moving_frames(model);
  Eigen::VectorXd middle(static_cast<Eigen::Index>(moving.size()));
  for (size_t j = 0; j < moving.size(); ++j)
    middle[j] = (model.frames[moving[j]].lower + model.frames[moving[j]].upper) / 2;
  const Eigen::Isometry3d first = frame_poses(model, middle)[moving.front()];
  const Eigen::Vector3d g = first.linear().transpose() * model.gravity;
  char text[160];
  std::snprintf(text, sizeof text, "gravity in %s's frame: %.3f %.3f %.3f m/s^2",
                model.frames[moving.front()].name.c_str(), g.x(), g.y(), g.z());
  lines.emplace_back(text);
  if (!mechanics(model).masses_known()) {
    lines.emplace_back("no masses given: static torques are unknown");
    return;
  }
  if (std::string strange = strange_masses(mechanics(model)); !strange.empty())
    lines.push_back(std::move(strange));
  const Eigen::VectorXd torques = gravity_torques(model, middle);
  lines.emplace_back(std::string("static torques with every joint in the middle of its limits") +
                     (mechanics(model).masses_assumed ? ", by usual masses of the links:" : ":"));
  for (size_t j = 0; j < moving.size(); ++j) {
    const Frame& frame = model.frames[moving[j]];
    std::snprintf(text, sizeof text, "  %s %.2f %s", frame.name.c_str(), torques[j],
                  frame.motion == Motion::revolute ? "N m" : "N");
    lines.emplace_back(text);
  }
}

}  // namespace

std::vector<std::string> remarks(const Model& model) {
  std::vector<std::string> lines;
  add_frames(model, lines);
  add_gravity(model, lines);
  return lines;
}

}  // namespace selfcal::serial
