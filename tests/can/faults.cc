// What the controller reports, and what is said of it.
#include "io/can/faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can/error.h>

namespace selfcal {
namespace {

using testing::IsEmpty;

CanFrame report(std::uint32_t classes, std::uint8_t controller = 0) {
  CanFrame frame;
  frame.error = true;
  frame.id.value = classes;
  frame.size = 8;
  frame.data[1] = controller;
  return frame;
}

class CanFaultsTest : public testing::Test {
 protected:
  Nanoseconds now = 100 * kSecond;
  CanFaults faults{"can0"};
};

TEST_F(CanFaultsTest, SayBusOffUntilTheRestart) {
  faults.note_error_frame(report(CAN_ERR_BUSOFF), now);
  EXPECT_EQ(faults.trouble(now + 3600 * kSecond), "can0: the controller is off the bus");
  faults.note_error_frame(report(CAN_ERR_RESTARTED), now + kSecond);
  EXPECT_EQ(faults.trouble(now + kSecond), "can0: the controller restarted");
  EXPECT_THAT(faults.trouble(now + 4 * kSecond), IsEmpty());
  EXPECT_EQ(faults.count(CanFault::bus_off), 1u);
  EXPECT_EQ(faults.count(CanFault::restarted), 1u);
  EXPECT_EQ(faults.count(CanFault::error_frame), 2u);
}

TEST_F(CanFaultsTest, SayErrorPassiveUntilItIsActiveAgain) {
  faults.note_error_frame(report(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE), now);
  faults.note_error_frame(report(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE), now);
  EXPECT_EQ(faults.trouble(now + 60 * kSecond), "can0: the controller is error passive");
  EXPECT_EQ(faults.count(CanFault::error_passive), 1u);
  faults.note_error_frame(report(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE), now);
  EXPECT_THAT(faults.trouble(now), IsEmpty());
}

TEST_F(CanFaultsTest, CountAnOverflowInTheController) {
  faults.note_error_frame(report(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW), now);
  EXPECT_EQ(faults.count(CanFault::overrun), 1u);
  EXPECT_EQ(faults.trouble(now),
            "can0: frames were lost in the queue (in the controller, how many is not known)");
}

TEST_F(CanFaultsTest, TakeASingleErrorForAnAccidentAndManyForTrouble) {
  faults.note_error_frame(report(CAN_ERR_PROT | CAN_ERR_BUSERROR), now);
  EXPECT_THAT(faults.trouble(now), IsEmpty());
  for (int i = 0; i < 20; ++i)
    faults.note_error_frame(report(CAN_ERR_PROT), now + i * 10 * kMillisecond);
  EXPECT_EQ(faults.trouble(now + kSecond / 5), "can0: errors on the bus");
}

TEST_F(CanFaultsTest, TellOfAStepOfTheWallClockForAWhile) {
  faults.note(CanFault::time_stepped, now);
  EXPECT_EQ(faults.trouble(now), "can0: the wall clock stepped");
  EXPECT_THAT(faults.trouble(now + 2 * kSecond), IsEmpty());
  EXPECT_EQ(faults.count(CanFault::time_stepped), 1u);
}

TEST_F(CanFaultsTest, SaySeveralThingsInOneSentence) {
  faults.set(CanFault::interface_down, true, now, "it is gone");
  faults.note(CanFault::jumped, now, "j3");
  EXPECT_EQ(faults.trouble(now), "can0: a counter jumped (j3); the interface is down (it is gone)");
}

TEST_F(CanFaultsTest, TallyEveryFaultByItsName) {
  faults.note(CanFault::overrun, now, "", 5);
  const auto tallies = faults.tallies();
  ASSERT_EQ(tallies.size(), static_cast<std::size_t>(kCanFaults));
  for (const Tally& tally : tallies) {
    EXPECT_FALSE(tally.name.empty());
    EXPECT_EQ(tally.count, tally.name == "overrun" ? 5u : 0u);
  }
  EXPECT_EQ(to_string(CanFault::time_stepped), "time_stepped");
}

}  // namespace
}  // namespace selfcal
