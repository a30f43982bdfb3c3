// What no part of a robot may enter: distances by hand, and plans and ways that keep out of it.
#include "constraints/planning/fence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "constraints/planning/fence_file.h"
#include "constraints/planning/free_way.h"
#include "tests/constraints/touch_plan_cell.h"

namespace selfcal {
namespace {

using Eigen::Vector3d;

KeepOut box_of(const Vector3d& least, const Vector3d& most) {
  KeepOut keep;
  keep.box = Eigen::AlignedBox3d(least, most);
  return keep;
}

TEST(Distance, OfSegmentsIsThatOfTheirNearestPoints) {
  const Vector3d o = Vector3d::Zero();
  // Crossing a metre above each other; one beside the other's end; parallel; points.
  EXPECT_NEAR(distance_between({-1, 0, 0}, {1, 0, 0}, {0, -1, 1}, {0, 1, 1}), 1, 1e-15);
  EXPECT_NEAR(distance_between(o, {1, 0, 0}, {4, 4, 0}, {4, 5, 0}), 5, 1e-15);
  EXPECT_NEAR(distance_between(o, {1, 0, 0}, {0.5, 2, 0}, {3, 2, 0}), 2, 1e-15);
  EXPECT_NEAR(distance_between(o, o, {0, 3, 4}, {0, 3, 4}), 5, 1e-15);
  EXPECT_NEAR(distance_between(o, {0, 0, 2}, {1, 0, 1}, {1, 0, 1}), 1, 1e-15);
}

TEST(Distance, OfASegmentFromABoxAndAHalfSpace) {
  const KeepOut box = box_of({0, 0, 0}, {1, 1, 1});
  EXPECT_NEAR(distance_between({2, 0.5, 0.5}, {2, 5, 0.5}, box), 1, 1e-9);
  EXPECT_NEAR(distance_between({-1, 2, 0.5}, {2, 2, 0.5}, box), 1, 1e-9) << "beside its middle";
  EXPECT_NEAR(distance_between({-1, 0.5, 0.5}, {2, 0.5, 0.5}, box), -0.5, 1e-8) << "through it";
  EXPECT_NEAR(distance_between({4, 5, 0.5}, {9, 9, 0.5}, box), 5, 1e-9) << "a corner";
  KeepOut floor;
  EXPECT_NEAR(distance_between({0, 0, 2}, {0, 0, -0.5}, floor), -0.5, 1e-15);
}

TEST(Distance, OfASegmentFromASurfaceIsThatOfItsNearestPoint) {
  const Obstacle patch{Vector3d::Zero(), Vector3d::UnitZ(), {Vector3d::Zero(), 0.1}};
  const Obstacle endless{Vector3d::Zero(), Vector3d::UnitZ(), {}};
  // Both ends are beside the half ball, and the middle is 3 cm behind the surface.
  EXPECT_NEAR(distance_between({-0.25, 0, -0.03}, {0.25, 0, -0.03}, patch), -0.03, 1e-9);
  EXPECT_NEAR(distance_between({-0.25, 0, 0.03}, {0.25, 0, 0.03}, patch), 0.03, 1e-9);
  EXPECT_NEAR(distance_between({-0.5, 0, 0.2}, {0.5, 0, -0.3}, patch), -0.05, 1e-8)
      << "through its middle, below which the surface is 5 cm away";
  EXPECT_NEAR(distance_between({0.2, -1, -0.03}, {0.2, 1, -0.03}, patch),
              std::hypot(0.2, 0.03) - 0.1, 1e-9)
      << "past the patch";
  EXPECT_NEAR(distance_between({0.2, -1, -0.03}, {0.2, 1, 0.5}, endless), -0.03, 1e-15);
}

TEST(Fence, KeepsTheEndpointAndThickLinksOut) {
  const Eigen::VectorXd q = home();
  const Vector3d p = located(q).p;
  const auto why = [&](const Fence& fence, const std::vector<Obstacle>& obstacles = {},
                       int touched = -1) {
    return in_the_way(rx90(), fence, obstacles, q, p, 0.02, touched);
  };
  Fence fence;
  EXPECT_EQ(why(fence), "");
  fence.keep_outs = {box_of(p + Vector3d(0.01, -1, -1), p + Vector3d(1, 1, 1))};
  EXPECT_EQ(why(fence), "the endpoint is where nothing may be") << "1 cm away, 2 are kept";
  fence.keep_outs = {box_of(p + Vector3d(0.03, -1, -1), p + Vector3d(1, 1, 1))};
  EXPECT_EQ(why(fence), "");
  fence.keep_outs = {box_of(p - Vector3d(0.1, 0.1, 0.1), p + Vector3d(0.1, 0.1, 0.1))};
  EXPECT_EQ(in_the_way(rx90(), fence, {}, q, p, 0, -1), "the endpoint is where nothing may be")
      << "within the box, and nothing more is kept apart";
  fence.keep_outs = {box_of(p + Vector3d(0.03, -1, -1), p + Vector3d(1, 1, 1))};
  // The last frame, 5 cm thick, reaches into it.
  const auto& links = rx90().statics()->mechanics().links;
  const int last = static_cast<int>(links.size()) - 1;
  fence.capsules = {{last, Vector3d::Zero(), Vector3d::Zero(), 0.05}};
  EXPECT_EQ(why(fence),
            "link " + links[static_cast<std::size_t>(last)].frame + " is where nothing may be");
}

TEST(Fence, KeepsLinksOffSurfacesAndOffEachOtherButForNeighbours) {
  const Eigen::VectorXd q = home();
  const Location X = located(q);
  const auto poses = rx90().statics()->link_poses(q);
  const int last = static_cast<int>(poses.size()) - 1;
  const auto why = [&](const Fence& fence, const std::vector<Obstacle>& obstacles, int touched) {
    return in_the_way(rx90(), fence, obstacles, q, X.p, 0.0, touched);
  };
  Fence fence;
  fence.capsules = {{last, Vector3d::Zero(), Vector3d::Zero(), 0.05}};
  const std::vector<Obstacle> table = {{X.p - Vector3d(0, 0, 0.03), Vector3d::UnitZ(), {X.p, 0.3}}};
  EXPECT_THAT(why(fence, table, -1), testing::HasSubstr("behind a surface"));
  EXPECT_EQ(why(fence, table, 0), "") << "the tool touches it";
  // Half a metre of the last link through the half ball, both ends beside it.
  const Vector3d along = poses.back().linear() * Vector3d(0.25, 0, 0);
  const Vector3d outward = along.unitOrthogonal();
  fence.capsules = {{last, {-0.25, 0, 0}, {0.25, 0, 0}, 0.05}};
  const auto beside = [&](double height) {
    const Vector3d point = X.p - height * outward;
    return why(fence, {{point, outward, {point, 0.1}}}, -1);
  };
  EXPECT_THAT(beside(0.02), testing::HasSubstr("behind a surface"));
  EXPECT_THAT(beside(-0.08), testing::HasSubstr("behind a surface"));
  EXPECT_EQ(beside(0.06), "");
  fence.capsules = {{last, Vector3d::Zero(), Vector3d::Zero(), 0.05}};
  // A second link that reaches from its own frame to the tool.
  const int elbow = rx90().statics()->mechanics().link_of(2);
  const Vector3d there = poses[static_cast<std::size_t>(elbow)].inverse() * X.p;
  fence.capsules.push_back({elbow, Vector3d::Zero(), there, 0.01});
  EXPECT_THAT(why(fence, {}, -1), testing::HasSubstr("meet"));
  const int wrist = rx90().statics()->mechanics().link_of(4);
  fence.capsules.back() = {wrist, Vector3d::Zero(),
                           poses[static_cast<std::size_t>(wrist)].inverse() * X.p, 0.01};
  EXPECT_EQ(why(fence, {}, -1), "") << "joint 6 joins them";
}

TEST(Fence, IsReadFromAFileAndRefusedWithAReason) {
  const auto read = [](Node keep_out, Node capsules, Problems& problems) {
    return read_fence(&keep_out, &capsules, rx90(), problems);
  };
  const auto numbers = [](double a, double b, double c) {
    return Node::of(Eigen::VectorXd(Vector3d(a, b, c)));
  };
  const auto list_of = [](std::vector<Node> items) {
    Node list = Node::list();
    list.items = std::move(items);
    return list;
  };
  const auto box = [&](double a, double b, double c) {
    return Node::map().set("min", numbers(0, 0, 0)).set("max", numbers(a, b, c));
  };
  const auto capsule = [&](const std::string& link, double radius) {
    return Node::map()
        .set("link", Node::of(link))
        .set("from", numbers(0, 0, 0))
        .set("to", numbers(0.1, 0, 0))
        .set("radius", Node::of(radius));
  };
  Problems none;
  const Node plane = Node::map().set("point", numbers(0, 0, -1)).set("normal", numbers(0, 0, 2));
  const Fence fence = read(list_of({box(1, 2, 3), plane}), list_of({capsule("j3", 0.05)}), none);
  EXPECT_FALSE(none.any());
  ASSERT_EQ(fence.keep_outs.size(), 2U);
  ASSERT_EQ(fence.capsules.size(), 1U);
  EXPECT_EQ(fence.keep_outs[0].box->max(), Vector3d(1, 2, 3));
  EXPECT_EQ(fence.keep_outs[1].outward, Vector3d::UnitZ());
  EXPECT_EQ(
      rx90().statics()->mechanics().links[static_cast<std::size_t>(fence.capsules[0].link)].frame,
      "j3");
  Problems some;
  read(list_of({box(1, -2, 3)}), list_of({capsule("elbow", 0.05), capsule("j3", -1)}), some);
  EXPECT_EQ(some.list.size(), 3U);
}

TEST(TouchPlan, KeepsOutOfABoxThatStandsInTheWay) {
  PlannedCell cell = table_and_wall(12);
  // A post on the table, in the middle of its patch.
  cell.options.fence.keep_outs = {box_of({0.65, -0.1, 0.1}, {0.85, 0.1, 0.6})};
  const TouchPlan plan = cell.plan();
  EXPECT_EQ(plan.unreached, "");
  Eigen::VectorXd here = home();
  const auto free = [&](const Eigen::VectorXd& to) {
    const bool is = path_is_free(rx90(), values(rx90()), here, to, {}, cell.options.apart, -1,
                                 cell.options.fence);
    here = to;
    return is;
  };
  for (const PlannedTouch& each : plan.touches) {
    if (each.via_home) {
      EXPECT_TRUE(free(home()));
    }
    for (const Eigen::VectorXd& place : each.way) EXPECT_TRUE(free(place));
    EXPECT_TRUE(free(each.start));
    EXPECT_TRUE(free(each.end));
    here = each.start;
  }
}

TEST(TouchPlan, FillsTheTimeThatItsMotionMayTake) {
  PlannedCell cell = table_and_wall(30);
  const TouchPlan free = cell.plan();
  const MotionTime all = motion_time(rx90(), values(rx90()), free, cell.options);
  double used = 0;
  for (const double share : {0.7, 0.5, 0.35}) {
    cell.options.longest = share * all.total();
    const TouchPlan some = cell.plan();
    ASSERT_EQ(some.unreached, "");
    const MotionTime time = motion_time(rx90(), values(rx90()), some, cell.options);
    EXPECT_LE(time.total(), cell.options.longest);
    used += time.total() / cell.options.longest / 3;
  }
  // Both sets get a touch more at a time, which take some 4 to 10 s together of 65 to 130 s.
  EXPECT_GT(used, 0.9);
}

TEST(TouchPlan, KeepsTouchesApartAndItsMotionWithinItsTime) {
  PlannedCell cell = table_and_wall(12);
  const TouchPlan free = cell.plan();
  const MotionTime all = motion_time(rx90(), values(rx90()), free, cell.options);
  cell.options.longest = 0.6 * all.total();
  const TouchPlan shorter = cell.plan();
  const MotionTime some = motion_time(rx90(), values(rx90()), shorter, cell.options);
  EXPECT_EQ(shorter.unreached, "");
  EXPECT_LE(some.total(), cell.options.longest);
  EXPECT_GE(shorter.touches.size(), 8U);
  EXPECT_LT(shorter.touches.size(), free.touches.size());
  cell.options.longest = 1;
  EXPECT_THAT(cell.plan().unreached, testing::HasSubstr("longer"));
  cell.options.longest = 0;
  cell.options.spacing = 0.05;
  const TouchPlan spaced = cell.plan();
  EXPECT_EQ(spaced.unreached, "");
  for (const PlannedTouch& a : spaced.touches)
    for (const PlannedTouch& b : spaced.touches) {
      const double apart = (located(a.touch).p - located(b.touch).p).norm();
      EXPECT_TRUE(a.set != b.set || apart < kMet || apart > 0.05 - kMet) << apart;
    }
}

}  // namespace
}  // namespace selfcal
