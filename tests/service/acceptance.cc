// What becomes of a result.
#include "app/service/session/acceptance.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

/// Check rows of that residual (m), each of a configuration of its own.
std::vector<CheckRow> check_rows(std::initializer_list<double> residuals) {
  std::vector<CheckRow> rows;
  for (const double residual : residuals)
    rows.push_back({residual, false, static_cast<int>(rows.size())});
  return rows;
}

/// A candidate that is twice as good on the check rows and changes nothing.
struct Case {
  Acceptance accept;
  Solution candidate, unchanged;
  Case() {
    candidate.verdict = {Answer::improved, "better", 1e-6};
    candidate.residual.check_rows = check_rows({1e-4, 1e-4, 1e-4, 1e-4, 1e-4});
    unchanged.residual.check_rows = check_rows({2e-4, 2e-4, 2e-4, 2e-4, 2e-4});
    for (const Parameter& parameter : rx90().parameters())
      candidate.parameters.push_back({parameter, parameter.value, 1e-5, Status::identified, {}});
  }
  ParameterResult& find(Part part, Quantity quantity) {
    return *std::ranges::find_if(candidate.parameters, [&](const ParameterResult& each) {
      return each.parameter.part == part && each.parameter.quantity == quantity;
    });
  }
  AcceptanceDecision rule() const { return decide_on_result(accept, rx90(), candidate, unchanged); }
};

TEST(AcceptanceDecision, AcceptsWhatIsBetterByTheMarginAndWithinTheLimits) {
  Case good;
  good.find(Part::link, Quantity::length).value += 1e-3;
  const AcceptanceDecision decided = good.rule();
  EXPECT_TRUE(decided.acceptable);
  EXPECT_EQ(decided.answer, Answer::improved);
  EXPECT_DOUBLE_EQ(decided.check_before, 2e-4);
  EXPECT_DOUBLE_EQ(decided.check_after, 1e-4);
  EXPECT_THAT(decided.why, HasSubstr("check residual 0.2 to 0.1 mm"));
  EXPECT_THAT(decided.why, HasSubstr("(100 sigma)"));
}

/// A set of 100 rows whose data sheet says 20 um, and what was found.
Solution left_of(double noise, double freedoms) {
  Solution solution;
  solution.sets.resize(1);
  solution.sets[0].name = "table";
  solution.sets[0].used = 100;
  solution.sets[0].noise_sigma = noise;
  solution.uncertainty.lack_of_fit.freedoms = freedoms;
  return solution;
}

std::vector<Set> sheet_of(double noise) {
  std::vector<Set> sets(1);
  sets[0].name = "table";
  sets[0].noise = noise;
  return sets;
}

TEST(FitDecision, ComparesWhatIsLeftWithDataSheets) {
  EXPECT_TRUE(decide_on_fit(left_of(21e-6, 80), sheet_of(20e-6)).noise);
  const FitDecision more = decide_on_fit(left_of(28e-6, 80), sheet_of(20e-6));  // twice the squares
  EXPECT_FALSE(more.noise);
  EXPECT_LT(more.p_value, 1e-3);
  EXPECT_THAT(more.why, HasSubstr("1.4 times the noise that the data sheets tell"));
  EXPECT_TRUE(decide_on_fit(left_of(28e-6, 9), sheet_of(20e-6)).noise)
      << "too few freedoms to tell";
}

TEST(FitDecision, BelievesRepeatsRatherThanDataSheets) {
  Solution solution = left_of(20e-6, 80);
  solution.uncertainty.lack_of_fit = {4.0, 1e-6, 60, 40};
  EXPECT_FALSE(decide_on_fit(solution, sheet_of(20e-6)).noise);
  solution = left_of(100e-6, 80);
  solution.uncertainty.lack_of_fit = {1.05, 0.4, 60, 40};
  EXPECT_TRUE(decide_on_fit(solution, sheet_of(20e-6)).noise);
}

TEST(FitDecision, SaysNothingWhereNobodySaysHowLargeTheNoiseIs) {
  const FitDecision decided = decide_on_fit(left_of(1e-3, 80), sheet_of(0));
  EXPECT_TRUE(decided.noise);
  EXPECT_THAT(decided.why, HasSubstr("nothing says"));
}

TEST(AcceptanceDecision, RefusesWhatTheVerdictDoesNotCallImproved) {
  for (const Answer answer : {Answer::not_improved, Answer::not_determined}) {
    Case bad;
    bad.candidate.verdict = {answer, "the data do not tell", 0.5};
    EXPECT_FALSE(bad.rule().acceptable);
    EXPECT_EQ(bad.rule().why, "the data do not tell");
    EXPECT_EQ(bad.rule().answer, answer);
  }
}

TEST(AcceptanceDecision, RefusesWhatIsNotBetterByTheMargin) {
  Case one;
  one.accept.margin = 0.5;
  EXPECT_FALSE(one.rule().acceptable) << "exactly half is not better than half";
  EXPECT_THAT(one.rule().why, HasSubstr("explain the check rows as well"));
  one.accept.margin = 0.49;
  EXPECT_TRUE(one.rule().acceptable);
  one.candidate.residual.check_rows[0].residual = std::nan("");
  EXPECT_FALSE(one.rule().acceptable) << "what is not a number is not better";
}

TEST(AcceptanceDecision, ComparesTheSameRowsBeforeAndAfter) {
  Case one;
  for (CheckRow* row :
       {&one.unchanged.residual.check_rows[1], &one.candidate.residual.check_rows[2]})
    row->residual = 2e-4, row->outlier = true;
  const AcceptanceDecision decided = one.rule();
  EXPECT_DOUBLE_EQ(decided.check_before, 2e-4) << "without what either rejects";
  EXPECT_DOUBLE_EQ(decided.check_after, 1e-4);
}

TEST(AcceptanceDecision, IsAsSureAsTheRowsAreThatTheActiveParametersAreWorse) {
  Case one;  // sure that the maker's figures are worse, which nobody uses any more
  one.unchanged.residual.check_rows = check_rows({4e-4, 1e-4, 4e-4, 1e-4, 4e-4, 1e-4, 4e-4, 1e-4});
  one.candidate.residual.check_rows = check_rows({2e-4, 2e-4, 2e-4, 2e-4, 2e-4, 2e-4, 2e-4, 2e-4});
  EXPECT_LT(one.rule().check_after, 0.7 * one.rule().check_before);
  EXPECT_GT(one.rule().p_value, 0.05) << "half of them gain, half of them lose";
  EXPECT_FALSE(one.rule().acceptable);
  EXPECT_THAT(one.rule().why, HasSubstr("do not say that the active parameters are worse"));
  for (CheckRow& row : one.unchanged.residual.check_rows) row.residual = 4e-4;
  EXPECT_LT(one.rule().p_value, 0.01);
  EXPECT_TRUE(one.rule().acceptable);
  for (CheckRow& row : one.candidate.residual.check_rows) row.configuration = 0;
  EXPECT_DOUBLE_EQ(one.rule().p_value, 0.5) << "eight repeats are one configuration";
  EXPECT_FALSE(one.rule().acceptable);
}

TEST(AcceptanceDecision, ExcusesNoRowThatTheCandidateAloneMakesFar) {
  Case one;
  one.unchanged.residual.check_rows.assign(40, {2e-4});
  one.candidate.residual.check_rows.assign(40, {1e-4});
  for (int row = 0; row < 40; ++row)
    for (auto* rows : {&one.unchanged.residual.check_rows, &one.candidate.residual.check_rows})
      (*rows)[row].configuration = row;
  EXPECT_TRUE(one.rule().acceptable);
  one.candidate.residual.check_rows[7].residual = 9e-3;
  one.candidate.residual.check_rows[7].outlier = true;
  EXPECT_FALSE(one.rule().acceptable);
  EXPECT_THAT(one.rule().why, HasSubstr("some of them are met much worse"));
  // A false trigger is far under both.
  one.unchanged.residual.check_rows[7] = one.candidate.residual.check_rows[7];
  one.unchanged.residual.check_rows[7].noise = 1e-4;
  EXPECT_TRUE(one.rule().acceptable);
}

TEST(AcceptanceDecision, SaysNothingOfRowsThatOneModelAloneMeets) {
  Case one;
  for (auto* rows : {&one.unchanged.residual.check_rows, &one.candidate.residual.check_rows})
    for (int row = 0; row < 5; ++row) (*rows)[row].row = 10 * row;
  CheckRow& closed = one.candidate.residual.check_rows.emplace_back();  // its loop closes now
  closed = {5e-3, true, 5};
  closed.row = 50;
  EXPECT_TRUE(one.rule().acceptable);
  EXPECT_DOUBLE_EQ(one.rule().check_after, 1e-4);
}

TEST(AcceptanceDecision, HasALimitOfItsOwnForEachPartOfTheMachine) {
  const ByPart limits{1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3};
  const std::tuple<Part, Quantity, double> each[] = {
      {Part::link, Quantity::length, 1e-3}, {Part::link, Quantity::angle, 2e-3},
      {Part::base, Quantity::length, 3e-3}, {Part::base, Quantity::angle, 4e-3},
      {Part::tool, Quantity::length, 5e-3}, {Part::tool, Quantity::angle, 6e-3}};
  for (const auto& [part, quantity, limit] : each)
    for (const double sign : {-1.0, 1.0}) {
      Case one;
      one.accept.largest_change = limits;
      ParameterResult& parameter = one.find(part, quantity);
      const double value = parameter.value;
      parameter.value = value + sign * 0.99 * limit;
      EXPECT_TRUE(one.rule().acceptable) << parameter.parameter.name;
      parameter.value = value + sign * 1.01 * limit;
      EXPECT_FALSE(one.rule().acceptable) << parameter.parameter.name;
      EXPECT_THAT(one.rule().why, HasSubstr(parameter.parameter.name + " changes by"));
      EXPECT_THAT(one.rule().why, HasSubstr("look at the robot first"));
    }
}

TEST(AcceptanceDecision, TakesALimitOfZeroAsNoChangeAtAll) {
  Case one;
  one.accept.largest_change.length = 0;
  EXPECT_TRUE(one.rule().acceptable) << "nothing has changed";
  one.find(Part::link, Quantity::length).value += 1e-9;
  EXPECT_FALSE(one.rule().acceptable);
}

TEST(AcceptanceDecision, CountsAsPutAsideOnlyRowsThatWereNotToIdentify) {
  Case one;
  one.candidate.outliers = {{3, "table", 4e-4, false, "outlier"},
                            {7, "table", 3e-4, true, "outlier among the check rows"},
                            {9, "wall", 2e-4, false, "outlier"}};
  EXPECT_EQ(count_outliers(one.candidate), 2);
}

TEST(AcceptanceDecision, CountsTheParametersThatAreIdentified) {
  Case one;
  one.candidate.parameters[0].status = Status::held;
  one.candidate.parameters[1].status = Status::grouped;
  EXPECT_EQ(parameters_identified(one.candidate), rx90().parameters().size() - 2);
}

}  // namespace
}  // namespace selfcal
