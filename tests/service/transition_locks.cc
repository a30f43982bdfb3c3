// Configurations with a joint locked: what is asked of the robot, and how it ends.
#include <gmock/gmock.h>

#include "tests/service/script.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using What = Event::What;
using Do = Action::Do;

constexpr int kFirstLock = 1, kSecondLock = 2;

/// What the store says after a visit; the next step wants `lock`.
Event lock_read(int next, int lock, bool ok = true) {
  Event event;
  event.what = What::read;
  event.ok = ok;
  event.step = next;
  event.lock = lock;
  return event;
}

/// On its way to the first of three steps under locks.
Script script_of_locks(bool release = false) {
  Script script = script_at(ServiceState::planning);
  Event planned;
  planned.what = What::planned;
  planned.steps = 3;
  planned.lock = kFirstLock;
  planned.release = release;
  return script.on(planned);
}

Script engaged_script() {
  Script script = script_of_locks();
  script.on(What::moved);
  return script.on(What::moved).on(What::closed);
}

TEST(TransitionLocks, AsksForTheLockAndVisitsOnceReplyAndTriggerConfirmIt) {
  Script script = script_of_locks();
  EXPECT_EQ(script.on(What::moved).done(), "lock");
  EXPECT_EQ(script.on(What::closed).done(), "");
  EXPECT_EQ(script.on(What::moved).done(), "visit");
  EXPECT_EQ(script.s.phase, Phase::visit);
}

TEST(TransitionLocks, ReleasesBetweenTwoLocksAndAfterTheLast) {
  Script script = engaged_script();
  script.on(What::moved);
  EXPECT_EQ(script.on(What::at_rest).done(), "read");
  EXPECT_EQ(script.on(lock_read(1, kFirstLock)).done(), "visit");
  script.on(What::moved).on(What::at_rest);
  EXPECT_EQ(script.on(lock_read(2, kSecondLock)).done(), "release");
  EXPECT_EQ(script.on(What::moved).done(), "");
  EXPECT_EQ(script.on(What::opened).done(), "go_to_start");
  script.on(What::moved).on(What::moved).on(What::closed).on(What::moved).on(What::at_rest);
  EXPECT_EQ(script.on(lock_read(3, 0)).done(), "release");
  script.on(What::opened);
  EXPECT_EQ(script.on(What::moved).done(), "analyse");
}

TEST(TransitionLocks, StopsThenReleasesWhenTheLockOpensByItself) {
  Script script = engaged_script();
  EXPECT_EQ(script.on(What::opened).done(), "stop, release, give_up, tell");
  EXPECT_THAT(script.s.why, HasSubstr("the lock opened by itself at configuration 1 of 3"));
  EXPECT_TRUE(script.s.unfinished);
}

TEST(TransitionLocks, StopsThenReleasesWhenTheConfirmationDoesNotCome) {
  Script script = script_of_locks();
  script.on(What::moved).on(What::moved).after(script.limits.lock + kSecond);
  EXPECT_EQ(script.done(), "stop, release, give_up, tell");
  EXPECT_THAT(script.s.why, HasSubstr("the lock's confirmation by the trigger"));
}

TEST(TransitionLocks, NamesALockThatIsRefused) {
  Script script = script_of_locks();
  script.on(What::moved).on(What::refused, false, "no such lock");
  EXPECT_THAT(script.s.why,
              HasSubstr("the lock for configuration 1 of 3 was refused: no such lock"));
}

TEST(TransitionLocks, NamesALockThatIsNotReleased) {
  Script script = engaged_script();
  script.on(What::moved).on(What::at_rest).on(lock_read(3, 0));
  script.on(What::moved).after(script.limits.lock + kSecond);
  EXPECT_THAT(script.s.why, HasSubstr("the lock stays closed"));
}

TEST(TransitionLocks, ReleasesAfterTheStopOfAnAbort) {
  EXPECT_EQ(engaged_script().ask(Verb::abort).done(), "grant, stop, release, abort");
}

TEST(TransitionLocks, ReleasesBeforeAnythingElseWhenASessionGoesOn) {
  Script script = script_of_locks(true);
  EXPECT_EQ(script.done(), "release");
  EXPECT_EQ(script.on(What::moved).done(), "go_to_start");
}

}  // namespace
}  // namespace selfcal
