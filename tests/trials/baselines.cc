// The textbook methods on a gap that nobody can miss.
#include <gtest/gtest.h>

#include "diagnosis/trials/baselines.h"
#include "sim/trials/trial_machine.h"

namespace selfcal {
namespace {

MadeTrial large_zero_shift() {
  TrialRequest request;
  request.effect = "zero_shift";
  request.r = 8;
  request.touches = false;
  request.least_rows = request.most_rows = 120;
  return make_trial(request);
}

TEST(Baselines, NameALargeCause) {
  const MadeTrial made = large_zero_shift();
  ASSERT_TRUE(made.unreached.empty()) << made.unreached;
  for (const char* name : {"stepwise", "bic"}) {
    const TrialAnswer answer = (*find_baseline(name))(made.robot, made.data);
    EXPECT_EQ(answer.verdict.effect, "zero_shift") << name;
    EXPECT_EQ(answer.verdict.where, made.truth.where.at("zero_shift")) << name;
    EXPECT_GT(answer.verdict.probability, 0.9) << name;
  }
}

TEST(Baselines, OfComplianceNeverLooks) {
  const MadeTrial made = large_zero_shift();
  const TrialAnswer answer = (*find_baseline("compliance"))(made.robot, made.data);
  EXPECT_EQ(answer.verdict.effect, "joint_compliance");
  EXPECT_EQ(answer.verdict.where, std::vector<std::string>{"j2"});
}

}  // namespace
}  // namespace selfcal
