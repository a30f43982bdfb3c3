// The configuration against the table of its keys at the head of app/service/config/config.h.
#include "app/service/config/config.h"

#include <gmock/gmock.h>

#include <fstream>
#include <regex>
#include <set>

#include "tests/service/cell.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

struct Key {
  std::string path, standard;
  std::optional<std::pair<double, double>> range;
};

std::optional<std::pair<double, double>> range_in(const std::string& text) {
  static const std::regex kRange(R"(^ *([0-9.]+(?:e[0-9-]+)?) to ([0-9.]+(?:e[0-9-]+)?)\b)");
  std::smatch m;
  if (!std::regex_search(text, m, kRange)) return std::nullopt;
  return std::pair{std::stod(m[1]), std::stod(m[2])};
}

/// The table at the head of config.h; keys of a part as "part.key".
std::vector<Key> documented_keys() {
  std::ifstream file(std::filesystem::path(SELFCAL_SOURCE_DIR) / "app/service/config/config.h");
  static const std::regex kRow(R"(^//   (  )?([a-z_]+) +(.*)$)");
  static const std::regex kDefault(
      R"(^((?:the robot's name|frames' names|\$STATE_DIRECTORY or state|[^ ]+)) *(.*)$)");
  static const std::regex kLimit(R"(([a-z_]+) ([0-9.]+))");
  std::vector<Key> keys;
  std::string line, part;
  std::string limits, changes;
  while (std::getline(file, line) && line != "#pragma once") {
    std::smatch row, cells;
    if (std::regex_match(line, row, kRow) && row[2] != "key") {
      const bool inside = row[1].matched;
      const std::string name = row[2], rest = row[3];
      if (!inside) part = name;
      if (!std::regex_match(rest, cells, kDefault)) continue;
      const std::string path = inside ? part + "." + name : name;
      keys.push_back({path, cells[1], range_in(cells[2])});
    }
    if (part == "limits") limits += line;
    if (!keys.empty() && keys.back().path == "accept.largest_change") changes += line;
  }
  const auto each_of = [&](const std::string& text, const std::string& from,
                           const std::string& path, std::optional<std::pair<double, double>> r) {
    const std::string list = text.substr(text.find(from) + from.size());
    for (std::sregex_iterator m(list.begin(), list.end(), kLimit), end; m != end; ++m)
      keys.push_back({path + (*m)[1].str(), (*m)[2], r});
  };
  each_of(limits, "time for", "limits.", std::pair{1.0, 3600.0});
  each_of(changes, "parameters:", "accept.largest_change.", std::nullopt);
  return keys;
}

/// A value of each key that differs from its default.
const CellKeys kValues = {
    {"id", "cell-7"},
    {"serial", "SN42"},
    {"state", "kept"},
    {"target", "2.0e-3"},
    {"workspace", "{box: [[0.2, -0.3, 0.1], [0.8, 0.3, 0.6]]}"},
    {"domain", "3"},
    {"encoders.kind", "dds"},
    {"encoders.topic", "joints"},
    {"encoders.joints", "[a, b, c, d, e, f]"},
    {"encoders.silence", "0.25"},
    {"trigger.kind", "dds"},
    {"trigger.topic", "probe"},
    {"trigger.debounce", "0.001"},
    {"trigger.delay", "0.0005"},
    {"temperature", "warmth"},
    {"motion.home", "[0, -0.6, 0.9, 0, 1.2, 0.1]"},
    {"motion.speed", "1.5"},
    {"motion.touch_speed", "0.02"},
    {"motion.clearance", "0.06"},
    {"motion.search", "0.02"},
    {"motion.apart", "0.05"},
    {"motion.tilt", "0.9"},
    {"motion.limit_margin", "0.1"},
    {"motion.slow", "0.03"},
    {"motion.spacing", "0.01"},
    {"motion.longest", "3600"},
    {"motion.keep_out",
     "[{min: [2, 2, 0], max: [3, 3, 1]}, {point: [0, 0, -1], normal: [0, 0, 1]}]"},
    {"motion.capsules", "[{link: j3, from: [0, 0, 0], to: [0.1, 0, 0], radius: 0.05}]"},
    {"motion.rest", "1.0e-3"},
    {"touch.repeats", "2"},
    {"touch.tolerance", "2.0e-4"},
    {"touch.attempts", "4"},
    {"touch.most_lost", "6"},
    {"limits.settle", "4"},
    {"sets.touches", "12"},
    {"accept.auto", "true"},
    {"accept.check", "0.4"},
    {"accept.margin", "0.1"},
    {"accept.largest_change", "{length: 0.001, base_angle: 0.02}"},
    {"commands.over", "secured"},
    {"commands.allow", "[start, abort]"},
    {"schedule.every_hours", "24"},
    {"schedule.at", "\"02:30\""},
    {"schedule.after_motion_hours", "100"},
    {"schedule.temperature_change", "5"},
    {"schedule.check_first", "false"},
    {"schedule.check_touches", "10"},
    {"schedule.check_p", "0.05"},
    {"schedule.full_after_checks", "7"},
    {"rounds.touches", "40"},
    {"rounds.margin", "2"},
    {"causes.auto", "false"},
    {"causes.touches", "30"},
    {"causes.round", "10"},
    {"causes.payload", "5"},
    {"resume", "false"},
    {"store_mb", "50"},
    {"simulation", "s.yaml"}};

TEST(Config, AcceptsEveryKeyOfItsTable) {
  const std::vector<Key> keys = documented_keys();
  ASSERT_GT(keys.size(), 50u) << "the table was read";
  const CellKeys cell = small_cell();
  std::set<std::string> known;
  for (const auto& [path, value] : kValues) known.insert(path);
  for (const auto& [path, value] : cell) known.insert(path);
  const std::set<std::string> parts = {"encoders", "trigger", "motion", "touch",
                                       "limits",   "sets",    "accept", "commands",
                                       "schedule", "causes",  "rounds"};
  for (const Key& key : keys) {
    if (parts.contains(key.path) || key.path == "sets.places" || key.path == "sets.way_out")
      continue;  // of sockets: see below
    if (key.path.starts_with("limits."))
      EXPECT_EQ(refusal({{key.path, "5"}}), "") << key.path;
    else if (key.path.starts_with("accept.largest_change."))
      EXPECT_EQ(refusal({{"accept.largest_change", "{" + key.path.substr(22) + ": 0.1}"}}), "");
    else
      EXPECT_TRUE(known.contains(key.path)) << key.path << " has no value in this test";
  }
  EXPECT_EQ(refusal(kValues), "") << "all of them together";
}

TEST(Config, RefusesEveryNumberOutsideTheRangeOfItsTable) {
  int tried = 0;
  for (const Key& key : documented_keys()) {
    if (!key.range || key.path == "limits") continue;
    const auto [least, most] = *key.range;
    for (const double value : {least > 0 ? least / 2 : -1.0, 2 * most + 1}) {
      const std::string why = refusal({{key.path, format_number(value)}});
      EXPECT_THAT(why, HasSubstr("config.yaml:")) << key.path << ": " << value;
      EXPECT_THAT(why, HasSubstr("'" + key.path.substr(key.path.find('.') + 1) + "'"));
    }
    ++tried;
  }
  EXPECT_GE(tried, 34) << "the table was read";
}

TEST(Config, HasTheDefaultsOfItsTable) {
  const auto config = load_cell();
  ASSERT_TRUE(config) << config.error().what;
  std::map<std::string, double> defaults;
  for (const Key& key : documented_keys())
    if (const auto number = parse_number(key.standard)) defaults[key.path] = *number;
  const std::map<std::string, double> read = {
      {"target", config->target},
      {"domain", config->domain},
      {"encoders.silence", config->silence},
      {"trigger.debounce", config->touch.debounce},
      {"trigger.delay", config->touch.delay},
      {"motion.speed", config->speeds.travel},
      {"motion.touch_speed", config->speeds.touch},
      {"motion.clearance", config->plan.clearance},
      {"motion.search", config->plan.search},
      {"motion.apart", config->plan.apart},
      {"motion.tilt", config->plan.tilt},
      {"motion.limit_margin", config->plan.limit_margin},
      {"motion.spacing", config->plan.spacing},
      {"motion.longest", config->plan.longest},
      {"motion.rest", config->touch.rest},
      {"touch.repeats", config->touch.repeats},
      {"touch.tolerance", config->touch.tolerance},
      {"touch.attempts", config->limits.attempts},
      {"touch.most_lost", config->limits.most_failures},
      {"limits.self_test", seconds(config->limits.self_test)},
      {"limits.planning", seconds(config->limits.planning)},
      {"limits.approach", seconds(config->limits.approach)},
      {"limits.touch", seconds(config->limits.touch)},
      {"limits.settle", seconds(config->limits.settle)},
      {"limits.retract", seconds(config->limits.retract)},
      {"limits.lock", seconds(config->limits.lock)},
      {"limits.computing", seconds(config->limits.computing)},
      {"limits.diagnosing", seconds(config->limits.diagnosing)},
      {"rounds.touches", config->rounds.touches},
      {"rounds.margin", config->rounds.margin},
      {"causes.touches", config->causes.touches},
      {"causes.round", config->causes.round},
      {"sets.touches", config->targets[0].touches},
      {"accept.check", config->plan.check},
      {"accept.margin", config->accept.margin},
      {"accept.largest_change.length", config->accept.largest_change.length},
      {"accept.largest_change.angle", config->accept.largest_change.angle},
      {"accept.largest_change.base_length", config->accept.largest_change.base_length},
      {"accept.largest_change.base_angle", config->accept.largest_change.base_angle},
      {"accept.largest_change.tool_length", config->accept.largest_change.tool_length},
      {"accept.largest_change.tool_angle", config->accept.largest_change.tool_angle},
      {"schedule.check_touches", config->schedule.check_touches},
      {"schedule.check_p", config->schedule.check_p},
      {"schedule.full_after_checks", config->schedule.full_after_checks},
      {"store_mb", static_cast<double>(config->store_bytes) / 1e6}};
  ASSERT_EQ(defaults.size(), read.size());
  for (const auto& [path, value] : read) {
    ASSERT_TRUE(defaults.contains(path)) << path;
    EXPECT_DOUBLE_EQ(defaults[path], value) << path;
  }
  EXPECT_EQ(config->commands.over, CommandRules::Over::none);
  EXPECT_THAT(config->commands.forbids(Verb::abort), HasSubstr("takes no commands"));
  EXPECT_FALSE(config->schedule.any());
  EXPECT_FALSE(config->accept.automatic);
  EXPECT_TRUE(config->resume && config->schedule.check_first);
  EXPECT_EQ(config->id, rx90().name());
  EXPECT_EQ(config->serial, config->id);
  EXPECT_EQ(config->encoders->source(), "topic joint_states");
  EXPECT_EQ(config->trigger->source(), "topic selfcal/staubli_rx90/trigger");
  EXPECT_EQ(config->joint_names.size(), 6u);
}

TEST(Config, PutsEveryValueInItsPlace) {
  const auto config = load_cell(kValues);
  ASSERT_TRUE(config) << config.error().what;
  EXPECT_EQ(config->id, "cell-7");
  EXPECT_EQ(config->encoders->source(), "topic joints");
  EXPECT_EQ(config->trigger->source(), "topic probe");
  EXPECT_EQ(config->plan.home[5], 0.1);
  EXPECT_EQ(config->plan.apart, 0.05);
  EXPECT_EQ(config->limits.settle, 4 * kSecond);
  EXPECT_EQ(config->limits.attempts, 4);
  EXPECT_EQ(config->limits.most_failures, 6);
  EXPECT_EQ(config->accept.largest_change.length, 0.001);
  EXPECT_EQ(config->accept.largest_change.angle, 0.005) << "left out";
  EXPECT_EQ(config->commands.over, CommandRules::Over::secured);
  EXPECT_EQ(config->commands.forbids(Verb::start), "");
  EXPECT_THAT(config->commands.forbids(Verb::accept), HasSubstr("does not take 'accept'"));
  EXPECT_EQ(config->schedule.at_minute, 150);
  EXPECT_EQ(config->store_bytes, 50'000'000);
  EXPECT_EQ(config->state.filename(), "kept");
  EXPECT_EQ(config->targets[0].touches, 12);
}

TEST(Config, RefusesAnUnknownKeyOfEachPartWithFileAndLine) {
  for (const char* part : {"", "encoders.", "trigger.", "motion.", "touch.", "limits.", "sets.",
                           "accept.", "commands.", "schedule."}) {
    const std::string why = refusal({{std::string(part) + "speeed", "1"}});
    EXPECT_THAT(why, testing::ContainsRegex("config\\.yaml:[0-9]+: ")) << part;
    EXPECT_THAT(why, HasSubstr("'speeed'")) << part;
  }
}

TEST(Config, TakesTheDomainOfTheEnvironmentWhereItNamesNone) {
  setenv("ROS_DOMAIN_ID", "17", 1);
  const auto silent = load_cell(), named = load_cell({{"domain", "3"}});
  setenv("ROS_DOMAIN_ID", "many", 1);
  const auto broken = load_cell();
  unsetenv("ROS_DOMAIN_ID");
  ASSERT_TRUE(silent && named);
  EXPECT_EQ(silent->domain, 17);
  EXPECT_EQ(named->domain, 3);
  ASSERT_FALSE(broken);
  EXPECT_THAT(broken.error().what, HasSubstr("ROS_DOMAIN_ID"));
}

}  // namespace
}  // namespace selfcal
