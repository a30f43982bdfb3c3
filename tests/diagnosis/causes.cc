#include "diagnosis/search/naming.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "diagnosis/constants.h"
#include "diagnosis/report/verdict.h"
#include "diagnosis/search/sign_flip_test.h"

namespace selfcal {
namespace {

TEST(Decided, NamesNothingThatNoiseFindsAsOften) {
  DiagnosisOptions options;
  Posterior posterior;
  posterior.none = 0.01;
  const CauseResult named{.effect = "backlash", .probability = 0.9};
  EXPECT_EQ(decided(named, posterior, {options.name_below_p, 1}, options).effect, "backlash");
  const CauseResult noise = decided(named, posterior, {0.05, 1}, options);
  EXPECT_EQ(noise.effect, kNone);
  EXPECT_EQ(noise.probability, least_probability_of_none(0.05));
  posterior.unknown = 0.8;
  EXPECT_EQ(decided(named, posterior, {0.05, 0.01}, options).effect, kUnknown);
}

TEST(Decided, LetsTheUnknownAnswerToNoiseAsWell) {
  const DiagnosisOptions options;
  Posterior posterior;
  posterior.unknown = 0.8;
  const CauseResult unknown{.effect = kUnknown, .probability = 0.8};
  EXPECT_EQ(decided(unknown, posterior, {1, options.name_below_p}, options).probability, 0.8);
  const CauseResult noise = decided(unknown, posterior, {0.005, 0.1}, options);
  EXPECT_EQ(noise.effect, kNone);
  EXPECT_EQ(noise.probability, least_probability_of_none(0.1));
}

std::vector<CauseResult> some_causes() {
  return {{.effect = "backlash", .probability = 0.97, .visible = 1},
          {.effect = kUnknown, .probability = 0.6},
          {.effect = "joint_compliance", .probability = 0.95, .visible = 3},
          {.effect = "zero_shift", .probability = 0.8, .visible = 9},
          {.effect = kNone, .probability = 0.02}};
}

TEST(SureCauses, AreNamedTogetherWhicheverIsTheLargest) {
  const DiagnosisOptions options;
  const std::vector<CauseResult> causes = some_causes();
  for (const int first : {0, 2}) {
    const auto named = sure_causes(causes, causes[first], {0.005, 1}, options);
    ASSERT_EQ(named.size(), 2u);
    EXPECT_EQ(named[0].effect, causes[first].effect);
    EXPECT_EQ(named[1].effect, causes[2 - first].effect);
  }
  const auto beside = sure_causes(causes, {.effect = kUnknown}, {0.005, 0.005}, options);
  ASSERT_EQ(beside.size(), 2u);
  EXPECT_EQ(beside[0].effect, "joint_compliance") << "the larger one first";
  EXPECT_TRUE(sure_causes(causes, {.effect = kUnknown}, {0.2, 0.005}, options).empty())
      << "noise does as well as a known cause";
  EXPECT_TRUE(sure_causes(causes, {.effect = kNone}, {0.2, 1}, options).empty());
}

// Each may be the other, and one of them is there for sure.
TEST(SureCauses, NamesTheLargerOfTwoLookAlikesThatAreSureTogether) {
  const std::vector<CauseResult> causes = {
      {.effect = "backlash", .where = {"j1"}, .probability = 0.97, .visible = 3},
      {.effect = "joint_compliance",
       .where = {"j2"},
       .probability = 0.7,
       .together = 0.98,
       .visible = 2,
       .confounded_with = {"link_compliance@j1"}},
      {.effect = "link_compliance",
       .where = {"j1"},
       .probability = 0.55,
       .together = 0.98,
       .visible = 1.9,
       .confounded_with = {"joint_compliance@j2"}}};
  const auto named = sure_causes(causes, causes[0], {0.005, 1}, DiagnosisOptions{});
  ASSERT_EQ(named.size(), 2u);
  EXPECT_EQ(named[1].effect, "joint_compliance");
}

TEST(UnlessNone, NamesNothingWhereNoneIsTooProbableOnceCalibrated) {
  const DiagnosisOptions options;
  std::vector<CauseResult> causes = some_causes();
  EXPECT_EQ(unless_none(causes[0], causes, options).effect, "backlash");
  causes[4].probability = 0.12;
  EXPECT_EQ(unless_none(causes[0], causes, options).effect, kNone);
  EXPECT_EQ(unless_none(causes[0], causes, options).probability, 0.12);
  EXPECT_EQ(unless_none(causes[1], causes, options).effect, kUnknown);
}

TEST(Agree, GivesOneThingOneProbability) {
  std::vector<CauseResult> causes = some_causes();
  CauseResult cause{.effect = "zero_shift", .probability = 0.5};
  agree(causes, cause);
  EXPECT_EQ(cause.probability, 0.8);
  // What the resampled rows say of none is said in the table too, and the others give way to it.
  CauseResult none{.effect = kNone, .probability = 0.51};
  agree(causes, none);
  const auto in_table = std::ranges::find(causes, kNone, &CauseResult::effect);
  EXPECT_EQ(in_table->probability, 0.51);
  EXPECT_NEAR(causes[1].probability, 0.97 / 2, 1e-12);
  EXPECT_TRUE(std::ranges::is_sorted(causes, std::ranges::greater{}, &CauseResult::probability));
}

TEST(WithoutCause, IsUnknownWhereThatIsMoreProbableThanNot) {
  Posterior posterior;
  posterior.none = 0.35;
  posterior.unknown = 0.45;
  EXPECT_EQ(without_cause(posterior).effect, kNone);
  posterior.unknown = 0.55;
  EXPECT_EQ(without_cause(posterior).effect, kUnknown);
  EXPECT_EQ(without_cause(posterior).probability, 0.55);
}

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
  diagnosis.unknown = KernelDomain::place;
  EXPECT_EQ(
      verdict_in_words(diagnosis),
      "no known effect explains the gap (99 % sure; noise alone does in 0.005 of cases): rows "
      "near each other in the cell err alike. Look at the machine and at what measures it, or "
      "repeat some "
      "configurations to be sure of the noise");
  diagnosis.unknown = KernelDomain::same;
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

TEST(ShareOfStructure, FallsWithTheLogarithmOfHowOftenNoiseShowsAsMuch) {
  const double none = kDiagnosis.naming.no_structure;
  EXPECT_EQ(share_of_structure(0.01, 0.025), 1);
  EXPECT_EQ(share_of_structure(0.025, 0.025), 1);
  EXPECT_NEAR(share_of_structure(std::sqrt(0.025 * none), 0.025), 0.5, 1e-12);
  EXPECT_EQ(share_of_structure(none, 0.025), 0);
  EXPECT_EQ(share_of_structure(0.93, 0.025), 0);
}

TEST(AllowForTheUnknown, MakesAllCausesButADriftByOrderLessSure) {
  std::vector<CauseResult> causes = {
      {.effect = "backlash", .probability = 0.9, .together = 0.9},
      {.effect = kUnknown, .probability = 0.8},
      {.effect = "base_drift", .probability = 0.5, .together = 0.95, .confounded_with = {kUnknown}},
      {.effect = kNone, .probability = 0.01}};
  CauseResult verdict = causes.front();
  std::vector<CauseResult> named = {causes[0], causes[2]};
  allow_for_the_unknown(causes, verdict, named, 1);
  // 0.45 of the 0.8 are the drift's other half.
  const double all = 1 - kDiagnosis.naming.imitated;
  const double kept = all * (1 - kDiagnosis.naming.beside_unknown * (0.8 - 0.45));
  EXPECT_EQ(causes[0].effect, kUnknown) << "the most probable first";
  EXPECT_EQ(causes[0].probability, 0.8);
  EXPECT_NEAR(verdict.probability, 0.9 * kept, 1e-12);
  EXPECT_NEAR(causes[1].probability, 0.9 * kept, 1e-12);
  EXPECT_NEAR(named[0].together, 0.9 * kept, 1e-12);
  EXPECT_NEAR(named[1].probability, 0.5 * all, 1e-12);
  EXPECT_EQ(causes[3].probability, 0.01);
}

TEST(AllowForTheUnknown, SaysUnknownWhereTheCauseIsNoLongerMoreProbableThanNot) {
  for (const double probability : {0.8, 0.95}) {
    std::vector<CauseResult> causes = {{.effect = "backlash", .probability = probability},
                                       {.effect = kUnknown, .probability = 1}};
    CauseResult verdict = causes.front();
    std::vector<CauseResult> named = {causes[0]};
    allow_for_the_unknown(causes, verdict, named, 0.3);
    EXPECT_EQ(verdict.effect, probability > 0.9 ? "backlash" : kUnknown);
  }
}

TEST(AllowForTheUnknown, IsLessWhereWhatIsNamedLeavesHardlyAnything) {
  const auto kept = [](double left) {
    std::vector<CauseResult> causes = {{.effect = "backlash", .probability = 0.9},
                                       {.effect = kUnknown, .probability = 1}};
    CauseResult verdict = causes.front();
    std::vector<CauseResult> named = {causes[0]};
    allow_for_the_unknown(causes, verdict, named, left);
    EXPECT_EQ(verdict.effect, left > kDiagnosis.naming.most_left ? kUnknown : "backlash");
    return named.front().probability / 0.9;
  };
  const double most = kDiagnosis.naming.beside_unknown;
  const double all = 1 - kDiagnosis.naming.imitated;
  EXPECT_NEAR(kept(0.6), all * (1 - most), 1e-12);
  EXPECT_NEAR(kept(kDiagnosis.naming.hardly_left / 2), all * (1 - most / 2), 1e-12);
  EXPECT_NEAR(kept(-0.01), all, 1e-12) << "all is closed";
}

/// Of probability 0.9, with steps at these places.
CauseResult stepping(const char* effect, const std::vector<const char*>& at) {
  CauseResult cause{.effect = effect, .where = {at.front()}, .probability = 0.9};
  for (const char* each : at) {
    cause.correction.push_back({.what = {effect, each, {}}});
    cause.correction.back().what.shape.moment =
        100.0 * static_cast<double>(cause.correction.size());
  }
  return cause;
}

TEST(DoubtRepeatedSteps, LeavesStepsOfSeveralPlacesAlone) {
  std::vector<CauseResult> causes = {stepping("zero_shift", {"j1", "j4"}),
                                     {.effect = kUnknown, .probability = 0.1}};
  CauseResult verdict = causes.front();
  std::vector<CauseResult> named = {verdict};
  doubt_repeated_steps(causes, verdict, named);
  EXPECT_EQ(verdict.effect, "zero_shift");
  EXPECT_EQ(verdict.probability, 0.9);
  EXPECT_EQ(causes[1].probability, 0.1);
}

TEST(DoubtRepeatedSteps, SaysUnknownOfWhatStepsAgainAtOnePlace) {
  std::vector<CauseResult> causes = {stepping("zero_shift", {"j4", "j4"}),
                                     {.effect = kUnknown, .probability = 0.1}};
  CauseResult verdict = causes.front();
  std::vector<CauseResult> named = {verdict};
  doubt_repeated_steps(causes, verdict, named);
  const double half = 0.9 * kDiagnosis.naming.steps_again;
  EXPECT_EQ(verdict.effect, kUnknown);
  EXPECT_NEAR(verdict.probability, 0.1 + 0.9 * (0.9 - half), 1e-12);
  EXPECT_EQ(causes.front().effect, kUnknown) << "the most probable first";
  ASSERT_EQ(named.size(), 1u);
  EXPECT_NEAR(named.front().probability, half, 1e-12);
}

TEST(DoubtRepeatedSteps, AddsToAnUnknownThatLeadsAlready) {
  std::vector<CauseResult> causes = {{.effect = kUnknown, .probability = 0.95},
                                     stepping("zero_shift", {"j4", "j4"})};
  CauseResult verdict = causes.front();
  std::vector<CauseResult> named = {causes[1]};
  doubt_repeated_steps(causes, verdict, named);
  const double lost = 0.9 * (1 - kDiagnosis.naming.steps_again);
  EXPECT_NEAR(causes.front().probability, 0.95 + 0.05 * lost, 1e-12);
  EXPECT_EQ(verdict.effect, kUnknown);
  EXPECT_EQ(verdict.probability, causes.front().probability) << "one thing, one probability";
}

TEST(DoubtRepeatedSteps, LetAnotherLeadThatIsNamed) {
  const CauseResult other{.effect = "backlash", .where = {"j1"}, .probability = 0.8};
  std::vector<CauseResult> causes = {
      stepping("zero_shift", {"j4", "j4"}), other, {.effect = kUnknown, .probability = 0.1}};
  CauseResult verdict = causes.front();
  std::vector<CauseResult> named = {verdict, other};
  doubt_repeated_steps(causes, verdict, named);
  EXPECT_EQ(verdict.effect, "backlash");
  EXPECT_EQ(verdict.probability, 0.8);
  ASSERT_EQ(named.size(), 2u);
  EXPECT_EQ(named.front().effect, "backlash");
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
