// DBC files: what is read, and every mistake with its line.
#include "io/can/dbc.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace selfcal {
namespace {

using testing::HasSubstr;

constexpr const char* kArm = R"(VERSION "1.0"

NS_ :
	CM_
	SIG_VALTYPE_
	SG_MUL_VAL_

BS_:
BU_: DRIVE PC

BO_ 496 ExampleMessage: 8 PCM1
 SG_ Temperature : 0|12@0- (0.01,250) [229.52|270.47] "degK"  PCM1,FOO
 SG_ AverageRadius : 6|6@0+ (0.1,0) [0|5] "m" Vector__XXX

BO_ 2566848770 Axis2: 64 DRIVE
 SG_ Mode M : 0|4@1+ (1,0) [0|15] "" PC
 SG_ Extra m1 : 8|8@1+ (1,0) [0|0] "" PC
 SG_ Position : 16|32@1- (1E-005,-180) [-180|180] "°" PC
 SG_ Torque : 64|32@1- (1,0) [0|0] "Nm" PC

BO_ 3221225472 VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX
 SG_ Left : 0|8@1+ (1,0) [0|0] "" Vector__XXX

BO_TX_BU_ 496 : DRIVE,PC;
CM_ SG_ 496 Temperature "a text over
BO_ lines that are none
 SG_ nor \" this";
SIG_VALTYPE_ 2566848770 Torque : 1;
VAL_ 496 Enable 1 "Enabled" 0 "Disabled" ;
)";

TEST(Dbc, SaysWhereSignalsStand) {
  const auto dbc = parse_dbc(kArm, "arm.dbc");
  ASSERT_TRUE(dbc) << dbc.error().what;
  const DbcMessage* example = dbc->find("ExampleMessage");
  ASSERT_NE(example, nullptr);
  EXPECT_EQ(example->id, (CanId{.value = 0x1f0, .extended = false}));
  EXPECT_EQ(example->bytes, 8);
  const DbcSignal* temperature = find(*example, "Temperature");
  ASSERT_NE(temperature, nullptr);
  EXPECT_EQ(temperature->field.start, 0);
  EXPECT_EQ(temperature->field.bits, 12);
  EXPECT_TRUE(temperature->field.big_endian);
  EXPECT_TRUE(temperature->field.is_signed);
  EXPECT_EQ(temperature->factor, 0.01);
  EXPECT_EQ(temperature->offset, 250);
  EXPECT_EQ(temperature->unit, "degK");
  EXPECT_EQ(temperature->line, 12);
}

TEST(Dbc, KnowsExtendedIdsMultiplexedAndFloatingSignals) {
  const auto dbc = parse_dbc(kArm, "arm.dbc");
  ASSERT_TRUE(dbc) << dbc.error().what;
  const DbcMessage* axis = dbc->find("Axis2");
  ASSERT_NE(axis, nullptr);
  EXPECT_EQ(axis->id, (CanId{.value = 0x18ff0102, .extended = true}));
  EXPECT_FALSE(find(*axis, "Mode")->multiplexed);
  EXPECT_TRUE(find(*axis, "Extra")->multiplexed);
  EXPECT_FALSE(find(*axis, "Position")->floating);
  EXPECT_EQ(find(*axis, "Position")->factor, 1e-5);
  EXPECT_TRUE(find(*axis, "Torque")->floating);
}

TEST(Dbc, ReadsLinesThatEndAsWindowsHasThem) {
  const auto dbc = parse_dbc("BO_ 1 M: 8 X\r\n\r\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" X\r\n", "w.dbc");
  ASSERT_TRUE(dbc) << dbc.error().what;
  EXPECT_NE(find(*dbc->find("M"), "S"), nullptr);
}

struct WrongDbc {
  const char* name;
  const char* text;
  const char* message;
};

class DbcMistake : public testing::TestWithParam<WrongDbc> {};

TEST_P(DbcMistake, IsRefusedWithItsLine) {
  const auto dbc = parse_dbc(GetParam().text, "arm.dbc");
  ASSERT_FALSE(dbc);
  EXPECT_EQ(dbc.error().exit_status, kBadInput);
  EXPECT_THAT(dbc.error().what, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Each, DbcMistake,
    testing::Values(
        WrongDbc{"NoId", "\nBO_ x M: 8 X\n", "arm.dbc:2: expected BO_"},
        WrongDbc{"TooLong", "BO_ 1 M: 65 X\n", "arm.dbc:1: message M: 0 to 64"},
        WrongDbc{"NoCanId", "BO_ 2048 M: 8 X\n", "arm.dbc:1: message M: no CAN id"},
        WrongDbc{"Twice", "BO_ 1 M: 8 X\n\nBO_ 2 M: 8 X\n", "arm.dbc:3: message M is there twice"},
        WrongDbc{"NoMessage", " SG_ S : 0|8@1+ (1,0) [0|0] \"\" X\n", "arm.dbc:1: SG_ without"},
        WrongDbc{"NoBits", "BO_ 1 M: 8 X\n SG_ S : 0@1+ (1,0) [0|0] \"\" X\n",
                 "arm.dbc:2: expected SG_"},
        WrongDbc{"Order", "BO_ 1 M: 8 X\n SG_ S : 0|8@2+ (1,0) [0|0] \"\" X\n",
                 "arm.dbc:2: expected SG_"},
        WrongDbc{"OpenText", "BO_ 1 M: 8 X\n SG_ S : 0|8@1+ (1,0) [0|0] \"deg X\n",
                 "arm.dbc:2: expected SG_"},
        WrongDbc{"ZeroFactor", "BO_ 1 M: 8 X\n SG_ S : 0|8@1+ (0,0) [0|0] \"\" X\n",
                 "arm.dbc:2: signal M.S: a factor"},
        WrongDbc{"Beyond", "BO_ 1 M: 2 X\n SG_ S : 8|9@1+ (1,0) [0|0] \"\" X\n",
                 "arm.dbc:2: signal M.S reaches beyond the 2 bytes"},
        WrongDbc{"BeyondMotorola", "BO_ 1 M: 2 X\n SG_ S : 8|2@0+ (1,0) [0|0] \"\" X\n",
                 "arm.dbc:2: signal M.S reaches beyond"},
        WrongDbc{"TooManyBits", "BO_ 1 M: 64 X\n SG_ S : 0|65@1+ (1,0) [0|0] \"\" X\n",
                 "arm.dbc:2: signal M.S: 1 to 64 bits"},
        WrongDbc{"SignalTwice",
                 "BO_ 1 M: 8 X\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" X\n"
                 " SG_ S : 8|8@1+ (1,0) [0|0] \"\" X\n",
                 "arm.dbc:3: signal M.S is there twice"}),
    [](const auto& mistake) { return std::string(mistake.param.name); });

TEST(Dbc, SaysThatAFileIsMissing) {
  const auto dbc = read_dbc("/nowhere/arm.dbc");
  ASSERT_FALSE(dbc);
  EXPECT_THAT(dbc.error().what, HasSubstr("/nowhere/arm.dbc"));
}

}  // namespace
}  // namespace selfcal
