// A robot's table by circle points, against the table that the circles were made with.
#include "constraints/axes/axis_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "constraints/methods/data_set.h"
#include "io/files/yaml.h"
#include "tests/constraints/marker_noise.h"

namespace selfcal {
namespace {

using Eigen::Matrix3Xd;

/// Yaskawa Motoman AID 810 by its nominal table (standard convention, mm and degrees there).
constexpr const char* kMotoman = R"(
robot: motoman-aid-810
kind: serial
convention: standard
frames:
  - {name: j1, joint: revolute, r: 0.785, alpha: pi/2}
  - {name: j2, joint: revolute, d: 0.670}
  - {name: j3, joint: revolute, alpha: pi/2}
  - {name: j4, joint: revolute, r: 0.950, alpha: pi/2}
  - {name: j5, joint: revolute, r: 0.090, alpha: pi/2}
  - {name: j6, joint: revolute}
)";

serial::Model model_of(const std::string& text) {
  Problems problems;
  serial::Model model = serial::read(*parse_yaml(text, "robot.yaml"), problems);
  EXPECT_FALSE(problems.any());
  return model;
}

/// Six rows a joint, 10 degrees apart, five markers on a bracket in depth, by a camera of `sigma`.
DataSet seen_by_camera(const serial::Model& robot, double sigma, Random& random) {
  DataSet data;
  Problems problems;
  std::string sets;
  const std::vector<int> moving = serial::moving_frames(robot);
  for (const int j : moving)
    sets += robot.frames[j].name +
            ": {method: circle-point, markers: 5, joint: " + robot.frames[j].name + "}\n";
  data.sets = read_sets(*parse_yaml(sets, "dataset.yaml"), problems);
  EXPECT_FALSE(problems.any());
  Matrix3Xd bracket(3, 5);
  bracket << 0.2, -0.2, 0.2, -0.2, 0, 0.2, 0.2, -0.2, -0.2, 0, 0.1, 0.2, 0.2, 0.1, 0.4;
  const auto n = static_cast<Eigen::Index>(moving.size());
  Eigen::VectorXd home(n);
  home << 0.3, 0.9, -0.4, 0.5, 1.0, -0.2;
  data.rows.q.resize(6 * n, n);
  for (const MeasuredColumn& column : data.sets[0].method->measures())
    data.rows.measured[column.name].resize(6 * n);
  for (int row = 0; row < 6 * n; ++row) {
    Eigen::VectorXd q = home;
    q[row / 6] += (row % 6 - 2.5) * std::numbers::pi / 18;
    data.rows.q.row(row) = q.transpose();
    data.rows.set.push_back(row / 6);
    data.rows.group.push_back(-1);
    data.rows.check.push_back(0);
    const Matrix3Xd at =
        (serial::frame_poses(robot, q).back() * bracket.colwise().homogeneous()).topRows(3) +
        marker_noise(5, sigma, random);
    for (int i = 0; i < 15; ++i)
      data.rows.column(marker_column(i / 3, i % 3))[row] = at(i % 3, i / 3);
  }
  return data;
}

/// Largest difference of alpha, d, theta, r and beta of the frames (m, rad).
double farthest(const serial::Model& a, const serial::Model& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.frames.size(); ++i)
    if (a.frames[i].motion != serial::Motion::fixed)
      most = std::max(most, (a.frames[i].value - b.frames[i].value).cwiseAbs().maxCoeff());
  return most;
}

TEST(AxisModelOfMotoman, IsItsTableWithoutNoise) {
  const serial::Model robot = model_of(kMotoman);
  Random random(1);
  std::vector<std::string> problems;
  const auto model = axis_model(robot, seen_by_camera(robot, 0, random), problems);
  EXPECT_THAT(problems, testing::IsEmpty());
  ASSERT_TRUE(model);
  EXPECT_LT(farthest(model->found, model->made), 1e-11);
  // The table, in the frames of the modified convention: alpha and d belong to the frame after.
  const std::vector<serial::Frame>& f = model->found.frames;
  EXPECT_NEAR(f[1].value[serial::kR], 0.785, 1e-11);
  EXPECT_NEAR(std::abs(f[2].value[serial::kAlpha]), std::numbers::pi / 2, 1e-11);
  EXPECT_NEAR(f[3].value[serial::kD], 0.670, 1e-11);
  EXPECT_NEAR(std::abs(f[4].value[serial::kR]), 0.950, 1e-11);
  EXPECT_NEAR(std::abs(f[5].value[serial::kR]), 0.090, 1e-11);
}

TEST(AxisModelOfMotoman, FindsAxesThatDifferFromTheTable) {
  const serial::Model file = model_of(kMotoman);
  serial::Model robot = file;
  robot.frames[2].value[serial::kD] += 0.004;
  robot.frames[2].value[serial::kBeta] += 0.002;
  robot.frames[4].value[serial::kAlpha] -= 0.003;
  Random random(1);
  std::vector<std::string> problems;
  const auto model = axis_model(file, seen_by_camera(robot, 0, random), problems);
  ASSERT_TRUE(model);
  const auto& found = model->found.frames;
  const auto& made = model->made.frames;
  EXPECT_NEAR(found[3].value[serial::kD] - made[3].value[serial::kD], 0.004, 1e-5);  // 2nd order
  EXPECT_NEAR(found[3].value[serial::kBeta], 0.002, 1e-9);
  EXPECT_NEAR(found[5].value[serial::kAlpha] - made[5].value[serial::kAlpha], -0.003, 1e-9);
}

TEST(AxisModelOfMotoman, IsItsTableToACamerasThirdOfAMillimetre) {
  const serial::Model robot = model_of(kMotoman);
  Random random(2);
  double angle = 0, length = 0, turn = 0, along = 0;
  constexpr int kTrials = 20;
  for (int i = 0; i < kTrials; ++i) {
    std::vector<std::string> problems;
    const auto model = axis_model(robot, seen_by_camera(robot, 0.3e-3, random), problems);
    ASSERT_TRUE(model) << problems.front();
    for (std::size_t j = 2; j < 7; ++j) {
      const Eigen::VectorXd off = model->found.frames[j].value - model->made.frames[j].value;
      angle = std::max(angle, std::abs(off[serial::kAlpha]));
      length = std::max(length, std::abs(off[serial::kD]));
      turn = std::max(turn, std::abs(off[serial::kTheta]));
      along = std::max(along, std::abs(off[serial::kR]));
    }
  }
  std::printf(
      "Motoman by a camera of 0.3 mm, worst of %d: alpha %.2f, theta %.2f mrad, d %.2f, r "
      "%.2f mm\n",
      kTrials, 1e3 * angle, 1e3 * turn, 1e3 * length, 1e3 * along);
  // Per axis: rotation of a row 0.3 mm / sqrt(0.22 m^2), the markers' squares about a line across;
  // over sqrt(0.53), the squares of six turns 10 degrees apart: 0.88 mrad. Two axes, 4 sigma; an
  // arm of 1 m from the markers to where the axes are nearest. The paper's own table was off by 65
  // mrad and 9.3 mm.
  EXPECT_LT(angle, 4 * std::sqrt(2.0) * 0.88e-3);
  EXPECT_LT(length, 4 * std::sqrt(2.0) * 0.88e-3);
  // Three axes each; those of j2 and j3 are parallel, 0.67 m apart.
  EXPECT_LT(turn, 4 * std::sqrt(3.0) * 0.88e-3 / 0.67);
  EXPECT_LT(along, 4 * std::sqrt(3.0) * 0.88e-3);
}

TEST(AxisModelOfMotoman, NamesTheJointThatLacksRowsAndTheOneThatMoved) {
  const serial::Model robot = model_of(kMotoman);
  Random random(3);
  DataSet data = seen_by_camera(robot, 0, random);
  data.rows.q(20, 1) += 0.01;
  for (int row = 0; row < 6; ++row) data.rows.set[row] = 1;
  std::vector<std::string> problems;
  EXPECT_FALSE(axis_model(robot, data, problems));
  EXPECT_THAT(problems, testing::Contains(testing::HasSubstr("joint j1 has no rows")));
  EXPECT_THAT(problems, testing::Contains("set j4: row 21: joint j2 moved, where j4 alone shall"));
}

}  // namespace
}  // namespace selfcal
