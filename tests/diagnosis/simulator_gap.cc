// The gap of a simulator, whose poses are made by hand: what an instrument's unknown frame takes up
// and what it does not.
#include "diagnosis/comparison/simulator_gap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kinematics/rotation.h"

namespace selfcal {
namespace {

constexpr int kSimulatedPoses = 40;
constexpr double kExact = 1e-12;  // m: of numbers around 1 m, multiplied a few times

struct SimulatedTool {
  DataSet data;
  ToolPoses poses;
};

/// `entry` describes the set; each row measures the tool where the simulator has it.
SimulatedTool simulated_tool(const std::string& entry) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto draw = [&] {
    return Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
  };
  SimulatedTool made;
  Problems problems;
  Node node = Node::map().set("method", Node::of(std::string("position")));
  if (entry == "frame" || entry == "both") node.set("frame", Node::of(std::string("unknown")));
  if (entry == "both") node.set("point", Node::of(std::string("unknown")));
  made.data.sets = {make_set("tracker", node, problems)};
  Observations& rows = made.data.rows;
  rows.q.setZero(kSimulatedPoses, 6);
  rows.position.resize(kSimulatedPoses, 3);
  rows.set.assign(kSimulatedPoses, 0);
  rows.group.assign(kSimulatedPoses, -1);
  for (int i = 0; i < kSimulatedPoses; ++i) {
    rows.check.push_back(static_cast<char>(i % 4 == 0));
    const Location X{exp_rotation(2 * draw()), draw()};
    made.poses.emplace_back(X);
    rows.position.row(i) = X.p.transpose();
  }
  return made;
}

TEST(SimulatorGap, IsHowFarTheToolIsOffWhereTheInstrumentsFrameIsTheWorld) {
  SimulatedTool made = simulated_tool("");
  for (auto& X : made.poses) X->p += Eigen::Vector3d(0.003, 0, 0.004);
  const SimulatorGap gap = simulator_gap(made.data, made.poses);
  EXPECT_NEAR(gap.rms, 0.005, kExact);
  EXPECT_EQ(gap.rows, kSimulatedPoses / 4);
  EXPECT_TRUE(gap.kept_aside);
}

TEST(SimulatorGap, IsOfNoRowThatIsAFalseReading) {
  SimulatedTool made = simulated_tool("frame");
  made.data.rows.position(8, 0) += 0.05;
  made.data.rows.position(9, 1) -= 0.05;
  EXPECT_GT(simulator_gap(made.data, made.poses).rms, 1e-3);
  std::vector<Outlier> outliers(2);
  outliers[0].row = 9;  // from 1
  outliers[1].row = 10;
  const SimulatorGap gap = simulator_gap(made.data, without_false_rows(made.poses, outliers));
  EXPECT_NEAR(gap.rms, 0, 1e-9);
  EXPECT_EQ(gap.rows, kSimulatedPoses / 4 - 1);
}

TEST(SimulatorGap, DoesNotCountWhereTheInstrumentAndItsTargetStand) {
  SimulatedTool made = simulated_tool("both");
  const Location F{exp_rotation({0.3, -2, 0.5}), {1, 2, 3}};
  for (auto& X : made.poses) {
    X->p = F.R * (X->p - X->R * Eigen::Vector3d(0.1, 0.02, -0.05)) + F.p;
    X->R = F.R * X->R;
  }
  EXPECT_NEAR(simulator_gap(made.data, made.poses).rms, 0, 1e-9);
}

TEST(SimulatorGap, IsJudgedOnRowsThatPlacedNothing) {
  SimulatedTool made = simulated_tool("frame");
  // Rows that are kept aside are off by 1 mm; the others place the frame, and are not.
  for (int i = 0; i < kSimulatedPoses; i += 4) made.data.rows.position(i, 1) += 1e-3;
  EXPECT_NEAR(simulator_gap(made.data, made.poses).rms, 1e-3, 1e-9);
}

TEST(SimulatorGap, LeavesOutRowsWithoutAPoseAndNamesSetsThatItCannotJudge) {
  SimulatedTool made = simulated_tool("");
  made.poses[0].reset();
  EXPECT_EQ(simulator_gap(made.data, made.poses).rows, kSimulatedPoses / 4 - 1);
  Problems problems;
  Node pairs = Node::map().set("method", Node::of(std::string("position-constraint")));
  made.data.sets = {make_set("tip", pairs, problems)};
  const SimulatorGap gap = simulator_gap(made.data, made.poses);
  EXPECT_EQ(gap.rows, 0);
  EXPECT_EQ(gap.sets, std::vector<std::string>{"tip"});
}

}  // namespace
}  // namespace selfcal
