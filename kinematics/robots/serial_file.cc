// The file of a serial robot, read and written (app/selfcal-data.5: convention, frames, coupling).
// It is always written in the frames that the program works with.
#include <cmath>

#include "kinematics/robots/serial_frames.h"

namespace selfcal::serial {
namespace {

constexpr double kMostGravity = 100;  // m/s^2
constexpr std::size_t kMostFrames = 100;

void read_coupling(Fields& fields, int joints, Model& model) {
  const Node* node = fields.node("coupling");
  if (!node) return;
  model.coupling.resize(joints, joints);
  bool good = node->kind == Node::Kind::list && static_cast<int>(node->items.size()) == joints;
  for (int i = 0; good && i < joints; ++i) {
    const Node& row = node->items[i];
    good = row.kind == Node::Kind::list && static_cast<int>(row.items.size()) == joints;
    for (int j = 0; good && j < joints; ++j) {
      const auto value = written_number(row.items[j].text);
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

Convention read_convention(Fields& fields) {
  const std::string text = fields.text("convention", "modified");
  if (text == "standard") return Convention::standard;
  if (text != "modified") fields.fail("convention", "modified or standard");
  return Convention::modified;
}

}  // namespace

Model read(const Node& node, Problems& problems) {
  Fields fields(node, "robot", problems);
  Model model;
  model.name = fields.text("robot");
  fields.text("kind");
  if (const auto gravity = fields.numbers("gravity", 3)) model.gravity = *gravity;
  if (model.gravity.norm() > kMostGravity) fields.fail("gravity", "m/s^2, 9.81 on earth");
  const Convention convention = read_convention(fields);
  model.mass = fields.optional_number("mass");
  model.payload = fields.number("payload", 0.0);
  if (model.mass && *model.mass <= 0) fields.fail("mass", "a mass above 0 kg");
  if (model.payload < 0) fields.fail("payload", "a mass of at least 0 kg");
  const Node* frames = fields.node("frames");
  if (!frames || frames->kind != Node::Kind::list || frames->items.empty()) {
    fields.fail("frames", "a list of frames from the world to the tool");
    return model;
  }
  if (frames->items.size() > kMostFrames) {
    fields.fail("frames", "at most " + std::to_string(kMostFrames) + " of them");
    return model;
  }
  for (const Node& item : frames->items)
    model.frames.push_back(read_frame(item, static_cast<int>(model.frames.size()), convention,
                                      moving_frames(model).empty(), problems));
  check_names(model, *frames, problems);
  model.standard = convention == Convention::standard;
  if (model.standard && !problems.any()) model.frames = from_standard(model.frames);
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
  if (model.mass) node.set("mass", Node::of(*model.mass));
  if (model.payload > 0) node.set("payload", Node::of(model.payload));
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
