// What controllers take of a robot: offsets of joints, or a table, beside its base and tool.
#include "io/models/controller_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string_view>
#include <vector>

#include "io/files/csv.h"
#include "io/models/dh_rows.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

using Eigen::Isometry3d;
using serial::Frame;

constexpr double kInDegrees = 180 / std::numbers::pi, kInMillimetres = 1e3;
constexpr double kDigits = 1e9;  // of degrees and millimetres: below what anything can set

std::string short_number(double value) {
  return format_number(std::round(value * kDigits) / kDigits + 0.0);
}

/// The robot as its maker says it is.
serial::Model as_maker_says(serial::Model robot) {
  for (Frame& frame : robot.frames) {
    frame.value = frame.nominal;
    frame.rpy = frame.rpy_nominal;
    frame.gear = frame.gear_nominal;
  }
  return robot;
}

Isometry3d pose_product(const std::vector<Frame>& frames, int from, int to) {
  Isometry3d X = Isometry3d::Identity();
  for (int i = from; i < to; ++i) X = X * serial::pose_in_parent(frames[i], 0);
  return X;
}

Isometry3d base_of_chain(const serial::Model& robot) {
  return pose_product(robot.frames, 0, serial::moving_frames(robot).front());
}

Isometry3d tool_of_chain(const serial::Model& robot) {
  return pose_product(robot.frames, serial::moving_frames(robot).back() + 1,
                      static_cast<int>(robot.frames.size()));
}

std::string listed(const Eigen::Vector3d& v) {
  return "[" + short_number(v.x()) + ", " + short_number(v.y()) + ", " + short_number(v.z()) + "]";
}

std::string pose_entry(const Isometry3d& X) {
  return "{xyz: " + listed(X.translation()) + ", rpy: " + listed(rpy_of(X.linear())) + "}";
}

double offset_of(const Frame& frame, bool undone) {
  const int field = frame.motion == serial::Motion::prismatic ? serial::kR : serial::kTheta;
  return undone ? 0 : frame.value[field] - frame.nominal[field];
}

/// In quotes where it may be anything but a word.
std::string yaml_key(const std::string& name) {
  const bool word =
      std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) || c == '_'; }) &&
      !name.empty() && std::isalpha(static_cast<unsigned char>(name.front()));
  return word ? name : nlohmann::json(name).dump();
}

std::string offset_lines(const serial::Model& robot, bool undone, const std::string& indent) {
  std::string text;
  for (const int i : serial::moving_frames(robot)) {
    const Frame& frame = robot.frames[i];
    const double offset = offset_of(frame, undone);
    const bool slides = frame.motion == serial::Motion::prismatic;
    text += indent + yaml_key(frame.name) + ": " + short_number(offset) + "  # " +
            short_number(offset * (slides ? kInMillimetres : kInDegrees)) +
            (slides ? " mm\n" : " degrees\n");
  }
  return text;
}

std::string_view type_of(serial::Motion motion) {
  if (motion == serial::Motion::fixed) return "fixed";
  return motion == serial::Motion::prismatic ? "prismatic" : "revolute";
}

/// A table, where the first joint's row begins in the world, and the tool in the frame of the last
/// joint's row.
struct DhTable {
  std::string text;
  Isometry3d base, tool;
};

DhTable dh_table(const serial::Model& robot, bool standard) {
  DhTable table{"joint,alpha [deg],a [mm],d [mm],theta [deg],type\n", base_of_chain(robot),
                tool_of_chain(robot)};
  const Frame& first = robot.frames[serial::moving_frames(robot).front()];
  if (standard)
    table.base = table.base *
                 Eigen::AngleAxisd(first.value[serial::kAlpha], Eigen::Vector3d::UnitX()) *
                 Eigen::Translation3d(first.value[serial::kD], 0, 0);
  std::vector<DhRow> rows = modified_rows(robot);
  if (standard) rows = standard_rows(rows);
  if (standard) {  // the last joint's row ends with what leads to the tool's first
    const auto last = std::find_if(rows.rbegin(), rows.rend(), [](const DhRow& row) {
      return row.motion != serial::Motion::fixed;
    });
    table.tool = (Eigen::Translation3d(last->a, 0, 0) *
                  Eigen::AngleAxisd(last->alpha, Eigen::Vector3d::UnitX()))
                     .inverse() *
                 table.tool;
  }
  for (const DhRow& row : rows) {
    table.text += csv_cell(row.name) + "," + short_number(row.alpha * kInDegrees) + "," +
                  short_number(row.a * kInMillimetres) + "," +
                  short_number(row.d * kInMillimetres) + "," +
                  short_number(row.theta * kInDegrees) + ",";
    table.text += type_of(row.motion);
    table.text += "\n";
  }
  return table;
}

std::string frames_in_words(const Isometry3d& base, const Isometry3d& tool) {
  return "the first joint's row stands in the world at " + pose_in_words(base) +
         "\nthe tool stands in the frame of the last joint's row at " + pose_in_words(tool) + "\n";
}

}  // namespace

std::string commented(const std::string& text, char sign) {
  std::string lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines += std::string(1, sign) + (end > at ? " " : "") + text.substr(at, end - at) + "\n";
    at = end + 1;
  }
  return lines;
}

ToolFrame tool_frame(const serial::Model& robot) {
  return {tool_of_chain(robot), tool_of_chain(as_maker_says(robot))};
}

std::string pose_in_words(const Isometry3d& X) {
  const Eigen::Vector3d p = X.translation() * kInMillimetres, rpy = rpy_of(X.linear()) * kInDegrees;
  const auto three = [](const Eigen::Vector3d& v) {
    const auto rounded = [](double value) {
      return format_number(std::round(value * 1e6) / 1e6 + 0.0);
    };
    return rounded(v.x()) + " " + rounded(v.y()) + " " + rounded(v.z());
  };
  return "x y z " + three(p) + " mm, roll pitch yaw " + three(rpy) + " degrees";
}

std::string controller_offsets_text(const serial::Model& robot, const std::string& head) {
  const serial::Model before = as_maker_says(robot);
  const ToolFrame tool = tool_frame(robot);
  return commented(head) +
         "# Lengths in m, angles in rad; a pose is Trans(xyz) Rot(z, yaw) Rot(y, pitch) Rot(x, "
         "roll).\n"
         "offsets:  # to add to the joints' positions\n" +
         offset_lines(robot, false, "  ") + "base: " + pose_entry(base_of_chain(robot)) +
         "  # of the robot in the world\ntool: " + pose_entry(tool.pose) +
         "  # in the last joint's frame\ntool_correction: " + pose_entry(tool.correction()) +
         "  # in place of `tool`: this times the tool frame that is set where the robot's file "
         "ends "
         "at the flange, that times this where it ends there\n"
         "undo:  # the maker's\n  offsets:\n" +
         offset_lines(robot, true, "    ") + "  base: " + pose_entry(base_of_chain(before)) +
         "\n  tool: " + pose_entry(tool.nominal) + "\n";
}

Result<std::string> dh_table_text(const serial::Model& robot, const serial::Model& before,
                                  const std::string& convention, const std::string& head,
                                  const std::string& file) {
  const std::vector<int> moving = serial::moving_frames(robot);
  for (int i = moving.front(); i <= moving.back(); ++i)
    if (robot.frames[i].whole)
      return bad_input(file + ": frame " + robot.frames[i].name +
                       " between the joints is a whole pose, which no row of a table is");
  const bool standard = convention == "standard";
  const DhTable now = dh_table(robot, standard), undone = dh_table(before, standard);
  return commented(head + "Rows are of the " + convention +
                   " convention; those of type fixed are base and tool.\n" +
                   frames_in_words(now.base, now.tool) + "To undo it, the maker's:\n" +
                   undone.text + frames_in_words(undone.base, undone.tool)) +
         now.text;
}

}  // namespace selfcal
