// The same contact, come to by other joints.
#include "constraints/planning/other_approach.h"

#include <gtest/gtest.h>

#include "tests/constraints/touch_plan_cell.h"

namespace selfcal {
namespace {

class OtherApproach : public testing::Test {
 protected:
  OtherApproach() {
    cell_.plane({0.75, 0, 0.15}, Eigen::Vector3d::UnitZ(), 0.25, 20);
    Random random(1);
    const Eigen::VectorXd xi = values(rx90());
    const TouchCandidates candidates(rx90(), xi, cell_.sets, cell_.obstacles, cell_.options);
    touches_ = usable_touches(candidates, cell_.targets, random).front();
  }

  std::vector<PlannedTouch> others(const PlannedTouch& touch) const {
    Random random(2);
    return other_approaches(rx90(), values(rx90()), cell_.targets[0], cell_.obstacles,
                            cell_.options, touch, 2, random);
  }

  PlannedCell cell_;
  std::vector<PlannedTouch> touches_;
};

TEST_F(OtherApproach, MeetsTheSameContactFromAsFarOutAndGoesAsFarBehind) {
  int found = 0;
  for (const PlannedTouch& touch : touches_)
    for (const PlannedTouch& other : others(touch)) {
      ++found;
      EXPECT_EQ(other.touch, touch.touch);
      const Eigen::Vector3d tip = located(touch.touch).p;
      EXPECT_NEAR((located(other.outside).p - tip).z(), cell_.options.clearance,
                  0.02 * cell_.options.clearance);
      EXPECT_NEAR((located(other.start).p - tip).z(), cell_.options.slow,
                  0.02 * cell_.options.slow);
      EXPECT_NEAR((located(other.end).p - tip).z(), -cell_.options.search,
                  0.02 * cell_.options.search);
      // On the straight path between the two.
      const Eigen::VectorXd way = other.end - other.start, part = touch.touch - other.start;
      EXPECT_LT((part - way * (part.dot(way) / way.squaredNorm())).norm(), 1e-9);
      EXPECT_TRUE(within_limits(rx90(), other.start, cell_.options.limit_margin));
    }
  EXPECT_GT(found, static_cast<int>(touches_.size()));
}

TEST_F(OtherApproach, TurnsJointsTheOtherWayRound) {
  int turned = 0, all = 0;
  for (const PlannedTouch& touch : touches_)
    for (const PlannedTouch& other : others(touch))
      for (Eigen::Index j = 0; j < touch.touch.size(); ++j) {
        const double before = touch.end[j] - touch.start[j], now = other.end[j] - other.start[j];
        ++all;
        turned += before * now < 0;
      }
  EXPECT_GT(turned, all / 4) << "of joints drawn anew half turn round";
}

TEST_F(OtherApproach, HasNoneForSockets) {
  PlannedTouch touch = touches_.front();
  TouchTarget socket = cell_.targets[0];
  socket.plane.reset();
  Random random(1);
  EXPECT_TRUE(other_approaches(rx90(), values(rx90()), socket, {}, cell_.options, touch, 2, random)
                  .empty());
}

}  // namespace
}  // namespace selfcal
