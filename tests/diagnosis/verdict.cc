#include "diagnosis/report/verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace selfcal {
namespace {

using testing::HasSubstr;

Diagnosis with(CauseResult verdict) {
  Diagnosis diagnosis;
  diagnosis.p_value = 0.005;
  diagnosis.verdict = std::move(verdict);
  if (names_effect(diagnosis.verdict.effect)) diagnosis.named = {diagnosis.verdict};
  const bool unknown = diagnosis.verdict.effect == kUnknown;
  diagnosis.candidates = {{.effect = kUnknown, .probability = unknown ? 0.99 : 0.01},
                          {.effect = "joint_compliance", .where = {"j2", "j3"}, .probability = 0.9},
                          {.effect = "base_drift", .where = {"base"}, .probability = 0.8},
                          {.effect = "backlash", .where = {"j1"}, .probability = 0.2}};
  return diagnosis;
}

TEST(VerdictInWords, TellsOfLookAlikesWithTheProbabilityOfAllOfThem) {
  const CauseResult cause{.effect = "joint_compliance",
                          .where = {"j2", "j3"},
                          .probability = 0.65,
                          .together = 0.99,
                          .confounded_with = {"link_compliance@j1"}};
  EXPECT_EQ(
      verdict_in_words(with(cause)),
      "joint_compliance at j2 and j3 causes the gap (65 % sure), or link_compliance@j1 does: "
      "these rows cannot tell which (one of them: 99 % sure). Noise alone explains as much in "
      "0.005 of cases");
}

TEST(VerdictInWords, TellsHowMuchOfTheGapIsClosed) {
  Diagnosis diagnosis = with({.effect = "backlash", .where = {"j1"}, .probability = 0.999});
  diagnosis.gap.closed.fraction = 0.966;
  EXPECT_EQ(verdict_in_words(diagnosis),
            "backlash at j1 causes the gap (over 99 % sure). It closes 97 % of what calibration "
            "leaves; noise alone explains as much in 0.005 of cases");
  diagnosis.gap.closed.fraction = 1.46;
  EXPECT_THAT(verdict_in_words(diagnosis), HasSubstr("It closes all of what calibration leaves"));
}

TEST(VerdictInWords, TellsWhatIsLeftBesideWhatIsNamed) {
  Diagnosis diagnosis =
      with({.effect = "backlash", .where = {"j1", "j2", "j3"}, .probability = 0.97});
  diagnosis.candidates.front().probability = 0.2;
  EXPECT_EQ(verdict_in_words(diagnosis),
            "backlash at j1, j2 and j3 causes the gap (97 % sure). Noise alone explains as much in "
            "0.005 of cases");
  diagnosis.candidates.front().probability = 0.9;
  EXPECT_EQ(verdict_in_words(diagnosis),
            "backlash at j1, j2 and j3 causes the gap (97 % sure). Noise alone explains as much in "
            "0.005 of cases. Besides there is structure that no known effect explains (90 % sure)");
  diagnosis.named.front().confounded_with = {std::string(kUnknown)};
  EXPECT_EQ(verdict_in_words(diagnosis).find("Besides there is"), std::string::npos)
      << "what is named may be it";
}

TEST(VerdictInWords, TellsBesideTheUnknownWhatIsProbableAllTheSame) {
  EXPECT_EQ(
      verdict_in_words(with({.effect = kUnknown, .probability = 0.99})),
      "no known effect explains the gap (99 % sure; noise alone does in 0.005 of cases). "
      "Probable besides: joint_compliance at j2 and j3, base_drift at base. Look at the "
      "machine and at what measures it, or repeat some configurations to be sure of the noise");
}

TEST(VerdictInWords, TellsHowTheUnknownErrsAndWhatWouldShow) {
  Diagnosis diagnosis = with({.effect = kUnknown, .probability = 0.99});
  diagnosis.candidates.resize(1);
  diagnosis.unknown = {KernelDomain::place};
  EXPECT_EQ(
      verdict_in_words(diagnosis),
      "no known effect explains the gap (99 % sure; noise alone does in 0.005 of cases): rows "
      "near each other in the cell err alike. Look at the machine and at what measures it, or "
      "repeat some "
      "configurations to be sure of the noise");
  diagnosis.unknown = {KernelDomain::same};
  EXPECT_EQ(verdict_in_words(diagnosis),
            "no known effect explains the gap (99 % sure; noise alone does in 0.005 of cases): the "
            "repeats of a configuration err alike, and no other rows with them. Look at the "
            "machine and at what measures it, or go to some of these configurations again from "
            "elsewhere: what a robot does "
            "not repeat looks like this");
}

TEST(VerdictInWords, SaysThatTheRowsDoNotSettleItWhereACauseIsLikelierThanNone) {
  Diagnosis diagnosis = with({.effect = kNone, .probability = 0.24});
  diagnosis.p_value = 0.04;
  diagnosis.candidates = {{.effect = "fixture_shift", .where = {"plane2"}, .probability = 0.41},
                          {.effect = kNone, .probability = 0.24},
                          {.effect = "backlash", .where = {"j1"}, .probability = 0.2}};
  EXPECT_EQ(verdict_in_words(diagnosis),
            "no cause is named: these rows do not settle whether it is fixture_shift at plane2 (41 "
            "% sure) or noise alone (24 % sure; as much is found in 0.04 of resampled rows)");
}

TEST(VerdictInWords, TellsAllThatAreSureAndTheirShares) {
  Diagnosis diagnosis = with({.effect = "backlash", .where = {"j1"}, .probability = 0.97});
  diagnosis.named.front().closes_alone = 0.4;
  diagnosis.named.front().closes_beside = 0.25;
  diagnosis.named.push_back({.effect = "joint_compliance",
                             .where = {"j2", "j3"},
                             .probability = 0.95,
                             .closes_alone = 0.6,
                             .closes_beside = 0.45});
  EXPECT_EQ(verdict_in_words(diagnosis),
            "2 causes make the gap together: backlash at j1 (97 % sure, closes 25 % beside the "
            "others, 40 % alone); joint_compliance at j2 and j3 (95 % sure, closes 45 % beside the "
            "others, 60 % alone). Noise alone explains as much in 0.005 of cases");
}

TEST(VerdictInWords, SaysThatOneCauseIsEnoughWhereEachClosesAllAlone) {
  Diagnosis diagnosis = with({.effect = "zero_shift", .where = {"j1"}, .probability = 0.95});
  diagnosis.gap.closed.fraction = 0.99;
  diagnosis.named.front().closes_alone = 0.985;
  diagnosis.named.front().closes_beside = 0.004;
  diagnosis.named.push_back({.effect = "base_drift",
                             .where = {"base"},
                             .probability = 0.5,
                             .closes_alone = 0.99,
                             .closes_beside = 0.003});
  EXPECT_THAT(verdict_in_words(diagnosis),
              testing::StartsWith("any one of these closes the gap alone, and which of them are "
                                  "there the rows cannot tell: zero_shift at j1 (95 % sure"));
  diagnosis.gap.closed.fraction = 0.3;
  for (CauseResult& each : diagnosis.named) each.closes_alone = 0.3;
  EXPECT_THAT(verdict_in_words(diagnosis), testing::StartsWith("2 causes make the gap together"));
  diagnosis.gap.closed.fraction = 0.99;
  for (CauseResult& each : diagnosis.named) each.closes_alone = 0.99;
  diagnosis.named.front().closes_beside = 0.2;
  EXPECT_THAT(verdict_in_words(diagnosis), testing::StartsWith("2 causes make the gap together"));
}

TEST(VerdictInWords, TellsOfStepsThatComeAgain) {
  CauseResult cause{.effect = "zero_shift", .where = {"j4"}, .probability = 0.97};
  const auto step = [&](const char* at, double moment) {
    cause.correction.push_back({.what = {"zero_shift", at, {}}});
    cause.correction.back().what.shape.moment = moment;
    Diagnosis diagnosis = with(cause);
    diagnosis.candidates.clear();
    return verdict_in_words(diagnosis);
  };
  const std::string once =
      "zero_shift at j4 causes the gap (97 % sure). Noise alone explains as "
      "much in 0.005 of cases";
  EXPECT_EQ(step("j4", 1126), once);
  EXPECT_EQ(step("j3", 900), once);
  EXPECT_EQ(step("j4", 3758), once +
                                  ". zero_shift at j4 steps 2 times: something there slips again "
                                  "and again, or wanders");
}

TEST(VerdictInWords, SaysThatASizeIsFarBeyondTheUsual) {
  CauseResult cause{.effect = "zero_shift", .where = {"j6"}, .probability = 0.99};
  cause.parameters = {{"j6.step", "rad", 0.0149, 1e-5, 5e-5, 5e-3}};
  EXPECT_EQ(verdict_in_words(with(cause)).find("far beyond"), std::string::npos);
  cause.parameters.front().value = -0.105;  // a tool that was remounted, six degrees
  EXPECT_NE(verdict_in_words(with(cause))
                .find("; j6.step = -105 mrad is far beyond the usual 0.05 mrad to 5 mrad"),
            std::string::npos);
  cause.parameters.front().sigma = 0.05;  // and hardly known
  EXPECT_EQ(verdict_in_words(with(cause)).find("far beyond"), std::string::npos);
}

}  // namespace
}  // namespace selfcal
