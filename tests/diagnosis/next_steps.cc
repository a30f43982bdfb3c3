// What to measure next: something for every answer that leaves a question, or the reason why not.
#include "diagnosis/report/experiment_design.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/diagnosis/two_sessions.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

/// Made once: it takes seconds.
class NextStepsOfAnArm : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    data_ = std::make_unique<DataSet>(TwoSessions(30).before);
    Observations& rows = data_->rows;
    rows.velocity = Eigen::MatrixXd::Constant(rows.q.rows(), rows.q.cols(), 0.1);
    for (Eigen::Index row = 0; row < rows.q.rows(); row += 2) rows.velocity.row(row) *= -1;
    linearised_ =
        std::make_unique<LinearisedModel>(TwoSessions(2).robot, *data_, quick(), Progress{});
  }
  static void TearDownTestSuite() {
    linearised_.reset();
    data_.reset();
  }

  static CauseResult backlash(double probability) {
    return {.effect = "backlash",
            .where = {"j3"},
            .probability = probability,
            .correction = {{.what = {"backlash", "j3"},
                            .values = {{"play", 2e-5}},
                            .sigma = {1e-4},
                            .named = true}}};
  }
  static CauseResult coupling(double probability) {
    return {.effect = "joint_coupling",
            .where = {"j3"},
            .probability = probability,
            .correction = {{.what = {"joint_coupling", "j3", {.from = "j2"}},
                            .values = {{"kappa_j2", 2e-5}},
                            .sigma = {1e-4},
                            .named = true}}};
  }
  static NextSteps of(Diagnosis diagnosis) { return next_steps(*linearised_, *data_, diagnosis); }

  static inline std::unique_ptr<DataSet> data_;
  static inline std::unique_ptr<LinearisedModel> linearised_;
};

TEST_F(NextStepsOfAnArm, TellANamedCauseFromItsLookAlike) {
  Diagnosis diagnosis;
  diagnosis.verdict = backlash(0.6);
  diagnosis.verdict.confounded_with = {"joint_coupling@j3"};
  diagnosis.named = {diagnosis.verdict};
  diagnosis.candidates = {backlash(0.6), coupling(0.35)};
  const NextSteps next = of(diagnosis);
  ASSERT_FALSE(next.steps.empty());
  EXPECT_THAT(next.steps.front().separates,
              testing::ElementsAre("backlash@j3", "joint_coupling@j3"));
  EXPECT_GE(next.steps.front().probability_after, 0.6 / 0.95 - 1e-9);
  EXPECT_GT(next.steps.front().rows.rows(), 0);
}

TEST_F(NextStepsOfAnArm, TellACauseThatIsHardlyProbableFromNoise) {
  Diagnosis diagnosis;
  diagnosis.verdict = {.effect = kNone, .probability = 0.7};
  diagnosis.candidates = {{.effect = kNone, .probability = 0.7}, coupling(0.2)};
  const NextSteps next = of(diagnosis);
  ASSERT_FALSE(next.steps.empty());
  EXPECT_THAT(next.steps.front().separates, testing::ElementsAre("joint_coupling@j3", kNone));
  EXPECT_GT(next.steps.front().probability_after, 0.2 / 0.9);
}

TEST_F(NextStepsOfAnArm, TellTheLookAlikesOfACauseThatIsNotNamedFromEachOther) {
  Diagnosis diagnosis;
  diagnosis.verdict = {.effect = kNone, .probability = 0.3};
  diagnosis.candidates = {backlash(0.5), coupling(0.4), {.effect = kNone, .probability = 0.3}};
  diagnosis.candidates.front().confounded_with = {"joint_coupling@j3"};
  std::vector<std::string> from;
  for (const NextStep& each : of(diagnosis).steps) from.push_back(each.separates.back());
  EXPECT_THAT(from, testing::IsSupersetOf({std::string("joint_coupling@j3"), std::string(kNone)}));
}

TEST_F(NextStepsOfAnArm, PromiseNoMoreThanTheRowsCanDo) {
  Diagnosis diagnosis;
  diagnosis.verdict = backlash(0.6);
  diagnosis.named = {diagnosis.verdict};
  CauseResult same = backlash(0.35);  // under another name: no row tells it from the other
  same.effect = "zero_shift";
  diagnosis.named.front().confounded_with = {"zero_shift@j3"};
  diagnosis.candidates = {backlash(0.6), same};
  const NextSteps next = of(diagnosis);
  ASSERT_EQ(next.steps.size(), 1u);
  EXPECT_NEAR(next.steps.front().probability_after, 0.6 / 0.95, 0.02);
  EXPECT_THAT(next.why, HasSubstr("rows of no such kind tell backlash@j3 from zero_shift@j3"));

  same = coupling(0.35);
  diagnosis.named.front().confounded_with = {"joint_coupling@j3"};
  diagnosis.candidates = {backlash(0.6), same};
  const NextSteps other = of(diagnosis);
  EXPECT_EQ(other.why.empty(), other.steps.front().probability_after >= 0.95) << other.why;
}

TEST_F(NextStepsOfAnArm, LookCloserAtTheUnknown) {
  Diagnosis diagnosis;
  diagnosis.verdict = {.effect = kUnknown, .probability = 0.9};
  diagnosis.candidates = {{.effect = kUnknown, .probability = 0.9}};
  const NextSteps next = of(diagnosis);
  std::string all;
  for (const NextStep& each : next.steps) {
    EXPECT_TRUE(std::isnan(each.probability_after));
    EXPECT_EQ(each.separates.front(), kUnknown);
    EXPECT_GT(each.rows.rows(), 0);
    all += each.what + "; ";
  }
  EXPECT_THAT(all, HasSubstr("twice at once"));
  EXPECT_THAT(all, HasSubstr("from the other side"));
  EXPECT_THAT(all, HasSubstr("payload"));
}

TEST_F(NextStepsOfAnArm, LookCloserAtWhatIsLeftBesideWhatIsNamed) {
  Diagnosis diagnosis;
  diagnosis.verdict = backlash(0.99);
  diagnosis.named = {diagnosis.verdict};
  diagnosis.candidates = {{.effect = kUnknown, .probability = 0.9}, diagnosis.verdict};
  const NextSteps next = of(diagnosis);
  ASSERT_FALSE(next.steps.empty());
  for (const NextStep& each : next.steps) EXPECT_EQ(each.separates.front(), kUnknown);
}

TEST_F(NextStepsOfAnArm, AskForTheSameRowsOnce) {
  Diagnosis diagnosis;
  diagnosis.verdict = {.effect = kUnknown, .probability = 0.9};
  diagnosis.candidates = {{.effect = kUnknown, .probability = 0.9}, coupling(0.3)};
  std::vector<std::string> all;
  for (const NextStep& each : of(diagnosis).steps) all.push_back(each.what);
  std::ranges::sort(all);
  EXPECT_EQ(std::ranges::adjacent_find(all), all.end()) << testing::PrintToString(all);
}

TEST_F(NextStepsOfAnArm, SayWhyThereAreNone) {
  Diagnosis diagnosis;
  diagnosis.verdict = {.effect = kNone, .probability = 0.99};
  diagnosis.candidates = {{.effect = kNone, .probability = 0.99}, coupling(0.01)};
  EXPECT_TRUE(of(diagnosis).steps.empty());
  EXPECT_THAT(of(diagnosis).why, HasSubstr("no cause is as probable as 5 %"));
  diagnosis.verdict = backlash(0.99);
  diagnosis.named = {diagnosis.verdict};
  EXPECT_TRUE(of(diagnosis).steps.empty());
  EXPECT_THAT(of(diagnosis).why, HasSubstr("no other cause looks like what is named"));
}

// ----------------------------------------------------------- of rows that a cell can take

/// Rows of the data set once more; every second one approached from the other side.
std::shared_ptr<PossibleRows> once_more(const DataSet& data) {
  auto possible = std::make_shared<PossibleRows>();
  std::vector<int> rows;
  for (int row = 0; row < std::min(data.rows.rows(), 24); ++row) rows.push_back(row);
  possible->rows = taken(data.rows, rows);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    possible->what.emplace_back(i % 2 == 0 ? "once more" : "from the other side");
    if (i % 2 != 0) possible->rows.velocity.row(static_cast<Eigen::Index>(i)) *= -1;
  }
  return possible;
}

TEST_F(NextStepsOfAnArm, AreChosenOfTheRowsThatACellCanTake) {
  Diagnosis diagnosis;
  diagnosis.verdict = backlash(0.6);
  diagnosis.verdict.confounded_with = {"joint_coupling@j3"};
  diagnosis.named = {diagnosis.verdict};
  diagnosis.candidates = {diagnosis.verdict, coupling(0.35)};
  DiagnosisOptions options;
  options.possible = once_more(*data_);
  options.most_further = 6;
  const NextSteps next = next_steps(*linearised_, *data_, diagnosis, options);
  ASSERT_EQ(next.steps.size(), 1);
  const NextStep& step = next.steps.front();
  ASSERT_FALSE(step.chosen.empty());
  EXPECT_LE(step.chosen.size(), 6);
  EXPECT_EQ(step.rows.rows(), static_cast<int>(step.chosen.size()));
  EXPECT_GT(step.probability_after, 0.5);
  EXPECT_THAT(step.separates, testing::ElementsAre("backlash@j3", "joint_coupling@j3"));
}

TEST_F(NextStepsOfAnArm, AskForNoRowWhereTheCauseIsSettled) {
  Diagnosis diagnosis;
  diagnosis.verdict = backlash(0.99);
  diagnosis.named = {diagnosis.verdict};
  diagnosis.candidates = {backlash(0.99), {.effect = kNone, .probability = 0.001}};
  DiagnosisOptions options;
  options.possible = once_more(*data_);
  const NextSteps next = next_steps(*linearised_, *data_, diagnosis, options);
  EXPECT_TRUE(next.steps.empty());
  EXPECT_NE(next.why, "");
}

}  // namespace
}  // namespace selfcal
