// The ways between planned touches are free, and short.
#include <gtest/gtest.h>

#include "tests/constraints/touch_plan_cell.h"

namespace selfcal {
namespace {

TEST(TouchPlan, ChoosesWaysThatAreFree) {
  const PlannedCell cell = table_and_wall();
  const TouchPlan plan = cell.plan();
  const auto free = [&](const Eigen::VectorXd& from, const Eigen::VectorXd& to, int touched = -1) {
    return path_is_free(rx90(), values(rx90()), from, to, cell.obstacles, cell.options.apart,
                        touched);
  };
  Eigen::VectorXd here = home();
  for (const PlannedTouch& each : plan.touches) {
    if (each.via_home) {
      EXPECT_TRUE(free(here, home()) && free(home(), each.start));
    } else {
      EXPECT_TRUE(free(here, each.start));
    }
    EXPECT_TRUE(free(home(), each.start)) << "every touch can be begun at home";
    EXPECT_TRUE(free(each.start, each.end, each.set));
    here = each.start;
  }
}

TEST(TouchPlan, FinishesASetBeforeItBeginsTheNext) {
  int changes = 0, last = -1;
  for (const PlannedTouch& each : table_and_wall().plan().touches) {
    changes += each.set != last;
    last = each.set;
  }
  EXPECT_EQ(changes, 2);
}

TEST(PathIsFree, KeepsOutOfTheHalfBallBehindASurface) {
  const Eigen::VectorXd q = home();
  const Eigen::Vector3d p = located(q).p, up = Eigen::Vector3d::UnitZ();
  const auto free = [&](const Eigen::Vector3d& point, double radius, double apart,
                        int touched = -1) {
    return path_is_free(rx90(), values(rx90()), q, q, {{point, up, {point, radius}}}, apart,
                        touched);
  };
  EXPECT_TRUE(free(p - 0.10 * up, 0.5, 0.05));
  EXPECT_FALSE(free(p - 0.04 * up, 0.5, 0.05)) << "too near";
  EXPECT_FALSE(free(p + 0.10 * up, 0.5, 0.05)) << "behind it";
  EXPECT_TRUE(free(p + 0.10 * up, 0.04, 0.05)) << "out of its ball";
  EXPECT_FALSE(free(p + 0.10 * up, 0.06, 0.05)) << "the ball and what is kept from it";
  EXPECT_FALSE(free(p + 10 * up, 0, 0)) << "a surface without an end";
  EXPECT_TRUE(free(p + 0.10 * up, 0.5, 0.05, 0)) << "the one that is touched";
}

TEST(PathIsFree, SeesWhatLiesBetweenTheEnds) {
  Eigen::VectorXd from = home(), to = home();
  from[0] = -1;
  to[0] = 1;
  const Eigen::Vector3d middle = located(home()).p;
  const Obstacle post{
      middle + Eigen::Vector3d(0, 0, 0.1), Eigen::Vector3d::UnitZ(), {middle, 0.15}};
  EXPECT_TRUE(path_is_free(rx90(), values(rx90()), from, from, {post}, 0.01));
  EXPECT_TRUE(path_is_free(rx90(), values(rx90()), to, to, {post}, 0.01));
  EXPECT_FALSE(path_is_free(rx90(), values(rx90()), from, to, {post}, 0.01));
  EXPECT_TRUE(path_is_free(rx90(), values(rx90()), from, to, {}, 0.01));
}

}  // namespace
}  // namespace selfcal
