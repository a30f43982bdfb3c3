// What planning gains over as many configurations at random, over many seeds: by the end position's
// sigma without the part that no such row tells, however many (ConfigurationPlan::rest), which is
// printed beside.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "constraints/planning/configuration_plan.h"
#include "constraints/statistics.h"
#include "io/files/robot_file.h"
#include "tests/support/cell.h"

namespace selfcal::recovery {
namespace {

Set set_from(const std::string& name, const Node& entry) {
  Problems problems;
  Set set = make_set(name, entry, problems);
  EXPECT_FALSE(problems.any()) << problems.list.front();
  return set;
}

Node plane_entry() { return Node::map().set("method", Node::of(std::string("plane"))); }

/// The median over seeds of what is left of the end position's sigma after random configurations
/// over that after the planned ones.
double median_gain_over_random(const std::string& name, PlanRequest request) {
  const auto robot = load_robot(SELFCAL_SOURCE_DIR "/app/examples/" + name + ".robot.yaml");
  EXPECT_TRUE(robot) << robot.error().what;
  request.speed.setOnes(static_cast<Eigen::Index>((*robot)->joints().size()));
  const int seeds = repetitions("SELFCAL_SEEDS", 50);
  std::vector<double> gains, before, after, rests;
  for (int seed = 1; seed <= seeds; ++seed) {
    request.pool.seed = static_cast<unsigned long long>(seed);
    const ConfigurationPlan plan = plan_configurations(**robot, values(**robot), request);
    EXPECT_EQ(plan.problem, "");
    before.push_back(1e3 * plan.random.sigma);
    after.push_back(1e3 * plan.planned.sigma);
    gains.push_back(plan.random.sigma / plan.planned.sigma);
    rests.push_back(plan.rest(plan.random.sigma) / plan.rest(plan.planned.sigma));
  }
  std::printf(
      "%s, %d seeds: median sigma %.4f mm at random, %.4f mm planned; gain %.2f (least %.2f), "
      "%.2f of what rows tell\n",
      name.c_str(), seeds, median(before), median(after), median(gains),
      *std::ranges::min_element(gains), median(rests));
  return median(rests);
}

TEST(Planning, TellsTwiceAsMuchOfTheRx90AsRandomTouchesOfThreePlanes) {
  PlanRequest request;
  for (const char* plane : {"plane1", "plane2", "plane3"})
    request.pool.sets.push_back(set_from(plane, plane_entry()));
  request.count = 30;
  request.pool.candidates = 300;
  EXPECT_GE(median_gain_over_random("rx90", request), 2);
}

TEST(Planning, TellsTwiceAsMuchOfTheDeltaAsRandomTouchesOfItsBed) {
  PlanRequest request;
  const Eigen::VectorXd bed = Eigen::Vector3d(0, 0, -10);
  request.pool.sets.push_back(set_from("bed", plane_entry().set("plane", Node::of(bed))));
  request.count = 16;
  request.pool.candidates = 600;
  EXPECT_GE(median_gain_over_random("delta", request), 2);
}

}  // namespace
}  // namespace selfcal::recovery
