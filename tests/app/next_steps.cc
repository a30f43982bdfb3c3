// What a person is told to do after an identification.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/report/next_steps.h"

#include "app/report/summary.h"

namespace selfcal {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

constexpr double kTarget = 1e-3;  // m

/// An identification that knows the end position to `sigma` (m), of which `noise` comes of the
/// rows' noise and `shared` of what no geometry explains.
Solution known_to(double sigma, double noise, double shared) {
  Solution solution;
  solution.converged = true;
  solution.verdict.answer = Answer::not_determined;
  solution.residual.check.rows = 30;
  solution.endpoint.poses = solution.workspace.poses = 300;
  solution.workspace.rms = sigma;
  solution.uncertainty.budget = {{std::string(kNoiseOfRows), noise},
                                 {std::string(kSharedErrors), shared}};
  solution.unexcited = {{"theta2", "hardly seen by these rows", "j2"}};
  return solution;
}

std::vector<std::string> steps_of(const Solution& solution) {
  DataSet data;
  data.target = kTarget;
  return next_steps(data, solution);
}

TEST(NextSteps, AskForRowsWhereNoiseIsTheLargestDoubt) {
  const std::vector<std::string> steps = steps_of(known_to(2e-3, 1.9e-3, 0.6e-3));
  EXPECT_THAT(steps, Contains(HasSubstr("2 mm only. Add rows that move j2 further.")));
  EXPECT_THAT(steps, Each(Not(HasSubstr("diagnose"))));
}

TEST(NextSteps, NameEachJointOnceWhoseMovementWouldHelp) {
  Solution solution = known_to(2e-3, 1.9e-3, 0.6e-3);
  solution.unexcited = {{"theta2", "", "j2"}, {"r3", "", ""}, {"d3", "", "j3"}, {"r2", "", "j2"}};
  EXPECT_THAT(steps_of(solution), Contains(HasSubstr("Add rows that move j2 and j3 further.")));
}

TEST(NextSteps, NameNoJointsWhereNoMovementWouldHelp) {
  Solution solution = known_to(2e-3, 1.9e-3, 0.6e-3);
  solution.unexcited = {{"theta2", "more rows in other postures would help"}};
  EXPECT_THAT(steps_of(solution), Contains(HasSubstr("Add rows in other postures.")));
  solution.unexcited.clear();
  EXPECT_THAT(steps_of(solution), Contains(HasSubstr("Add rows in other postures.")));
}

TEST(NextSteps, SendToTheDiagnosisWhereTheGeometryDoesNotExplainTheRows) {
  EXPECT_THAT(steps_of(known_to(2e-3, 0.6e-3, 1.9e-3)),
              AllOf(Contains(HasSubstr("more rows like these do not help")),
                    Contains(HasSubstr("selfcal diagnose"))));
}

TEST(NextSteps, SendRowsThatScatterMoreThanTheyShouldToTheDiagnosis) {
  Solution solution = known_to(0.5e-3, 0.4e-3, 0);
  solution.verdict.answer = Answer::improved;
  solution.sets.resize(1);
  EXPECT_THAT(steps_of(solution), Each(Not(HasSubstr("diagnose"))));
  solution.sets[0].unexplained = true;
  EXPECT_THAT(steps_of(solution), AllOf(Contains(HasSubstr("The result is a candidate")),
                                        Contains(HasSubstr("selfcal diagnose"))));
}

TEST(NextSteps, SendACandidateToTheDiagnosisAsWell) {
  Solution solution = known_to(0.5e-3, 0.2e-3, 0.4e-3);
  solution.verdict.answer = Answer::improved;
  EXPECT_THAT(steps_of(solution), AllOf(Contains(HasSubstr("The result is a candidate")),
                                        Contains(HasSubstr("selfcal diagnose"))));
}

TEST(NextSteps, AskForMoreConfigurationsAsideWhereTooFewJudge) {
  Solution solution = known_to(0.5e-3, 0.4e-3, 0);
  solution.verdict.answer = Answer::not_determined;
  solution.residual.check.configurations = 4;
  EXPECT_THAT(steps_of(solution), Contains(HasSubstr("Keep at least 5 configurations aside")));
  solution.residual.check.configurations = 5;
  EXPECT_THAT(steps_of(solution), Contains(HasSubstr("Mend what the verdict")));
}

TEST(Summary, CountsOneRowAndGivesANoiseOfAnglesAlone) {
  Solution solution = known_to(0.5e-3, 0.4e-3, 0);
  solution.residual.check.rows = 1;
  EXPECT_THAT(headline(solution), HasSubstr("on 1 row kept aside"));
  solution.sets.resize(1);
  SetResult& set = solution.sets[0];
  set.name = "one";
  set.method = "bearing";
  set.rows = set.used = 80;
  set.identifies = true;
  set.noise_angle_sigma = 20e-6;
  EXPECT_THAT(summary({}, solution), HasSubstr("one (bearing): 80 of 80 rows used, noise 20 urad"));
}

TEST(NextSteps, DoNotKeepTheMakersFiguresForWantOfRowsThatJudge) {
  Solution solution = known_to(0.5e-3, 0.4e-3, 0);
  solution.verdict.answer = Answer::not_improved;
  solution.residual.check.configurations = 5;
  for (const double after : {8e-5, 9e-5, 7e-5, 8e-5, 5.2e-3})  // the last one is a false reading
    solution.residual.rows.push_back(
        {.check = true, .before = after > 1e-3 ? 5e-3 : 5e-4, .after = after});
  solution.residual.check.rms_after = 2.3e-3;
  solution.residual.check.rms_without_outliers = 8e-5;
  EXPECT_THAT(steps_of(solution),
              Contains(HasSubstr("Keep more configurations aside than 5 (column part), and look at "
                                 "those beyond the noise")));
  EXPECT_THAT(headline(solution), HasSubstr("Not improved: that these rows are met better may be "
                                            "chance"));
  for (RowFigure& row : solution.residual.rows) row.before = row.after * 1.1;
  EXPECT_THAT(steps_of(solution), Contains(HasSubstr("keep them")));
  EXPECT_THAT(headline(solution), HasSubstr("the maker's figures explain the rows as well"));
}

TEST(NextSteps, AskHowWellIsKnownWhatIsGivenWhereThatIsMostOfTheDoubt) {
  Solution solution = known_to(0.5e-3, 0.2e-3, 0);
  solution.verdict.answer = Answer::improved;
  const auto asks = Contains(HasSubstr("Say how well the surfaces and lengths are known"));
  solution.uncertainty.budget.push_back({std::string(kWhatWasGiven), 0.3e-3});
  EXPECT_THAT(steps_of(solution), Not(asks));
  solution.uncertainty.budget.back().sigma = 0.45e-3;
  EXPECT_THAT(steps_of(solution), Not(asks)) << "a gear's ratio is given, and no set gives any";
  solution.scale.stands_on.resize(1);
  EXPECT_THAT(steps_of(solution), asks);
  DataSet data;
  data.target = kTarget;
  data.sets.resize(1);
  data.sets[0].given.place = 1e-5;
  EXPECT_THAT(next_steps(data, solution), Not(asks)) << "it is said already";
}

}  // namespace
}  // namespace selfcal
