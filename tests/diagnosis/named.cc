// What is named closes so far, everything found so far: each is that of a fit of its own.
#include "diagnosis/report/named.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/diagnosis.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/report/holdout_validation.h"
#include "io/files/robot_file.h"
#include "kinematics/corrected_robot.h"
#include "tests/diagnosis/two_sessions.h"
#include "tests/recovery/session.h"

namespace selfcal {
namespace {

constexpr double kNoise = 20e-6;  // m, of one coordinate

/// A robot whose second joint's gear errs, by far the largest, and whose third joint is dragged
/// along by the fifth; seen by a tracker in the world's frame.
struct TwoCauses {
  TwoCauses() {
    auto loaded = load_robot(SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml");
    if (!loaded) std::abort();
    robot = *std::move(loaded);
    Random random(5);
    const Node tracker = recovery::entry({{"method", "position"}, {"noise", "2e-5"}});
    data = recovery::make_session(*robot, nominal_values(*robot), {{"tracker", tracker, 150}},
                                  kNoise, random)
               .data;
    auto q2 = data.rows.q.col(1);
    q2.array() += 6e-4 * (3 * q2.array()).sin();
    data.rows.q.col(2) += 3e-4 * data.rows.q.col(4);
  }

  std::shared_ptr<const Robot> robot;
  DataSet data;
};

/// m, rms of the distance between measured and modelled positions of the check rows.
double left_by(const Robot& robot, const Eigen::VectorXd& xi, const Observations& rows) {
  double squares = 0;
  int count = 0;
  for (int row = 0; row < rows.rows(); ++row) {
    if (!rows.check[row]) continue;
    const Eigen::Vector3d measured = rows.position.row(row).transpose();
    squares += (locate(robot, xi, rows.q.row(row).transpose()).p - measured).squaredNorm();
    ++count;
  }
  return std::sqrt(squares / count);
}

/// The same of an identification of the geometry with the effects of `entries`, from the fit rows.
double left_by_fit_of(const TwoCauses& of, const std::vector<Node>& entries) {
  Problems problems;
  const std::shared_ptr<const Robot> model = correct(of.robot, entries, {}, problems);
  Options options;
  options.free = {"K*"};
  for (const Parameter& p : model->parameters())
    if (p.part == Part::effect) options.free.push_back(p.name);
  return left_by(*model, identify(*model, of.data, options).values, of.data.rows);
}

/// Of the corrected robot's file, the entries that it says are named; or those that are not.
std::vector<Node> entries_of(const Diagnosis& diagnosis, const char* named) {
  std::vector<Node> list;
  const Node file = diagnosis.model->text().describe(diagnosis.values);
  for (const Node& entry : file.find("effects")->items)
    if (const Node* flag = entry.find("named"); flag && flag->text == named) list.push_back(entry);
  return list;
}

// The fits of a diagnosis have priors as wide as the rows speak for, those of an identification ten
// times the usual: of 100 fit rows that shifts what is left by less than 2 %.
constexpr double kPriors = 0.02;

/// 1 - (after^2 - floor^2) / (before^2 - floor^2).
double share(const Gap& gap, double after) {
  const auto beyond = [&](double rms) { return rms * rms - gap.noise_floor * gap.noise_floor; };
  return 1 - beyond(after) / beyond(gap.rms_before);
}

TEST(Named, AreAllThatAreSureAndCloseAsFarAsFitsOfThemAlone) {
  const TwoCauses of;
  const Diagnosis diagnosis = diagnose(of.robot, of.data, quick());
  const Gap& gap = diagnosis.gap;
  ASSERT_EQ(diagnosis.verdict.effect, "transmission_error") << diagnosis.why;
  ASSERT_EQ(diagnosis.verdict.where, std::vector<std::string>{"j2"});
  ASSERT_EQ(gap.rows, std::ranges::count(of.data.rows.check, 1));
  ASSERT_EQ(diagnosis.named.size(), 2u) << diagnosis.why;
  EXPECT_EQ(diagnosis.named[1].effect, "joint_coupling");
  EXPECT_EQ(diagnosis.named[1].where, std::vector<std::string>{"j3"});

  const std::vector<Node> named = entries_of(diagnosis, "true"),
                          beside = entries_of(diagnosis, "false");
  std::vector<Node> of_gear, of_coupling;
  for (const Node& entry : named)
    (entry.find("effect")->text == "joint_coupling" ? of_coupling : of_gear).push_back(entry);
  ASSERT_FALSE(of_gear.empty() || of_coupling.empty());
  for (const Node& entry : of_gear) EXPECT_EQ(entry.find("at")->text, "j2");
  EXPECT_EQ(named.size() + beside.size(), diagnosis.found.size());

  EXPECT_NEAR(gap.rms_before, left_by_fit_of(of, {}), kPriors * gap.rms_before);
  EXPECT_NEAR(gap.rms_after, left_by_fit_of(of, named), kPriors * gap.rms_after);
  EXPECT_NEAR(gap.rms_all, left_by(*diagnosis.model, diagnosis.values, of.data.rows),
              1e-9 * gap.rms_all);
  // Each alone is a fit of its own; beside the other it adds what the fit of that leaves open.
  const double both = share(gap, gap.rms_after), gear = share(gap, left_by_fit_of(of, of_gear)),
               coupling = share(gap, left_by_fit_of(of, of_coupling));
  EXPECT_NEAR(*diagnosis.named[0].closes_alone, gear, 2 * kPriors);
  EXPECT_NEAR(*diagnosis.named[0].closes_beside, both - coupling, 4 * kPriors);
  EXPECT_NEAR(*diagnosis.named[1].closes_alone, coupling, 2 * kPriors);
  EXPECT_NEAR(*diagnosis.named[1].closes_beside, both - gear, 4 * kPriors);
  EXPECT_GT(*diagnosis.named[1].closes_beside, 0.05);
  for (const CauseResult& each : diagnosis.candidates)
    if (each.effect == diagnosis.verdict.effect) {
      EXPECT_EQ(each.probability, diagnosis.verdict.probability);
    }
}

TEST(Named, AreNotThoseThatCloseNothingOfTheRowsKeptAside) {
  const CauseResult large{.effect = "backlash", .closes_alone = 0.6, .closes_beside = 0.55},
      hidden{.effect = "joint_coupling", .closes_alone = -0.1, .closes_beside = 0.2},
      idle{.effect = "tool_shift", .closes_alone = 0.01, .closes_beside = -0.002},
      unjudged{.effect = "base_drift"};
  std::vector<CauseResult> named = {idle, large, hidden, unjudged};
  const std::vector<CauseResult> taken = take_idle(named);
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_EQ(taken.front().effect, "tool_shift");
  EXPECT_THAT(named, testing::ElementsAre(testing::Field(&CauseResult::effect, "backlash"),
                                          testing::Field(&CauseResult::effect, "joint_coupling"),
                                          testing::Field(&CauseResult::effect, "base_drift")));
  named = {idle, idle};
  EXPECT_TRUE(take_idle(named).empty()) << "nothing would be left";
  EXPECT_EQ(named.size(), 2u);
}

TEST(Named, ClosesNothingWhereOnlyOtherThingsAreFound) {
  const TwoCauses of;
  const DiagnosisOptions options = quick();
  const LinearisedModel linearised(of.robot, of.data, options, {});
  const ShapedEffect gear{"transmission_error", "j2", {.waves = {3}}};
  const std::vector<char> none(static_cast<size_t>(of.data.rows.rows()), 0);
  const auto closed = [&](bool named) {
    return gap_of(validate_on_holdout(linearised.shared_geometry(), linearised.adjusted(), of.data,
                                      {{gear, {}, {1e-3, 1e-3}, named}}, linearised.context(),
                                      {kNoise}, none, options)
                      .rows,
                  1);
  };
  const Gap found = closed(false), named = closed(true);
  EXPECT_EQ(found.rms_after, found.rms_before);
  EXPECT_EQ(*found.closed.fraction, 0);
  EXPECT_GT(*found.closed_all.fraction, 0.5);
  EXPECT_EQ(named.rms_after, named.rms_all);
  EXPECT_EQ(named.rms_all, found.rms_all);
}

TEST(Named, IsNotJudgedByRowsOfWhichAStepMayLieOnEitherSide) {
  const TwoCauses of;
  const DiagnosisOptions options = quick();
  const LinearisedModel linearised(of.robot, of.data, options, {});
  const auto judged = [&](const std::vector<char>& undecided) {
    return validate_on_holdout(linearised.shared_geometry(), linearised.adjusted(), of.data, {},
                               linearised.context(), {kNoise}, undecided, options);
  };
  std::vector<char> undecided(static_cast<size_t>(of.data.rows.rows()), 0);
  const HoldoutValidation all = judged(undecided);
  EXPECT_EQ(all.undecided, 0);
  const auto kept = std::ranges::find(of.data.rows.check, char{1}) - of.data.rows.check.begin();
  undecided[static_cast<size_t>(kept)] = 1;
  const HoldoutValidation others = judged(undecided);
  EXPECT_EQ(others.undecided, 1);
  ASSERT_EQ(others.rows.size() + 1, all.rows.size());
  EXPECT_EQ(others.rows.front().before, all.rows[1].before);
}

TEST(WithNamed, PutsBackThePlacesThatTheVerdictNames) {
  Candidates all;
  all.list = {{.effect = "backlash", .at = "j1"},
              {.effect = "backlash", .at = "j2"},
              {.effect = "backlash", .at = "j2"},
              {.effect = "zero_shift", .at = "j2"}};
  Posterior posterior;
  posterior.hypotheses = {{{0}, 0, -0.5, {4}}, {{2, 3}, 0, -1, {2, 8}}, {{1}, 0, -2, {1}}};
  const CauseResult verdict{.effect = "backlash", .where = {"j1", "j2"}};

  // Of the second place the shape that the most probable hypothesis has, with its size.
  const Hypothesis whole = with_named({{3, 0}, 0, 0, {8, 4}}, {verdict}, all, posterior);
  EXPECT_EQ(whole.candidates, (std::vector<int>{3, 0, 2}));
  EXPECT_EQ(whole.sizes, (std::vector<double>{8, 4, 2}));
  // What is there in any shape stays as it is, and nothing is put where nothing is named.
  EXPECT_EQ(with_named({{0, 1}, 0, 0, {4, 1}}, {verdict}, all, posterior).candidates,
            (std::vector<int>{0, 1}));
  EXPECT_EQ(with_named({{3}, 0, 0, {8}}, {}, all, posterior).candidates, std::vector<int>{3});
}

TEST(Names, TheVerdictsEffectAtItsPlaces) {
  const CauseResult verdict{.effect = "backlash", .where = {"j1", "j2"}};
  EXPECT_TRUE(names(verdict, {.effect = "backlash", .at = "j2"}));
  EXPECT_FALSE(names(verdict, {.effect = "backlash", .at = "j3"}));
  EXPECT_FALSE(names(verdict, {.effect = "zero_shift", .at = "j2"}));
  EXPECT_TRUE(names({.effect = "thermal_expansion"}, {.effect = "thermal_expansion", .at = ""}));
}

}  // namespace
}  // namespace selfcal
