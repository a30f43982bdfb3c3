// Whether the active model explains the touches of a quick check.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "app/service/session/acceptance.h"
#include "constraints/estimation/identification.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

Solution check_of(int rows, double rms) {
  Solution solution;
  solution.residual.check.rows = solution.residual.check.configurations = rows;
  solution.residual.check.rms_after = solution.residual.check.rms_without_outliers = rms;
  return solution;
}

TEST(CheckDecision, ExplainsWhatIsAsGoodAsItWas) {
  const CheckDecision decided = decide_on_check(check_of(80, 2e-5), check_of(12, 2e-5), 0.01);
  EXPECT_TRUE(decided.explained);
  EXPECT_NEAR(decided.p_value, 0.47, 0.03);  // the median of F(12, 80) is 0.953, below 1
  EXPECT_THAT(decided.why, HasSubstr("the active model explains them"));
}

TEST(CheckDecision, DoesNotExplainWhatHasBecomeWorse) {
  // F(12, 80) exceeds 2.415 with 1 % (tables of the F distribution).
  EXPECT_TRUE(decide_on_check(check_of(80, 1), check_of(12, std::sqrt(2.40)), 0.01).explained);
  EXPECT_FALSE(decide_on_check(check_of(80, 1), check_of(12, std::sqrt(2.43)), 0.01).explained);
  EXPECT_TRUE(decide_on_check(check_of(80, 1), check_of(12, 0.1), 0.01).explained);
}

TEST(CheckDecision, ExplainsNothingWithoutRowsToCompare) {
  EXPECT_FALSE(decide_on_check(check_of(0, 0), check_of(12, 1e-5), 0.01).explained);
  EXPECT_FALSE(decide_on_check(check_of(80, 1e-5), check_of(0, 0), 0.01).explained);
  EXPECT_EQ(decide_on_check({}, {}, 0.01).why, "nothing to compare with");
}

TEST(CheckDecision, RaisesAFalseAlarmAsRarelyAsItIsAskedTo) {
  // Rows as the service has them: planes fitted to the fit rows of a session, its check rows and
  // the new touches judged by them; the robot held, nothing changed but the noise.
  const Simulated simulated = made(
      "robot: r\nseed: 3\ncheck: 0.5\nsets:\n"
      "  a: {method: plane, noise: 2.0e-5, rows: 200,\n"
      "      within: {center: [0.7, 0, 0.2], radius: 0.4}}\n");
  Options held;
  held.fix = {"*"};
  std::mt19937_64 random(5);
  constexpr int kTrials = 60, kNew = 12;
  constexpr double kP = 0.2;
  int alarms = 0;
  DataSet all = simulated.data;
  std::vector<int> check;
  for (int row = 0; row < all.rows.rows(); ++row)
    if (all.rows.check[row]) check.push_back(row);
  for (int trial = 0; trial < kTrials; ++trial) {
    // Other touches of the same noise: which check rows belong to the session, which are new.
    std::ranges::shuffle(check, random);
    const auto only = [&](std::size_t from, std::size_t to) {
      DataSet data = all;
      std::vector<int> rows;
      for (int row = 0; row < all.rows.rows(); ++row)
        if (!all.rows.check[row]) rows.push_back(row);
      rows.insert(rows.end(), check.begin() + from, check.begin() + to);
      data.rows.q = all.rows.q(rows, Eigen::all);
      data.rows.normal = all.rows.normal(rows, Eigen::all);
      data.rows.position = data.rows.orientation = Eigen::MatrixXd();
      data.rows.measured.clear();
      data.rows.repeat.clear();
      for (std::size_t i = 0; i < rows.size(); ++i) {
        data.rows.set[i] = all.rows.set[rows[i]];
        data.rows.group[i] = all.rows.group[rows[i]];
        data.rows.check[i] = all.rows.check[rows[i]];
      }
      data.rows.set.resize(rows.size());
      data.rows.group.resize(rows.size());
      data.rows.check.resize(rows.size());
      return data;
    };
    const Solution now = identify(rx90(), only(0, kNew), held);
    const Solution then = identify(rx90(), only(kNew, check.size()), held);
    alarms += !decide_on_check(then, now, kP).explained;
  }
  // Binomial: 3 sigma of 60 trials at 0.2 are 9.3; the trials share rows, which narrows it.
  const double sigma = std::sqrt(kTrials * kP * (1 - kP));
  EXPECT_NEAR(alarms, kTrials * kP, 3 * sigma);
}

TEST(CheckDecision, RaisesAFalseAlarmAtTheRateAskedForOverManyGaussianChecks) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  const auto rms = [&](int rows) {
    double sum = 0;
    for (int i = 0; i < rows; ++i) sum += std::pow(normal(random), 2);
    return 2e-5 * std::sqrt(sum / rows);
  };
  constexpr int kTrials = 20'000;
  constexpr double kP = 0.01;
  int alarms = 0;
  for (int i = 0; i < kTrials; ++i)
    alarms += !decide_on_check(check_of(80, rms(80)), check_of(24, rms(24)), kP).explained;
  EXPECT_NEAR(alarms, kTrials * kP, 3 * std::sqrt(kTrials * kP * (1 - kP)));  // binomial, 3 sigma
}

}  // namespace
}  // namespace selfcal
