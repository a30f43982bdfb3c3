// Plans that keep to a spacing and to a time, and what is told of configurations that are too few.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "constraints/planning/configuration_plan.h"
#include "io/files/robot_file.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

std::shared_ptr<const Robot> example_arm() {
  return std::move(*load_robot(SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml"));
}

Set set_by(const std::string& name, const std::string& method) {
  Problems none;
  return make_set(name, Node::map().set("method", Node::of(method)), none);
}

PlanRequest touches_of_planes(int planes, int count, int candidates) {
  PlanRequest request;
  for (int i = 0; i < planes; ++i)
    request.pool.sets.push_back(set_by("plane" + std::to_string(i + 1), "plane"));
  request.count = count;
  request.pool.candidates = candidates;
  request.speed.setOnes(6);
  return request;
}

/// Least distance between end positions of the rows (m).
double least_apart(const Robot& robot, const DataSet& data) {
  double least = HUGE_VAL;
  const auto at = [&](int row) {
    return locate(robot, values(robot), data.rows.q.row(row).transpose()).p;
  };
  for (int a = 0; a < data.rows.rows(); ++a)
    for (int b = 0; b < a; ++b) least = std::min(least, (at(a) - at(b)).norm());
  return least;
}

TEST(ConfigurationPlan, KeepsEndPositionsApartAndItsWayWithinItsTime) {
  const auto robot = example_arm();
  PlanRequest request = touches_of_planes(1, 15, 200);
  request.pool.spacing = 0.1;
  const ConfigurationPlan spaced = plan_configurations(*robot, values(*robot), request);
  ASSERT_EQ(spaced.problem, "");
  EXPECT_GE(least_apart(*robot, spaced.data), 0.1);
  request.longest = 0.5 * spaced.way;
  const ConfigurationPlan shorter = plan_configurations(*robot, values(*robot), request);
  ASSERT_EQ(shorter.problem, "");
  EXPECT_LE(shorter.way, request.longest);
  EXPECT_LT(shorter.units.size(), 15U);
  // What is compared with it are as many at random.
  request.longest = 0;
  request.count = static_cast<int>(shorter.units.size());
  const double as_many = plan_configurations(*robot, values(*robot), request).random.sigma;
  EXPECT_NEAR(shorter.random.sigma, as_many, 0.2 * as_many) << "medians of 25 choices";
  request.count = 15;
  request.longest = 1e-3;
  EXPECT_EQ(plan_configurations(*robot, values(*robot), request).units.size(), 1U);
}

TEST(ConfigurationPlan, SpendsTheTimeThatItHasOnWhatTellsMost) {
  const auto robot = example_arm();
  PlanRequest request = touches_of_planes(3, 30, 300);
  request.longest = 10;
  const ConfigurationPlan plan = plan_configurations(*robot, values(*robot), request);
  ASSERT_EQ(plan.problem, "");
  EXPECT_LE(plan.way, request.longest);
  // From one to the next takes two seconds, so that no further one goes into what is left over.
  EXPECT_GT(plan.way, request.longest - 3);
  EXPECT_EQ(plan.curve.size(), plan.units.size() + 1);
}

TEST(ConfigurationPlan, KeepsEndPositionsApartFromThoseThatAreTakenAlready) {
  const auto robot = example_arm();
  PlanRequest request = touches_of_planes(0, 25, 600);
  request.pool.sets = {set_by("tracker", "position")};
  request.pool.spacing = 0.3;
  const ConfigurationPlan first = plan_configurations(*robot, values(*robot), request);
  request.pool.taken = first.data;
  request.pool.seed = 2;
  const ConfigurationPlan further = plan_configurations(*robot, values(*robot), request);
  ASSERT_EQ(further.problem, "");
  DataSet both = first.data;
  both.rows.q.conservativeResize(50, Eigen::NoChange);
  both.rows.q.bottomRows(25) = further.data.rows.q;
  both.rows.set.resize(50, 0);
  EXPECT_GE(least_apart(*robot, both), 0.3);
}

TEST(ConfigurationPlan, SaysSoWhereRoundingHidesWhatRowsTell) {
  const auto robot = robot_of(R"(robot: arm
kind: serial
frames:
  - {name: base, joint: fixed, alpha: 0.1, d: 0.2, theta: 0.3, r: 0.4}
  - {name: j1, joint: revolute, alpha: 0.02, r: 0.3, limits: [-2.5, 2.5]}
  - {name: j2, joint: revolute, alpha: -1.5, d: 0.15, limits: [-1.5, 1.5]}
  - {name: j3, joint: prismatic, alpha: 1.4, d: 0.1, r: 0.5, limits: [-0.1, 0.3]}
  - {name: j4, joint: revolute, alpha: 0.02, r: 0.3, limits: [-2.5, 2.5]}
  - {name: j5, joint: revolute, alpha: -1.5, d: 0.15, limits: [-1.5, 1.5]}
  - {name: j6, joint: revolute, alpha: 1.5, d: 0.05, limits: [-1.5, 1.5]}
  - {name: tool, joint: fixed, d: 0.03, r: 0.12, theta: 0.4, tolerance: {d: 1.0e-3}}
)");
  // A nanometre beside a surface that lies anywhere within metres: squared, 18 digits.
  PlanRequest request = touches_of_planes(1, 30, 100);
  request.pool.sets.front().noise = 1e-9;
  const ConfigurationPlan plan = plan_configurations(*robot, values(*robot), request);
  EXPECT_NE(plan.problem, "");
}

TEST(ConfigurationPlan, GivesNoIndicesOfParametersThatAreNotSeen) {
  const auto robot = example_arm();
  // Two poses in each of four nests, which are twice as many equations as there are parameters; but
  // most choices leave a nest with one pose, that says where it lies and no more.
  PlanRequest request = touches_of_planes(0, 8, 120);
  request.pool.sets = {set_by("nest", "location-constraint")};
  request.pool.groups = 4;
  const ConfigurationPlan plan = plan_configurations(*robot, values(*robot), request);
  ASSERT_EQ(plan.problem, "");
  EXPECT_EQ(plan.random.observability.condition, 0) << "none";
  EXPECT_GT(plan.planned.observability.condition, 1);
  EXPECT_LT(plan.planned.observability.condition, 1e3);
}

}  // namespace
}  // namespace selfcal
