// Axis j is seen with the joints before it at v_1 … v_j-1, and is taken back to where they are zero
// by the axes found before (product of exponentials, from the base on):
//   axis_j(0) = (exp(S_1 v_1) … exp(S_j-1 v_j-1))^-1 axis_j(v)
// Several groups of a joint are averaged by their weights. The lines make a chain, its frames are
// those of kinematics/chains.
#include "constraints/axes/axis_model.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "kinematics/chains/joint_chain.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using serial::Frame;

const char* const kMethod = "circle-point";

/// Rows of one group, by joint.
struct Circle {
  int set = 0, joint = 0;
  std::vector<int> rows;
};

std::string called(const DataSet& data, const Circle& circle) {
  const Set& set = data.sets[static_cast<std::size_t>(circle.set)];
  const int group = data.rows.group[static_cast<std::size_t>(circle.rows[0])];
  return "set " + set.name +
         (group < 0 || set.groups.size() < 2
              ? ""
              : ", group " + set.groups[static_cast<std::size_t>(group)]) +
         ": ";
}

/// The joint variables of every row: coupling, gears, readings.
Eigen::MatrixXd variables(const serial::Model& file, const Eigen::MatrixXd& q) {
  const std::vector<int> moving = serial::moving_frames(file);
  Eigen::MatrixXd v = q;
  for (std::size_t j = 0; j < moving.size(); ++j)
    v.col(static_cast<Eigen::Index>(j)) *= file.frames[static_cast<std::size_t>(moving[j])].gear;
  return file.coupling.size() > 0 ? Eigen::MatrixXd(v * file.coupling.transpose()) : v;
}

std::vector<Circle> circles_of(const serial::Model& file, const DataSet& data) {
  const std::vector<int> moving = serial::moving_frames(file);
  std::map<std::pair<int, int>, Circle> circles;
  for (int row = 0; row < data.rows.rows(); ++row) {
    const auto at = static_cast<std::size_t>(row);
    if (data.rows.check[at]) continue;
    Circle& circle = circles[{data.rows.set[at], data.rows.group[at]}];
    circle.set = data.rows.set[at];
    circle.rows.push_back(row);
  }
  std::vector<Circle> list;
  for (auto& [key, circle] : circles) {
    const std::string joint =
        data.sets[static_cast<std::size_t>(circle.set)].method->turning_joint();
    for (std::size_t j = 0; j < moving.size(); ++j)
      if (file.frames[static_cast<std::size_t>(moving[j])].name == joint)
        circle.joint = static_cast<int>(j);
    list.push_back(std::move(circle));
  }
  return list;
}

/// What the rows saw, or nothing where a joint other than theirs moved.
std::optional<Turning> turning_of(const DataSet& data, const Circle& circle,
                                  const Eigen::MatrixXd& v, const serial::Model& file,
                                  std::vector<std::string>& problems) {
  const Method& method = *data.sets[static_cast<std::size_t>(circle.set)].method;
  const Eigen::Index markers = method.tangent_dimension() / 3;
  const std::vector<int> moving = serial::moving_frames(file);
  Turning turning;
  turning.variable.resize(static_cast<Eigen::Index>(circle.rows.size()));
  for (std::size_t i = 0; i < circle.rows.size(); ++i) {
    const int row = circle.rows[i];
    for (Eigen::Index j = 0; j < v.cols(); ++j) {
      if (j == circle.joint || std::abs(v(row, j) - v(circle.rows[0], j)) <= kStands) continue;
      problems.push_back(
          called(data, circle) + "row " + std::to_string(row + 1) + ": joint " +
          file.frames[static_cast<std::size_t>(moving[static_cast<std::size_t>(j)])].name +
          " moved, where " + method.turning_joint() + " alone shall");
      return std::nullopt;
    }
    turning.variable[static_cast<Eigen::Index>(i)] = v(row, circle.joint);
    Eigen::Matrix3Xd seen(3, markers);
    for (int m = 0; m < markers; ++m)
      for (int c = 0; c < 3; ++c) seen(c, m) = data.rows.column(marker_column(m, c))[row];
    turning.markers.push_back(std::move(seen));
  }
  return turning;
}

Isometry3d turn_about(const TurnAxis& line, double angle) {
  Isometry3d X = Isometry3d::Identity();
  X.linear() = exp_rotation(angle * line.e);
  X.translation() = line.p - X.linear() * line.p;
  return X;
}

/// The mean of the lines of one joint.
TurnAxis mean_of(const std::vector<TurnAxis>& lines) {
  TurnAxis mean = lines[0];
  if (lines.size() == 1) return mean;
  mean = {Vector3d::Zero(), Vector3d::Zero(), 0, 0, {}};
  double squares = 0;
  for (const TurnAxis& each : lines) {
    mean.e += each.weight * each.e;
    mean.weight += each.weight;
    squares += each.weight * each.off * each.off;
  }
  mean.e.normalize();
  for (const TurnAxis& each : lines)
    mean.p += each.weight / mean.weight * (each.p - mean.e * mean.e.dot(each.p));
  mean.off = std::sqrt(squares / mean.weight);
  return mean;
}

std::vector<JointAxis> axes_of(const serial::Model& file, const DataSet& data,
                               std::vector<std::string>& problems) {
  const Eigen::MatrixXd v = variables(file, data.rows.q);
  const std::vector<Circle> circles = circles_of(file, data);
  std::vector<JointAxis> axes;
  for (const int frame : serial::moving_frames(file)) {
    const auto joint = static_cast<int>(axes.size());
    axes.push_back({file.frames[static_cast<std::size_t>(frame)].name, {}});
    std::vector<TurnAxis> lines;
    for (const Circle& circle : circles) {
      if (circle.joint != joint) continue;
      const auto turning = turning_of(data, circle, v, file, problems);
      if (!turning) continue;
      TurnAxis line = turn_axis(*turning);
      if (!line.problem.empty()) {
        problems.push_back(called(data, circle) + line.problem);
        continue;
      }
      Isometry3d before = Isometry3d::Identity();
      for (int i = 0; i < joint; ++i)
        before = before * turn_about(axes[static_cast<std::size_t>(i)].line, v(circle.rows[0], i));
      line.e = before.linear().transpose() * line.e;
      line.p = before.inverse() * line.p;
      lines.push_back(std::move(line));
    }
    const bool has_set =
        std::ranges::any_of(circles, [joint](const Circle& each) { return each.joint == joint; });
    if (!has_set)
      problems.push_back("joint " + axes.back().joint +
                         " has no rows: each joint "
                         "takes a set of circle points");
    if (!lines.empty()) axes.back().line = mean_of(lines);
  }
  return axes;
}

/// The robot of the file as a chain. Its first joint stands before its own theta and r, so that
/// these stay what they are.
JointChain chain_of(const serial::Model& file) {
  JointChain chain;
  chain.name = file.name;
  Isometry3d X = Isometry3d::Identity();
  for (const Frame& frame : file.frames) {
    const Isometry3d before = X;
    X = X * serial::pose_in_parent(frame, 0);
    if (frame.motion == serial::Motion::fixed) continue;
    ChainJoint joint;
    joint.name = frame.name;
    joint.X_WJ = X;
    joint.x = X.linear().col(0);
    joint.lower = frame.lower;
    joint.upper = frame.upper;
    joint.mass = frame.mass;
    joint.com = frame.com;
    if (chain.joints.empty()) {
      Frame start = frame;
      start.value[serial::kTheta] = start.value[serial::kR] = 0;
      joint.X_WJ = before * serial::pose_in_parent(start, 0);
      joint.com = joint.X_WJ.inverse() * (X * frame.com);
    }
    chain.joints.push_back(std::move(joint));
  }
  chain.X_WT = X;
  return chain;
}

/// The directions of the axes, and from one to the next where they are parallel.
Eigen::Matrix3Xd directions(const std::vector<JointAxis>& axes) {
  Eigen::Matrix3Xd all(3, 2 * static_cast<Eigen::Index>(axes.size()));
  all.setZero();
  for (std::size_t j = 0; j < axes.size(); ++j) {
    const TurnAxis& line = axes[j].line;
    all.col(2 * static_cast<Eigen::Index>(j)) = line.e;
    if (j + 1 == axes.size()) break;
    const TurnAxis& next = axes[j + 1].line;
    if (line.e.cross(next.e).norm() > kParallel) continue;
    const Vector3d way = next.p - line.p, across = way - line.e * line.e.dot(way);
    if (across.norm() > 0) all.col(2 * static_cast<Eigen::Index>(j) + 1) = across.normalized();
  }
  return all;
}

std::vector<JointAxis> axes_of(const JointChain& chain) {
  std::vector<JointAxis> axes;
  for (const ChainJoint& joint : chain.joints)
    axes.push_back({joint.name, {joint.X_WJ.linear().col(2), joint.X_WJ.translation(), 1, 0, {}}});
  return axes;
}

/// The chain that the axes make; x of each frame points as the file's does.
JointChain chain_of(const JointChain& file, const std::vector<JointAxis>& axes) {
  const Eigen::Matrix3d R = rotation_onto(directions(axes_of(file)), directions(axes));
  JointChain chain = file;
  for (std::size_t j = 0; j < axes.size(); ++j) {
    ChainJoint& joint = chain.joints[j];
    const TurnAxis& line = axes[j].line;
    joint.x = R * *joint.x;
    Vector3d x = R * joint.X_WJ.linear().col(0);
    x = (x - line.e * line.e.dot(x)).norm() > kParallel ? x : line.e.unitOrthogonal();
    x = (x - line.e * line.e.dot(x)).normalized();
    joint.X_WJ.linear() << x, line.e.cross(x), line.e;
    joint.X_WJ.translation() = line.p;
  }
  return chain;
}

Isometry3d along_its_axis(const Frame& like) {
  Frame frame;
  frame.value[serial::kTheta] = like.value[serial::kTheta];
  frame.value[serial::kR] = like.value[serial::kR];
  return serial::pose_in_parent(frame, 0);
}

/// The frames of `chain` with the zero and the shift of its first and last joint, and the tool, of
/// `made`.
serial::Model frames_like(JointChain chain, const serial::Model& made) {
  const serial::Model loose = frames_of(chain);
  const std::vector<Isometry3d> at = serial::frame_poses(
      loose, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(chain.joints.size())));
  const std::size_t last = chain.joints.size();
  chain.joints.front().X_WJ = at[1] * along_its_axis(made.frames[1]).inverse();
  if (last > 1)
    chain.joints.back().X_WJ =
        at[last] * along_its_axis(loose.frames[last]).inverse() * along_its_axis(made.frames[last]);
  chain.X_WT = chain.joints.back().X_WJ * serial::pose_in_parent(made.frames[last + 1], 0);
  return frames_of(chain);
}

/// What no axis tells: couplings, gears, masses, and where down is.
void complete(const serial::Model& file, const Eigen::Matrix3d& R, serial::Model& model) {
  model.gravity = R * file.gravity;
  model.coupling = file.coupling;
  model.mass = file.mass;
  model.payload = file.payload;
  const std::vector<int> moving = serial::moving_frames(file);
  for (std::size_t j = 0; j < moving.size(); ++j) {
    Frame& frame = model.frames[j + 1];
    const Frame& like = file.frames[static_cast<std::size_t>(moving[j])];
    frame.gear = frame.gear_nominal = like.gear;
    frame.gear_tolerance = like.gear_tolerance;
  }
}

}  // namespace

bool of_circles_alone(const DataSet& data) {
  return std::ranges::all_of(data.sets,
                             [](const Set& set) { return set.method->name() == kMethod; });
}

std::optional<AxisModel> axis_model(const serial::Model& file, const DataSet& data,
                                    std::vector<std::string>& problems) {
  const auto slides = std::ranges::find(file.frames, serial::Motion::prismatic, &Frame::motion);
  if (slides != file.frames.end())
    problems.push_back("joint " + slides->name +
                       " slides: circle points tell the axes of joints that turn");
  if (!problems.empty()) return std::nullopt;
  AxisModel model;
  model.axes = axes_of(file, data, problems);
  if (!problems.empty()) return std::nullopt;
  const JointChain as_made = chain_of(file);
  model.made = frames_of(as_made);
  complete(file, Eigen::Matrix3d::Identity(), model.made);
  model.found = frames_like(chain_of(as_made, model.axes), model.made);
  const Eigen::Matrix3d R = rotation_onto(directions(axes_of(as_made)), directions(model.axes));
  complete(file, R, model.found);
  for (std::size_t i = 1; i + 1 < model.found.frames.size(); ++i) {
    model.found.frames[i].mass = model.made.frames[i].mass;
    model.found.frames[i].com = model.made.frames[i].com;
  }
  return model;
}

}  // namespace selfcal
