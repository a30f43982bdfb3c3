// What every kind of robot shares: looking parameters up by name.
#include "kinematics/robot.h"

#include <numbers>

namespace selfcal {

namespace {

bool matches(std::string_view text, std::string_view pattern) {
  if (pattern.empty()) return text.empty();
  if (pattern.front() == '*')
    return matches(text, pattern.substr(1)) || (!text.empty() && matches(text.substr(1), pattern));
  return !text.empty() && text.front() == pattern.front() &&
         matches(text.substr(1), pattern.substr(1));
}

}  // namespace

std::string_view unit(Quantity quantity) {
  switch (quantity) {
    case Quantity::length:
      return "m";
    case Quantity::angle:
      return "rad";
    case Quantity::ratio:
    case Quantity::other:
      return "1";
  }
  return "1";
}

double Joint::range() const {
  if (limited()) return upper - lower;
  return quantity == Quantity::angle ? 2 * std::numbers::pi : 2;
}

Eigen::Matrix3d Locations::R(int lane) const { return rotation.row(lane).reshaped(3, 3).matrix(); }

Eigen::VectorXd values(const Robot& robot) {
  Eigen::VectorXd xi(static_cast<Eigen::Index>(robot.parameters().size()));
  for (Eigen::Index i = 0; i < xi.size(); ++i) xi[i] = robot.parameters()[i].value;
  return xi;
}

Eigen::VectorXd nominal_values(const Robot& robot) {
  Eigen::VectorXd xi(static_cast<Eigen::Index>(robot.parameters().size()));
  for (Eigen::Index i = 0; i < xi.size(); ++i) xi[i] = robot.parameters()[i].nominal;
  return xi;
}

int find_joint(const Robot& robot, std::string_view name) {
  for (size_t j = 0; j < robot.joints().size(); ++j)
    if (robot.joints()[j].name == name) return static_cast<int>(j);
  return -1;
}

bool within_limits(const Robot& robot, const Eigen::VectorXd& q, double margin) {
  for (Eigen::Index j = 0; j < q.size(); ++j)
    if (const Joint& joint = robot.joints()[j]; !joint.allows(q[j], margin * joint.range()))
      return false;
  return robot.within_passive_limits(q);
}

Eigen::VectorXd Robot::variable_change(const Eigen::VectorXd& xi, int j) const {
  return Eigen::VectorXd::Unit(xi.size(), variable_parameter(j));
}

Eigen::MatrixXd Robot::variables_per_reading(const Eigen::VectorXd&) const {
  const auto n = static_cast<Eigen::Index>(joints().size());
  return Eigen::MatrixXd::Identity(n, n);
}

const std::vector<PassiveJoint>& Robot::passive_joints() const {
  static const std::vector<PassiveJoint> none;
  return none;
}

int passive_index(const Robot& robot, Body body) {
  const std::vector<PassiveJoint>& joints = robot.passive_joints();
  for (size_t i = 0; i < joints.size(); ++i)
    if (body_behind(joints[i].chain, joints[i].kind) == body) return static_cast<int>(i);
  return -1;
}

const std::vector<std::string>& Robot::links() const {
  static const std::vector<std::string> none;
  return none;
}

bool has_body(const Robot& robot, Body body) {
  if (body >= Body::first_named) return body < link_body(static_cast<int>(robot.links().size()));
  return body < Body::first_passive || passive_index(robot, body) >= 0;
}

std::vector<NamedBody> named_bodies(const Robot& robot) {
  std::vector<NamedBody> all = {{"endpoint", Body::endpoint},
                                {"last_link", Body::last_link},
                                {"first_link", Body::first_link}};
  for (const PassiveJoint& joint : robot.passive_joints())
    all.push_back({joint.name, body_behind(joint.chain, joint.kind)});
  for (size_t k = 0; k < robot.links().size(); ++k)
    all.push_back({robot.links()[k], link_body(static_cast<int>(k))});
  return all;
}

std::optional<Body> find_body(const Robot& robot, std::string_view name) {
  for (const NamedBody& each : named_bodies(robot))
    if (each.name == name) return each.body;
  return std::nullopt;
}

void Closure::leave_open(int lane, std::string reason) {
  if (!closes(lane)) return;
  open |= 1U << lane;
  why.resize(kLanes);
  why[static_cast<size_t>(lane)] = std::move(reason);
}

void Closure::add(const Closure& other) {
  for (int lane = 0; other.open != 0 && lane < kLanes; ++lane)
    if (!other.closes(lane)) leave_open(lane, other.why[static_cast<size_t>(lane)]);
}

Eigen::VectorXd Robot::draw(const Eigen::MatrixX2d& span,
                            const std::function<double()>& uniform) const {
  Eigen::VectorXd q(span.rows());
  for (Eigen::Index j = 0; j < q.size(); ++j)
    q[j] = span(j, 0) + (span(j, 1) - span(j, 0)) * uniform();
  return q;
}

std::vector<Eigen::Isometry3d> seen_poses(const Robot& robot, const Eigen::VectorXd& q) {
  if (const Statics* statics = robot.statics()) return statics->link_poses(q);
  const Location tool = locate(robot, values(robot), q);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = tool.R;
  pose.translation() = tool.p;
  return {pose};
}

ConfigurationBlock block_of(const Eigen::VectorXd& q) { return {q.transpose().array(), 1}; }

Location locate(const Robot& robot, const Eigen::VectorXd& xi, const Eigen::VectorXd& q,
                Body body) {
  Locations X;
  robot.locate(block_of(q), xi, body, X, nullptr);
  return X.at(0);
}

std::string full_name(const Parameter& parameter) {
  const std::string in_frame = parameter.frame + "." + parameter.field;
  return parameter.name == in_frame ? in_frame : parameter.name + " " + in_frame;
}

std::string name_example(const Robot& robot) {
  const Parameter& one = robot.parameters()[robot.parameters().size() / 3];
  const std::string in_frame = one.frame + "." + one.field;
  return one.name == in_frame ? in_frame : one.name + " or " + in_frame;
}

std::vector<int> match_parameters(const Robot& robot, std::string_view pattern) {
  std::vector<int> found;
  const std::vector<Parameter>& list = robot.parameters();
  for (size_t i = 0; i < list.size(); ++i)
    if (matches(list[i].name, pattern) || matches(list[i].frame + "." + list[i].field, pattern))
      found.push_back(static_cast<int>(i));
  return found;
}

int find_parameter(const Robot& robot, std::string_view name) {
  const std::vector<int> found = match_parameters(robot, name);
  return found.size() == 1 ? found.front() : -1;
}

}  // namespace selfcal
