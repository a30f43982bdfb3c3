// The gap in words: what is named and everything found, each for what it is.
#include "app/report/diagnosis_summary.h"

#include <gmock/gmock.h>

#include "app/report/diagnosis_json.h"
#include "app/report/page/diagnosis_page.h"
#include "io/files/robot_file.h"

namespace selfcal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Diagnosis named(const std::vector<bool>& found) {
  Diagnosis diagnosis;
  diagnosis.verdict = {.effect = "joint_compliance", .where = {"j2", "j3"}, .probability = 0.9};
  diagnosis.named = {diagnosis.verdict};
  for (const bool each : found)
    diagnosis.found.push_back(
        {.what = {"joint_compliance", "j" + std::to_string(diagnosis.found.size() + 2)},
         .named = each});
  diagnosis.gap = {.rms_nominal = 2e-3,
                   .rms_before = 1e-3,
                   .rms_after = 6.4e-4,
                   .rms_all = 3.8e-4,
                   .max_all = 9e-4,
                   .noise_floor = 2e-4,
                   .closed = {0.615, 0.55, 0.66},
                   .closed_all = {0.891, 0.88, 0.93},
                   .rows = 40};
  return diagnosis;
}

/// What the page of the diagnosis says in words.
nlohmann::ordered_json page_words(const Diagnosis& diagnosis) {
  const auto robot = load_robot(SELFCAL_SOURCE_DIR "/app/examples/delta.robot.yaml");
  const DataSet data;
  return diagnosis_data({**robot, data, "arm", 0}, {"arm", diagnosis, {}, {}})["words"];
}

TEST(DiagnosisSummary, CountsAnEffectInSeveralShapesOnce) {
  Diagnosis diagnosis = named({true, false});
  diagnosis.found.push_back(diagnosis.found.front());
  EXPECT_EQ(page_words(diagnosis)["found"], "everything found (2 effects, 1 of them not named)");
}

TEST(DiagnosisSummary, TellsWhatIsNamedFromEverythingFound) {
  const Diagnosis diagnosis = named({true, true, false, false, false});
  EXPECT_THAT(summary(diagnosis),
              HasSubstr("1 mm calibrated, 0.64 mm with joint compliance at j2 and j3 (named), "
                        "0.38 mm with everything found (5 effects, 3 of them not named); noise"));
  EXPECT_THAT(summary(diagnosis),
              HasSubstr("62 % of what calibration leaves is closed by what is named (55 to 66 %), "
                        "89 % by everything found (88 to 93 %)\n"));
  EXPECT_EQ(page_words(diagnosis)["named"], "joint compliance at j2 and j3 (named)");
  EXPECT_EQ(page_words(diagnosis)["found"], "everything found (5 effects, 3 of them not named)");
}

TEST(DiagnosisSummary, SaysThatNothingElseWasFoundWhereAllOfItIsNamed) {
  const Diagnosis diagnosis = named({true, true});
  EXPECT_THAT(summary(diagnosis), HasSubstr("(named; nothing else was found); noise"));
  EXPECT_THAT(summary(diagnosis), HasSubstr("calibration leaves is closed (55 to 66 %)\n"));
  EXPECT_THAT(summary(diagnosis), Not(HasSubstr("everything found")));
  EXPECT_EQ(page_words(diagnosis)["found"], "");
}

TEST(DiagnosisSummary, NamesNothingWhereTheVerdictIsUnknown) {
  Diagnosis diagnosis = named({false, false});
  diagnosis.verdict = {.effect = "unknown"};
  diagnosis.named.clear();
  EXPECT_THAT(summary(diagnosis), HasSubstr("1 mm calibrated, 0.38 mm with everything found (2 "
                                            "effects, none named); noise"));
  EXPECT_THAT(summary(diagnosis),
              HasSubstr("     89 % of what calibration leaves is closed by everything found"));
  diagnosis.verdict = {.effect = "none"};
  diagnosis.found.clear();
  EXPECT_THAT(summary(diagnosis), HasSubstr("1 mm calibrated; noise"));
  EXPECT_THAT(summary(diagnosis), Not(HasSubstr("is closed")));
}

TEST(DiagnosisSummary, KeepsBothFiguresWhereThirdsOfTheRowsNamedForThemselves) {
  Diagnosis diagnosis = named({true});
  diagnosis.gap.validated_on = "folds";
  EXPECT_THAT(summary(diagnosis), HasSubstr("(named), 0.38 mm with everything found (1 effect, "
                                            "all named)"));
}

TEST(DiagnosisJson, HasBothFiguresUncutAndNothingWhereTheyAreNotKnown) {
  Diagnosis diagnosis = named({true, false});
  diagnosis.gap.closed = {-0.25, -0.5, 1.2};
  const auto gap = to_json(diagnosis)["gap"];
  EXPECT_EQ(gap["rms_after"], 6.4e-4);
  EXPECT_EQ(gap["rms_all"], 3.8e-4);
  EXPECT_EQ(gap["max_all"], 9e-4);
  EXPECT_EQ(gap["closed_fraction"], -0.25);
  EXPECT_EQ(gap["closed_interval"], nlohmann::ordered_json({-0.5, 1.2}));
  EXPECT_EQ(gap["closed_all"], 0.891);
  EXPECT_EQ(gap["closed_all_interval"], nlohmann::ordered_json({0.88, 0.93}));
  diagnosis.gap.closed = diagnosis.gap.closed_all = {};
  const auto within = to_json(diagnosis)["gap"];
  EXPECT_TRUE(within["closed_fraction"].is_null() && within["closed_interval"].is_null());
  EXPECT_TRUE(within["closed_all"].is_null() && within["closed_all_interval"].is_null());
}

TEST(DiagnosisSummary, SaysHowManyRowsAreLeftOutAndWhatItIsWithThem) {
  Diagnosis diagnosis = named({true, false});
  EXPECT_THAT(summary(diagnosis), Not(HasSubstr("left out")));
  diagnosis.gap.false_rows = 2;
  diagnosis.gap.with_false_rows = {3e-3, 2.5e-3, 2.25e-3};
  const char* const told =
      "2 rows kept aside that no model comes near are left out; with them 3 mm calibrated, 2.5 mm "
      "with what is named, 2.25 mm with everything found";
  EXPECT_THAT(summary(diagnosis), HasSubstr(told));
  EXPECT_EQ(page_words(diagnosis)["false_rows"], told);
  EXPECT_EQ(to_json(diagnosis)["gap"]["false_rows"], 2);
  EXPECT_EQ(to_json(diagnosis)["gap"]["with_false_rows"]["rms_all"], 2.25e-3);
}

TEST(DiagnosisSummary, GivesNoDigitsOfWhatIsNothingBesideItsSigma) {
  Diagnosis diagnosis;
  diagnosis.candidates = {
      {.effect = "link_compliance", .where = {"j1"}, .probability = 0.9, .p_value = 0.01}};
  diagnosis.candidates[0].parameters = {{"j1.twist", "rad/(N m)", -6e-12, 2.3e-6, 1e-8, 2e-5}};
  EXPECT_THAT(summary(diagnosis), HasSubstr("not told from zero: j1.twist (± 2.3 urad/(N m))\n"));
}

TEST(DiagnosisSummary, SaysWhatToMeasureNextOrWhyNothing) {
  Diagnosis diagnosis = named({true});
  diagnosis.next = {{"repeat 12 rows", {"backlash@j1", "none"}, 0.9, {}},
                    {"repeat 24 rows", {"unknown", "how much is noise"}, NAN, {}}};
  EXPECT_THAT(summary(diagnosis),
              HasSubstr("repeat 12 rows (then 90 % sure, of backlash@j1 or none)"));
  EXPECT_THAT(summary(diagnosis), HasSubstr("repeat 24 rows (tells how much is noise)"));
  diagnosis.next.clear();
  diagnosis.next_why = "no other cause looks like what is named";
  EXPECT_THAT(summary(diagnosis),
              HasSubstr("Next: nothing: no other cause looks like what is named"));
  const auto file = next_json(diagnosis, {});
  EXPECT_TRUE(file["steps"].empty());
  EXPECT_EQ(file["why"], "no other cause looks like what is named");
}

TEST(DiagnosisSummary, GivesNoIntervalSoNearTheNoise) {
  Diagnosis diagnosis = named({true});
  diagnosis.gap.closed = {0.5};
  EXPECT_THAT(summary(diagnosis), HasSubstr("is closed (so near the noise that no interval"));
  EXPECT_EQ(to_json(diagnosis)["gap"]["closed_fraction"], 0.5);
  EXPECT_TRUE(to_json(diagnosis)["gap"]["closed_interval"].is_null());
}

TEST(DiagnosisSummary, GivesNoIntervalOfTooFewRows) {
  Diagnosis diagnosis = named({true});
  std::vector<ValidationRow> rows;  // far beyond the noise, in four blocks
  for (int block = 0; block < 4; ++block)
    rows.push_back({.before = 100, .after = 10, .all = 10, .floor = 1, .block = block});
  diagnosis.gap.closed = gap_of(rows, 1).closed;
  EXPECT_THAT(summary(diagnosis), HasSubstr("is closed (too few rows judge it for an interval)"));
}

TEST(DiagnosisJson, NamesAllThatAreSureWithTheirShares) {
  Diagnosis diagnosis = named({true, true});
  diagnosis.named[0].closes_alone = 0.5;
  diagnosis.named.push_back({.effect = "backlash", .where = {"j1"}, .closes_beside = 0.125});
  EXPECT_THAT(summary(diagnosis),
              HasSubstr("joint compliance at j2 and j3; backlash at j1 (named"));
  const auto list = to_json(diagnosis)["verdict"]["named"];
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["closes_alone"], 0.5);
  EXPECT_EQ(list[1]["effect"], "backlash");
  EXPECT_EQ(list[1]["closes_beside"], 0.125);
  EXPECT_TRUE(list[1]["closes_alone"].is_null());
}

}  // namespace
}  // namespace selfcal
