// Numbers as text, and the reading of fields with the place of every mistake.
#include "kinematics/description.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

namespace selfcal {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Node at_line(Node node, int line) {
  node.place = {std::make_shared<const std::string>("robot.yaml"), line};
  return node;
}

Node frame_with(const std::string& key, Node value) {
  Node node = at_line(Node::map(), 3);
  node.set(key, at_line(std::move(value), 4));
  return node;
}

TEST(Node, WithoutSomeKeysKeepsTheOthersAndItsPlace) {
  Node node = at_line(Node::map(), 3);
  node.set("a", Node::of("1")).set("b", Node::of("2")).set("c", Node::of("3"));
  const Node rest = node.without({"a", "c", "d"});
  EXPECT_THAT(rest.keys, ElementsAre("b"));
  EXPECT_EQ(rest.items[0].text, "2");
  EXPECT_EQ(rest.place.line, 3);
  EXPECT_EQ(Node::of("text").without({"a"}).text, "text");
}

TEST(Numbers, ReadBackBitByBit) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100000; ++i) {
    const double number = std::bit_cast<double>(static_cast<std::uint64_t>(random()));
    if (!std::isfinite(number)) continue;
    const auto read = parse_number(format_number(number));
    ASSERT_TRUE(read.has_value()) << format_number(number);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(*read), std::bit_cast<std::uint64_t>(number));
  }
}

TEST(Numbers, AreWrittenWithAPointBeforeTheExponent) {
  EXPECT_EQ(format_number(1e-6), "1.0e-06");
  EXPECT_EQ(format_number(2.5e-7), "2.5e-07");
  EXPECT_EQ(format_number(0.5), "0.5");
  EXPECT_EQ(format_number(-3), "-3");
}

TEST(Numbers, AcceptAPlusAndRefuseEverythingThatIsNoFiniteNumber) {
  EXPECT_EQ(parse_number("+1.5"), 1.5);
  EXPECT_FALSE(
      std::signbit(*parse_number("-0")));  // found by a fuzzer: another hash, the same robot
  EXPECT_EQ(parse_number("-2e3"), -2000.0);
  for (const char* text : {"", "+", "+-1", "++1", "1.5 ", " 1.5", "1,5", "abc", "1.5x", "nan",
                           "NaN", "inf", "-inf", "infinity", "1e400", "0x10", "1_000"}) {
    EXPECT_FALSE(parse_number(text).has_value()) << text;
  }
}

TEST(WrittenNumbers, MayBePartsOfPi) {
  constexpr double pi = std::numbers::pi;
  const std::pair<const char*, double> cases[] = {{"pi", pi},
                                                  {"-pi", -pi},
                                                  {"+pi", pi},
                                                  {"pi/2", pi / 2},
                                                  {"-pi/2", -pi / 2},
                                                  {"3*pi/4", 3 * pi / 4},
                                                  {"-2*pi", -2 * pi},
                                                  {"0.5*pi", 0.5 * pi},
                                                  {"2 * pi / 3", 2 * pi / 3},
                                                  {"pi / 1e2", pi / 100},
                                                  {"1.5", 1.5},
                                                  {"-2e3", -2000.0}};
  for (const auto& [text, number] : cases) EXPECT_EQ(written_number(text), number) << text;
}

TEST(WrittenNumbers, AreNothingElse) {
  for (const char* text : {"",     "2pi",   "pi2",      "pi*2",   "pi/",    "*pi",    "2*",
                           "pi/0", "pi/-2", "-2*-pi",   "--pi",   "- pi",   "pi ",    " pi",
                           "Pi",   "PI",    "pipi",     "pi/2/2", "2*3*pi", "pi+1",   "pi/pi",
                           "x*pi", "pi/x",  "1e400*pi", "2/3*pi", "nan*pi", "1,5*pi", "sin(pi)"})
    EXPECT_FALSE(written_number(text).has_value()) << text;
  EXPECT_FALSE(parse_number("pi").has_value());  // rows of measurements have plain numbers
}

TEST(Fields, NameTheFileTheLineTheMappingAndTheKeyOfAWrongNumber) {
  const Node node = frame_with("alpha", Node::of("abc"));
  Problems problems;
  Fields fields(node, "frame j2", problems);
  EXPECT_EQ(fields.number("alpha", 7.0), 7.0);
  EXPECT_THAT(problems.list,
              ElementsAre("robot.yaml:4: frame j2: key 'alpha': expected a number, got 'abc'"));
}

TEST(Fields, NameTheMappingsLineForAMissingKey) {
  const Node node = at_line(Node::map(), 3);
  Problems problems;
  Fields fields(node, "frame j2", problems);
  EXPECT_EQ(fields.text("name"), "");
  EXPECT_THAT(problems.list,
              ElementsAre("robot.yaml:3: frame j2: key 'name' is missing: expected a text"));
}

TEST(Fields, RefuseKeysThatNobodyAskedForAndListTheKnownOnes) {
  const Node node = frame_with("alhpa", Node::of(1.0));
  Problems problems;
  Fields fields(node, "frame j2", problems);
  fields.number("alpha", 0.0);
  fields.has("beta");
  fields.refuse_unknown();
  EXPECT_THAT(problems.list,
              ElementsAre("robot.yaml:4: frame j2: unknown key 'alhpa'; known: alpha, beta"));
}

TEST(Fields, TakeAListOnlyOfTheRightLengthAndOnlyOfNumbers) {
  Node list = Node::of(Eigen::VectorXd::Constant(3, 0.5));
  const Node right = frame_with("com", list);
  list.items[1] = at_line(Node::of("x"), 9);
  const Node wrong = frame_with("com", list);
  Problems problems;
  EXPECT_EQ(Fields(right, "frame", problems).numbers("com", 3), Eigen::VectorXd::Constant(3, 0.5));
  EXPECT_THAT(problems.list, IsEmpty());
  EXPECT_FALSE(Fields(right, "frame", problems).numbers("com", 2).has_value());
  EXPECT_FALSE(Fields(wrong, "frame", problems).numbers("com", 3).has_value());
  EXPECT_THAT(
      problems.list,
      ElementsAre("robot.yaml:4: frame: key 'com': expected a list of 2 numbers, got a list of 3",
                  "robot.yaml:9: frame: key 'com': expected a list of 3 numbers, got 'x' among "
                  "them"));
}

TEST(Fields, HoldWholeNumbersFlagsAndPositivesToWhatTheySay) {
  Node node = at_line(Node::map(), 1);
  node.set("whole", at_line(Node::of("2.5"), 2)).set("flag", at_line(Node::of("yes"), 3));
  node.set("positive", at_line(Node::of("0"), 4)).set("texts", at_line(Node::of("a"), 5));
  Problems problems;
  Fields fields(node, "x", problems);
  EXPECT_EQ(fields.integer("whole", 1, 0, 9), 1);
  EXPECT_TRUE(fields.flag("flag", true));
  EXPECT_EQ(fields.positive("positive", 3.0), 3.0);
  EXPECT_THAT(fields.texts("texts"), IsEmpty());
  EXPECT_THAT(problems.list,
              ElementsAre("robot.yaml:2: x: key 'whole': expected a whole number from 0 to 9, got "
                          "'2.5'",
                          "robot.yaml:3: x: key 'flag': expected true or false, got 'yes'",
                          "robot.yaml:4: x: key 'positive': expected a positive number, got '0'",
                          "robot.yaml:5: x: key 'texts': expected a list of texts, got 'a'"));
}

TEST(Fields, HoldNumbersToTheirRange) {
  Node node = at_line(Node::map(), 1);
  node.set("low", at_line(Node::of("0.5"), 2)).set("high", at_line(Node::of("3"), 3));
  Problems problems;
  Fields fields(node, "x", problems);
  EXPECT_EQ(fields.number("low", 2, 0.5, 3), 0.5);
  EXPECT_EQ(fields.number("missing", 2, 0.5, 3), 2);
  EXPECT_TRUE(problems.list.empty());
  EXPECT_EQ(fields.number("high", 2, 0.5, 2.5), 2);
  EXPECT_THAT(problems.list,
              ElementsAre("robot.yaml:3: x: key 'high': expected a number from 0.5 to 2.5, got "
                          "'3'"));
}

TEST(Fields, SayOnceThatANodeIsNoMapping) {
  const Node node = at_line(Node::of("text"), 5);
  Problems problems;
  Fields fields(node, "frame 0", problems);
  fields.number("alpha");
  fields.text("name");
  fields.refuse_unknown();
  EXPECT_THAT(problems.list, ElementsAre("robot.yaml:5: frame 0: expected a mapping, got 'text'"));
}

}  // namespace
}  // namespace selfcal
