// What a diagnosis says of itself before one acts on it.
#include "diagnosis/warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "diagnosis/diagnosis.h"
#include "kinematics/corrected_robot.h"
#include "tests/diagnosis/two_sessions.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

TEST(Warnings, NameTheEffectsOfTheRobotsFileThatAreNotUsed) {
  const TwoSessions sessions;
  EXPECT_THAT(warning_of_own_effects(*sessions.robot), IsEmpty());
  Node entry = Node::map();
  entry.set("effect", Node::of(std::string("joint_coupling")));
  entry.set("at", Node::of(std::string("j3")));
  entry.set("from", Node::of(std::string("j2")));
  Problems problems;
  const auto corrected = correct(sessions.robot, {entry}, {}, problems);
  ASSERT_NE(corrected, nullptr);
  EXPECT_THAT(warning_of_own_effects(*corrected), HasSubstr("not used (joint_coupling@j3)"));
}

Diagnosis named(double before, double after, double least) {
  Diagnosis diagnosis;
  diagnosis.verdict.effect = "joint_coupling";
  diagnosis.gap.rows = 40;
  diagnosis.gap.rms_before = before;
  diagnosis.gap.rms_after = after;
  diagnosis.gap.closed_fraction = 0.5;
  diagnosis.gap.closed_least = least;
  return diagnosis;
}

TEST(Warnings, SayWhetherTheRowsKeptAsideConfirmTheName) {
  EXPECT_THAT(warning_of_gap(named(2e-4, 1e-4, 0.3)), IsEmpty());
  EXPECT_THAT(warning_of_gap(named(2e-4, 1e-4, 0)), HasSubstr("too few to confirm it"));
  EXPECT_THAT(warning_of_gap(named(2e-4, 2.1e-4, 0)), HasSubstr("do not confirm it"));
  Diagnosis unjudged = named(2e-4, 1e-4, 0.3);
  unjudged.gap.rows = 0;
  EXPECT_THAT(warning_of_gap(unjudged), HasSubstr("nothing confirms it"));
  Diagnosis none = named(2e-4, 2.1e-4, 0);
  none.verdict.effect = "none";
  EXPECT_THAT(warning_of_gap(none), IsEmpty());
}

}  // namespace
}  // namespace selfcal
