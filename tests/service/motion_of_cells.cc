// How long the sessions of the example cells move, and what of that the ways between the touches
// and the way into a contact have saved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include "app/commands/support/simulated_robot.h"
#include "app/service/config/config.h"
#include "app/service/session/slow_height.h"
#include "constraints/planning/touch_plan.h"
#include "constraints/planning/tour.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

struct CellMotion {
  double travel = 0, touching = 0;  ///< s
  int via_home = 0;
  double all() const { return travel + touching; }
};

/// The same touches without free ways or a tour: always to the nearest one of the set, straight
/// where that is free and through home else, slowly from the clearance on, out twice as fast.
CellMotion straight_or_through_home(const Config& config, std::vector<PlannedTouch> left) {
  const Robot& robot = *config.robot;
  const Eigen::VectorXd xi = values(robot), &home = config.plan.home;
  const Eigen::VectorXd speed = Eigen::VectorXd::Constant(home.size(), config.plan.speed);
  CellMotion motion;
  Eigen::VectorXd here = home;
  int set = -1;
  while (!left.empty()) {
    const auto next = std::ranges::min_element(left, {}, [&](const PlannedTouch& each) {
      return joint_time(here, each.outside, speed) + (set >= 0 && each.set != set ? 1e3 : 0);
    });
    if (path_is_free(robot, xi, here, next->outside, config.obstacles, config.plan.apart)) {
      motion.travel += joint_time(here, next->outside, speed);
    } else {
      motion.travel += joint_time(here, home, speed) + joint_time(home, next->outside, speed);
      ++motion.via_home;
    }
    const double way =
        (locate(robot, xi, next->touch).p - locate(robot, xi, next->outside).p).norm();
    motion.touching += 1.5 * way / config.plan.touch_speed;
    here = next->outside;
    set = next->set;
    left.erase(next);
  }
  motion.travel += joint_time(here, home, speed);
  return motion;
}

/// The plan's motion by the robot that the example's scenario makes, whose contacts come where its
/// errors put them: slowly from where those before leave the surface open.
CellMotion as_felt(const Config& config, const std::string& name, const TouchPlan& plan,
                   CellMotion motion) {
  const auto machine = load_machine(example(name + "_cell.scenario.yaml"), config);
  EXPECT_TRUE(machine) << machine.error().what;
  const Robot& robot = *config.robot;
  const Eigen::VectorXd xi = values(robot), &truth = (*machine)->truth().xi;
  const Eigen::VectorXd nearer =
      Eigen::VectorXd::Constant(config.plan.home.size(), config.plan.speed / 4);
  std::map<int, std::vector<FeltContact>> felt;
  motion.touching = 0;
  for (const PlannedTouch& each : plan.touches) {
    const auto target = std::ranges::find(config.targets, each.set, &TouchTarget::set);
    const Eigen::Vector3d expected = locate(robot, xi, each.touch).p;
    const double slow = target->outward.dot(locate(robot, xi, each.start).p - expected);
    const double height =
        slow_height(felt[each.set], expected, slow, std::min(slow, config.plan.search));
    const double out = target->outward.dot(expected - locate(robot, truth, each.touch).p);
    const Eigen::VectorXd from = each.touch + height / slow * (each.start - each.touch);
    motion.touching += joint_time(each.start, from, nearer) +
                       (height - out) / config.plan.touch_speed +
                       joint_time(each.touch, each.start, 4 * nearer);
    felt[each.set].push_back({expected, out});
  }
  return motion;
}

struct Compared {
  CellMotion before, now, felt;
  std::size_t touches = 0;
};

Compared compare(const std::string& name) {
  const auto config = load_config(example(name + "_cell.config.yaml"));
  EXPECT_TRUE(config) << config.error().what;
  const TouchPlan plan =
      plan_touches(*config->robot, values(*config->robot), config->sets, config->targets,
                   config->obstacles, config->workspace, config->plan);
  EXPECT_EQ(plan.unreached, "");
  const MotionTime time = motion_time(*config->robot, values(*config->robot), plan, config->plan);
  Compared result{straight_or_through_home(*config, plan.touches), {}, {}, plan.touches.size()};
  result.now = {time.travel, time.touching,
                static_cast<int>(std::ranges::count(plan.touches, true, &PlannedTouch::via_home))};
  result.felt = as_felt(*config, name, plan, result.now);
  const auto print = [](const char* what, const CellMotion& motion) {
    std::printf("  %s: %.0f s between touches, %.0f s into contacts and out, %d through home\n",
                what, motion.travel, motion.touching, motion.via_home);
  };
  std::printf(
      "%s, %zu touches: %.2f times as long before, %.2f as touches tell where surfaces lie\n",
      name.c_str(), result.touches, result.before.all() / result.now.all(),
      result.before.all() / result.felt.all());
  print("straight or through home", result.before);
  print("as planned", result.now);
  print("as touches tell", result.felt);
  return result;
}

// As planned it is about half: which touches are chosen, and so how far apart they lie, hangs on
// the last digits of what a processor computes.
TEST(MotionOfCells, IsHalfOfWhatStraightPathsThroughHomeTake) {
  for (const char* name : {"rx90", "irb1600"}) {
    const Compared cell = compare(name);
    EXPECT_LE(cell.now.via_home, static_cast<int>(cell.touches) / 10) << name;
    EXPECT_LE(cell.now.all(), cell.before.all() / 1.8) << name;
    EXPECT_LE(cell.felt.all(), cell.before.all() / 2) << name;
  }
}

// Their touches lie near each other, and what the plan cannot shorten is the search for the
// surface, at the speed that the configuration states: that the touches before shorten.
TEST(MotionOfCells, IsHalfOnceTouchesTellWhereSurfacesLieWhereMostOfItIsTheSearchForThem) {
  for (const char* name : {"delta", "stewart", "hexaslide"}) {
    const Compared cell = compare(name);
    EXPECT_EQ(cell.now.via_home, 0) << name;
    EXPECT_LE(cell.now.all(), cell.before.all() / 1.3) << name;
    EXPECT_LE(cell.felt.all(), cell.before.all() / 2) << name;
  }
}

}  // namespace
}  // namespace selfcal
