// Many rows, all of which stand at one configuration: whatever the noise, they tell no robot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "constraints/estimation/identification.h"
#include "tests/recovery/session.h"
#include "tests/support/arm_of_size.h"

namespace selfcal::recovery {
namespace {

TEST(OneConfiguration, DeterminesNothing) {
  const auto robot = arm_of_size(1);
  Random random(5);
  const Node tracker = entry(
      {{"method", "position"}, {"frame", "unknown"}, {"point", "unknown"}, {"noise", "2e-5"}});
  Session session =
      make_session(*robot, nominal_values(*robot), {{"tracker", tracker, 60}}, 20e-6, random);
  Observations& rows = session.data.rows;
  const std::vector<int> first(40, 0);
  rows = taken(rows, first);
  rows.repeat = first;
  for (std::size_t row = 0; row < rows.check.size(); ++row) rows.check[row] = row % 3 == 0;
  std::normal_distribution<double> noise(0, 20e-6);
  for (double& each : rows.position.reshaped()) each += noise(random);
  const Solution solution = identify(*robot, session.data);
  EXPECT_EQ(solution.verdict.answer, Answer::not_determined);
  EXPECT_THAT(solution.verdict.why, testing::HasSubstr("all stand at one configuration"));
}

}  // namespace
}  // namespace selfcal::recovery
