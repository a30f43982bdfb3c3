// Short ways against the shortest of all, and times worked by hand.
#include "constraints/planning/tour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace selfcal {
namespace {

TEST(Tour, TakesTheTimeOfTheSlowestJoint) {
  const Eigen::Vector3d from(0, 1, 0.2), to(0.5, -1, 0.1), speed(1, 2, 0.05);
  EXPECT_DOUBLE_EQ(joint_time(from, to, speed), 2.0);  // 0.5 s, 1 s, 0.1 m at 0.05 m/s
  const std::vector<Visit> visits = {{from, to}, {to, to}, {from, from}};
  EXPECT_DOUBLE_EQ(way_time(visits, {0, 1, 2}, speed), 4.0);  // its own way, none, and back
}

TEST(Tour, IsHardlyLongerThanTheShortestOfAll) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform;
  const Eigen::Vector2d speed(1, 1);
  double sum = 0, shortest_sum = 0;
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Visit> visits(7);
    for (Visit& each : visits)
      each.first = each.last = Eigen::Vector2d(uniform(random), uniform(random));
    std::vector<int> order(7);
    std::iota(order.begin(), order.end(), 0);
    double shortest = HUGE_VAL;
    do shortest = std::min(shortest, way_time(visits, order, speed));
    while (std::next_permutation(order.begin(), order.end()));
    std::vector<int> found = short_tour(visits, speed);
    const double way = way_time(visits, found, speed);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, std::vector<int>({0, 1, 2, 3, 4, 5, 6}));
    EXPECT_GE(way, shortest - 1e-12);
    EXPECT_LE(way, 1.25 * shortest);  // a local optimum
    sum += way;
    shortest_sum += shortest;
  }
  EXPECT_LE(sum, 1.05 * shortest_sum);
}

TEST(Tour, KeepsTheDirectionOfVisitsThatEndElsewhere) {
  // Three pairs on a line, each from left to right: only from 0 to 5 needs no way back.
  std::vector<Visit> visits;
  for (const double at : {4.0, 0.0, 2.0})
    visits.push_back({Eigen::VectorXd::Constant(1, at), Eigen::VectorXd::Constant(1, at + 1)});
  const Eigen::VectorXd speed = Eigen::VectorXd::Ones(1);
  EXPECT_EQ(short_tour(visits, speed), std::vector<int>({1, 2, 0}));
}

}  // namespace
}  // namespace selfcal
