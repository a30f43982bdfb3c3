// The gpio kind's keys, and what can be said of a line that is not there.
#include <gmock/gmock.h>

#include <fstream>
#include <regex>

#include "io/dds/context.h"
#include "io/files/yaml.h"
#include "io/gpio/sim_line.h"
#include "io/gpio/trigger.h"
#include "io/triggers.h"
#include "tests/io/scratch.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

struct Made {
  TriggerKindPtr kind;
  std::string problem;   ///< the first
  std::string problems;  ///< all of them
};

Made make(const std::string& text, const std::string& kind = "gpio") {
  const auto node = parse_yaml(text, "config.yaml");
  Problems problems;
  Made made;
  made.kind = make_trigger(kind, {*node, "r", problems});
  if (problems.any()) made.problem = problems.list.front();
  for (const std::string& each : problems.list) made.problems += each + "\n";
  return made;
}

TEST(GpioKind, NamesItsLine) {
  EXPECT_EQ(make("line: probe").kind->source(), "line probe");
  EXPECT_EQ(make("chip: gpiochip2\nline: 3").kind->source(), "line 3 of gpiochip2");
  EXPECT_EQ(make("line: probe").kind->stamped_by(), StampedBy::kernel);
}

TEST(GpioKind, RefusesWhatIsWrongWithItsLineInTheFile) {
  EXPECT_THAT(make("chip: gpiochip0").problem, HasSubstr("'line'"));
  EXPECT_THAT(make("bias: as-is\nline: 3").problem, HasSubstr("config.yaml:2: "));
  EXPECT_THAT(make("line: 3").problem, HasSubstr("an offset needs `chip`"));
  EXPECT_THAT(make("line: probe\nbias: up").problem, HasSubstr("pull-up"));
  EXPECT_THAT(make("line: probe\nactive: 0").problem, HasSubstr("high or low"));
  EXPECT_THAT(make("line: probe\ntopic: probe").problem, HasSubstr("unknown key 'topic'"));
  for (const char* bias : {"as-is", "pull-up", "pull-down", "disabled"})
    EXPECT_EQ(make(std::string("line: probe\nactive: low\nbias: ") + bias).problem, "");
}

/// Keys of the table at the head of a kind's file.
std::vector<std::string> documented_keys(const std::string& file) {
  std::ifstream stream(std::filesystem::path(SELFCAL_SOURCE_DIR) / file);
  static const std::regex kRow(R"(^//   ([a-z_]+)  .*$)");
  std::vector<std::string> keys;
  std::string line;
  std::smatch row;
  while (std::getline(stream, line) && line.starts_with("//"))
    if (std::regex_match(line, row, kRow) && row[1] != "key") keys.push_back(row[1]);
  return keys;
}

TEST(TriggerKinds, ReadEveryKeyOfTheirTables) {
  for (const std::string_view name : trigger_kinds()) {
    const auto keys = documented_keys("io/triggers/" + std::string(name) + ".cc");
    EXPECT_FALSE(keys.empty()) << name;
    for (const std::string& key : keys)
      EXPECT_THAT(make(key + ": [1, 2]", std::string(name)).problems,
                  testing::AllOf(HasSubstr("'" + key + "'"), Not(HasSubstr("unknown"))))
          << name;
  }
}

TEST(GpioTrigger, SaysThatThereIsNoSuchChip) {
  Wakeup wakeup;
  const auto opened = GpioTrigger::open({.chip = "gpiochip987", .line = "3"}, wakeup);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().exit_status, kDeviceFailed);
  EXPECT_THAT(opened.error().what,
              HasSubstr("line 3 of gpiochip987: there is no such chip or line"));
}

TEST(GpioSimLine, WritesWhichWayTheLineIsPulled) {
  const Scratch scratch;
  const auto pull = scratch.write("pull", "");
  const auto text = [&] {
    std::string line;
    std::getline(std::ifstream(pull), line);
    return line;
  };
  const auto high = GpioSimLine::open(pull, false);
  ASSERT_TRUE(high) << high.error().what;
  EXPECT_TRUE((*high)->send(0, true));
  EXPECT_EQ(text(), "pull-up");
  const auto low = GpioSimLine::open(scratch.write("pull", ""), true);
  EXPECT_TRUE((*low)->send(0, true));
  EXPECT_EQ(text(), "pull-down");
  EXPECT_THAT(GpioSimLine::open("/sys/nowhere/pull", false).error().what,
              HasSubstr("/sys/nowhere/pull: No such file"));
}

TEST(GpioKind, SaysWhatAPlayedRobotNeedsToDriveTheLine) {
  const auto participant = DdsParticipant::open(0, "test");
  Wakeup wakeup;
  const auto sender = make("line: probe").kind->open_sender({{*participant}, wakeup, ""});
  ASSERT_FALSE(sender);
  EXPECT_THAT(sender.error().what, HasSubstr("trigger_pull"));
}

}  // namespace
}  // namespace selfcal
