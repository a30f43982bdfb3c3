// A tool whose point is 30 mm off the flange's axis, across its bend: four numbers reach it only by
// a turn of the tool, a whole pose reaches it as it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "constraints/estimation/identification.h"
#include "constraints/identifiability/endpoint_sigma.h"
#include "io/files/robot_file.h"
#include "tests/recovery/session.h"
#include "tests/support/end_position.h"

namespace selfcal::recovery {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::unique_ptr<Robot> arm_with(const std::string& tool) {
  auto robot = selfcal::robot_of(
      "robot: rx90\nkind: serial\nframes:\n"
      "  - {name: base, joint: fixed, xyz: [0.2, -0.1, 0.5], rpy: [0, 0, pi/2]}\n"
      "  - {name: j1, joint: revolute, alpha: 0.1, limits: [-2.79, 2.79]}\n"
      "  - {name: j2, joint: revolute, alpha: -pi/2, limits: [-2.40, 2.40]}\n"
      "  - {name: j3, joint: revolute, d: 0.5, limits: [-2.49, 2.49]}\n"
      "  - {name: j4, joint: revolute, alpha: pi/2, r: 0.5, limits: [-4.71, 4.71]}\n"
      "  - {name: j5, joint: revolute, alpha: -pi/2, limits: [-1.83, 2.09]}\n"
      "  - {name: j6, joint: revolute, alpha: pi/2, r: 0.1, limits: [-4.71, 4.71]}\n"
      "  - {name: tool, joint: fixed, " +
          tool + "}\n",
      "arm");
  EXPECT_TRUE(robot.has_value()) << robot.error().what;
  return std::move(*robot);
}

const char* const kNumbers = "r: 0.15";
const char* const kWhole = "xyz: [0, 0, 0.15]";

/// The machine as built: links within a millimetre and a milliradian, the tool's point 30 mm off.
Eigen::VectorXd as_built(const Robot& robot, Random& random) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd xi = nominal_values(robot);
  for (Eigen::Index i = 0; i < xi.size(); ++i)
    if (robot.parameters()[i].part == Part::link) xi[i] += 0.5e-3 * normal(random);
  xi[find_parameter(robot, "tool.y")] += 0.030;
  xi[find_parameter(robot, "tool.rx")] += 0.01;
  return xi;
}

std::vector<SetPart> tracker() { return {{"tracker", entry({{"method", "position"}}), 90}}; }

std::vector<SetPart> planes() {
  std::vector<SetPart> parts;
  for (const char* name : {"a", "b", "c", "d"})
    parts.push_back({name, entry({{"method", "plane"}}), 75});
  Node gauge = entry({{"method", "plane"}});
  gauge.set("parallel_to", entry({{"set", "a"}, {"distance", "0.2"}, {"noise", "2e-6"}}));
  parts.push_back({"gauge", gauge, 60});
  return parts;
}

class ToolOffsetBy : public testing::TestWithParam<int> {
 protected:
  std::vector<SetPart> parts() const { return GetParam() == 0 ? tracker() : planes(); }
};

TEST_P(ToolOffsetBy, IsFoundByAWholePoseWithItsOrientationHeldAndSaid) {
  const auto robot = arm_with(kWhole);
  for (int seed = 1; seed <= 3; ++seed) {
    Random random(seed);
    const Eigen::VectorXd truth = as_built(*robot, random);
    const Session session = make_session(*robot, truth, parts(), 20e-6, random);
    ASSERT_EQ(session.unreached, "");
    const Solution solution = identify(*robot, session.data);
    EXPECT_EQ(solution.verdict.answer, Answer::improved) << solution.verdict.why;
    // Along the last joint's axis and around it the tool is not told from the last link: there its
    // sigma is that of the link's prior.
    for (const char* name : {"tool.x", "tool.y", "tool.z"}) {
      const int i = find_parameter(*robot, name);
      const ParameterResult& p = solution.parameters[i];
      EXPECT_TRUE(p.status == Status::identified || p.status == Status::grouped) << name;
      EXPECT_LT(std::abs(p.value - truth[i]), 4 * p.sigma) << name;  // one in 16 000 exceeds it
      EXPECT_LT(p.sigma, 2.1e-3) << name;                            // 50 mm were believed
    }
    std::vector<std::string> held;
    for (const Note& note : solution.gauge) {
      held.push_back(note.parameter);
      EXPECT_THAT(note.text, HasSubstr("no row sees how the tool is turned"));
      const int i = find_parameter(*robot, note.parameter);
      EXPECT_EQ(solution.parameters[i].status, Status::held);
      EXPECT_EQ(solution.values[i], 0);
    }
    EXPECT_THAT(held, ElementsAre("tool.rx", "tool.ry", "tool.rz"));
    EXPECT_THAT(solution.warnings, Not(Contains(HasSubstr("whole pose"))));
    EXPECT_LT(aligned_errors(*robot, solution.values, truth)[250], 0.1e-3);
  }
}

TEST_P(ToolOffsetBy, TurnsAToolOfFourNumbersAndIsWarnedOfByName) {
  const auto machine = arm_with(kWhole), robot = arm_with(kNumbers);
  Random random(1);
  const Eigen::VectorXd truth = as_built(*machine, random);
  const Session session = make_session(*machine, truth, parts(), 20e-6, random);
  ASSERT_EQ(session.unreached, "");
  const Solution solution = identify(*robot, session.data);
  // 30 mm by 150 mm: 11 degrees, four times the 50 mrad that are believed of a tool.
  const int alpha = find_parameter(*robot, "tool.alpha");
  EXPECT_GT(std::abs(solution.values[alpha]), 0.15);
  EXPECT_THAT(solution.warnings,
              Contains(testing::AllOf(HasSubstr("alpha7 (tool.alpha) turns the tool by"),
                                      HasSubstr("give the tool as a whole pose"))));
  for (const Note& note : solution.gauge) EXPECT_EQ(note.text.find("turned"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Rows, ToolOffsetBy, testing::Values(0, 1), [](const auto& each) {
  return each.param == 0 ? "PositionsOfATracker" : "TouchesOfPlanes";
});

TEST(ToolOffset, IsFoundWithItsOrientationWhereRowsSeeOne) {
  const auto robot = arm_with(kWhole);
  Random random(2);
  const Eigen::VectorXd truth = as_built(*robot, random);
  const Session session =
      make_session(*robot, truth, {{"arm", entry({{"method", "location"}}), 90}}, 20e-6, random);
  const Solution solution = identify(*robot, session.data);
  EXPECT_THAT(solution.gauge, IsEmpty());
  const int rx = find_parameter(*robot, "tool.rx");
  EXPECT_EQ(solution.parameters[rx].status, Status::identified);
  EXPECT_LT(std::abs(solution.values[rx] - truth[rx]), 4 * solution.parameters[rx].sigma);
  EXPECT_LT(solution.parameters[rx].sigma, 1e-3);
}

TEST(ToolOffset, LeavesTheMakersPoseTheCentreWhenItsResultIsCalibratedAgain) {
  const auto robot = arm_with(kWhole);
  Random random(3);
  const Eigen::VectorXd truth = as_built(*robot, random);
  const Session session =
      make_session(*robot, truth, {{"arm", entry({{"method", "location"}}), 90}}, 20e-6, random);
  const Solution first = identify(*robot, session.data);
  const auto calibrated = selfcal::robot_of(robot_text(*robot, first.values), "calibrated");
  ASSERT_TRUE(calibrated.has_value()) << calibrated.error().what;
  const Solution second = identify(**calibrated, session.data);
  // The same minimum: what the iteration's end leaves is a hundred-thousandth of a sigma.
  for (size_t i = 0; i < first.parameters.size(); ++i)
    EXPECT_LE(std::abs(second.parameters[i].value - first.parameters[i].value),
              1e-3 * std::max(first.parameters[i].sigma, 1e-9))
        << first.parameters[i].parameter.name;
}

}  // namespace
}  // namespace selfcal::recovery
