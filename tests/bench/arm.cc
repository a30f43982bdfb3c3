#include "tests/bench/arm.h"

#include <map>
#include <random>

#include "constraints/equations/equations.h"
#include "constraints/identifiability/identifiability.h"
#include "constraints/sampling/random_poses.h"
#include "io/files/robot_file.h"
#include "kinematics/expects.h"

namespace selfcal::bench {
namespace {

constexpr double kOff = 1e-3;  // m, rad

DataSet perfect_rows(const Robot& robot, const Eigen::VectorXd& truth, int count) {
  DataSet data;
  Problems problems;
  Node entry = Node::map();
  entry.set("method", Node::of(std::string("position")));
  data.sets.push_back(make_set("tracker", entry, problems));
  expects(!problems.any(), "a set of positions needs nothing else");
  data.sets[0].noise = kMeasured;
  Observations& rows = data.rows;
  rows.q = random_poses(robot, nullptr, count, 1);
  rows.position.resize(count, 3);
  for (int row = 0; row < count; ++row)
    rows.position.row(row) = locate(robot, truth, rows.q.row(row).transpose()).p.transpose();
  rows.orientation.setConstant(count, 4, std::nan(""));
  rows.normal.setConstant(count, 3, std::nan(""));
  rows.temperature.setConstant(count, std::nan(""));
  rows.noise_factor.setOnes(count);
  rows.set.assign(static_cast<std::size_t>(count), 0);
  rows.group.assign(static_cast<std::size_t>(count), -1);
  rows.check.assign(static_cast<std::size_t>(count), 0);
  return data;
}

std::vector<int> told_by(const Robot& robot, const DataSet& data) {
  const Equations equations(robot, data, Use::fit);
  State state;
  state.xi = values(robot);
  equations.start(state);
  Weighting weighting;
  weighting.scale = {{kMeasured, kMeasured}};
  weighting.outlier.assign(data.rows.set.size(), 0);
  const std::vector<char> free(robot.parameters().size(), 1);  // gear ratios too
  const Eigen::MatrixXd R = equations.linearise(state, weighting, true).R;
  const Identifiability rank = identifiability(equations, R, state, free, {});
  std::vector<int> list;
  for (std::size_t i = 0; i < free.size(); ++i)
    if (rank.status[i] == Status::identified) list.push_back(static_cast<int>(i));
  return list;
}

}  // namespace

int parameter_of(const Robot& robot, const std::string& frame, const std::string& field) {
  for (std::size_t i = 0; i < robot.parameters().size(); ++i)
    if (robot.parameters()[i].frame == frame && robot.parameters()[i].field == field)
      return static_cast<int>(i);
  expects(false, "the example's frames have all five numbers");
  return -1;
}

Arm::Arm(const Robot& robot) {
  std::vector<std::string> names;
  for (const Parameter& each : robot.parameters())
    if (each.part != Part::gear && (names.empty() || names.back() != each.frame))
      names.push_back(each.frame);
  for (const std::string& name : names) {
    const int joint = find_joint(robot, name);
    frames.push_back({parameter_of(robot, name, "beta"), parameter_of(robot, name, "alpha"),
                      parameter_of(robot, name, "d"), parameter_of(robot, name, "theta"),
                      parameter_of(robot, name, "r"), joint,
                      joint < 0 ? -1 : parameter_of(robot, name, "gear")});
  }
}

Eigen::Vector3d endpoint_and_jacobian(const Arm& arm, const Eigen::VectorXd& xi, const double* q,
                                      Eigen::Matrix3Xd& J) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  struct Turned {
    int index;
    Eigen::Vector3d axis, origin;
  };
  std::array<Turned, 64> turned;
  std::size_t count = 0;
  const auto turn = [&](int a, int b, double angle, const Eigen::Vector3d& axis, int index) {
    turned[count++] = {index, axis, p};
    const double c = std::cos(angle), s = std::sin(angle);
    const Eigen::Vector3d x = R.col(a), y = R.col(b);
    R.col(a) = c * x + s * y;
    R.col(b) = c * y - s * x;
  };
  J.setZero(3, xi.size());
  for (const ArmFrame& each : arm.frames) {
    turn(2, 0, xi[each.beta], R.col(1), each.beta);
    turn(1, 2, xi[each.alpha], R.col(0), each.alpha);
    J.col(each.d) = R.col(0);
    p += xi[each.d] * R.col(0);
    turn(0, 1, xi[each.theta] + (each.joint < 0 ? 0 : xi[each.K] * q[each.joint]), R.col(2),
         each.theta);
    J.col(each.r) = R.col(2);
    p += xi[each.r] * R.col(2);
  }
  for (std::size_t i = 0; i < count; ++i)
    J.col(turned[i].index) = turned[i].axis.cross(p - turned[i].origin);
  for (const ArmFrame& each : arm.frames)
    if (each.joint >= 0) J.col(each.K) = q[each.joint] * J.col(each.theta);
  return p;
}

const Robot& example_robot() {
  static const std::unique_ptr<Robot> robot =
      std::move(*load_robot(SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml"));
  return *robot;
}

const Task& task_of(int rows) {
  static std::map<int, Task> made;
  const auto [found, fresh] = made.try_emplace(rows);
  Task& task = found->second;
  if (!fresh) return task;
  const Robot& robot = example_robot();
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  task.xi = task.truth = values(robot);
  task.unknowns = told_by(robot, perfect_rows(robot, task.xi, 200));
  expects(task.unknowns.size() == kUnknowns, "positions tell 33 parameters of the example");
  for (const int each : task.unknowns) task.truth[each] += kOff * normal(random);
  task.data = perfect_rows(robot, task.truth, rows);
  for (double& each : task.data.rows.position.reshaped()) each += kMeasured * normal(random);
  return task;
}

}  // namespace selfcal::bench
