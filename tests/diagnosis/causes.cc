#include "diagnosis/search/causes.h"

#include <gtest/gtest.h>

#include "diagnosis/search/sign_flip_test.h"

namespace selfcal {
namespace {

TEST(Decided, NamesNothingThatNoiseFindsAsOften) {
  DiagnosisOptions options;
  Posterior posterior;
  posterior.none = 0.01;
  const CauseResult named{.effect = "backlash", .probability = 0.9};
  EXPECT_EQ(decided(named, posterior, options.name_below_p, options).effect, "backlash");
  const CauseResult noise = decided(named, posterior, 0.05, options);
  EXPECT_EQ(noise.effect, kNone);
  EXPECT_EQ(noise.probability, least_probability_of_none(0.05));
  posterior.unknown = 0.8;
  EXPECT_EQ(decided(named, posterior, 0.05, options).effect, kUnknown);
  EXPECT_EQ(decided({.effect = kUnknown, .probability = 0.6}, posterior, 1, options).probability,
            0.6);
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
  diagnosis.candidates = {{.effect = kUnknown, .probability = 0.99},
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
  EXPECT_EQ(verdict_in_words(with(cause)),
            "joint_compliance at j2 and j3, or what these rows cannot tell from it "
            "(link_compliance@j1), causes the gap (probability 0.65, with these 0.99, p 0.005)");
}

TEST(VerdictInWords, TellsBesideTheUnknownWhatIsProbableAllTheSame) {
  EXPECT_EQ(verdict_in_words(with({.effect = kUnknown, .probability = 0.99})),
            "there is structure that no known effect explains, beside joint_compliance at j2 and "
            "j3, base_drift at base: look at the machine, or repeat some configurations to be sure "
            "of the noise");
}

}  // namespace
}  // namespace selfcal
