// A hundred thousand rows: memory bounded beyond the input, time linear in the rows.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>

#include "constraints/endpoint_sigma.h"
#include "constraints/identification.h"
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

}  // namespace
}  // namespace selfcal::recovery
