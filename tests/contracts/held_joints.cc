// A joint of a serial robot that is locked at one reading while the others move: what that costs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "constraints/identifiability/excitation.h"
#include "tests/contracts/arm.h"
#include "tests/contracts/method_case.h"

namespace selfcal {
namespace {

StructuralRank told_with(const std::string& sets, const std::vector<int>& held) {
  const auto arm = six_axis_arm();
  const std::vector<char> all(arm->parameters().size(), 1);
  return structural(*arm, make_sets(sets), all, 80, 1, {}, held);
}

TEST(HeldJoint, StaysAtOneReadingWhileTheConstraintIsMet) {
  const auto arm = six_axis_arm();
  DataSet data;
  data.sets = make_sets("s: {method: position-constraint}");
  SampleRequest request;
  request.rows = 24;
  request.held = {3};
  Random random(4);
  const Sampled sampled = sample_rows(*arm, values(*arm), {request}, random, data);
  ASSERT_EQ(sampled.unreached, "");
  const Eigen::VectorXd q = data.rows.q.col(3);
  EXPECT_TRUE((q.array() == q[0]).all());
  EXPECT_GT(data.rows.q.col(2).maxCoeff() - data.rows.q.col(2).minCoeff(), 0.1);
  const Equations equations(*arm, data, Use::fit);
  for (const RowResidual& row : equations.residuals(sampled.truth)) EXPECT_LT(row.length, 1e-12);
}

TEST(HeldJoint, MakesItsTwoLinksOneOfWhichLessIsTold) {
  for (const char* sets : {"s: {method: position-constraint}", "s: {method: position}"}) {
    const StructuralRank free = told_with(sets, {});
    ASSERT_EQ(free.unreached, "");
    for (const int joint : {1, 3}) {
      const StructuralRank locked = told_with(sets, {joint});
      ASSERT_EQ(locked.unreached, "");
      std::printf("%s, j%d locked: %d of %d\n", sets, joint + 1, locked.rank.total(),
                  free.rank.total());
      EXPECT_LT(locked.rank.total(), free.rank.total());
      // Its gear does no more than its zero.
      const auto arm = six_axis_arm();
      const int gear = find_parameter(*arm, "K" + std::to_string(joint + 1));
      const int zero = find_parameter(*arm, "j" + std::to_string(joint + 1) + ".theta");
      EXPECT_FALSE(locked.rank.status[gear] == Status::identified &&
                   locked.rank.status[zero] == Status::identified);
    }
  }
}

/// Six equations, five joints: only the configuration that one started from.
TEST(HeldJoint, LeavesNoOtherWayToMeetALocationWithFiveJoints) {
  EXPECT_THAT(told_with("s: {method: location-constraint}", {3}).unreached,
              testing::HasSubstr("only 1 of 80 configurations"));
}

}  // namespace
}  // namespace selfcal
