// What goes wrong in a session, and what the state machine makes of it.
#include <gmock/gmock.h>

#include "tests/service/script.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using What = Event::What;
using Do = Action::Do;

/// A fault as it has to be: the robot is stopped before anything else, and both say why.
void expect_fault(const Script& script, const std::string& why) {
  EXPECT_EQ(script.s.state, ServiceState::fault);
  EXPECT_EQ(script.s.phase, Phase::none);
  EXPECT_THAT(script.done(), StartsWith("stop, give_up, tell"));
  EXPECT_THAT(script.why(Do::stop), HasSubstr(why));
  EXPECT_THAT(script.s.why, HasSubstr(why));
}

TEST(Transition, StopsAndSaysWhyWhenAPortBreaksInAnyState) {
  for (const ServiceState state : kAllStates) {
    if (state == ServiceState::fault) continue;
    Script script = script_at(state);
    expect_fault(script.on(What::broken, false, "no encoder reading for 0.5 s"),
                 "no encoder reading for 0.5 s");
    const bool collected = state == ServiceState::collecting || state == ServiceState::analysing ||
                           state == ServiceState::identifying || state == ServiceState::judging ||
                           state == ServiceState::awaiting_person;
    EXPECT_EQ(script.s.unfinished, collected) << to_string(state);
  }
  for (const Phase phase : kAllPhases)
    expect_fault(
        script_at(ServiceState::collecting, phase).on(What::broken, false, "the bus is down"),
        "the bus is down");
}

TEST(Transition, KeepsTheFirstReasonOfAFault) {
  Script script = script_at(ServiceState::fault);
  EXPECT_EQ(script.on(What::broken, false, "another").done(), "");
  EXPECT_EQ(script.s.why, "no reading");
}

TEST(Transition, KeepsAnUnfinishedSessionWhenPlanningItsResumptionFails) {
  Script script;
  script.s.unfinished = true;
  script.on(What::self_tested).ask(Verb::start);
  Event planned;
  planned.what = What::planned;
  planned.ok = false;
  planned.why = "no free way home";
  expect_fault(script.on(planned), "no free way home");
  EXPECT_TRUE(script.s.unfinished);
}

TEST(Transition, KnowsASessionThatIsInTheStoreThoughItDoesNotBegin) {
  for (const ServiceState state : {ServiceState::planning, ServiceState::diagnosing}) {
    Script script = script_at(state);
    Event planned;
    planned.what = What::planned;
    planned.ok = false;
    planned.session = 9;
    planned.why = "the robot does not stand still";
    expect_fault(script.on(planned), "the robot does not stand still");
    EXPECT_EQ(script.s.session, 9);
    EXPECT_TRUE(script.s.unfinished) << "a person resumes or aborts it";
  }
}

TEST(Transition, PostponesWhatNobodyAskedForUntilTheRobotStands) {
  Event due, planned;
  due.what = What::due;
  due.why = "every night";
  planned.what = What::planned;
  planned.ok = false;
  planned.later = true;
  planned.session = 9;
  planned.why = "the robot does not stand still";
  Script script = script_at(ServiceState::idle);
  script.on(due).on(planned);
  EXPECT_EQ(script.s.state, ServiceState::idle);
  EXPECT_TRUE(script.s.postponed);
  EXPECT_FALSE(script.s.held);
  EXPECT_EQ(script.on(due).done(), "tell, resume");
  EXPECT_FALSE(script.s.postponed);

  Script commanded = script_at(ServiceState::idle);
  expect_fault(commanded.ask(Verb::start).on(planned), "the robot does not stand still");
  planned.later = false;
  planned.why = "no free way home";
  expect_fault(script.on(planned), "no free way home");
}

TEST(Transition, NamesATriggerThatStaysClosedAfterTheRetract) {
  Script script = script_at(ServiceState::collecting, Phase::retract);
  script.on(What::moved).after(script.limits.retract + kSecond);
  expect_fault(script, "the trigger is stuck closed: opening after touch 1 of 5");
  EXPECT_TRUE(script.s.unfinished);
}

TEST(Transition, RefusesToTouchWithAClosedTrigger) {
  Script script = script_at(ServiceState::planning);
  expect_fault(script.on(What::closed).planned(5), "the trigger is closed away from any touch");

  Script in_it = script_at(ServiceState::planning);
  in_it.on(What::closed).planned(5, SessionKind::full, 0, false);
  EXPECT_EQ(in_it.done(), "go_to_start") << "the way out of the touch that it was in";
  expect_fault(in_it.on(What::moved), "the trigger is closed before touch 1 of 5: it is stuck");
}

TEST(Transition, BacksOffFromAContactOnTheWayAndTriesAgainThroughHome) {
  Script script = script_at(ServiceState::collecting, Phase::approach);
  EXPECT_EQ(script.on(What::closed).done(), "stop");
  EXPECT_EQ(script.s.phase, Phase::settle);
  EXPECT_EQ(script.on(What::at_rest).done(), "tell, back_off");
  EXPECT_EQ(script.on(What::moved).done(), "") << "the trigger has not opened";
  EXPECT_EQ(script.on(What::opened).done(), "go_home");
  EXPECT_EQ(script.on(What::moved).done(), "go_to_start");
  EXPECT_EQ(script.on(What::moved).done(), "go_touch") << "the way was free this time";
}

TEST(Transition, GivesUpAWayOnWhichTheTriggerClosesAgainAndAgain) {
  Script script = script_at(ServiceState::collecting, Phase::approach);
  for (int i = 0; i < script.limits.attempts; ++i) {
    ASSERT_EQ(script.s.state, ServiceState::collecting) << "attempt " << i;
    script.on(What::closed).on(What::at_rest).on(What::moved).on(What::opened);
  }
  expect_fault(script, "something stands in the way");
}

TEST(Transition, CountsStrayContactsOfOneStepOnly) {
  Script script = script_at(ServiceState::collecting, Phase::approach);
  for (int touch = 1; touch < 4; ++touch) {
    for (int i = 0; i + 1 < script.limits.attempts; ++i)
      script.on(What::closed).on(What::at_rest).on(What::moved).on(What::opened);
    script.touch_well(touch);
    ASSERT_EQ(script.s.state, ServiceState::collecting);
    ASSERT_EQ(script.s.step, touch);
  }
}

TEST(Transition, StopsWhenAMotionIsRefused) {
  for (const Phase phase : kAllPhases) {
    Script script = script_at(ServiceState::collecting, phase);
    expect_fault(script.on(What::refused, false, "the drives are off"),
                 "motion to touch 1 of 5 was refused: the drives are off");
  }
}

TEST(Transition, HasATimeLimitForEachPartOfASession) {
  const Limits limits;
  const auto late = [](Script script, Nanoseconds limit, const std::string& why) {
    EXPECT_EQ(script.after(limit - kMillisecond - kSecond).done(), "") << why;
    expect_fault(script.after(kSecond + kMillisecond), why);
  };
  late(Script(), limits.self_test + kSecond, "the self-test took longer than 11 s");
  late(script_at(ServiceState::planning), limits.planning, "planning took longer than 120 s");
  late(script_at(ServiceState::analysing), limits.computing, "analysing took longer");
  late(script_at(ServiceState::identifying), limits.computing, "identifying took longer");
  late(script_at(ServiceState::judging), limits.computing, "judging took longer");
  const auto in = [](Phase phase) { return script_at(ServiceState::collecting, phase); };
  late(in(Phase::approach), limits.approach, "the way to touch 1 of 5 took longer than 60 s");
  late(in(Phase::touch), limits.touch, "touch 1 of 5 took longer than 60 s");
  late(in(Phase::settle), limits.settle, "coming to rest after touch 1 of 5 took longer than 2 s");
  late(in(Phase::retract), limits.retract, "stuck closed");
  late(in(Phase::retract).on(What::opened), limits.retract, "the way out of touch 1 of 5");
}

TEST(Transition, StopsWhereTheFirstTouchesFeelNothingAtAll) {
  Script script = script_at(ServiceState::collecting, Phase::touch);
  script.on(What::moved);
  expect_fault(script.read(false, 1, "no touch"), "no touch has been felt");
}

TEST(Transition, BacksOutOfTheContactInWhichASessionIsResumedAndGoesHome) {
  Script script = script_at(ServiceState::planning);
  Event event;
  event.what = What::planned;
  event.steps = 5;
  event.step = 2;
  event.via_home = event.back_off = true;
  const Transition first = step(script.on(What::closed).s, event, script.limits);
  EXPECT_EQ(first.next.phase, Phase::retract);
  EXPECT_EQ(first.actions.front().what, Action::Do::back_off);
  script.s = first.next;
  EXPECT_EQ(script.on(What::moved).done(), "");
  EXPECT_EQ(script.on(What::opened).done(), "go_home");
  EXPECT_EQ(script.s.step, 2);
}

TEST(Transition, PutsATouchAsideThatMeetsNothingAndGoesOn) {
  Script script = script_at(ServiceState::collecting, Phase::touch);
  script.s.felt = true;  // an earlier one was
  EXPECT_EQ(script.on(What::moved).done(), "put_aside");
  EXPECT_THAT(script.why(Do::outlier), HasSubstr("no touch"));
  EXPECT_EQ(script.read(false, 0, "no touch").done(), "go_back");  // an attempt is left
  EXPECT_EQ(script.on(What::moved).done(), "go_touch");
  EXPECT_EQ(script.on(What::moved).done(), "put_aside");
  EXPECT_EQ(script.read(false, 1, "no touch").done(), "go_back");  // none is
  EXPECT_EQ(script.on(What::moved).done(), "go_to_start");
  EXPECT_EQ(script.s.step, 1);
  EXPECT_EQ(script.s.lost_in_a_row, 1);
}

TEST(Transition, StopsAfterTooManyTouchesPutAsideInARow) {
  Script script = script_at(ServiceState::planning);
  script.planned(20, SessionKind::full, 0, false);
  script.s.felt = true;
  for (int i = 0; i < script.limits.most_failures; ++i) {
    ASSERT_EQ(script.s.state, ServiceState::collecting) << i;
    script.on(What::moved).on(What::moved).read(false, i + 1, "no touch").on(What::moved);
  }
  EXPECT_EQ(script.s.state, ServiceState::fault);
  EXPECT_EQ(script.s.why, "5 touches in a row gave nothing; the last: no touch");
  EXPECT_TRUE(script.s.unfinished);
}

TEST(Transition, ForgivesLostTouchesAfterAGoodOne) {
  Script script = script_at(ServiceState::planning);
  script.planned(20, SessionKind::full, 0, false);
  script.s.felt = true;
  for (int i = 0; i < script.limits.most_failures - 1; ++i)
    script.on(What::moved).on(What::moved).read(false, i + 1).on(What::moved);
  script.touch_well(script.s.step + 1);
  EXPECT_EQ(script.s.lost_in_a_row, 0);
  EXPECT_EQ(script.s.state, ServiceState::collecting);
}

TEST(Transition, EndsASessionThatCannotBeComputed) {
  Script script = script_at(ServiceState::analysing);
  expect_fault(script.on(What::computed, false, "set table has only 2 good touches"), "table");
  EXPECT_EQ(script.done(), "stop, give_up, tell, abort");
  EXPECT_FALSE(script.s.unfinished) << "the same rows would fail again";
}

TEST(Transition, TestsItselfAgainAfterAFaultButMovesOnlyWhenAPersonSaysStart) {
  Script script = script_at(ServiceState::collecting, Phase::touch);
  script.on(What::broken, false, "the bus is down");
  EXPECT_EQ(script.after(script.limits.retry_self_test + kSecond).done(), "test");
  EXPECT_EQ(script.on(What::self_tested).done(), "");
  EXPECT_EQ(script.s.state, ServiceState::idle);
  Event due;
  due.what = What::due;
  EXPECT_EQ(script.on(due).done(), "") << "a schedule is no person";
  EXPECT_EQ(script.ask(Verb::start).done(), "grant, tell, resume");
}

TEST(Transition, FollowsItsScheduleAgainAfterAFaultThatAPersonHasSeen) {
  Script script = script_at(ServiceState::idle);
  script.on(What::broken, false, "store: disk full").ask(Verb::start).on(What::self_tested);
  Event due;
  due.what = What::due;
  EXPECT_EQ(script.on(due).done(), "plan");
}

TEST(Transition, ResumesByItselfAfterAPowerCutEvenIfTheEncodersComeUpLate) {
  Script script;
  script.s.unfinished = true;
  script.on(What::self_tested, false, "no encoder readings come in");
  expect_fault(script, "self-test: no encoder readings come in");
  script.after(script.limits.retry_self_test + kSecond);
  Event tested;
  tested.what = What::self_tested;
  tested.resume = true;
  EXPECT_EQ(script.on(tested).done(), "tell, resume");
}

}  // namespace
}  // namespace selfcal
