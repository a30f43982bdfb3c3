// The board: only what has changed; and the lines of the fleet, worst first.
#include "app/web/board.h"

#include <gmock/gmock.h>

#include "app/report/format.h"
#include "app/report/live/fleet.h"
#include "app/web/archive.h"
#include "app/web/changes.h"
#include "io/files/robot_file.h"
#include "tests/io/scratch.h"
#include "tests/io/store_records.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

using nlohmann::json;

json since(const Board& board, const std::string& robot, std::uint64_t version,
           const std::string& epoch = "e") {
  return json::parse(board.changes(robot, epoch, version));
}

TEST(Board, TellsEachChangeOnce) {
  Board board("e");
  board.put("", "fleet", {1});
  board.put("rx90", "status", {{"state", "idle"}});
  const json first = since(board, "rx90", 0);
  EXPECT_EQ(first["parts"], json({{"status", {{"state", "idle"}}}}));
  EXPECT_EQ(first["domain"]["fleet"], json({1}));

  board.put("rx90", "status", {{"state", "idle"}});
  const json same = since(board, "rx90", first["version"]);
  EXPECT_EQ(same["version"], first["version"]);
  EXPECT_TRUE(same["parts"].empty());
  EXPECT_TRUE(same["domain"].empty());

  board.put("rx90", "result", {{"answer", "improved"}});
  const json next = since(board, "rx90", first["version"]);
  EXPECT_EQ(next["parts"], json({{"result", {{"answer", "improved"}}}}));
}

TEST(Board, TellsAllToAPageOfAnotherStart) {
  Board board("new");
  board.put("rx90", "status", 1);
  EXPECT_EQ(since(board, "rx90", 99, "old")["parts"]["status"], 1);
}

TEST(Board, AppendsRestartsAndBoundsLists) {
  Board board("e");
  for (int i = 0; i < 5; ++i) board.append("rx90", "touches", i, 3);
  const json first = since(board, "rx90", 0);
  EXPECT_EQ(first["lists"]["touches"]["items"], json({2, 3, 4}));
  board.append("rx90", "touches", 5, 3);
  const json next = since(board, "rx90", first["version"]);
  EXPECT_EQ(next["lists"]["touches"]["items"], json({5}));
  EXPECT_EQ(next["lists"]["touches"]["restarted"], false);
  board.restart("rx90", "touches");
  const json anew = since(board, "rx90", next["version"]);
  EXPECT_EQ(anew["lists"]["touches"]["restarted"], true);
  EXPECT_TRUE(anew["lists"]["touches"]["items"].empty());
}

TEST(Board, KnowsNothingOfARobotThatIsNotThere) {
  Board board("e");
  board.put("rx90", "status", 1);
  board.drop("rx90");
  EXPECT_EQ(since(board, "rx90", 0)["known"], false);
  EXPECT_EQ(since(board, "\"}<script>", 0)["robot"], "\"}<script>");
}

Watched heard(const std::string& robot) {
  Watched watched;
  watched.robot = robot;
  watched.status.emplace();
  watched.status->state = "idle";
  watched.status->active = "factory";
  return watched;
}

TEST(Fleet, HasTheWorstFirst) {
  Watched well = heard("a_well"), waits = heard("waits"), warns = heard("warns"),
          fault = heard("fault"), silent = heard("silent"), sick = heard("sick");
  waits.status->candidate = true;
  warns.health = {
      {.name = "selfcal: store", .level = Health::warn, .message = "nearly full", .values = {}}};
  fault.status->state = "fault";
  fault.status->why = "the trigger is silent";
  sick.health = {{.name = "selfcal: encoders",
                  .level = Health::error,
                  .message = "no readings",
                  .values = {}}};
  silent.silent = kSilence;
  std::vector<nlohmann::ordered_json> lines;
  for (const Watched& each : {well, waits, warns, fault, silent, sick})
    lines.push_back(fleet_line(each));

  const auto sorted = fleet_json(lines);

  std::vector<std::string> names;
  for (const auto& line : sorted) names.push_back(line["robot"]);
  EXPECT_THAT(names, ::testing::ElementsAre("silent", "fault", "sick", "waits", "warns", "a_well"));
  EXPECT_EQ(sorted[1]["why"], "the trigger is silent");
  EXPECT_EQ(sorted[2]["why"], "no readings");
}

TEST(Fleet, SaysHowFarTheActiveParametersAreOff) {
  Watched watched = heard("rx90");
  EXPECT_TRUE(fleet_line(watched)["off"].is_null());
  ResultMessage& result = watched.result.emplace();
  result.kind = "full";
  result.answer = "improved";
  result.decision = "candidate";
  result.check_before = 2e-3;
  result.check_after = 1e-4;
  EXPECT_EQ(fleet_line(watched)["off"], 2e-3);
  result.session = 7;
  result.decision = "applied";
  watched.status->active = "session 7";
  EXPECT_EQ(fleet_line(watched)["off"], 1e-4);
  result.answer = "failed";
  EXPECT_TRUE(fleet_line(watched)["off"].is_null());
}

TEST(Fleet, SaysNothingOfParametersThatWereRolledBack) {
  Watched watched = heard("rx90");
  ResultMessage& result = watched.result.emplace();
  result.session = 7;
  result.unix_ms = 1000;
  result.kind = "full";
  result.answer = "improved";
  result.decision = "rolled-back";
  result.check_before = 2e-3;
  result.check_after = 1e-4;
  EXPECT_TRUE(fleet_line(watched)["off"].is_null());

  result.kind = "check";
  result.answer = "explained";
  result.decision = "none";
  EXPECT_TRUE(fleet_line(watched)["off"].is_null()) << "a check of what was given up";
  watched.status->active = "session 6";
  watched.status->active_since_ms = 500;
  EXPECT_EQ(fleet_line(watched)["off"], 1e-4);
  watched.status->active_since_ms = 2000;
  EXPECT_TRUE(fleet_line(watched)["off"].is_null()) << "back since then";
}

TEST(Fleet, IsATableForATerminal) {
  std::vector<nlohmann::ordered_json> lines;
  for (int i = 0; i < 9; ++i) lines.push_back(fleet_line(heard("robot" + std::to_string(i))));
  Watched fault = heard("a_robot_with_a_long_name");
  fault.status->state = "fault";
  fault.status->why = "the trigger\033[2J is silent";
  lines.push_back(fleet_line(fault));

  const std::vector<Line> shown = fleet_picture(fleet_json(lines), 0, 90, 6);

  ASSERT_EQ(shown.size(), 6U);
  EXPECT_EQ(shown[0].text, "10 robots, 1 error, 9 well");
  EXPECT_EQ(shown[1].text.find("state"), shown[2].text.find("fault")) << "aligned";
  EXPECT_EQ(shown[2].text.rfind("a_robot_with_a_long_name", 0), 0U);
  EXPECT_EQ(shown[2].tone, Tone::bad);
  EXPECT_EQ(shown[2].text.find('\033'), std::string::npos);
  EXPECT_EQ(shown[5].text, "and 7 more robots");
  for (const Line& line : shown) EXPECT_LE(characters(line.text), 90) << line.text;
}

std::shared_ptr<const Robot> two_links(const std::string& first, const std::string& second) {
  return must(robot_of("robot: two\nkind: serial\nframes:\n  - {name: j1, joint: revolute, " +
                           first + "}\n  - {name: j2, joint: revolute, d: 0.4, " + second +
                           "}\n  - {name: tool, joint: fixed, d: 0.1}\n",
                       "two.robot.yaml"));
}

TEST(Archive, KnowsTheStepsThatAFurtherRoundHasPlanned) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const std::int64_t session = must(store->begin(some_session(), some_plan(2, 6)));
  Archive archive(scratch.folder(), two_links("d: 0.3", "alpha: 0.2"));
  EXPECT_TRUE(archive.planned(session, 1));
  EXPECT_FALSE(archive.planned(session, 2));
  must(store->extend(session, some_plan(3, 6)));
  EXPECT_TRUE(archive.planned(session, 4));
  EXPECT_FALSE(archive.planned(session, 5));
}

TEST(Archive, ReadsTheStoreThatIsThereNow) {
  const Scratch scratch;
  auto store = opened(scratch.folder());
  must(store->begin(some_session(), some_plan(2, 6)));
  must(store->begin(some_session(), some_plan(2, 6)));
  Archive archive(scratch.folder(), two_links("d: 0.3", "alpha: 0.2"));
  EXPECT_EQ(archive.history()["sessions"].size(), 2u);
  store.reset();
  for (const char* ending : {"", "-wal", "-shm"}) {
    const std::string name = std::string("selfcal.db") + ending;
    if (std::filesystem::exists(scratch.folder() / name))
      std::filesystem::rename(scratch.folder() / name, scratch.folder() / ("aside." + name));
  }
  store = must(Store::open(scratch.folder())).store;
  must(store->begin(some_session(), some_plan(2, 6)));
  EXPECT_EQ(archive.history()["sessions"].size(), 1u);
}

TEST(Changes, AreTheDifferencesOfValuesLargestFirst) {
  const auto factory = two_links("d: 0.3", "alpha: 0.2");
  const auto found =
      two_links("d: 0.302, nominal: {d: 0.3}", "alpha: 0.195, nominal: {alpha: 0.2}");
  const char* result = R"({"parameters": [{"name": "d0", "sigma": 1e-5}]})";

  const auto changes = changes_between(factory, found, result);

  ASSERT_EQ(changes["count"], 2);
  EXPECT_EQ(changes["rows"][0]["name"], "alpha1 j2.alpha");
  EXPECT_EQ(changes["rows"][0]["unit"], "rad");
  EXPECT_NEAR(changes["rows"][0]["change"].get<double>(), -5e-3, 1e-15);
  EXPECT_TRUE(changes["rows"][0]["sigma"].is_null());
  EXPECT_EQ(changes["rows"][1]["name"], "d0 j1.d");
  EXPECT_NEAR(changes["rows"][1]["change"].get<double>(), 2e-3, 1e-15);
  EXPECT_EQ(changes["rows"][1]["sigma"], 1e-5);
  EXPECT_EQ(changes_between(found, factory, "")["rows"][1]["change"].get<double>(),
            -changes["rows"][1]["change"].get<double>());
}

TEST(Changes, AreUnknownBetweenDifferentModels) {
  EXPECT_TRUE(
      changes_between(two_links("d: 0.3", "alpha: 0.2"), two_links("d: 0.4", "alpha: 0.2"), "")
          .is_null());
}

TEST(Changes, OfAResultAreFromTheMakersFigures) {
  const auto changes = changes_of_result(
      R"({"parameters": [{"name": "d0", "frame": "j1", "unit": "m", "nominal": 0.5, "value": 0.5, "sigma": null},
                         {"name": "theta2", "frame": "j2", "unit": "rad", "nominal": 0, "value": -0.001, "sigma": 1e-6}]})");
  ASSERT_EQ(changes["count"], 1);
  EXPECT_EQ(changes["rows"][0]["name"], "theta2 j2.theta");
  EXPECT_EQ(changes["rows"][0]["change"], -0.001);
  EXPECT_EQ(changes["rows"][0]["sigma"], 1e-6);
  EXPECT_TRUE(changes_of_result("").is_null());
  EXPECT_TRUE(changes_of_result("[]").is_null());
  EXPECT_TRUE(changes_of_result(R"({"parameters": 3})").is_null());
}

// They come from anybody in the domain.
TEST(Changes, OfSetsPassOverWhatIsNoneOfOurs) {
  const auto sets = [](const std::string& by_set) {
    const std::string text = R"({"residual": {"check": {"by_set": )" + by_set + "}}}";
    return sets_of_result(nlohmann::ordered_json::parse(text)).dump();
  };
  EXPECT_EQ(sets(R"([{"name": "table", "rows": 3, "rms_before": 0.5, "rms_after": null}])"),
            R"([{"name":"table","rows":3.0,"before":0.5,"after":null}])");
  EXPECT_EQ(sets(R"([7, {"name": 5, "rows": "many"}])"),
            R"([{"name":"","rows":null,"before":null,"after":null},)"
            R"({"name":"","rows":null,"before":null,"after":null}])");
  EXPECT_EQ(sets("3"), "null");
  EXPECT_TRUE(sets_of_result({{"residual", 1}}).is_null());
  EXPECT_TRUE(changes_of_result(std::string(200'000, '[')).is_null());
}

}  // namespace
}  // namespace selfcal
