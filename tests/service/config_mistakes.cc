// What a person gets wrong in a configuration, and what it makes of a cell.
#include <gmock/gmock.h>

#include <algorithm>

#include "app/service/session/decoding.h"
#include "tests/service/cell.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(Config, SaysWhatIsMissing) {
  for (const std::string key : {"robot", "motion.home", "sets.surface", "sets.within"}) {
    CellKeys keys = small_cell();
    keys.erase(key);
    const auto config = load_text(cell_text(keys));
    ASSERT_FALSE(config) << key;
    EXPECT_THAT(config.error().what, HasSubstr(key.substr(key.find('.') + 1)));
  }
  EXPECT_THAT(load_text("robot: " + small_cell()["robot"] + "\nmotion: {home: [0,0,0,0,0,0]}\n")
                  .error()
                  .what,
              HasSubstr("one set or more"));
}

TEST(Config, RefusesARobotThatIsBrokenOrNotThere) {
  EXPECT_THAT(refusal({{"robot", "nowhere.yaml"}}), HasSubstr("nowhere.yaml"));
  const Scratch scratch;
  const auto broken =
      scratch.write("bad.yaml", "robot: x\nkind: serial\nframes: [{name: j1, joint: bent}]\n");
  CellKeys keys = small_cell();
  keys["robot"] = broken.string();
  const auto config = load_config(scratch.write("config.yaml", cell_text(keys)));
  ASSERT_FALSE(config);
  EXPECT_THAT(config.error().what, HasSubstr("bad.yaml:3"));
}

TEST(Config, SaysThatTheFileIsARobotsOrADataSets) {
  const Scratch scratch;
  const auto robot = load_config(example("rx90.robot.yaml"));
  ASSERT_FALSE(robot);
  EXPECT_THAT(robot.error().what, HasSubstr("is the file of a robot; expected a CONFIG.yaml"));
  const auto data =
      load_config(scratch.write("dataset.yaml", "robot: x.yaml\nobservations: rows.csv\n"));
  ASSERT_FALSE(data);
  EXPECT_THAT(data.error().what, HasSubstr("is the file of a data set; expected a CONFIG.yaml"));
}

TEST(Config, RefusesWaysThatDoNotFitTogether) {
  EXPECT_THAT(refusal({{"motion.apart", "0.03"}}), HasSubstr("less than clearance"));
  EXPECT_THAT(refusal({{"motion.search", "0.03"}}), HasSubstr("less than clearance"));
  EXPECT_EQ(refusal({{"motion.clearance", "0.021"}}), "");
}

TEST(Config, RefusesAPlaceToTouchThatMissesTheSurface) {
  const std::string said = refusal({{"sets.within", "{center: [0.75, 0, 9], radius: 0.3}"}});
  EXPECT_THAT(said, AllOf(HasSubstr("within"), HasSubstr("a ball that meets the surface")));
}

TEST(Config, SaysFirstThatAKeyIsMistyped) {
  EXPECT_THAT(refusal({{"motion.apart", "0.03"}, {"motion.clearence", "0.05"}}),
              testing::ContainsRegex("^[^;]*unknown key 'clearence'"));
}

TEST(Config, RefusesAHomeBeyondAPassiveJointsSwing) {
  const auto said = [](const std::string& home) {
    std::string robot = text_of(example("stewart.robot.yaml"));
    const std::string limits = ", limits: [0.55, 1.15]";
    for (std::size_t at = robot.find(limits); at != std::string::npos;
         at = robot.find(limits, at + 2 * limits.size()))
      robot.insert(at, ", swing: [0.2, 0.25]");
    std::string text = text_of(example("stewart_lock_cell.config.yaml"));
    const Scratch scratch;
    scratch.write("stewart.robot.yaml", robot);
    const std::string simulation = "simulation: stewart_lock_cell.scenario.yaml\n",
                      middle = "[0.8, 0.8, 0.8, 0.8, 0.8, 0.8]";
    text.erase(text.find(simulation), simulation.size());
    text.replace(text.find(middle), middle.size(), home);
    const auto config = load_config(scratch.write("config.yaml", text));
    return config ? "" : config.error().what;
  };
  EXPECT_EQ(said("[0.85, 0.85, 0.85, 0.85, 0.85, 0.85]"), "");
  EXPECT_THAT(said("[1.1, 1.1, 0.6, 0.6, 0.6, 0.6]"),
              AllOf(HasSubstr("config.yaml:10: motion: key 'home'"),
                    HasSubstr("every passive joint is within its limit (`swing`")));
}

TEST(Config, RefusesRoundsInACellWithLocks) {
  std::string text = text_of(example("stewart_lock_cell.config.yaml"));
  replace(text, "robot: stewart.robot.yaml", "robot: " + example("stewart.robot.yaml").string());
  EXPECT_TRUE(load_text(text));
  const auto config = load_text(text + "rounds: {touches: 40}\n");
  ASSERT_FALSE(config);
  EXPECT_THAT(config.error().what, HasSubstr("none in a cell with locks"));
}

TEST(Config, RefusesListsOfTheWrongLength) {
  EXPECT_THAT(refusal({{"motion.home", "[0, 0, 0]"}}), HasSubstr("home"));
  EXPECT_THAT(refusal({{"encoders.joints", "[a, b]"}}), HasSubstr("6 names"));
}

TEST(Config, NamesTheKindsItKnowsWhenItDoesNotKnowOne) {
  EXPECT_THAT(refusal({{"encoders.kind", "ethercat"}}),
              AllOf(HasSubstr("config.yaml:"), HasSubstr("'kind'"), HasSubstr("one of dds")));
  EXPECT_THAT(refusal({{"trigger.kind", "telepathy"}}), HasSubstr("one of dds, gpio"));
}

TEST(Config, LetsAKindReadItsOwnKeysAndRefuseAnyOther) {
  EXPECT_THAT(refusal({{"trigger.line", "probe"}}), HasSubstr("unknown key 'line'"));
  EXPECT_THAT(refusal({{"trigger.kind", "gpio"}}), HasSubstr("'line'"));
  EXPECT_THAT(refusal({{"trigger.kind", "gpio"}, {"trigger.line", "p"}, {"trigger.topic", "t"}}),
              HasSubstr("unknown key 'topic'"));
}

TEST(Config, RefusesEncodersAndATriggerThatTwoClocksStamp) {
  EXPECT_THAT(refusal({{"trigger.kind", "gpio"}, {"trigger.line", "probe"}}),
              HasSubstr("a kind that the same clock stamps"));
}

TEST(Config, RefusesATimeOfDayThatIsNone) {
  for (const char* at : {"\"24:00\"", "\"2:60\"", "\"02:30h\"", "\"noon\"", "\"-1:30\""})
    EXPECT_THAT(refusal({{"schedule.at", at}}), HasSubstr("HH:MM")) << at;
  EXPECT_EQ(load_cell({{"schedule.at", "\"23:59\""}})->schedule.at_minute, 24 * 60 - 1);
}

TEST(Config, RefusesMethodsThatATouchCannotDo) {
  EXPECT_NE(refusal({{"sets.method", "sphere"}}), "");
  EXPECT_THAT(refusal({{"sets.method", "no-such"}}), HasSubstr("config.yaml:"));
}

TEST(Config, ReadsSocketsWithTheirPlacesAndTheWayOut) {
  CellKeys keys = {{"robot", small_cell()["robot"]},
                   {"motion.home", small_cell()["motion.home"]},
                   {"sets.method", "position-constraint"},
                   {"sets.noise", "2.0e-5"},
                   {"sets.places", "[[0.7, 0, 0.2], [0.6, 0.2, 0.2]]"},
                   {"sets.way_out", "[0, 0, 2]"}};
  const auto config = load_text(cell_text(keys));
  ASSERT_TRUE(config) << config.error().what;
  EXPECT_EQ(config->targets[0].places.size(), 2u);
  EXPECT_EQ(config->targets[0].outward, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(config->obstacles.empty());
  keys.erase("sets.way_out");
  EXPECT_THAT(load_text(cell_text(keys)).error().what, HasSubstr("way_out"));
  keys.erase("sets.places");
  EXPECT_THAT(load_text(cell_text(keys)).error().what, HasSubstr("places"));
}

TEST(Config, LoadsTheExampleThatIsShipped) {
  const auto config = load_config(example("rx90_cell.config.yaml"));
  ASSERT_TRUE(config) << config.error().what;
  EXPECT_EQ(config->sets.size(), 6u);
  EXPECT_EQ(config->targets.size(), 6u);
  EXPECT_EQ(config->obstacles.size(), 6u);
  const auto far = std::ranges::find(config->sets, "gauge_right", &Set::name);
  EXPECT_EQ(config->sets[far->reference].name, "gauge_left");
  EXPECT_TRUE(std::filesystem::exists(config->simulation));
  for (std::size_t i = 0; i < config->obstacles.size(); ++i)
    EXPECT_NEAR(config->obstacles[i].outward.norm(), 1, 1e-15);  // rounding
}

TEST(Config, ChangesTheMeaningOfASessionWithWhatItsRowsMeanOnly) {
  const std::vector<EncoderScale> scales(6);
  const auto decoding = [&](const CellKeys& keys) {
    return decoding_text(*load_cell(keys), scales);
  };
  using Keys = CellKeys;
  const std::string usual = decoding(Keys{});
  EXPECT_EQ(decoding(Keys{{"schedule.every_hours", "24"}, {"motion.speed", "2"}}), usual);
  EXPECT_EQ(decoding(Keys{{"sets.touches", "99"}}), usual);
  EXPECT_NE(decoding(Keys{{"sets.noise", "3.0e-5"}}), usual);
  EXPECT_NE(decoding(Keys{{"target", "2.0e-3"}}), usual);
  EXPECT_NE(decoding(Keys{{"trigger.delay", "0.003"}}), usual);
  EXPECT_NE(decoding_text(*load_cell(), std::vector<EncoderScale>(6, {1e-6, 5})), usual);
}

TEST(ConfigHash, IsAnotherWhereReadingsMeanSomethingElse) {
  const auto hash = [](const CellKeys& changes) {
    return config_hash(*load_cell(changes), std::vector<EncoderScale>(6, {1e-6, 0}));
  };
  const std::string usual = hash({});
  for (const CellKeys& changes :
       {CellKeys{{"encoders.topic", "joints"}}, CellKeys{{"encoders.joints", "[f, e, d, c, b, a]"}},
        CellKeys{{"trigger.topic", "probe"}}, CellKeys{{"trigger.delay", "0.001"}}})
    EXPECT_NE(hash(changes), usual) << changes.begin()->first;
  EXPECT_EQ(hash({{"encoders.silence", "0.4"}, {"trigger.debounce", "0.001"}}), usual);
}

TEST(ConfigHash, IsTheSameInWhateverOrderTheKeysStand) {
  const auto hash = [](const std::string& encoders) {
    const auto config = load_text(cell_text(small_cell()) + "encoders: " + encoders + "\n");
    return config_hash(*config, std::vector<EncoderScale>(6, {1e-6, 0}));
  };
  EXPECT_EQ(hash("{topic: a, joints: [a, b, c, d, e, f]}"),
            hash("{joints: [a, b, c, d, e, f], topic: a}"));
}

}  // namespace
}  // namespace selfcal
