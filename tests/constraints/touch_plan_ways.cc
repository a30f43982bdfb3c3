// The ways between planned touches are free, and short.
#include <gtest/gtest.h>

#include "constraints/planning/free_way.h"
#include "constraints/planning/tour.h"
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
  int last = -1;  // the surface that the robot comes from
  for (const PlannedTouch& each : plan.touches) {
    if (each.via_home) {
      EXPECT_TRUE(free(here, home(), last));
      here = home();
    }
    for (const Eigen::VectorXd& place : each.way) {
      EXPECT_TRUE(free(here, place, last));
      here = place;
    }
    EXPECT_TRUE(free(here, each.start, each.set));
    EXPECT_TRUE(free(home(), each.start, each.set)) << "every touch can be begun at home";
    EXPECT_TRUE(free(home(), each.outside));
    EXPECT_TRUE(free(each.start, each.end, each.set));
    here = each.start;
    last = each.set;
  }
}

TEST(TouchPlan, HardlyEverGoesHomeBetweenTouches) {
  PlannedCell cell = table_and_wall(30);
  int through = 0;
  const TouchPlan plan = cell.plan();
  for (const PlannedTouch& each : plan.touches) through += each.via_home;
  EXPECT_LE(through, 6) << "one in ten";
  // As if each touch were reached through home, which is what the straight paths alone leave of
  // most: at least twice as long.
  double all = 0;
  Eigen::VectorXd here = cell.options.home;
  const Eigen::VectorXd speed = Eigen::VectorXd::Constant(6, cell.options.speed);
  for (const PlannedTouch& each : plan.touches) {
    all += joint_time(here, home(), speed) + joint_time(home(), each.start, speed);
    here = each.start;
  }
  const MotionTime time = motion_time(rx90(), values(rx90()), plan, cell.options);
  EXPECT_LT(time.travel, all / 2);
}

TEST(MotionTime, IsThatOfTheSlowestJointAndOfTheWayIntoTheContact) {
  TouchPlan plan;
  PlannedTouch touch;
  touch.touch = touch.start = touch.end = home();
  touch.start[1] += 0.02;
  plan.touches = {touch};
  TouchPlanOptions options;
  options.home = home();
  options.speed = 0.1;
  options.repeats = 3;
  touch.way = {home()};
  touch.way[0][0] += 0.5;
  touch.way[0][3] -= 0.2;
  plan.touches.push_back(touch);
  const double into = (located(touch.start).p - located(touch.touch).p).norm() / 0.01;
  const MotionTime time = motion_time(rx90(), values(rx90()), plan, options);
  // 0.02 to the first, 0.5 to the place and back to the second, 0.02 home.
  EXPECT_NEAR(time.travel, (0.02 + 0.5 + 0.5 + 0.02) / 0.1, 1e-9);
  EXPECT_NEAR(time.touching, 2 * 3 * (into + 0.02 / 0.1), 1e-9);
}

TEST(FreeWay, LeavesTheStraightPathOnlyWhereSomethingStandsInIt) {
  Eigen::VectorXd from = home(), to = home();
  from[0] = -1;
  to[0] = 1;
  from[1] = to[1] = 0.1;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Eigen::VectorXd middle_q = from;
  middle_q[0] = 0;
  const Eigen::Vector3d middle = located(middle_q).p;
  const std::vector<Obstacle> post = {{middle + 0.05 * up, up, {middle, 0.15}}};
  const Eigen::VectorXd xi = values(rx90()), free_home = home();
  const FreeWay open = free_way({rx90(), xi, {}, 0.01, free_home, 0.5}, from, to);
  EXPECT_TRUE(open.through.empty() && !open.via_home);
  EXPECT_DOUBLE_EQ(open.time, 2 / 0.5);
  const FreeWay round = free_way({rx90(), xi, post, 0.01, free_home, 0.5}, from, to);
  ASSERT_FALSE(path_is_free(rx90(), xi, from, to, post, 0.01));
  ASSERT_EQ(round.through.size(), 2u) << round.via_home;
  EXPECT_GE(round.time, open.time - 1e-9);
  Eigen::VectorXd here = from;
  for (const Eigen::VectorXd& place : {round.through[0], round.through[1], to}) {
    EXPECT_TRUE(path_is_free(rx90(), xi, here, place, post, 0.01));
    here = place;
  }
}

TEST(InShortOrder, SaysWhichTouchesAnEngagedLockDoesNotGetTo) {
  Problems none;
  Node entry = Node::map(), lock = Node::map();
  lock.set("leg", Node::of(1.0));
  lock.set("joint", Node::of(std::string("universal")));
  entry.set("method", Node::of(std::string("locked-joint")));
  entry.set("lock", std::move(lock));
  const std::vector<Set> sets = {make_set("lock", entry, none)};
  ASSERT_FALSE(none.any());
  const auto touch_at = [](double turn) {
    PlannedTouch touch;
    touch.outside = home();
    touch.outside[0] = turn;
    touch.start = touch.touch = touch.end = touch.outside;
    return touch;
  };
  const Eigen::Vector3d middle = located(home()).p;
  const std::vector<Obstacle> post = {
      {middle + Eigen::Vector3d(0, 0, 0.1), Eigen::Vector3d::UnitZ(), {middle, 0.15}}};
  const std::vector<PlannedTouch> touches = {touch_at(-1), touch_at(-0.9), touch_at(1)};
  const Eigen::VectorXd xi = values(rx90()), begin = touch_at(-1.1).outside;

  const TouchPlan open = in_short_order({rx90(), xi, {}, 0.01, begin, 0.5}, sets, touches);
  EXPECT_EQ(open.touches.size(), 3u);
  EXPECT_EQ(open.left_out, "");
  const TouchPlan round = in_short_order({rx90(), xi, post, 0.01, begin, 0.5}, sets, touches);
  EXPECT_EQ(round.touches.size(), 2u);
  EXPECT_EQ(round.left_out,
            "set lock: 1 of 3 touches are left out, for no straight way to them is free with the "
            "lock engaged");
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

/// Of sheets across the whole cell, which nothing can go round, those that the path is said to be
/// free of.
int sheets_passed(const Eigen::VectorXd& from, const Eigen::VectorXd& to, double apart,
                  const std::vector<Capsule>& capsules, double thick) {
  constexpr int kSheets = 60;
  int passed = 0;
  for (int i = 0; i < kSheets; ++i) {
    const double y = -0.3 + 0.6 * i / kSheets;
    KeepOut sheet;
    sheet.box = Eigen::AlignedBox3d(Eigen::Vector3d(-3, y, -3), Eigen::Vector3d(3, y + thick, 3));
    passed += path_is_free(rx90(), values(rx90()), from, to, {}, apart, -1, {{sheet}, capsules});
  }
  return passed;
}

TEST(PathIsFree, LetsNoThinSheetFitBetweenTwoPlaces) {
  Eigen::VectorXd from(6), to(6);
  from << -2.7, 0.1, 0.1, -4, 0.2, -4;
  to << 2.7, 0.1, 0.1, 4, 0.2, 4;
  EXPECT_EQ(sheets_passed(from, to, 0.004, {}, 1e-3), 0);
  EXPECT_EQ(sheets_passed(from, to, 0, {}, 6e-3), 0) << "where nothing more is kept apart";
}

TEST(PathIsFree, LetsNoThinSheetFitBetweenTwoPlacesOfACapsule) {
  Eigen::VectorXd from = Eigen::VectorXd::Zero(6), to = from;
  from[0] = -2.7;
  to[0] = 2.7;
  // A thin rod a metre beside the first joint's axis.
  const int first = rx90().statics()->mechanics().link_of(0);
  const std::vector<Capsule> rod = {{first, {1, 0, 0}, {1, 0, 0.1}, 1e-3}};
  EXPECT_EQ(sheets_passed(from, to, 0.002, rod, 1e-3), 0);
}

}  // namespace
}  // namespace selfcal
