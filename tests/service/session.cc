// What is stored with a session, which touch comes next, and which count.
#include "app/service/session/session.h"

#include <gmock/gmock.h>

#include "app/service/session/touch_decision.h"
#include "tests/service/stored_session.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

// -------------------------------------------------------------------------- decoding

TEST(Decoding, ReadsBackAsItWasWritten) {
  const Config config = two_planes();
  const Decoding decoding = decoding_of(config);
  EXPECT_EQ(decoding.target, config.target);
  EXPECT_EQ(decoding.delay, 0.001);
  ASSERT_EQ(decoding.scales.size(), 6u);
  EXPECT_EQ(decoding.scales[5].step, kStep);
  EXPECT_EQ(decoding.scales[5].zero, 1000);
  ASSERT_EQ(decoding.sets.size(), 2u);
  EXPECT_EQ(decoding.sets[0].name, "near");
  EXPECT_EQ(decoding.sets[0].noise, 2e-5);
  EXPECT_EQ(decoding.sets[1].reference, 0);
  EXPECT_EQ(decoding.outward[1], Eigen::Vector3d::UnitZ());
}

TEST(Decoding, KeepsLargeEncoderZerosToTheCount) {
  const std::vector<EncoderScale> scales(6, EncoderScale{-1e-9, -4'503'599'627'370'495});  // 2^52
  const auto decoding = read_decoding(decoding_text(two_planes(), scales));
  ASSERT_TRUE(decoding);
  EXPECT_EQ(decoding->scales[0].zero, -4'503'599'627'370'495);
  EXPECT_EQ(decoding->scales[0].step, -1e-9);
}

TEST(Decoding, RefusesATextThatIsNone) {
  EXPECT_FALSE(read_decoding("target: 1.0e-3\n"));
  EXPECT_FALSE(read_decoding("{"));
  EXPECT_FALSE(read_decoding("sets: {a: {method: plane}}\n")) << "without target and delay";
}

// ----------------------------------------------------------------------- next step

TEST(NextStep, IsTheFirstThatNeedsAnotherTouch) {
  Session session = session_of(3);
  EXPECT_EQ(next_step(session, 1, 3), 0);
  session.touches = {touch_of(0)};
  EXPECT_EQ(next_step(session, 1, 3), 1);
  EXPECT_EQ(next_step(session, 2, 3), 0) << "a repeat is missing";
  session.touches = {touch_of(0), touch_of(1), touch_of(2)};
  EXPECT_EQ(next_step(session, 1, 3), 3) << "all done";
}

TEST(NextStep, PutsAStepAsideOnceItsAttemptsAreUsedUp) {
  Session session = session_of(3);
  for (int i = 0; i < 2; ++i) session.touches.push_back(touch_of(0, TouchOutcome::outlier));
  EXPECT_EQ(next_step(session, 1, 3), 0);
  EXPECT_EQ(steps_put_aside(session, 1, 3), 0);
  session.touches.push_back(touch_of(0, TouchOutcome::outlier));
  EXPECT_EQ(next_step(session, 1, 3), 1);
  EXPECT_EQ(steps_put_aside(session, 1, 3), 1);
}

TEST(NextStep, WantsAllRepeatsAgainAfterATouchThatDiffers) {
  Session session = session_of(2);
  session.touches = {touch_of(0), touch_of(0, TouchOutcome::differs)};
  EXPECT_TRUE(good_touches(session, 0).empty()) << "which of the two is wrong is not known";
  EXPECT_EQ(next_step(session, 2, 3), 0);
  session.touches.push_back(touch_of(0));
  EXPECT_EQ(next_step(session, 2, 3), 0);
  session.touches.push_back(touch_of(0));
  EXPECT_EQ(next_step(session, 2, 3), 1);
  EXPECT_EQ(good_touches(session, 0).size(), 2u);
}

// --------------------------------------------------------------------------- decisions

/// Joint 1 so far that the endpoint is moved by about `way` along the outward direction.
Reading reading_out_by(const Robot& robot, const std::vector<double>& touch, double way) {
  Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(touch.data(), 6);
  const auto height = [&](double turn) {
    Eigen::VectorXd moved = q;
    moved[1] += turn;
    return endpoint(robot, moved).z() - endpoint(robot, q).z();
  };
  double turn = 0;
  for (int i = 0; i < 20; ++i) turn += (way - height(turn)) / ((height(1e-4) - height(0)) / 1e-4);
  q[1] += turn;
  return {q, Eigen::VectorXd::Zero(6)};
}

TEST(RuleOnTouch, PutsAsideATouchLongBeforeTheSurface) {
  const Decoding decoding = decoding_of(two_planes());
  const Session session = session_of(1);
  const StepRecord& step = session.plan[0];
  const auto rule = [&](double way) {
    return decide_on_touch(rx90(), session, decoding, step, reading_out_by(rx90(), step.touch, way),
                           0.01, 1e-4);
  };
  EXPECT_EQ(rule(0.0099).outcome, TouchOutcome::taken);
  EXPECT_EQ(rule(0.012).outcome, TouchOutcome::outlier);
  EXPECT_EQ(rule(0.012).why, "touched 12 mm before the surface");
  EXPECT_EQ(rule(-0.009).outcome, TouchOutcome::taken) << "behind it the search has an end";
}

TEST(RuleOnTouch, FindsATouchThatDiffersFromTheOneBefore) {
  const Decoding decoding = decoding_of(two_planes());
  Session session = session_of(1);
  session.touches = {touch_of(0)};
  const StepRecord& step = session.plan[0];
  const auto rule = [&](double way) {
    return decide_on_touch(rx90(), session, decoding, step, reading_out_by(rx90(), step.touch, way),
                           0.01, 1e-4);
  };
  EXPECT_EQ(rule(0.9e-4).outcome, TouchOutcome::taken);
  EXPECT_EQ(rule(-0.9e-4).outcome, TouchOutcome::taken);
  EXPECT_EQ(rule(1.1e-4).outcome, TouchOutcome::differs);
  EXPECT_EQ(rule(-1.1e-4).outcome, TouchOutcome::differs);
  EXPECT_THAT(rule(1.1e-4).why, HasSubstr("110 um"));
}

TEST(StepsOf, KeepsThePlanInItsOrder) {
  TouchPlan plan;
  PlannedTouch touch;
  touch.start = touch.touch = touch.end = Eigen::VectorXd::Constant(6, 0.25);
  touch.check = true;
  plan.touches.push_back(touch);
  touch.set = 1;
  touch.group = 2;
  touch.check = false;
  touch.via_home = true;
  touch.way = {Eigen::VectorXd::Constant(6, 0.5)};
  plan.touches.push_back(touch);
  const auto steps = steps_of(plan, two_planes().sets);
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].set, "near");
  EXPECT_EQ(steps[0].group, "");
  EXPECT_TRUE(steps[0].check && !steps[0].via_home);
  EXPECT_EQ(steps[1].index, 1);
  EXPECT_EQ(steps[1].set, "far");
  EXPECT_EQ(steps[1].group, "g2");
  EXPECT_TRUE(!steps[1].check && steps[1].via_home);
  EXPECT_EQ(steps[1].way, std::vector(1, std::vector<double>(6, 0.5)));
  EXPECT_EQ(steps[1].end, std::vector<double>(6, 0.25));
}

}  // namespace
}  // namespace selfcal
