// The sockets against the real kernel.
#include <gmock/gmock.h>
#include <linux/can.h>

#include "io/clock.h"
#include "tests/can/interface.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

CanFrame frame_of(std::uint32_t id, std::uint8_t first_byte, bool extended = false) {
  CanFrame frame;
  frame.id = {.value = id, .extended = extended};
  frame.size = 4;
  frame.data[0] = first_byte;
  return frame;
}

class CanSockets : public CanInterfaceTest {};

TEST_F(CanSockets, LetOnlyTheIdsInUseIn) {
  auto receiver = must(CanReceiver::open(
      {.interface = interface_,
       .ids = {{.value = 0x181, .extended = false}, {.value = 0x18ff0102, .extended = true}}}));
  auto sender = must(CanSender::open(robot_interface_, false));
  settle(receiver, sender, {.value = 0x181});
  must(sender.send(frame_of(0x182, 1)));
  must(sender.send(frame_of(0x181, 2, true)));
  must(sender.send(frame_of(0x102, 3)));
  // An emulated SJA1000 never gets over a remote frame.
  if (is_virtual()) must(sender.send(frame_of(0x181 | CAN_RTR_FLAG, 4)));
  must(sender.send(frame_of(0x181, 5)));
  must(sender.send(frame_of(0x18ff0102, 6, true)));

  const auto frames = read_frames(receiver, 2);

  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].id, (CanId{.value = 0x181, .extended = false}));
  EXPECT_EQ(frames[0].data[0], 5);
  EXPECT_EQ(frames[0].size, 4);
  EXPECT_EQ(frames[1].id, (CanId{.value = 0x18ff0102, .extended = true}));
  EXPECT_EQ(frames[1].data[0], 6);
}

TEST_F(CanSockets, GiveTheKernelsStampsHoweverLateTheyAreRead) {
  auto receiver = must(CanReceiver::open({.interface = interface_, .ids = {{.value = 0x181}}}));
  auto sender = must(CanSender::open(robot_interface_, false));
  settle(receiver, sender, {.value = 0x181});
  const Nanoseconds before = realtime_now();
  must(sender.send(frame_of(0x181, 1)));
  const Nanoseconds limit = 50 * kMillisecond, after = realtime_now();
  EXPECT_TRUE(eventually([&] { return realtime_now() > after + limit; }));

  const auto frames = read_frames(receiver, 1);

  ASSERT_EQ(frames.size(), 1u);
  EXPECT_GE(frames[0].stamp, before);
  // On a bus of wires the frame is on its way for a while; in the kernel alone it is not.
  EXPECT_LE(frames[0].stamp, is_virtual() ? after : after + limit);
}

TEST_F(CanSockets, SayHowManyFramesWereLostInTheQueue) {
  if (!is_virtual()) GTEST_SKIP() << interface_ << " sends slower than its queue fills";
  auto receiver = must(CanReceiver::open(
      {.interface = interface_, .ids = {{.value = 0x181}}, .receive_buffer = 8192}));
  auto sender = must(CanSender::open(robot_interface_, false));
  settle(receiver, sender, {.value = 0x181});
  constexpr int kSent = 500;
  for (int i = 0; i < kSent; ++i) must(sender.send(frame_of(0x181, 0)));
  must(sender.send(frame_of(0x181, 9)));
  // The last frame finds no room either, until some are read.
  std::vector<CanFrame> frames;
  int sent = kSent + 1;
  EXPECT_TRUE(eventually([&] {
    must(receiver.read(frames));
    if (!frames.empty() && frames.back().data[0] == 9) return true;
    must(sender.send(frame_of(0x181, 9)));
    ++sent;
    return false;
  }));
  // Some of the last ones may still be on their way.
  EXPECT_TRUE(eventually([&] {
    must(receiver.read(frames));
    std::size_t known = frames.size();
    for (const CanFrame& frame : frames) known += frame.lost;
    return known == static_cast<std::size_t>(sent);
  }));
  EXPECT_LT(frames.size(), kSent);
}

TEST_F(CanSockets, CarryFdFrames) {
  if (mtu() < static_cast<int>(CANFD_MTU)) GTEST_SKIP() << interface_ << " carries no FD frames";
  auto classic = must(CanReceiver::open({.interface = interface_, .ids = {{.value = 0x181}}}));
  auto both =
      must(CanReceiver::open({.interface = interface_, .ids = {{.value = 0x181}}, .fd = true}));
  auto sender = must(CanSender::open(robot_interface_, true));
  settle(classic, sender, {.value = 0x181});
  settle(both, sender, {.value = 0x181});
  std::vector<CanFrame> settling;
  must(classic.read(settling));
  CanFrame fd = frame_of(0x181, 1);
  fd.fd = true;
  fd.size = 64;
  fd.data[63] = 0xab;
  must(sender.send(fd));
  must(sender.send(frame_of(0x181, 2)));

  const auto heard = read_frames(both, 2);
  const auto heard_classic = read_frames(classic, 2);

  ASSERT_EQ(heard.size(), 2u);
  EXPECT_TRUE(heard[0].fd);
  EXPECT_EQ(heard[0].size, 64);
  EXPECT_EQ(heard[0].data[63], 0xab);
  EXPECT_FALSE(heard[1].fd);
  // Where none are meant they are heard too, so that the map can say what is wrong.
  ASSERT_EQ(heard_classic.size(), 2u);
  EXPECT_TRUE(heard_classic[0].fd);
  EXPECT_EQ(heard_classic[1].data[0], 2);
}

TEST_F(CanSockets, RefuseFdWhereTheInterfaceHasNone) {
  if (mtu() > static_cast<int>(CAN_MTU) && !(set_up(false) && set_mtu(CAN_MTU) && set_up(true)))
    GTEST_SKIP() << "may not change " << interface_;
  const auto receiver = CanReceiver::open({.interface = interface_, .ids = {}, .fd = true});
  ASSERT_FALSE(receiver);
  EXPECT_EQ(receiver.error().exit_status, kDeviceFailed);
  EXPECT_THAT(receiver.error().what, HasSubstr(interface_ + " carries no FD frames"));
}

TEST_F(CanSockets, NameAnInterfaceThatIsNotThere) {
  const auto receiver = CanReceiver::open({.interface = "nocan7", .ids = {}});
  ASSERT_FALSE(receiver);
  EXPECT_EQ(receiver.error().exit_status, kDeviceFailed);
  EXPECT_THAT(receiver.error().what, HasSubstr("nocan7"));
  EXPECT_FALSE(CanReceiver::open({.interface = "lo", .ids = {}}));
}

TEST_F(CanSockets, TellReportsOfTheControllerFromFrames) {
  if (!is_virtual()) GTEST_SKIP() << interface_ << " makes its reports itself";
  auto receiver = must(CanReceiver::open({.interface = interface_, .ids = {{.value = 0x181}}}));
  auto deaf = must(
      CanReceiver::open({.interface = interface_, .ids = {{.value = 0x181}}, .errors = false}));
  auto sender = must(CanSender::open(robot_interface_, false));
  settle(receiver, sender, {.value = 0x181});
  settle(deaf, sender, {.value = 0x181});
  std::vector<CanFrame> settling;
  must(receiver.read(settling));
  CanFrame report = frame_of(0x40, 0);  // CAN_ERR_BUSOFF
  report.error = true;
  report.size = 8;
  must(sender.send(report));
  must(sender.send(frame_of(0x181, 7)));

  const auto frames = read_frames(receiver, 2);
  const auto without = read_frames(deaf, 1);

  ASSERT_EQ(frames.size(), 2u);
  EXPECT_TRUE(frames[0].error);
  EXPECT_EQ(frames[0].id.value, 0x40u);
  EXPECT_FALSE(frames[1].error);
  ASSERT_EQ(without.size(), 1u);
  EXPECT_EQ(without[0].data[0], 7);
}

}  // namespace
}  // namespace selfcal
