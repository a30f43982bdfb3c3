// Rows that the simulation makes for a method (through, measure, Newton's steps) are rows that
// hold.
#include <gtest/gtest.h>

#include "constraints/sampling/configurations.h"
#include "kinematics/linear_algebra.h"
#include "tests/contracts/arm.h"
#include "tests/contracts/method_case.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

constexpr int kRows = 12;
constexpr double kSampleHolds = 1e-12;  // Newton's steps end below 1e-13, readings at rounding

/// kRows rows for every set.
struct Simulated {
  std::unique_ptr<Robot> robot;
  DataSet data;
  Sampled sampled;

  explicit Simulated(const MethodCase& each)
      : robot(each.of_platform ? robot_of(kind_examples().at("gough-stewart")) : six_axis_arm()) {
    data.sets = make_sets(each.sets);
    std::vector<SampleRequest> requests;
    for (size_t s = 0; s < data.sets.size(); ++s) {
      data.sets[s].groups.clear();  // drawn rows name their own
      SampleRequest request;
      request.set = static_cast<int>(s);
      request.rows = kRows;
      requests.push_back(request);
    }
    Random random(91);
    sampled = sample_rows(*robot, values(*robot), requests, random, data);
  }
};

double largest(const std::vector<RowResidual>& residuals) {
  double most = 0;
  for (const RowResidual& each : residuals) most = std::max({most, each.length, each.angle});
  return most;
}

class Simulation : public testing::TestWithParam<MethodCase> {};

TEST_P(Simulation, MakesRowsThatHold) {
  const Simulated made(GetParam());
  EXPECT_EQ(made.sampled.unreached, "");
  EXPECT_EQ(made.data.rows.rows(), kRows * static_cast<int>(made.data.sets.size()));
  const Equations equations(*made.robot, made.data, Use::fit);
  const auto residuals = equations.residuals(made.sampled.truth);
  size_t expected = 0;
  for (const Set& set : made.data.sets) expected += kRows - (set.method->paired() ? 1 : 0);
  EXPECT_EQ(residuals.size(), expected);
  EXPECT_LT(largest(residuals), kSampleHolds);
}

TEST_P(Simulation, MakesRowsFromWhichOwnAndGroupValuesAreFound) {
  const Simulated made(GetParam());
  if (!made.sampled.unreached.empty()) return;  // the test above says so
  const Equations equations(*made.robot, made.data, Use::fit);
  State state;
  state.xi = values(*made.robot);
  equations.start(state);
  const Weighting weighting{std::vector<Scale>(made.data.sets.size()),
                            std::vector<char>(made.data.rows.rows(), 0)};
  for (int i = 0; i < 30; ++i) {
    const Linearised at = equations.linearise(state, weighting);
    Eigen::VectorXd step = Eigen::VectorXd::Zero(equations.columns());
    const int nuisance = equations.nuisance_columns();
    step.tail(nuisance) =
        least_squares(at.R.middleCols(equations.robot_columns(), nuisance), at.R.rightCols(1));
    state = equations.stepped(state, at, step);
  }
  EXPECT_LT(largest(equations.residuals(state)), 1e-9);  // steps end at rounding, far below
}

INSTANTIATE_TEST_SUITE_P(Methods, Simulation, testing::ValuesIn(method_cases()), title_of);

}  // namespace
}  // namespace selfcal
