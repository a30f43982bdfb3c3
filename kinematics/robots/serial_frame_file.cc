// One entry of `frames`: its numbers or its whole pose, what its maker says of them, limits, gear
// and mass.
#include <cmath>
#include <functional>
#include <span>

#include "kinematics/robots/serial_frames.h"
#include "kinematics/rotation.h"

namespace selfcal::serial {
namespace {

constexpr double kHeaviestPart = 10000;  // kg; the largest arms weigh as much in all

constexpr const char* kMotions[] = {"fixed", "revolute", "prismatic"};

Motion read_motion(Fields& fields) {
  const std::string text = fields.text("joint");
  for (int m = 0; m < 3; ++m)
    if (text == kMotions[m]) return static_cast<Motion>(m);
  fields.fail("joint", "revolute, prismatic or fixed");
  return Motion::fixed;
}

/// What a frame's own parameters are called: of a standard table all but beta.
std::span<const char* const> read_fields(const Frame& frame, Convention convention) {
  const std::span<const char* const> names = field_names(frame.whole);
  return convention == Convention::standard && !frame.whole ? names.first(kBeta) : names;
}

/// 1 sigma of the parameters that the frame's maker gives one.
void read_tolerance(Fields& frame_fields, std::span<const char* const> names, Problems& problems,
                    Frame& frame) {
  const Node* node = frame_fields.node("tolerance");
  if (!node) return;
  Fields fields(*node, frame_fields.what() + " tolerance", problems);
  const auto sigma = [&](double value) {
    if (!(value > 0 && value < 1))
      frame_fields.fail("tolerance", "1 sigma each, above 0 and below 1 (m or rad)");
    return value;
  };
  for (int i = 0; i < static_cast<int>(names.size()); ++i)
    if (const auto value = fields.optional_number(names[i])) frame.tolerance[i] = sigma(*value);
  if (frame.motion != Motion::fixed)
    if (const auto value = fields.optional_number("gear"))
      frame.gear_tolerance = *value == 0 ? 0 : sigma(*value);  // 0: a ratio of exact teeth
  fields.refuse_unknown();
}

/// What `fields` have of the frame's parameters; the others stay as they are in `into`.
void read_numbers(Fields& fields, std::span<const char* const> names, double farthest,
                  const Frame& frame, Eigen::VectorXd& into) {
  for (int i = 0; i < static_cast<int>(names.size()); ++i)
    into[i] = is_angle(frame, i) ? fields.angle(names[i], into[i])
                                 : fields.length(names[i], into[i], farthest);
}

double read_gear(Fields& fields, double otherwise) {
  const double gear = fields.number("gear", otherwise);
  if (gear == 0) fields.fail("gear", "a ratio other than 0");
  return gear;
}

/// The parameters, and what the maker says of those that a calibration has moved.
void read_figures(Fields& fields, std::span<const char* const> names, double farthest,
                  Problems& problems, Frame& frame) {
  frame.value.setZero(kFields);
  read_numbers(fields, names, farthest, frame, frame.value);
  frame.nominal = frame.value;
  const bool moves = frame.motion != Motion::fixed;
  if (moves) frame.gear = frame.gear_nominal = read_gear(fields, 1);
  const Node* node = fields.node("nominal");
  if (!node) return;
  Fields nominal(*node, fields.what() + " nominal", problems);
  read_numbers(nominal, names, farthest, frame, frame.nominal);
  if (moves) frame.gear_nominal = read_gear(nominal, frame.gear);
  nominal.refuse_unknown();
}

/// [x, y, z] or [roll, pitch, yaw], each up to `most`.
Eigen::Vector3d read_three(Fields& fields, const char* key, const Eigen::Vector3d& fallback,
                           double most, const char* unit, const char* mistaken) {
  const auto given = fields.numbers(key, 3);
  if (!given) return fallback;
  if (given->cwiseAbs().maxCoeff() > most)
    fields.fail(
        key, std::string(unit) + ", each at most " + format_number(most) + " (" + mistaken + "?)");
  return *given;
}

void read_pose(Fields& fields, double farthest, Problems& problems, Frame& frame) {
  const auto read = [&](Fields& from, Eigen::Vector3d& xyz, Eigen::Vector3d& rpy) {
    xyz = read_three(from, "xyz", xyz, farthest, "metres", "millimetres");
    rpy = read_three(from, "rpy", rpy, kMostTurned, "radians", "degrees");
  };
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  read(fields, xyz, frame.rpy);
  Eigen::Vector3d xyz_nominal = xyz;
  frame.rpy_nominal = frame.rpy;
  if (const Node* node = fields.node("nominal")) {
    Fields nominal(*node, fields.what() + " nominal", problems);
    read(nominal, xyz_nominal, frame.rpy_nominal);
    nominal.refuse_unknown();
  }
  frame.value.setZero(kPoseFields);
  frame.nominal.setZero(kPoseFields);
  frame.value.head<3>() = xyz;
  frame.nominal.head<3>() = xyz_nominal;
  if (frame.rpy != frame.rpy_nominal)
    frame.value.tail<3>() =
        log_rotation(rpy_rotation(frame.rpy_nominal).transpose() * rpy_rotation(frame.rpy));
}

void read_limits(Fields& fields, Frame& frame) {
  const auto limits = fields.numbers("limits", 2);
  if (!limits) return;
  frame.lower = (*limits)[0];
  frame.upper = (*limits)[1];
  if (!(frame.lower < frame.upper)) fields.fail("limits", "[lower, upper] with lower < upper");
  const bool turns = frame.motion == Motion::revolute;
  if (limits->cwiseAbs().maxCoeff() > (turns ? kMostTurned : kFarthestPlace))
    fields.fail("limits", turns ? "radians, at most four turns (degrees?)"
                                : "metres, at most 1000 (millimetres?)");
}

void read_mass(Fields& fields, Frame& frame) {
  frame.mass = fields.optional_number("mass");
  if (frame.mass && !(*frame.mass >= 0 && *frame.mass <= kHeaviestPart))
    fields.fail("mass", "a mass of 0 to 10000 kg (grams?)");
  const auto com = fields.numbers("com", 3);
  if (!com) return;
  frame.com = *com;
  if (!frame.mass) fields.fail("com", "the mass beside it: where no mass is, none has a centre");
  if (!(com->cwiseAbs().maxCoeff() <= kLongestPart)) fields.fail("com", "metres (millimetres?)");
}

/// Where the frame stands, and how surely its maker knows.
void read_place(Fields& fields, Convention convention, double farthest, Problems& problems,
                Frame& frame) {
  const std::span<const char* const> names = read_fields(frame, convention);
  if (frame.whole)
    read_pose(fields, farthest, problems, frame);
  else
    read_figures(fields, names, farthest, problems, frame);
  if (frame.motion != Motion::fixed) read_limits(fields, frame);
  frame.tolerance.setConstant(frame.fields(), -1);
  read_tolerance(fields, names, problems, frame);
}

Node named(std::span<const char* const> names, const Eigen::VectorXd& values,
           const std::function<bool(int)>& which) {
  Node node = Node::map();
  for (int i = 0; i < values.size(); ++i)
    if (which(i)) node.set(names[i], Node::of(values[i]));
  return node;
}

Node three(const Eigen::Vector3d& v) { return Node::of(Eigen::VectorXd(v)); }

Node nominal_pose(const Frame& frame) {
  Node node = Node::map();
  if (frame.nominal.head<3>() != frame.value.head<3>())
    node.set("xyz", three(frame.nominal.head<3>()));
  if (frame.rpy_nominal != frame.rpy) node.set("rpy", three(frame.rpy_nominal));
  return node;
}

}  // namespace

Frame read_frame(const Node& node, int index, Convention convention, bool based,
                 Problems& problems) {
  Fields fields(node, "frame " + std::to_string(index), problems);
  Frame frame;
  frame.name = fields.text("name");
  frame.motion = read_motion(fields);
  const bool moves = frame.motion != Motion::fixed;
  for (const char* key : {"xyz", "rpy"})
    if (fields.has(key)) {
      frame.whole = !moves;
      if (moves) fields.fail(key, "alpha, d, theta and r: only a fixed frame may be a whole pose");
    }
  if (convention == Convention::standard && fields.has("beta"))
    fields.fail("beta", "theta, r, d and alpha alone: standard DH has no beta");
  if (convention == Convention::standard && fields.has("a"))
    fields.fail("a",
                "the letters of this file: what a data sheet's table calls d is r here, and its "
                "a is d (`selfcal robot convert TABLE.csv` reads the sheet's own)");
  read_place(fields, convention, based && !moves ? kFarthestPlace : kLongestPart, problems, frame);
  read_mass(fields, frame);
  if (frame.name.find_first_of(".* \t") != std::string::npos || frame.name.empty())
    fields.fail("name", "a name without blanks, dots or stars");
  fields.refuse_unknown();
  return frame;
}

Node write_frame(const Frame& frame) {
  const std::span<const char* const> names = field_names(frame.whole);
  Node node = Node::map();
  node.set("name", Node::of(frame.name));
  node.set("joint", Node::of(std::string(kMotions[static_cast<int>(frame.motion)])));
  if (frame.whole) node.set("xyz", three(frame.value.head<3>())).set("rpy", three(frame.rpy));
  for (int i = 0; !frame.whole && i < kFields; ++i)
    if (frame.value[i] != 0) node.set(names[i], Node::of(frame.value[i]));
  if (frame.gear != 1) node.set("gear", Node::of(frame.gear));
  if (frame.lower < frame.upper)
    node.set("limits", Node::of(Eigen::VectorXd(Eigen::Vector2d(frame.lower, frame.upper))));
  if (frame.mass) {
    node.set("mass", Node::of(*frame.mass));
    node.set("com", Node::of(Eigen::VectorXd(frame.com)));
  }
  Node tolerance = named(names, frame.tolerance, [&](int i) { return frame.tolerance[i] > 0; });
  if (frame.gear_tolerance >= 0) tolerance.set("gear", Node::of(frame.gear_tolerance));
  if (!tolerance.items.empty()) node.set("tolerance", std::move(tolerance));
  Node nominal = frame.whole ? nominal_pose(frame) : named(names, frame.nominal, [&](int i) {
    return frame.nominal[i] != frame.value[i];
  });
  if (frame.gear_nominal != frame.gear) nominal.set("gear", Node::of(frame.gear_nominal));
  if (!nominal.items.empty()) node.set("nominal", std::move(nominal));
  return node;
}

}  // namespace selfcal::serial
