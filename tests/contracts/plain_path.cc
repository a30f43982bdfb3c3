// The fast path against the plain one, every method on every kind of robot: the same products,
// costs and residuals to rounding.
#include "tests/contracts/plain_path.h"

#include <gmock/gmock.h>

#include <numeric>

#include "kinematics/corrected_robot.h"
#include "kinematics/make_robot.h"
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
  MeasurementContext context;
  context.sets = {{"s", TouchedSurface::plane, {0.4, 0.2, 0.1}, {0.1, -0.3, 0.9}}};
  for (double t = 0; t <= 3600; t += 60) {
    context.times.push_back(t);
    context.temperatures.push_back(20 + t / 900);
  }
  context.end = 3600;
  context.loads = context.velocities = context.speeds = true;
  Node arm = six_axis_arm()->text().describe(values(*six_axis_arm()));
  arm.set("mass", Node::of(120.0));
  std::vector<Node> entries;
  for (const char* each :
       {"{effect: joint_compliance, at: j2, c: 2.0e-6}", "{effect: backlash, at: j3, play: 1.0e-4}",
        "{effect: thermal_expansion}", "{effect: link_compliance, at: j3}",
        "{effect: tool_compliance, at: probe}", "{effect: base_drift}"})
    entries.push_back(parsed(each));
  Problems problems;
  auto corrected = correct(robot_of(arm), entries, context, problems);
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

void expect_same_residuals(const Equations& equations, const State& state,
                           const std::vector<RowNorm>& norms, const PlainSystem& plain) {
  const std::vector<RowResidual> fast = equations.residuals(state);
  const std::vector<RowPlace> places = equations.places(state);
  ASSERT_EQ(fast.size(), plain.residuals.size());
  ASSERT_EQ(norms.size(), plain.residuals.size());
  ASSERT_EQ(places.size(), plain.residuals.size());
  for (size_t i = 0; i < fast.size(); ++i) {
    const RowResidual &a = fast[i], &b = plain.residuals[i];
    ASSERT_EQ(a.row, b.row);
    EXPECT_EQ(a.set, b.set);
    EXPECT_EQ(a.lengths, b.lengths);
    EXPECT_EQ(a.angles, b.angles);
    EXPECT_EQ(a.factor, b.factor);
    EXPECT_NEAR(a.length, b.length, kRounding);
    EXPECT_NEAR(a.angle, b.angle, kRounding);
    EXPECT_NEAR(norms[i].length, b.length, kRounding);
    EXPECT_NEAR(norms[i].angle, b.angle, kRounding);
    for (size_t k = 0; k < static_cast<size_t>(a.lengths + a.angles); ++k)
      EXPECT_NEAR(a.scalars[k], b.scalars[k], kRounding);
    const RowPlace& is = plain.places[i];
    EXPECT_LT((places[i].at - is.at).norm(), kRounding);
    EXPECT_LT((places[i].way - is.way).norm(), 1e-9 * (1 + is.way.norm()));  // nearly dependent
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
    std::vector<int> all(static_cast<size_t>(global));
    std::iota(all.begin(), all.end(), 0);
    const NormalEquations summed = equations.normal_equations(made.state, made.weighting, all);
    EXPECT_LT((lengths.cwiseInverse().asDiagonal() * (summed.H - gram) *
               lengths.cwiseInverse().asDiagonal())
                  .cwiseAbs()
                  .maxCoeff(),
              kRounding);
    std::vector<int> some;  // half of the robot's parameters, and what the sets own
    for (const int c : all)
      if (c >= equations.robot_columns() || c % 2 == 1) some.push_back(c);
    const NormalEquations fewer = equations.normal_equations(made.state, made.weighting, some);
    std::vector<int> of_all = some;
    of_all.push_back(global);
    EXPECT_LT((fewer.H - summed.H(of_all, of_all)).cwiseAbs().maxCoeff(),
              kRounding * summed.H.cwiseAbs().maxCoeff());
    EXPECT_EQ(summed.cost, fast.cost);
    EXPECT_NEAR(fast.cost, plain.cost, kRounding * plain.cost);
    EXPECT_EQ(fast.equations, plain.equations);
    expect_same_residuals(equations, made.state, fast.norms, plain);
  }
  EXPECT_GT(answered, 30);
}

TEST(FastPathParts, AddUpToTheWholeOfASetWithAndWithoutGroups) {
  for (const char* sets : {"s: {method: position, frame: unknown, point: unknown}",
                           "s: {method: position-constraint}"}) {
    SCOPED_TRACE(sets);
    const PathCase made(std::shared_ptr<const Robot>(six_axis_arm()), {"", sets}, 3000);
    const Equations equations(*made.robot, made.data, Use::fit);
    const Linearised fast = equations.linearise(made.state, made.weighting);
    const PlainSystem plain = PlainPath(equations, made.state, made.weighting).system();
    expect_same_residuals(equations, made.state, fast.norms, plain);
    EXPECT_NEAR(fast.cost, plain.cost, 1e-11 * plain.cost);  // 3000 squares
    std::vector<int> all(static_cast<size_t>(equations.columns()));
    std::iota(all.begin(), all.end(), 0);
    const NormalEquations summed = equations.normal_equations(made.state, made.weighting, all);
    const Eigen::VectorXd lengths = summed.H.diagonal().cwiseSqrt().array() + 1;
    EXPECT_LT((lengths.cwiseInverse().asDiagonal() * (fast.R.transpose() * fast.R - summed.H) *
               lengths.cwiseInverse().asDiagonal())
                  .cwiseAbs()
                  .maxCoeff(),
              1e-11);
    EXPECT_EQ(summed.cost, fast.cost);
  }
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
