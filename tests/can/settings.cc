// The configuration of encoders on CAN: what is read, and every mistake with file and line.
#include "io/can/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "io/files/yaml.h"
#include "tests/io/scratch.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
constexpr double kTurn = 2 * std::numbers::pi;

struct Read {
  CanSettings settings;
  Problems problems;
};

constexpr Quantity kTurns = Quantity::angle, kSlides = Quantity::length;

Read read(const std::string& text, const std::filesystem::path& folder = {},
          Quantity first = kTurns, Quantity second = kTurns) {
  const std::vector<Joint> joints = {{.name = "j1", .quantity = first},
                                     {.name = "j2", .quantity = second}};
  Read read;
  const auto node = parse_yaml(text, "cell.yaml");
  EXPECT_TRUE(node) << node.error().what;
  if (node) read.settings = read_can_settings(*node, joints, folder, read.problems);
  return read;
}

TEST(CanSettings, ReadAPlainMap) {
  const Read r = read(R"(
interface: can0
cycle: 0.002
joints:
  j2: {id: 0x18FF0102, extended: true, bit: 7, bits: 20, endian: big, signed: false,
       counts_per_turn: 1048576, wraps_at: 1048576, speed: 3}
  j1: {id: 385, byte: 2, length: 3, counts_per_turn: 4096, gear: 50, zero: -17, sign: -1}
)");
  ASSERT_THAT(r.problems.list, IsEmpty());
  const CanSettings& s = r.settings;
  EXPECT_EQ(s.interface, "can0");
  EXPECT_EQ(s.timing.cycle, 0.002);
  EXPECT_DOUBLE_EQ(s.timing.window, 0.0032);
  EXPECT_EQ(s.sync_send_period, 0);
  EXPECT_FALSE(s.map.sync);
  ASSERT_EQ(s.map.joints.size(), 2u);
  const CanJoint &j1 = s.map.joints[0], &j2 = s.map.joints[1];
  EXPECT_EQ(j1.id, (CanId{.value = 0x181, .extended = false}));
  EXPECT_EQ(j1.field.start, 16);
  EXPECT_EQ(j1.field.bits, 24);
  EXPECT_DOUBLE_EQ(j1.scale.step, -kTurn / (4096 * 50));
  EXPECT_EQ(j1.scale.zero, -17);
  EXPECT_EQ(j2.id, (CanId{.value = 0x18ff0102, .extended = true}));
  EXPECT_TRUE(j2.field.big_endian);
  EXPECT_FALSE(j2.field.is_signed);
  EXPECT_EQ(j2.field.start, 7);
  EXPECT_EQ(j2.wraps_at, 1048576);
  EXPECT_EQ(j2.most_speed, 3);
}

TEST(CanSettings, KnowCia402WithSync) {
  const Read r = read(R"(
interface: can0
joints:
  j1: {cia402: {node: 1}, counts_per_turn: 65536}
  j2: {cia402: {node: 2, tpdo: 3, byte: 2}, counts_per_turn: 65536, pitch: 0.005}
)",
                      {}, kTurns, kSlides);
  ASSERT_THAT(r.problems.list, IsEmpty());
  const CanMap& map = r.settings.map;
  EXPECT_EQ(map.sync, (CanId{.value = 0x80, .extended = false}));
  EXPECT_EQ(map.joints[0].id.value, 0x181u);
  EXPECT_EQ(map.joints[1].id.value, 0x382u);
  EXPECT_EQ(map.messages[1].bytes, 6);  // status word, then the position
  EXPECT_DOUBLE_EQ(map.joints[1].scale.step, 0.005 / 65536);
  EXPECT_EQ(r.settings.sync_send_period, 0);
}

TEST(CanSettings, SendSyncOnlyWhereTold) {
  const std::string joints =
      "joints: {j1: {cia402: {node: 1}, counts_per_turn: 8}, j2: {cia402: {node: 2}, "
      "counts_per_turn: 8}}\n";
  const Read silent = read("interface: can0\nsync: {id: 0x90}\n" + joints);
  const Read told = read("interface: can0\nsync: {send_period: 0.01}\n" + joints);
  const Read free = read("interface: can0\ncycle: 0.01\n" + joints);
  ASSERT_THAT(silent.problems.list, IsEmpty());
  ASSERT_THAT(told.problems.list, IsEmpty());
  ASSERT_THAT(free.problems.list, IsEmpty());
  EXPECT_EQ(silent.settings.map.sync->value, 0x90u);
  EXPECT_EQ(silent.settings.sync_send_period, 0);
  EXPECT_EQ(told.settings.map.sync->value, 0x80u);
  EXPECT_EQ(told.settings.sync_send_period, 0.01);
  EXPECT_FALSE(free.settings.map.sync);
}

constexpr const char* kDbc = R"(BO_ 496 Axes: 8 DRIVE
 SG_ One : 7|16@0- (0.01,-180) [0|0] "deg" PC
 SG_ Two : 16|16@1+ (0.5,0) [0|0] "" PC
 SG_ Three m0 : 32|8@1+ (1,0) [0|0] "" PC
 SG_ Four : 32|32@1- (1,0) [0|0] "" PC
 SG_ Five : 0|8@1+ (1e-9,1e100) [0|0] "" PC
 SG_ Six : 0|8@1+ (1e-320,0) [0|0] "" PC
SIG_VALTYPE_ 496 Four : 1;
)";

TEST(CanSettings, TakeJointsFromADbcFile) {
  const Scratch scratch;
  scratch.write("arm.dbc", kDbc);
  const Read r = read(R"(
interface: can0
cycle: 0.01
dbc: arm.dbc
joints:
  j1: {message: Axes, signal: One, unit: deg}
  j2: {message: Axes, signal: Two, unit: counts, counts_per_turn: 1000, sign: -1, zero: 3}
)",
                      scratch.folder());
  ASSERT_THAT(r.problems.list, IsEmpty());
  const auto& joints = r.settings.map.joints;
  EXPECT_EQ(joints[0].id.value, 496u);
  EXPECT_DOUBLE_EQ(joints[0].scale.step, 0.01 * std::numbers::pi / 180);
  EXPECT_EQ(joints[0].scale.zero, 18000);  // 0 deg = 18000 * 0.01 - 180
  EXPECT_DOUBLE_EQ(joints[1].scale.step, -0.5 * kTurn / 1000);
  EXPECT_EQ(joints[1].scale.zero, 3);
  EXPECT_EQ(r.settings.map.messages.size(), 1u);
}

struct WrongSettings {
  const char* name;
  const char* joint;  ///< j1's entry
  const char* message;
  Quantity of_joint = kTurns;
};
class CanSettingsMistake : public testing::TestWithParam<WrongSettings> {};

TEST_P(CanSettingsMistake, IsRefusedWithFileAndLine) {
  const Scratch scratch;
  scratch.write("arm.dbc", kDbc);
  const Read r = read(
      "interface: can0\ncycle: 0.01\ndbc: arm.dbc\njoints:\n"
      "  j2: {id: 0x182, counts_per_turn: 8}\n  j1: " +
          std::string(GetParam().joint) + "\n",
      scratch.folder(), GetParam().of_joint);
  ASSERT_TRUE(r.problems.any());
  EXPECT_THAT(r.problems.list[0], HasSubstr("cell.yaml:6: joint j1"));
  EXPECT_THAT(r.problems.list[0], HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Each, CanSettingsMistake,
    testing::Values(
        WrongSettings{"NoPlace", "{counts_per_turn: 8}", "one of 'id', 'cia402' and 'message'"},
        WrongSettings{"TwoPlaces", "{id: 1, cia402: {node: 1}, counts_per_turn: 8}", "one of 'id'"},
        WrongSettings{"LargeId", "{id: 0x800, counts_per_turn: 8}", "a CAN id of at most 0x7ff"},
        WrongSettings{"LargerId", "{id: 0x20000000, extended: true, counts_per_turn: 8}",
                      "at most 0x1fffffffx"},
        WrongSettings{"NoNumber", "{id: 0x18g, counts_per_turn: 8}", "a CAN id"},
        WrongSettings{"Length", "{id: 1, length: 9, counts_per_turn: 8}", "from 1 to 8"},
        WrongSettings{"BitAndByte", "{id: 1, bit: 0, bits: 8, byte: 1, counts_per_turn: 8}",
                      "only without 'bit'"},
        WrongSettings{"NoBits", "{id: 1, bit: 0, counts_per_turn: 8}", "'bits' is missing"},
        WrongSettings{"Endian", "{id: 1, endian: middle, counts_per_turn: 8}", "little or big"},
        WrongSettings{"NoCounts", "{id: 1}", "'counts_per_turn' is missing"},
        WrongSettings{"Gear", "{id: 1, counts_per_turn: 8, gear: 0}", "a positive number"},
        WrongSettings{"Sign", "{id: 1, counts_per_turn: 8, sign: 0}", "1 or -1"},
        WrongSettings{"Zero", "{id: 1, counts_per_turn: 8, zero: 0.5}", "a whole number"},
        WrongSettings{"Wraps", "{id: 1, length: 2, counts_per_turn: 8, wraps_at: 65537}",
                      "can count"},
        WrongSettings{"Unknown", "{id: 1, counts_per_turn: 8, bite: 2}", "unknown key 'bite'"},
        WrongSettings{"Node", "{cia402: {node: 128}, counts_per_turn: 8}", "from 1 to 127"},
        WrongSettings{"NoNode", "{cia402: {tpdo: 1}, counts_per_turn: 8}", "'node' is missing"},
        WrongSettings{"NoMessage", "{message: Axis, signal: One, unit: deg}", "a message of"},
        WrongSettings{"NoSignal", "{message: Axes, signal: Ten, unit: deg}", "arm.dbc:1"},
        WrongSettings{"Multiplexed", "{message: Axes, signal: Three, unit: deg}",
                      "not multiplexed"},
        WrongSettings{"Floating", "{message: Axes, signal: Four, unit: deg}", "not floating point"},
        WrongSettings{"FarZero", "{message: Axes, signal: Five, unit: deg}", "at most 2^52 counts"},
        WrongSettings{"FineStep", "{message: Axes, signal: Six, unit: deg}", "1e-15 to 1000 rad"},
        WrongSettings{"CoarseStep", "{id: 1, counts_per_turn: 1.0e-300}", "1e-15 to 1000 rad"},
        WrongSettings{"NoUnit", "{message: Axes, signal: One}", "'unit' is missing"},
        WrongSettings{"Unit", "{message: Axes, signal: One, unit: grad}",
                      "deg, rad or counts, for the joint turns"},
        WrongSettings{"Slide", "{message: Axes, signal: One, unit: mm}",
                      "deg, rad or counts, for the joint turns"},
        WrongSettings{"Turn", "{message: Axes, signal: One, unit: deg}",
                      "m, mm or counts, for the joint slides", kSlides},
        WrongSettings{"Pitch", "{id: 1, counts_per_turn: 8, pitch: 0.01}",
                      "no pitch of a joint that turns"},
        WrongSettings{"NoPitch", "{id: 1, counts_per_turn: 8}", "'pitch' is missing", kSlides}),
    [](const auto& mistake) { return std::string(mistake.param.name); });

TEST(CanSettings, RefuseWhatConcernsTheWholeBus) {
  const auto first = [](const std::string& text) {
    const Read r = read(text);
    return r.problems.any() ? r.problems.list[0] : std::string("no problem");
  };
  const std::string joints =
      "joints: {j1: {id: 1, counts_per_turn: 8}, j2: {id: 2, counts_per_turn: 8}}\n";
  EXPECT_THAT(first("cycle: 0.01\n" + joints), HasSubstr("'interface' is missing"));
  EXPECT_THAT(first("interface: can0\n" + joints), HasSubstr("'cycle' is missing"));
  EXPECT_THAT(first("interface: can0\ncycle: 0.01\nsync: {}\n" + joints),
              HasSubstr("only without 'sync'"));
  EXPECT_THAT(first("interface: a_name_that_is_long\ncycle: 0.01\n" + joints),
              HasSubstr("1 to 15 characters"));
  EXPECT_THAT(first("interface: can0\ncycle: 0.01\n"), HasSubstr("'joints' is missing"));
  EXPECT_THAT(first("interface: can0\ncycle: 0.01\njoints: {j1: {id: 1, counts_per_turn: 8}}\n"),
              HasSubstr("'j2' is missing"));
  EXPECT_THAT(first("interface: can0\ncycle: 0.01\nbitrate: 1\n" + joints),
              HasSubstr("cell.yaml:3: encoders on CAN: unknown key 'bitrate'"));
  EXPECT_THAT(first("interface: can0\ndbc: none.dbc\ncycle: 0.01\n" + joints),
              HasSubstr("none.dbc"));
  EXPECT_THAT(first("interface: can0\ncycle: 0.01\njoints: {j1: {id: 1, byte: 6, "
                    "counts_per_turn: 8}, j2: {id: 2, counts_per_turn: 8}}\n"),
              HasSubstr("joint j1 stands beyond"));
  EXPECT_THAT(first("interface: can0\nsync: {send_period: 5}\n" + joints),
              HasSubstr("send_period"));
}

}  // namespace
}  // namespace selfcal
