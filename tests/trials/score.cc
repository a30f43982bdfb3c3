// The table, worked by hand on a few answers.
#include <gtest/gtest.h>

#include "diagnosis/trials/trials.h"

namespace selfcal {
namespace {

TrialTruth truth(const std::string& effect, double r, std::vector<std::string> where = {}) {
  TrialTruth out;
  out.effect = effect;
  out.r = r;
  out.where[effect] = std::move(where);
  return out;
}

TrialAnswer answer(const std::string& effect, double probability,
                   std::vector<std::string> where = {}) {
  return {{effect, std::move(where), probability}};
}

const ScoreLine& line(const std::vector<ScoreLine>& lines, const std::string& name) {
  for (const ScoreLine& each : lines)
    if (each.name == name) return each;
  ADD_FAILURE() << "no line " << name;
  return lines.front();
}

TEST(TrialScore, CountsRightCausesBySizeAndTheirPlaces) {
  TrialTruths truths{{"a", truth("backlash", 0.5, {"j2", "j3"})},
                     {"b", truth("backlash", 0.5, {"j2"})},
                     {"c", truth("thermal_expansion", 0.75)},
                     {"d", truth("zero_shift", 1, {"j4"})},
                     {"e", truth("zero_shift", 4, {"j4"})}};
  TrialAnswers answers{{"a", answer("backlash", 0.9, {"j3"})},
                       {"b", answer("none", 0.6)},
                       {"c", answer("thermal_expansion", 0.9)},
                       {"d", answer("zero_shift", 0.9, {"j5"})}};  // e is not answered
  const auto lines = score(truths, answers);
  EXPECT_DOUBLE_EQ(*line(lines, "right_cause_r_0.5").value, 0.5);
  EXPECT_DOUBLE_EQ(*line(lines, "right_cause_r_0.75").value, 1);
  EXPECT_EQ(line(lines, "right_cause_r_1").of, 2);
  EXPECT_DOUBLE_EQ(*line(lines, "right_cause_r_1").value, 0.5);
  EXPECT_EQ(line(lines, "right_place").of, 3);
  EXPECT_EQ(line(lines, "right_place").count, 2);
}

TEST(TrialScore, TellsNamedCausesFromUnknownWhereThereIsNoneToName) {
  TrialTruths truths{{"a", truth("none", 0)},      {"b", truth("none", 0)},
                     {"c", truth("none", 0)},      {"d", truth("none", 0)},
                     {"e", truth("unknown", 1.5)}, {"f", truth("unknown", 1)},
                     {"g", truth("unknown", 4)},   {"h", truth("unknown", 0.5)}};
  TrialAnswers answers{{"a", answer("none", 0.9)},
                       {"b", answer("backlash", 0.3, {"j1"})},
                       {"c", answer("unknown", 0.8)},
                       {"d", answer("none", 0.9)},
                       {"e", answer("unknown", 0.9)},
                       {"f", answer("backlash", 0.4, {"j1"})},
                       {"g", answer("backlash", 0.5, {"j1"})},
                       {"h", answer("none", 0.7)}};
  const auto lines = score(truths, answers);
  EXPECT_DOUBLE_EQ(*line(lines, "false_alarms").value, 0.25);
  EXPECT_DOUBLE_EQ(*line(lines, "unknown_on_none").value, 0.25);
  EXPECT_DOUBLE_EQ(*line(lines, "unknown_recognised").value, 0.5);     // e of e, g
  EXPECT_DOUBLE_EQ(*line(lines, "confident_on_unknown").value, 0.25);  // g alone is confident
}

TEST(TrialScore, CountsAnAnswerThatSaysWhatItCannotTellApart) {
  const TrialTruth compliance = truth("joint_compliance", 1, {"j2"});
  TrialAnswer hedged = answer("transmission_error", 0.6, {"j2"});
  hedged.verdict.confounded_with = {"joint_compliance@j2"};
  EXPECT_TRUE(right_cause(compliance, hedged));
  EXPECT_TRUE(right_place(compliance, hedged));
  hedged.verdict.confounded_with = {"joint_compliance@j3"};
  EXPECT_FALSE(right_place(compliance, hedged));
  hedged.verdict.probability = 0.99;  // certain of one, and cannot tell it from another
  EXPECT_FALSE(right_cause(compliance, hedged));
}

TEST(TrialScore, AsksForBothCausesOfAPair) {
  TrialTruth pair = truth("zero_shift", 1, {"j4"});
  pair.second = "base_drift";
  pair.where["base_drift"] = {"base"};
  TrialAnswer one = answer("base_drift", 0.9, {"base"});
  one.candidates = {one.verdict, {"zero_shift", {"j4"}, 0.4}};
  EXPECT_TRUE(right_cause(pair, one));
  EXPECT_FALSE(both_causes(pair, one));
  one.candidates.back().probability = 0.5;
  EXPECT_TRUE(both_causes(pair, one));
}

TEST(TrialScore, WeighsTheCalibrationErrorByBins) {
  // 0.9 stated twice, right once: |1.8 - 1|; 0.6 stated once, right: |0.6 - 1|; over 3 trials.
  TrialTruths truths{
      {"a", truth("none", 0)}, {"b", truth("backlash", 1, {"j1"})}, {"c", truth("unknown", 1)}};
  TrialAnswers answers{
      {"a", answer("none", 0.9)}, {"b", answer("none", 0.9)}, {"c", answer("unknown", 0.6)}};
  EXPECT_NEAR(*line(score(truths, answers), "calibration_error").value, (0.8 + 0.4) / 3, 1e-12);
}

TEST(TrialScore, ComparesTheClosedFractionWithTheToldFit) {
  TrialTruths truths{{"a", truth("backlash", 1, {"j1"})}, {"b", truth("backlash", 1, {"j1"})}};
  truths["a"].told_closed = 0.8;  // b's geometry leaves nothing to close
  TrialAnswers answers{{"a", answer("backlash", 1, {"j1"})}, {"b", answer("backlash", 1, {"j1"})}};
  answers["a"].closed = 0.6;
  answers["b"].closed = 0.1;
  EXPECT_NEAR(*line(score(truths, answers), "closed_over_told").value, 0.75, 1e-12);
  // A told fraction is cut to 0 ... 1, and so is what is compared with it.
  answers["a"].closed = 1.2;
  EXPECT_NEAR(*line(score(truths, answers), "closed_over_told").value, 1 / 0.8, 1e-12);
  answers["a"].closed = -0.3;
  EXPECT_NEAR(*line(score(truths, answers), "closed_over_told").value, 0, 1e-12);
}

}  // namespace
}  // namespace selfcal
