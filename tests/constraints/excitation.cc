// What would help where the rows do not tell what they could.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "constraints/estimation/identification.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<Note> unexcited_by(const std::string& sets) {
  const Simulated simulated = made(
      "robot: rx90.robot.yaml\nseed: 3\nerrors: {length: 1.0e-3, angle: 1.0e-3}\nsets: " + sets +
      "\n");
  return identify(rx90(), simulated.data, {}, {}).unexcited;
}

TEST(Excitation, NamesAJointThatHardlyMoved) {
  const std::vector<Note> notes =
      unexcited_by("{tracker: {method: position, rows: 60, noise: 2.0e-5, locked: [j3]}}");
  ASSERT_FALSE(notes.empty());
  for (const Note& each : notes) {
    EXPECT_THAT(each.text, HasSubstr("j3 moved through 0 mrad only")) << each.parameter;
    EXPECT_EQ(each.joint, "j3");
  }
}

TEST(Excitation, AsksForNoMovementOfAJointThatMovedThroughItsRange) {
  const std::vector<Note> notes =
      unexcited_by("{tracker: {method: position, rows: 9, noise: 2.0e-3}}");
  ASSERT_FALSE(notes.empty());
  for (const Note& each : notes) {
    if (!each.joint.empty()) continue;
    EXPECT_THAT(each.text, Not(HasSubstr("more movement"))) << each.parameter;
    EXPECT_THAT(each.text, HasSubstr("more rows in other postures would help"));
  }
  EXPECT_TRUE(std::ranges::any_of(notes, [](const Note& each) { return each.joint.empty(); }));
}

}  // namespace
}  // namespace selfcal
