// The file of a serial robot, read and written (app/selfcal-data.5: frames, limits, masses,
// tolerances, the prior's centre, coupling).
#include <cmath>
#include <functional>

#include "kinematics/robots/serial.h"

namespace selfcal::serial {
namespace {

constexpr const char* kNames[kFields] = {"alpha", "d", "theta", "r", "beta"};
constexpr double kMostGravity = 100;  // m/s^2
constexpr const char* kMotions[] = {"fixed", "revolute", "prismatic"};

Motion read_motion(Fields& fields) {
  const std::string text = fields.text("joint");
  for (int m = 0; m < 3; ++m)
    if (text == kMotions[m]) return static_cast<Motion>(m);
  fields.fail("joint", "revolute, prismatic or fixed");
  return Motion::fixed;
}

/// `tolerance` and `nominal`: a mapping from the names of a frame's parameters to numbers.
void read_named(Fields& frame_fields, const char* key, bool moves, Problems& problems,
                const std::function<void(int, double)>& take,
                const std::function<void(double)>& take_gear) {
  const Node* node = frame_fields.node(key);
  if (!node) return;
  Fields fields(*node, frame_fields.what() + " " + key, problems);
  for (int i = 0; i < kFields; ++i)
    if (const auto value = fields.optional_number(kNames[i])) take(i, *value);
  if (moves)
    if (const auto value = fields.optional_number("gear")) take_gear(*value);
  fields.refuse_unknown();
}

void read_mass(Fields& fields, Frame& frame) {
  frame.mass = fields.optional_number("mass");
  if (frame.mass && *frame.mass < 0) fields.fail("mass", "a mass of at least 0 kg");
  if (const auto com = fields.numbers("com", 3)) frame.com = *com;
}

/// A fixed frame before the first joint places the robot in its world (`based`); others are its
/// own.
Frame read_frame(const Node& node, int index, bool based, Problems& problems) {
  Fields fields(node, "frame " + std::to_string(index), problems);
  Frame frame;
  frame.name = fields.text("name");
  frame.motion = read_motion(fields);
  const bool moves = frame.motion != Motion::fixed;
  for (int i = 0; i < kFields; ++i)
    frame.value[i] =
        i == kD || i == kR
            ? fields.length(kNames[i], 0, based && !moves ? kFarthestPlace : kLongestPart)
            : fields.angle(kNames[i], 0);
  frame.nominal = frame.value;
  frame.tolerance.setConstant(-1);
  if (moves) {
    frame.gear = frame.gear_nominal = fields.number("gear", 1.0);
    if (frame.gear == 0) fields.fail("gear", "a ratio other than 0");
    if (const auto limits = fields.numbers("limits", 2)) {
      frame.lower = (*limits)[0];
      frame.upper = (*limits)[1];
      if (!(frame.lower < frame.upper)) fields.fail("limits", "[lower, upper] with lower < upper");
      const bool turns = frame.motion == Motion::revolute;
      if (limits->cwiseAbs().maxCoeff() > (turns ? kMostTurned : kFarthestPlace))
        fields.fail("limits", turns ? "radians, at most four turns (degrees?)"
                                    : "metres, at most 1000 (millimetres?)");
    }
  }
  const auto positive = [&](double value) {
    if (!(value > 0 && value < 1))
      fields.fail("tolerance", "1 sigma each, above 0 and below 1 (m or rad)");
    return value;
  };
  read_named(
      fields, "tolerance", moves, problems,
      [&](int i, double value) { frame.tolerance[i] = positive(value); },
      [&](double value) { frame.gear_tolerance = positive(value); });
  read_named(
      fields, "nominal", moves, problems, [&](int i, double value) { frame.nominal[i] = value; },
      [&](double value) { frame.gear_nominal = value; });
  read_mass(fields, frame);
  if (frame.name.find_first_of(".* \t") != std::string::npos || frame.name.empty())
    fields.fail("name", "a name without blanks, dots or stars");
  fields.refuse_unknown();
  return frame;
}

void read_coupling(Fields& fields, int joints, Model& model) {
  const Node* node = fields.node("coupling");
  if (!node) return;
  model.coupling.resize(joints, joints);
  bool good = node->kind == Node::Kind::list && static_cast<int>(node->items.size()) == joints;
  for (int i = 0; good && i < joints; ++i) {
    const Node& row = node->items[i];
    good = row.kind == Node::Kind::list && static_cast<int>(row.items.size()) == joints;
    for (int j = 0; good && j < joints; ++j) {
      const auto value = parse_number(row.items[j].text);
      good = value.has_value();
      if (good) model.coupling(i, j) = *value;
    }
  }
  if (good) good = std::abs(model.coupling.determinant()) > 1e-9;
  if (!good)
    fields.fail("coupling", "a regular matrix of " + std::to_string(joints) + " x " +
                                std::to_string(joints) + " numbers, a row a joint variable");
}

void check_names(const Model& model, const Node& frames, Problems& problems) {
  for (size_t i = 0; i < model.frames.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (model.frames[i].name == model.frames[j].name)
        problems.add(frames.items[i].place,
                     "frame name '" + model.frames[i].name + "' is used twice");
}

Node named(const Eigen::Matrix<double, kFields, 1>& values, const std::function<bool(int)>& which) {
  Node node = Node::map();
  for (int i = 0; i < kFields; ++i)
    if (which(i)) node.set(kNames[i], Node::of(values[i]));
  return node;
}

Node write_frame(const Frame& frame) {
  Node node = Node::map();
  node.set("name", Node::of(frame.name));
  node.set("joint", Node::of(std::string(kMotions[static_cast<int>(frame.motion)])));
  for (int i = 0; i < kFields; ++i)
    if (frame.value[i] != 0) node.set(kNames[i], Node::of(frame.value[i]));
  if (frame.gear != 1) node.set("gear", Node::of(frame.gear));
  if (frame.lower < frame.upper)
    node.set("limits", Node::of(Eigen::VectorXd(Eigen::Vector2d(frame.lower, frame.upper))));
  if (frame.mass) {
    node.set("mass", Node::of(*frame.mass));
    node.set("com", Node::of(Eigen::VectorXd(frame.com)));
  }
  Node tolerance = named(frame.tolerance, [&](int i) { return frame.tolerance[i] > 0; });
  if (frame.gear_tolerance > 0) tolerance.set("gear", Node::of(frame.gear_tolerance));
  if (!tolerance.items.empty()) node.set("tolerance", std::move(tolerance));
  Node nominal = named(frame.nominal, [&](int i) { return frame.nominal[i] != frame.value[i]; });
  if (frame.gear_nominal != frame.gear) nominal.set("gear", Node::of(frame.gear_nominal));
  if (!nominal.items.empty()) node.set("nominal", std::move(nominal));
  return node;
}

}  // namespace

Model read(const Node& node, Problems& problems) {
  Fields fields(node, "robot", problems);
  Model model;
  model.name = fields.text("robot");
  fields.text("kind");
  if (const auto gravity = fields.numbers("gravity", 3)) model.gravity = *gravity;
  if (model.gravity.norm() > kMostGravity) fields.fail("gravity", "m/s^2, 9.81 on earth");
  const Node* frames = fields.node("frames");
  if (!frames || frames->kind != Node::Kind::list || frames->items.empty()) {
    fields.fail("frames", "a list of frames from the world to the tool");
    return model;
  }
  for (const Node& item : frames->items)
    model.frames.push_back(read_frame(item, static_cast<int>(model.frames.size()),
                                      moving_frames(model).empty(), problems));
  check_names(model, *frames, problems);
  const int joints = static_cast<int>(moving_frames(model).size());
  if (joints == 0) fields.fail("frames", "at least one revolute or prismatic joint");
  read_coupling(fields, joints, model);
  fields.refuse_unknown();
  return model;
}

Node write(const Model& model) {
  Node node = Node::map();
  node.set("robot", Node::of(model.name));
  node.set("kind", Node::of(std::string("serial")));
  node.set("gravity", Node::of(Eigen::VectorXd(model.gravity)));
  Node frames = Node::list();
  for (const Frame& frame : model.frames) frames.items.push_back(write_frame(frame));
  node.set("frames", std::move(frames));
  if (model.coupling.size() > 0) {
    Node rows = Node::list();
    for (const auto& row : model.coupling.rowwise())
      rows.items.push_back(Node::of(Eigen::VectorXd(row.transpose())));
    node.set("coupling", std::move(rows));
  }
  return node;
}

}  // namespace selfcal::serial
