// A hundred thousand rows: memory bounded beyond the input, time linear in the rows.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>

#include "constraints/estimation/identification.h"
#include "constraints/sampling/random_poses.h"
#include "tests/recovery/random_robot.h"
#include "tests/recovery/session.h"
#include "tests/support/end_position.h"

namespace selfcal::recovery {
namespace {

/// Measured positions of the endpoint at random poses, 20 um of noise.
DataSet measured(const Robot& robot, const Eigen::VectorXd& truth, int rows, Random& random) {
  DataSet data;
  Problems problems;
  data.sets.push_back(make_set("tracker", entry({{"method", "position"}}), problems));
  Observations& o = data.rows;
  o.q = random_poses(robot, nullptr, rows, 5);
  o.position.resize(rows, 3);
  o.set.assign(rows, 0);
  o.group.assign(rows, -1);
  o.check.assign(rows, 0);
  std::normal_distribution<double> noise(0, 20e-6);
  for (int i = 0; i < rows; ++i) {
    o.position.row(i) = endpoint(robot, truth, o.q.row(i)).transpose();
    for (int c = 0; c < 3; ++c) o.position(i, c) += noise(random);
    o.check[i] = i % 3 == 0;
  }
  return data;
}

double most_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

TEST(ManyRows, TakeLinearTimeAndNoMoreMemoryThanTheirResiduals) {
  Random random(1);
  const auto robot = random_robot(random);
  const Eigen::VectorXd truth = draw_truth(*robot, random);
  double seconds[2];
  const int rows[] = {10000, 100000};
  double memory = 0;
  for (int i = 0; i < 2; ++i) {
    const DataSet data = measured(*robot, truth, rows[i], random);
    const double before = most_memory_mb();
    const auto start = std::chrono::steady_clock::now();
    const Solution solution = identify(*robot, data);
    seconds[i] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    memory = most_memory_mb() - before;
    EXPECT_TRUE(solution.converged);
    EXPECT_LT(solution.endpoint.rms, 20e-6);
  }
  std::printf("100 000 rows: %.1f s, %.1f times 10 000 rows; %.0f MB beyond the input\n",
              seconds[1], seconds[1] / seconds[0], memory);
  EXPECT_LT(seconds[1] / seconds[0], 20);  // 10 when linear, 100 when quadratic
  // A residual of a row and its place are some 200 bytes, kept for a few models; W would be 400 MB.
  EXPECT_LT(memory, 150);
}

bool is_base_or_turn_of_tool(const Parameter& p) {
  return p.part == Part::base || (p.frame == "tool" && p.field == "theta");
}

/// Of touches of one point a group, four rows each.
Solution from_sockets(const Robot& robot, const Eigen::VectorXd& truth, int rows, Random& random) {
  const SetPart sockets{"tip", entry({{"method", "position-constraint"}, {"noise", "2e-5"}}), rows,
                        4};
  const Session session = make_session(robot, truth, {sockets}, 20e-6, random);
  EXPECT_EQ(session.unreached, "");
  return identify(robot, session.data);
}

TEST(ManyGroups, TakeNoMoreIterationsThanFewAndTellNothingOfTheToolsTurn) {
  Random random(2);
  const auto robot = random_robot(random);
  const Eigen::VectorXd truth = draw_truth(*robot, random);
  const double before = most_memory_mb();
  for (const int rows : {300, 3000}) {
    const Solution solution = from_sockets(*robot, truth, rows, random);
    EXPECT_TRUE(solution.converged) << rows;
    EXPECT_LE(solution.iterations, 15)
        << rows;  // 5 to 10; 95 and more were the noise seen as turns
    ASSERT_EQ(solution.gauge.size(), 1u) << rows;  // the scale
    for (const ParameterResult& each : solution.parameters)
      if (is_base_or_turn_of_tool(each.parameter)) {
        EXPECT_NE(each.status, Status::identified) << each.parameter.name;
      }
  }
  // Factors of a group are some 2 kB, residuals 200 bytes a row, in a few models.
  EXPECT_LT(most_memory_mb() - before, 60);
}

}  // namespace
}  // namespace selfcal::recovery
