// An instrument whose scale is wrong measures a robot that is larger all over.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/recovery/session.h"
#include "tests/support/arm_of_size.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

/// What positions `scale` times as long tell of an arm that errs by `off` times its tolerances.
Solution measured_by(double scale, double off, unsigned seed) {
  const auto robot = arm_of_size(1);
  Random random(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd truth = nominal_values(*robot);
  for (Eigen::Index i = 0; i < truth.size(); ++i) {
    const Parameter& p = robot->parameters()[static_cast<std::size_t>(i)];
    if (p.free) truth[i] += off * p.tolerance * normal(random);
  }
  const Node set = recovery::entry({{"method", "position"}, {"noise", "2e-5"}});
  DataSet data = recovery::make_session(*robot, truth, {{"tracker", set, 90}}, 2e-5, random).data;
  data.rows.position *= scale;
  return identify(*robot, data);
}

TEST(InstrumentScale, IsDoubtedWhereTheRobotIsLargerAllOver) {
  for (const double percent : {-2.0, 2.0}) {
    const Solution solution = measured_by(1 + percent / 100, 0.5, 3);
    EXPECT_EQ(solution.verdict.answer, Answer::not_determined);
    EXPECT_THAT(solution.verdict.why,
                HasSubstr(percent > 0 ? "% larger all over than the maker's"
                                      : "% smaller all over than the maker's"));
  }
}

// One in a hundred is doubted: of forty more than three are in one of a thousand runs.
TEST(InstrumentScale, IsSeldomDoubtedOfAHealthyOne) {
  int doubted = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Solution solution = measured_by(1, 1, seed);
    doubted += std::ranges::any_of(solution.warnings, [](const std::string& each) {
      return each.find("all over than the maker's") != std::string::npos;
    });
  }
  EXPECT_LE(doubted, 3);
}

// Written in another order, with their times, the rows say the same: which of them share errors is
// told from those taken one after the other.
TEST(RowsWithTimes, SayTheSameInWhicheverOrderTheyAreWritten) {
  const auto robot = arm_of_size(1);
  Random random(5);
  std::normal_distribution<double> normal;
  Eigen::VectorXd truth = nominal_values(*robot);
  const Node set = recovery::entry({{"method", "position"}, {"noise", "2e-5"}});
  DataSet data = recovery::make_session(*robot, truth, {{"tracker", set, 90}}, 2e-5, random).data;
  const Eigen::Index rows = data.rows.rows();
  data.rows.time = Eigen::VectorXd::LinSpaced(rows, 0, 890);
  for (Eigen::Index i = 0; i < rows; ++i)  // half a millimetre that comes and goes
    data.rows.position(i, 2) += 5e-4 * std::sin(data.rows.time[i] / 150);
  std::vector<int> order(static_cast<std::size_t>(rows));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::shuffle(order, random);
  DataSet shuffled = data;
  shuffled.rows = taken(data.rows, order);
  const Solution one = identify(*robot, data), other = identify(*robot, shuffled);
  EXPECT_GT(one.uncertainty.residuals.autocorrelation, 0.3);
  EXPECT_NEAR(other.uncertainty.residuals.autocorrelation,
              one.uncertainty.residuals.autocorrelation, 1e-6);
  EXPECT_NEAR(other.workspace.rms / one.workspace.rms, 1, 1e-6);
}

}  // namespace
}  // namespace selfcal
