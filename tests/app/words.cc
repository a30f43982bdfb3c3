// What a person reads of the program holds what the program knows: the manual pages and the
// completion against --help, the methods, the effects and the tables of keys.
#include <gtest/gtest.h>

#include <cctype>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "constraints/methods/data_set.h"
#include "constraints/planning/criterion.h"
#include "io/encoders.h"
#include "io/triggers.h"
#include "kinematics/effect.h"
#include "kinematics/make_robot.h"
#include "tests/app/cell.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

std::string source_text(const std::string& file) {
  return text_of(std::string(SELFCAL_SOURCE_DIR "/") + file);
}

/// A manual page with plain hyphens.
std::string page(const std::string& file) {
  std::string text = source_text(file);
  for (size_t at = text.find("\\-"); at != std::string::npos; at = text.find("\\-", at))
    text.erase(at, 1);
  return text;
}

bool belongs_to_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_';
}

/// Whether `word` stands in `text` on its own: "--sim" is not there in "--simulate".
bool has_word(const std::string& text, std::string_view word) {
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const size_t end = at + word.size();
    if ((at == 0 || !belongs_to_word(text[at - 1])) &&
        (end == text.size() || !belongs_to_word(text[end])))
      return true;
  }
  return false;
}

/// From the line that begins with `head`, with nothing but a blank or the line's end behind it, to
/// the next heading; empty when there is none.
std::string block(const std::string& page, const std::string& head) {
  for (size_t at = page.find("\n" + head); at != std::string::npos;
       at = page.find("\n" + head, at + 1)) {
    const size_t end = at + 1 + head.size();
    if (end < page.size() && page[end] != ' ' && page[end] != '\n') continue;
    return page.substr(at + 1, page.find("\n.S", end) - at);
  }
  return {};
}

/// What the completion offers for the last of these words behind the program's name.
std::string completed(const std::string& words) {
  return run_in_bash("source " SELFCAL_SOURCE_DIR "/app/selfcal.bash; COMP_WORDS=(" SELFCAL_BINARY
                     " " +
                     words +
                     "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _selfcal;"
                     " echo \"${COMPREPLY[@]}\"")
      .out;
}

std::string help(const std::string& command) { return run_selfcal(command + " --help").out; }

/// Every subcommand that has none itself: "identify", "trial seal".
std::vector<std::string> subcommands(const std::string& command = {}) {
  std::istringstream lines(help(command));
  std::vector<std::string> all;
  std::string line;
  while (std::getline(lines, line) && line != "Subcommands:") continue;
  while (std::getline(lines, line) && line.starts_with("  ")) {
    std::string name;
    std::istringstream(line) >> name;
    if (line[2] == ' ' || name.empty()) continue;  // the rest of a description
    const std::string whole = command.empty() ? name : command + " " + name;
    const std::vector<std::string> inner = subcommands(whole);
    if (inner.empty()) all.push_back(whole);
    all.insert(all.end(), inner.begin(), inner.end());
  }
  return all;
}

/// The options that the help of a command tells, without --help.
std::vector<std::string> options(const std::string& command) {
  std::istringstream lines(help(command));
  std::vector<std::string> all;
  for (std::string line; std::getline(lines, line);) {
    std::string word;
    std::istringstream(line) >> word;
    if (word.starts_with("--") && word != "--help") all.push_back(word);
  }
  return all;
}

TEST(Words, AreFoundWholeAndInTheirOwnBlock) {
  EXPECT_TRUE(has_word("serve --simulate --sim X", "--sim"));
  EXPECT_FALSE(has_word("serve --simulate", "--sim"));
  EXPECT_FALSE(has_word("serve --no-sim", "sim"));
  const std::string text = "\n.SS selfcal identifiable ROBOT\na\n.SS selfcal identify DATASET\nb\n";
  EXPECT_EQ(block(text, ".SS selfcal identify"), ".SS selfcal identify DATASET\nb\n");
  EXPECT_EQ(block(text, ".SS selfcal ident"), "");
}

TEST(Words, ManualAndCompletionNameEverySubcommandAndOption) {
  const std::string manual = page("app/selfcal.1");
  const std::vector<std::string> all = subcommands();
  EXPECT_EQ(all.size(), 18u);
  for (const std::string& command : all) {
    const std::string explained = block(manual, ".SS selfcal " + command);
    EXPECT_FALSE(explained.empty()) << command;
    const std::string words = completed(command + " --");
    for (const std::string& option : options(command)) {
      EXPECT_TRUE(has_word(explained, option)) << command << " " << option;
      EXPECT_TRUE(has_word(words, option)) << command << " " << option;
    }
  }
  const std::string data = page("app/selfcal-data.5");
  for (const std::string_view effect : effect_names())
    EXPECT_TRUE(has_word(data, effect)) << effect;
}

std::string in_one_line(const std::vector<std::string_view>& names) {
  std::string all;
  for (const std::string_view name : names) all += (all.empty() ? "" : " ") + std::string(name);
  return all + "\n";
}

TEST(Words, CompletionOffersEveryValueThatAnOptionTakes) {
  EXPECT_EQ(completed("identifiable --method \"\""), in_one_line(method_names()));
  EXPECT_EQ(completed("identify --effects \"\""), in_one_line(effect_names()));
  EXPECT_EQ(completed("identify data --effects backlash \"\""), in_one_line(effect_names()));
  EXPECT_EQ(completed("plan robot.yaml --further \"\""), in_one_line(method_names()));
  EXPECT_EQ(completed("plan robot.yaml --criterion \"\""), in_one_line(criterion_names()));
  EXPECT_EQ(completed("robot convert robot.yaml --to \"\""),
            "yaml urdf mjcf offsets dh ur delta\n");
  EXPECT_EQ(completed("robot convert --convention = m"), "modified\n");
  EXPECT_EQ(completed("command re"), "reject\n");
}

TEST(Words, CompletionOffersCommandsAndOptionsAsFarAsTheyAreTyped) {
  EXPECT_EQ(completed("id"), "identify identifiable\n");
  EXPECT_EQ(completed("robot \"\""), "check convert\n");
  EXPECT_EQ(completed("trial run --ba"), "--baseline\n");
}

/// The paragraph of `key` in `text`.
std::string paragraph(const std::string& text, const std::string& key) {
  const size_t begin = text.find("\n.B " + key + "\n");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find("\n.TP\n", begin) - begin);
}

TEST(Words, ThePagesNameEveryKindOfRobotEncoderAndTrigger) {
  const std::string robots = page("app/selfcal-data.5");
  for (const std::string_view kind : robot_kinds())
    EXPECT_TRUE(has_word(paragraph(block(robots, ".SH ROBOT:"), "kind"), kind)) << kind;
  const std::string configurations = page("app/selfcal-config.5");
  for (const std::string_view kind : encoder_kinds())
    EXPECT_TRUE(has_word(paragraph(block(configurations, ".SS encoders"), "kind"), kind)) << kind;
  for (const std::string_view kind : trigger_kinds())
    EXPECT_TRUE(has_word(paragraph(block(configurations, ".SS trigger"), "kind"), kind)) << kind;
}

TEST(Words, ThePageOfFilesNamesEveryMethodAndEffect) {
  const std::string files = page("app/selfcal-data.5");
  const std::string methods = block(files, ".SS Methods");
  for (const std::string_view method : method_names())
    EXPECT_NE(methods.find("\n.B " + std::string(method) + "\n"), std::string::npos) << method;
  for (const std::string_view effect : effect_names())
    EXPECT_NE(files.find("\n.B " + std::string(effect) + "\n"), std::string::npos) << effect;
}

/// The first words of the rows of the table at the head of a file, "//   key  default ...".
std::vector<std::string> keys_of_table(const std::string& file) {
  std::istringstream lines(source_text(file));
  std::vector<std::string> keys;
  for (std::string line; std::getline(lines, line) && line != "#pragma once";) {
    if (!line.starts_with("//   ")) continue;
    const size_t begin = line.find_first_not_of(' ', 2);
    const size_t end = line.find(' ', begin);
    if (begin > 7 || end == std::string::npos || line[begin] == '}') continue;
    std::string key = line.substr(begin, end - begin);
    if (key.ends_with(',')) key.pop_back();
    if (key != "key") keys.push_back(key);
  }
  return keys;
}

TEST(Words, ThePageOfConfigurationsNamesEveryKeyOfTheTables) {
  const std::string configurations = page("app/selfcal-config.5");
  for (const std::string file : {"app/service/config/config.h", "io/can/settings.h",
                                 "sim/scenario.h", "sim/machine_scenario.h"}) {
    const std::vector<std::string> keys = keys_of_table(file);
    EXPECT_GT(keys.size(), 10u) << file;
    for (const std::string& key : keys)
      EXPECT_TRUE(has_word(configurations, key)) << file << " " << key;
  }
}

}  // namespace
}  // namespace selfcal
