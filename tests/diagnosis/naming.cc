#include "diagnosis/search/naming.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "diagnosis/constants.h"
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
      {.effect = "backlash", .probability = 0.9, .together = 0.9, .visible = 1},
      {.effect = kUnknown, .probability = 0.8},
      {.effect = "base_drift",
       .probability = 0.5,
       .together = 0.95,
       .visible = 2,
       .confounded_with = {kUnknown}},
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

/// What is left of "backlash", 0.93 sure, where it may close `most` of the gap (`closed` of it) and
/// leaves `left` of the noise.
CauseResult bounded(double closed, double most, double left, double* unknown = nullptr) {
  std::vector<CauseResult> causes = {{.effect = "backlash", .probability = 0.93},
                                     {.effect = kUnknown, .probability = 0.03}};
  CauseResult verdict = causes.front();
  std::vector<CauseResult> named = {causes.front()};
  Gap gap;
  gap.rows = 40;
  gap.noise_floor = 1e-5;
  gap.rms_after = left * 1e-5;
  gap.closed = {closed, closed - 0.2, most};
  bound_by_what_is_left(gap, causes, verdict, named);
  EXPECT_NEAR(named.front().probability, std::min(0.93, left > 2 ? most : 1), 1e-12);
  if (unknown) *unknown = std::ranges::find(causes, kUnknown, &CauseResult::effect)->probability;
  return verdict;
}

TEST(BoundByWhatIsLeft, IsNoSurerThanWhatIsNamedMayCloseOfRowsThatNoChoiceSaw) {
  double unknown = 0;
  EXPECT_EQ(bounded(-0.3, 0.39, 2.6, &unknown).effect, kUnknown);
  EXPECT_NEAR(unknown, 0.61, 1e-12);
  EXPECT_EQ(bounded(0.5, 0.73, 2.3, &unknown).effect, "backlash");
  EXPECT_NEAR(unknown, 0.27, 1e-12);
  EXPECT_EQ(bounded(0.3, 0.4, 1.4, &unknown).probability, 0.93) << "hardly beyond noise";
  EXPECT_EQ(unknown, 0.03);
}

TEST(AllowForTheUnknown, SaysUnknownWhereTheCauseIsNoLongerMoreProbableThanNot) {
  for (const double probability : {0.8, 0.95}) {
    std::vector<CauseResult> causes = {
        {.effect = "backlash", .probability = probability, .visible = 1},
        {.effect = kUnknown, .probability = 1}};
    CauseResult verdict = causes.front();
    std::vector<CauseResult> named = {causes[0]};
    allow_for_the_unknown(causes, verdict, named, 0.3);
    EXPECT_EQ(verdict.effect, probability > 0.9 ? "backlash" : kUnknown);
  }
}

TEST(AllowForTheUnknown, IsLessWhereWhatIsNamedLeavesHardlyAnything) {
  const auto kept = [](double left) {
    std::vector<CauseResult> causes = {{.effect = "backlash", .probability = 0.9, .visible = 1},
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

TEST(AllowForTheUnknown, IsMoreTheLessOfTheCauseIsSeen) {
  const auto doubt = [](double visible) {
    std::vector<CauseResult> causes = {{.effect = "backlash", .probability = 1, .visible = visible},
                                       {.effect = kUnknown, .probability = 0}};
    CauseResult verdict = causes.front();
    std::vector<CauseResult> named = {causes[0]};
    allow_for_the_unknown(causes, verdict, named, 0);
    return 1 - verdict.probability;
  };
  EXPECT_NEAR(doubt(3), kDiagnosis.naming.imitated, 1e-12);
  EXPECT_NEAR(doubt(0.5), 4 * kDiagnosis.naming.imitated, 1e-12);
  EXPECT_NEAR(doubt(0.1), kDiagnosis.naming.mostly_imitated, 1e-12);
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

/// Of `causes`, the first of which is the verdict; `named` are those with an effect.
struct Doubted {
  explicit Doubted(std::vector<CauseResult> all) : causes(std::move(all)), verdict(causes.front()) {
    for (const CauseResult& each : causes)
      if (names_effect(each.effect)) named.push_back(each);
    doubt_repeated_steps(causes, verdict, named);
  }
  std::vector<CauseResult> causes;
  CauseResult verdict;
  std::vector<CauseResult> named = {};
};

const CauseResult kRarelyUnknown{.effect = kUnknown, .probability = 0.1};

TEST(DoubtRepeatedSteps, LeavesStepsOfSeveralPlacesAlone) {
  const Doubted doubted({stepping("zero_shift", {"j1", "j4"}), kRarelyUnknown});
  EXPECT_EQ(doubted.verdict.effect, "zero_shift");
  EXPECT_EQ(doubted.verdict.probability, 0.9);
  EXPECT_EQ(doubted.causes[1].probability, 0.1);
}

TEST(DoubtRepeatedSteps, SaysUnknownOfWhatStepsAgainAtOnePlace) {
  const Doubted doubted({stepping("zero_shift", {"j4", "j4"}), kRarelyUnknown});
  const double half = 0.9 * kDiagnosis.naming.steps_again;
  EXPECT_EQ(doubted.verdict.effect, kUnknown);
  EXPECT_NEAR(doubted.verdict.probability, 0.1 + 0.9 * (0.9 - half), 1e-12);
  EXPECT_EQ(doubted.causes.front().effect, kUnknown) << "the most probable first";
  ASSERT_EQ(doubted.named.size(), 1u);
  EXPECT_NEAR(doubted.named.front().probability, half, 1e-12);
}

TEST(DoubtRepeatedSteps, TakesStepsNearEachOtherForOneThatSettles) {
  CauseResult cause = stepping("zero_shift", {"j4", "j4"});  // at 100 and 200 s
  cause.settles = 100;
  EXPECT_EQ(Doubted({cause, kRarelyUnknown}).verdict.effect, "zero_shift");
  CauseResult wandering = stepping("zero_shift", {"j4", "j4", "j4"});
  wandering.settles = 100;
  EXPECT_EQ(Doubted({wandering, kRarelyUnknown}).verdict.effect, kUnknown) << "one after another";
  cause.settles = 99;
  EXPECT_EQ(Doubted({cause, kRarelyUnknown}).verdict.effect, kUnknown);
}

TEST(LetTheLargerShareLead, IsOfCausesThatAreAsProbable) {
  const auto leads = [](double probability, double beside = 0.6) {
    std::vector<CauseResult> named = {
        {.effect = "joint_compliance", .probability = 0.9, .closes_alone = 0.7, .closes_beside = 0},
        {.effect = "backlash",
         .probability = probability,
         .closes_alone = 0.6,
         .closes_beside = beside}};
    CauseResult verdict = named.front();
    let_the_larger_share_lead(verdict, named);
    EXPECT_EQ(named.front().effect, verdict.effect);
    EXPECT_EQ(named.size(), 2u);
    return verdict.effect;
  };
  EXPECT_EQ(leads(0.89), "backlash");
  EXPECT_EQ(leads(0.8), "joint_compliance");
  EXPECT_EQ(leads(0.89, 0.3), "joint_compliance") << "hardly more of the gap";
}

TEST(DoubtRepeatedSteps, AddsToAnUnknownThatLeadsAlready) {
  const Doubted doubted(
      {{.effect = kUnknown, .probability = 0.95}, stepping("zero_shift", {"j4", "j4"})});
  const double lost = 0.9 * (1 - kDiagnosis.naming.steps_again);
  EXPECT_NEAR(doubted.causes.front().probability, 0.95 + 0.05 * lost, 1e-12);
  EXPECT_EQ(doubted.verdict.effect, kUnknown);
  EXPECT_EQ(doubted.verdict.probability, doubted.causes.front().probability)
      << "one thing, one probability";
}

TEST(DoubtRepeatedSteps, LetAnotherLeadThatIsNamed) {
  const CauseResult other{.effect = "backlash", .where = {"j1"}, .probability = 0.8};
  const Doubted doubted({stepping("zero_shift", {"j4", "j4"}), other, kRarelyUnknown});
  EXPECT_EQ(doubted.verdict.effect, "backlash");
  EXPECT_EQ(doubted.verdict.probability, 0.8);
  ASSERT_EQ(doubted.named.size(), 2u);
  EXPECT_EQ(doubted.named.front().effect, "backlash");
}

}  // namespace
}  // namespace selfcal
