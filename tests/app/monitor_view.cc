// The picture and the lines that a watcher reads, from messages made up.
#include "app/report/live/monitor_view.h"

#include <gmock/gmock.h>

#include <cmath>

#include "app/report/format.h"
#include "app/report/live/message_json.h"
#include "app/report/live/monitor_news.h"

namespace selfcal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr std::int64_t kNow = 1'790'000'000'000;

StatusMessage collecting() {
  StatusMessage status;
  status.unix_ms = kNow;
  status.robot = "rx90";
  status.state = "collecting";
  status.phase = "touch";
  status.hardware = "move slowly towards the surface until the trigger closes";
  status.why = "asked by ana@cell";
  status.session = 3;
  status.kind = "full";
  status.active = "session 2";
  status.active_since_ms = kNow - 11 * 3'600'000;
  status.temperature = 21.5;
  return status;
}

ProgressMessage touch(std::uint32_t index, bool accepted = true) {
  ProgressMessage progress;
  progress.unix_ms = kNow;
  progress.session = 3;
  progress.done = index + 1;
  progress.planned = 240;
  progress.seconds_left = 200;
  progress.set = "ramp";
  progress.index = index;
  progress.accepted = accepted;
  progress.residual = accepted ? 12.3e-6 : std::nan("");
  progress.note = accepted ? "" : "touched 3.2 mm before the surface";
  return progress;
}

ResultMessage improved() {
  ResultMessage result;
  result.unix_ms = kNow;
  result.session = 2;
  result.kind = "full";
  result.answer = "improved";
  result.decision = "applied";
  result.why = "d2 by 1.91 mm";
  result.p_value = 8.6e-15;
  result.check_before = 1.92e-3;
  result.check_after = 0.0228e-3;
  result.endpoint_sigma = 0.0959e-3;
  result.touches = 240;
  result.outliers = 3;
  result.identified = 21;
  result.json = R"({"converged": true})";
  return result;
}

Watched watched() {
  Watched all;
  all.robot = "rx90";
  note(all, collecting());
  for (std::uint32_t i = 0; i < 10; ++i) note(all, touch(i, i != 9));
  note(all, improved());
  all.health = {{"selfcal: encoders", Health::ok, "readings come in", {{"rate_hz", "500"}}},
                {"selfcal: trigger", Health::error, "level unknown", {}}};
  return all;
}

std::string picture_text(const std::vector<Line>& lines) {
  std::string text;
  for (const Line& line : lines) text += line.text + "\n";
  return text;
}

TEST(MonitorView, ShowsAllThatIsKnownOfARunningSession) {
  const std::string text = picture_text(picture(watched(), kNow, 120, 50));

  EXPECT_THAT(text, StartsWith("rx90      collecting, touch, session 3 (full)\n"));
  EXPECT_THAT(text, HasSubstr("the robot may move slowly towards the surface"));
  EXPECT_THAT(text, HasSubstr("10 of 240 touches, 3 min 20 s left"));
  EXPECT_THAT(text, HasSubstr("+12.3 µm"));
  EXPECT_THAT(text, HasSubstr("put aside: touched 3.2 mm before the surface"));
  EXPECT_THAT(text, HasSubstr(": improved, applied\n"));
  EXPECT_THAT(text, HasSubstr("check 1.92 mm before, 0.0228 mm after; end position 0.0959 mm"));
  EXPECT_THAT(text, HasSubstr("session 2, for 11 h 00 min; 21.5 °C"));
  EXPECT_THAT(text, HasSubstr("OK    encoders     readings come in (rate_hz 500)"));
  EXPECT_THAT(text, HasSubstr("ERROR trigger      level unknown"));
}

TEST(MonitorView, KeepsTheLastTouchesOfOneSession) {
  Watched all = watched();
  EXPECT_EQ(all.touches.size(), kTouchesShown);
  EXPECT_EQ(all.touches.front().index, 2);

  ProgressMessage next = touch(0);
  next.session = 4;
  note(all, next);

  EXPECT_EQ(all.touches.size(), 1);
}

TEST(MonitorView, FitsEverySizeAndKeepsWhatMatters) {
  for (const int columns : {20, 40, 79, 200})
    for (const int rows : {1, 5, 10, 24, 60}) {
      const std::vector<Line> lines = picture(watched(), kNow, columns, rows);
      EXPECT_LE(static_cast<int>(lines.size()), rows);
      for (const Line& line : lines) EXPECT_LE(characters(line.text), columns);
      EXPECT_THAT(lines[0].text, StartsWith("rx90"));
      if (rows < 5) continue;
      EXPECT_THAT(picture_text(lines), HasSubstr("ERROR")) << rows;
      EXPECT_THAT(picture_text(lines), HasSubstr("Progress")) << rows;
    }
}

TEST(MonitorView, ShowsASilentServiceInRedWithItsAge) {
  Watched all = watched();
  all.silent = 12;
  const Line head = picture(all, kNow, 120, 50)[0];
  EXPECT_EQ(head.tone, Tone::bad);
  EXPECT_THAT(head.text, HasSubstr("SILENT for 12 s; last heard: collecting, touch"));
  EXPECT_THAT(painted(head), StartsWith("\033[1;31m"));
}

TEST(MonitorView, SaysThatNothingHasBeenHeard) {
  Watched none;
  none.robot = "rx90";
  none.silent = 4;
  const std::vector<Line> lines = picture(none, kNow, 80, 24);
  ASSERT_EQ(lines.size(), 1);
  EXPECT_THAT(lines[0].text, HasSubstr("no service heard yet, for 4 s"));
}

// What others send must not move the cursor or change colours.
TEST(MonitorView, LetsNoControlCharacterThrough) {
  Watched all = watched();
  all.robot = "rx\x1b[2J";
  all.status->why = "a\nb\x1b[31m\xc2\x9b";
  all.status->state = "idle\r";
  all.touches.back().note = "\x07";
  all.result->why = "\t\x7f";
  all.health[1].message = "\x1b]0;title\x07";
  for (const Line& line : picture(all, kNow, 120, 50))
    for (const char c : line.text) {
      EXPECT_GE(static_cast<unsigned char>(c), 0x20) << line.text;
      EXPECT_NE(c, 0x7f);
    }
}

TEST(MonitorView, HasNoBarWhereNoSessionIsUnderWay) {
  for (const char* state : {"idle", "planning", "awaiting-acceptance"}) {
    Watched all = watched();
    all.status->state = state;
    EXPECT_THAT(picture_text(picture(all, kNow, 120, 50)), Not(HasSubstr("Progress"))) << state;
  }
}

TEST(MonitorView, TellsOfAChecksOutcomeInItsOwnWords) {
  ResultMessage check = improved();
  check.kind = "check";
  EXPECT_THAT(figures(check), HasSubstr("check 0.0228 mm where 1.92 mm are expected"));
  check.answer = "failed";
  EXPECT_EQ(figures(check), "");
}

TEST(MonitorView, SaysOnceWhatStateAndResultHaveInCommon) {
  ResultMessage check = improved();
  check.kind = "check";
  check.why = "12 touches with 0.03 mm rms against 0.02 expected";
  Watched all = watched();
  all.status->state = "idle";
  all.status->why = check.why;
  note(all, check);
  const std::string shown = picture_text(picture(all, kNow, 200, 50));
  const std::size_t first = shown.find(check.why);
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(shown.find(check.why, first + 1), std::string::npos) << shown;
  all.status->why = "ready";
  EXPECT_THAT(picture_text(picture(all, kNow, 200, 50)), HasSubstr(check.why));
}

TEST(MonitorNews, TellsAStateOnceAndALevelWhenItChanges) {
  News news;
  EXPECT_THAT(news.of(collecting()), HasSubstr("collecting, session 3 (full): asked by ana@cell"));
  StatusMessage other_phase = collecting();
  other_phase.phase = "retract";
  EXPECT_EQ(news.of(other_phase), "");

  HealthMessage line{"selfcal: trigger", Health::ok, "open", {}};
  EXPECT_EQ(news.of(line), "");
  line.level = Health::error;
  line.message = "level unknown";
  EXPECT_EQ(news.of(line), "selfcal: trigger is error: level unknown");
  EXPECT_EQ(news.of(line), "");
}

TEST(MonitorNews, TellsOfSilenceAndOfItsEnd) {
  News news;
  Watched all = watched();
  EXPECT_EQ(news.of_silence(all), "");
  all.silent = 3.1;
  EXPECT_THAT(news.of_silence(all), HasSubstr("SILENT: nothing heard for 3 s"));
  EXPECT_EQ(news.of_silence(all), "");
  all.silent = 0;
  EXPECT_EQ(news.of_silence(all), "the service is heard again");
}

TEST(MonitorView, SaysNothingOfACauseInTheModelWhereNoneIsNamed) {
  ResultMessage result = improved();
  result.kind = "cause";
  result.answer = "no-cause";
  const auto shown = [&] {
    Watched all = watched();
    note(all, result);
    return picture_text(picture(all, kNow, 120, 60));
  };
  EXPECT_THAT(shown(), HasSubstr("nothing is named; calibrated 1.92 mm, p"));
  result.cause = "backlash@j2";
  EXPECT_THAT(shown(), HasSubstr("with the cause in the model 0.0228 mm"));
}

TEST(MonitorNews, TellsATouchInOneLine) {
  EXPECT_EQ(News().of(touch(7)), "ramp 7: +12.3 µm; 8 of 240 touches, 3 min 20 s left");
  EXPECT_THAT(News().of(touch(7, false)), HasSubstr("ramp 7: put aside: touched 3.2 mm before"));
}

TEST(MessageJson, EmbedsTheResultAndHasNullForNoNumber) {
  ResultMessage result = improved();
  result.p_value = std::nan("");
  const auto json = nlohmann::json::parse(line_of(to_json(result)));
  EXPECT_EQ(json["topic"], "result");
  EXPECT_TRUE(json["p_value"].is_null());
  EXPECT_EQ(json["result"]["converged"], true);
  result.json = "";
  EXPECT_TRUE(to_json(result)["result"].is_null());
  EXPECT_TRUE(to_json(touch(1, false))["residual"].is_null());
  EXPECT_THAT(line_of(to_json(collecting())), Not(HasSubstr("\n")));
}

// Anybody in the domain may send one, and it is written by a function that calls itself for each
// level.
TEST(MessageJson, PassesOverAResultThatNestsWithoutEnd) {
  ResultMessage result;
  result.json = std::string(200'000, '[') + std::string(200'000, ']');
  EXPECT_EQ(to_json(result)["result"], nullptr);
}

TEST(Words, ReadAsAPersonSaysThem) {
  EXPECT_EQ(duration(45), "45 s");
  EXPECT_EQ(duration(200), "3 min 20 s");
  EXPECT_EQ(duration(2 * 3600 + 300), "2 h 05 min");
  EXPECT_EQ(duration(12 * 86400), "12 days");
  EXPECT_EQ(duration(std::nan("")), "unknown");
  EXPECT_EQ(mm(1.92e-3), "1.92");
  EXPECT_EQ(mm(2.284e-5), "0.0228");
  EXPECT_EQ(mm(0), "0.00");
  EXPECT_EQ(mm(0.25), "250");
  EXPECT_EQ(mm(std::nan("")), "-");
  EXPECT_THAT(day_time(kNow, kNow), StartsWith("today "));
  EXPECT_THAT(day_time(kNow - 86'400'000, kNow), StartsWith("yesterday "));
  EXPECT_THAT(day_time(kNow + 86'400'000, kNow), StartsWith("tomorrow "));
  EXPECT_EQ(fitted("µµµµ", 4), "µµµµ");
  EXPECT_EQ(fitted("µµµµ", 3), "µµ…");
  EXPECT_EQ(fitted("abc", 1), "…");
}

}  // namespace
}  // namespace selfcal
