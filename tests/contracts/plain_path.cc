// The fast path against the plain one, every method on every kind of robot: the same products,
// costs and residuals to rounding.
#include "tests/contracts/plain_path.h"

#include <gmock/gmock.h>

#include "kinematics/corrected_robot.h"
#include "tests/contracts/arm.h"
#include "tests/contracts/path_case.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

/// Sums of 150 products, each within an epsilon of the product of its columns' lengths; what closed
/// loops iterate to differs by some hundred of them.
constexpr double kRounding = 1e-12;
constexpr int kRowsOfASet = 75;  // two blocks and a part of one

/// An arm with effects of readings, load, temperature and touch.
std::shared_ptr<const Robot> arm_with_effects() {
  Site site;
  site.sets = {{"s", true, {0.4, 0.2, 0.1}, {0.1, -0.3, 0.9}}};
  for (double t = 0; t <= 3600; t += 60) {
    site.times.push_back(t);
    site.temperatures.push_back(20 + t / 900);
  }
  site.end = 3600;
  site.loads = site.velocities = site.speeds = true;
  Node arm = six_axis_arm()->text().describe(values(*six_axis_arm()));
  arm.set("mass", Node::of(120.0));
  std::vector<Node> entries;
  for (const char* each :
       {"{effect: joint_compliance, at: j2, c: 2.0e-6}", "{effect: backlash, at: j3, play: 1.0e-4}",
        "{effect: thermal_expansion}", "{effect: link_compliance, at: j3}",
        "{effect: tool_compliance, at: probe}", "{effect: base_drift}"})
    entries.push_back(parsed(each));
  Problems problems;
  auto corrected = correct(robot_of(arm), entries, site, problems);
  for (const std::string& problem : problems.list) ADD_FAILURE() << problem;
  return corrected;
}

struct RobotCase {
  const char* title;
  std::shared_ptr<const Robot> (*make)();
};

std::string title_of_robot(const testing::TestParamInfo<RobotCase>& info) {
  return info.param.title;
}

std::vector<RobotCase> robot_cases() {
  return {
      {"SixAxes", [] { return std::shared_ptr<const Robot>(six_axis_arm()); }},
      {"WholePoses", [] { return std::shared_ptr<const Robot>(arm_of_whole_poses()); }},
      {"Effects", arm_with_effects},
      {"Serial",
       [] { return std::shared_ptr<const Robot>(robot_of(kind_examples().at("serial"))); }},
      {"LinearDelta",
       [] { return std::shared_ptr<const Robot>(robot_of(kind_examples().at("linear-delta"))); }},
      {"GoughStewart",
       [] { return std::shared_ptr<const Robot>(robot_of(kind_examples().at("gough-stewart"))); }},
      {"HexaSlide",
       [] { return std::shared_ptr<const Robot>(robot_of(kind_examples().at("hexaslide"))); }}};
}

class FastPath : public testing::TestWithParam<RobotCase> {};

void expect_same_residuals(const std::vector<RowResidual>& fast,
                           const std::vector<RowResidual>& plain, bool places) {
  ASSERT_EQ(fast.size(), plain.size());
  for (size_t i = 0; i < fast.size(); ++i) {
    const RowResidual &a = fast[i], &b = plain[i];
    ASSERT_EQ(a.row, b.row);
    EXPECT_EQ(a.set, b.set);
    EXPECT_EQ(a.lengths, b.lengths);
    EXPECT_EQ(a.angles, b.angles);
    EXPECT_EQ(a.factor, b.factor);
    EXPECT_NEAR(a.length, b.length, kRounding);
    EXPECT_NEAR(a.angle, b.angle, kRounding);
    for (size_t k = 0; k < static_cast<size_t>(a.lengths + a.angles); ++k)
      EXPECT_NEAR(a.scalars[k], b.scalars[k], kRounding);
    if (!places) continue;
    EXPECT_LT((a.at - b.at).norm(), kRounding);
    EXPECT_LT((a.way - b.way).norm(), 1e-9 * (1 + b.way.norm()));  // of nearly dependent lengths
  }
}

TEST_P(FastPath, GivesWhatThePlainOneGives) {
  int answered = 0;
  for (const MethodCase& each : method_cases()) {
    SCOPED_TRACE(each.sets);
    const PathCase made(GetParam().make(), each, kRowsOfASet);
    if (!made.answers()) continue;
    ++answered;
    const Equations equations(*made.robot, made.data, Use::fit);
    const PlainSystem plain = PlainPath(equations, made.state, made.weighting).system();
    const Linearised fast = equations.linearise(made.state, made.weighting);
    const int global = equations.columns();
    const Eigen::VectorXd lengths = plain.lengths(global).array() + 1;
    const Eigen::MatrixXd gram = plain.gram(global);
    const Eigen::MatrixXd difference = lengths.cwiseInverse().asDiagonal() *
                                       (fast.R.transpose() * fast.R - gram) *
                                       lengths.cwiseInverse().asDiagonal();
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), kRounding);
    EXPECT_NEAR(fast.cost, plain.cost, kRounding * plain.cost);
    EXPECT_EQ(fast.equations, plain.equations);
    expect_same_residuals(fast.residuals, plain.residuals, false);
    expect_same_residuals(equations.residuals(made.state), plain.residuals, true);
  }
  EXPECT_GT(answered, 30);
}

INSTANTIATE_TEST_SUITE_P(Robots, FastPath, testing::ValuesIn(robot_cases()), title_of_robot);

TEST(FastPathCases, AreOfEveryKindOfRobot) {
  std::vector<std::string> kinds;
  for (const RobotCase& each : robot_cases()) kinds.emplace_back(each.make()->kind());
  for (const std::string_view kind : robot_kinds())
    EXPECT_THAT(kinds, testing::Contains(std::string(kind)));
}

}  // namespace
}  // namespace selfcal
