// Sets with hardly more rows than unknowns, or fewer, and such whose times are shuffled: an answer,
// and numbers where one is said to be known, whatever is divided by nothing on the way.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "constraints/estimation/identification.h"
#include "diagnosis/diagnosis.h"
#include "tests/recovery/rx90.h"
#include "tests/recovery/session.h"

namespace selfcal::recovery {
namespace {

constexpr int kSmallSets = 60, kShuffledSets = 16;

DataSet small_set(const Robot& robot, int seed, int rows) {
  static constexpr std::array<std::pair<const char*, const char*>, 6> kOf = {
      std::pair{"position", "2e-5"}, {"plane", "2e-5"},    {"sphere", "2e-5"},
      {"location", "2e-5"},          {"distance", "1e-5"}, {"plane", "1e-9"}};
  Random random(static_cast<std::uint64_t>(seed));
  std::normal_distribution<double> normal;
  Eigen::VectorXd truth = nominal_values(robot);
  const double off = seed % 3 == 0 ? 0 : 1e-3;
  for (Eigen::Index i = 0; i < truth.size(); ++i)
    if (robot.parameters()[static_cast<size_t>(i)].free) truth[i] += off * normal(random);
  const auto& [method, noise] = kOf[static_cast<size_t>(seed) % kOf.size()];
  std::vector<SetPart> parts = {{"a", entry({{"method", method}, {"noise", noise}}), rows}};
  if (seed % 2 == 1) parts.push_back({"b", entry({{"method", "plane"}, {"noise", "2e-5"}}), rows});
  Session session = make_session(robot, truth, parts, seed % 5 == 4 ? 0 : 20e-6, random);
  EXPECT_EQ(session.unreached, "") << seed;
  // Now and then a reading that is the same in every row, or a row that is far off.
  if (seed % 7 == 3) session.data.rows.q.col(seed % 6).setConstant(0.3);
  if (seed % 7 == 5) session.data.rows.q.row(0) *= 0.5;
  return std::move(session.data);
}

void expect_an_answer(const std::shared_ptr<const Robot>& robot, const DataSet& data, int seed) {
  Solution solution;
  ASSERT_NO_THROW(solution = identify(*robot, data)) << seed;
  EXPECT_TRUE(solution.values.allFinite()) << seed;
  EXPECT_TRUE(solution.verdict.p_value >= 0 && solution.verdict.p_value <= 1) << seed;
  for (const ParameterResult& each : solution.parameters)
    EXPECT_TRUE(each.status != Status::identified || std::isfinite(each.sigma)) << seed;
  DiagnosisOptions options;
  options.resamples = 9;
  options.simulated_sessions = 0;
  Diagnosis diagnosis;
  ASSERT_NO_THROW(diagnosis = diagnose(robot, data, options)) << seed;
  if (!diagnosis.problem.empty()) return;
  EXPECT_TRUE(diagnosis.verdict.probability >= 0 && diagnosis.verdict.probability <= 1) << seed;
  EXPECT_TRUE(diagnosis.p_value >= 0 && diagnosis.p_value <= 1) << seed;
}

TEST(SmallSets, HaveAnAnswer) {
  const std::shared_ptr<const Robot> robot = robot_of(kRx90);
  for (int seed = 0; seed < kSmallSets; ++seed)
    expect_an_answer(robot, small_set(*robot, seed, 2 + seed / 3), seed);
}

TEST(SmallSets, HaveAnAnswerWhenTheirTimesAreShuffled) {
  const std::shared_ptr<const Robot> robot = robot_of(kRx90);
  for (int seed = 0; seed < kShuffledSets; ++seed) {
    DataSet data = small_set(*robot, seed, 30);
    Random random(static_cast<std::uint64_t>(seed));
    std::vector<double> times(static_cast<size_t>(data.rows.rows()));
    for (size_t i = 0; i < times.size(); ++i) times[i] = 30.0 * static_cast<double>(i);
    std::ranges::shuffle(times, random);
    data.rows.time = Eigen::Map<Eigen::VectorXd>(times.data(), data.rows.rows());
    data.rows.temperature = 20 + 1e-3 * data.rows.time.array();
    expect_an_answer(robot, data, seed);
  }
}

}  // namespace
}  // namespace selfcal::recovery
