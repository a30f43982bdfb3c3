// Configurations that are visited again minutes later, as is common practice, beside those that are
// repeated at once.
#include "diagnosis/evidence/visits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "diagnosis/diagnosis.h"
#include "diagnosis/evidence/discrepancy.h"
#include "diagnosis/search/shapes.h"
#include "io/files/robot_file.h"
#include "tests/diagnosis/two_sessions.h"
#include "tests/recovery/session.h"

namespace selfcal {
namespace {

TEST(Visits, AreOneWhereNothingComesBetweenAndLittleTimePasses) {
  Observations rows;
  rows.q.setZero(7, 1);
  rows.set = {0, 0, 0, 0, 0, 1, 1};
  rows.repeat = {3, 3, -1, 3, 3, 3, 3};
  EXPECT_EQ(visits(rows), (std::vector<int>{0, 0, 1, 2, 2, 3, 3}));
  rows.time.resize(7);
  rows.time << 0, 70, 20, 80, 90, 100, 161;  // the second row was taken after the third
  EXPECT_EQ(visits(rows), (std::vector<int>{0, 2, 1, 2, 2, 3, 4}));
}

/// Some configurations of a robot without any effect, under a tracker: then the first `again` of
/// them twice at once, and all of these once more an hour later.
struct Revisited {
  Revisited(int rows, int again, double of_visits) {
    auto loaded = load_robot(SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml");
    if (!loaded) std::abort();
    robot = *std::move(loaded);
    const Node tracker = recovery::entry({{"method", "position"}, {"noise", "2e-5"}});
    const DataSet exact = recovery::make_session(*robot, nominal_values(*robot),
                                                 {{"tracker", tracker, rows}}, 0, random)
                              .data;
    std::vector<int> take;
    for (int row = 0; row < rows; ++row)
      for (int i = 0; i < (row < again ? 2 : 1); ++i) take.push_back(row);
    const size_t first = take.size();
    for (int row = 0; row < again; ++row) take.insert(take.end(), 2, row);
    data = exact;
    data.rows = taken(exact.rows, take);
    const int n = data.rows.rows();
    data.rows.repeat.assign(take.size(), -1);
    data.rows.time.resize(n);
    for (int i = 0; i < n; ++i) {
      if (take[i] < again) data.rows.repeat[i] = take[i];
      data.rows.check[i] = take[i] >= again && take[i] % 3 == 2;
      data.rows.time[i] = 10.0 * i + (i < static_cast<int>(first) ? 0 : 3600);
    }
    measure(of_visits);
  }

  void measure(double of_visits) {
    std::normal_distribution<double> normal;
    const std::vector<int> visit = visits(data.rows);
    Eigen::RowVector3d shared;
    for (int i = 0; i < data.rows.rows(); ++i) {
      const bool same = i > 0 && visit[i] == visit[i - 1];
      for (int c = 0; c < 3; ++c) {
        if (!same) shared[c] = of_visits * normal(random);
        data.rows.position(i, c) += kTrackerNoise * (shared[c] + normal(random));
      }
    }
  }

  Random random{7};
  std::shared_ptr<const Robot> robot;
  DataSet data;
};

TEST(Visits, TellTheirNoiseApartFromThatOfImmediateRepeats) {
  Observations rows;
  DenseEquations equations;
  std::vector<double> left;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  double of_visit = 0;
  constexpr int kConfigurations = 400;             // the estimate is then good to a twentieth
  for (int i = 0; i < 4 * kConfigurations; ++i) {  // two visits of two rows each
    if (i % 2 == 0) of_visit = 2 * normal(random);
    rows.set.push_back(0);
    rows.repeat.push_back((i / 2) % kConfigurations);
    equations.row.push_back(i);
    left.push_back(1e3 * (of_visit + normal(random)));
  }
  rows.q.setZero(static_cast<Eigen::Index>(left.size()), 1);
  const Eigen::Map<const Eigen::VectorXd> all(left.data(), static_cast<Eigen::Index>(left.size()));
  EXPECT_NEAR(noise_of_visits(rows, equations, all), 2, 0.2);
  rows.repeat.assign(rows.repeat.size(), -1);
  EXPECT_EQ(noise_of_visits(rows, equations, all), 0);
}

TEST(Visits, MakeCovariancesOfAllThatRowsMayShare) {
  Revisited session(60, 12, 0);
  DenseEquations rows;
  const int n = session.data.rows.rows();
  rows.shift = Eigen::MatrixXd::Zero(n, 3);
  rows.shift.col(2).setConstant(1e5);
  for (int i = 0; i < n; ++i) rows.row.push_back(i);
  std::vector<Eigen::Isometry3d> ends(n, Eigen::Isometry3d::Identity());
  for (int i = 0; i < n; ++i) ends[i].translation() = session.data.rows.position.row(i).transpose();
  int of_time = 0;
  for (const double of_visits : {0.0, 3.0})
    for (const DiscrepancyCovariance& each :
         structures(session.data.rows, rows, ends, 4 / 3.0,
                    {.readings = {Eigen::MatrixXd::Ones(n, 6), reading_steps(session.data.rows.q)},
                    .alike = session.data.rows.q},
                    of_visits)) {
      const Eigen::MatrixXd S = each.matrix();
      EXPECT_TRUE(S.allFinite()) << in_words({static_cast<KernelDomain>(each.kind)});
      EXPECT_GT(S.llt().matrixL().toDenseMatrix().diagonal().minCoeff(), 0.99);
      of_time += each.kind == static_cast<int>(KernelDomain::time);
    }
  EXPECT_GT(of_time, 0);
}

DiagnosisOptions without_simulation() {
  DiagnosisOptions options = quick();
  options.search.extended_singles = options.search.extended_pairs = 4;
  return options;
}

TEST(Visits, MinutesApartAreDiagnosedAndTheirOwnNoiseIsNoCause) {
  const Revisited session(60, 15, 3);
  const Diagnosis diagnosis = diagnose(session.robot, session.data, without_simulation());
  EXPECT_EQ(diagnosis.problem, "");
  EXPECT_EQ(diagnosis.verdict.effect, kNone) << diagnosis.why;
  EXPECT_NEAR(diagnosis.noise / kTrackerNoise, std::sqrt(10.0), 0.8) << "of a new configuration";
}

TEST(Visits, ShowAZeroThatMovedBetweenThem) {
  Revisited session(60, 15, 1);
  for (int i = 0; i < session.data.rows.rows(); ++i)
    if (session.data.rows.time[i] > 3600) session.data.rows.q(i, 2) -= 5e-4;
  const Diagnosis diagnosis = diagnose(session.robot, session.data, without_simulation());
  EXPECT_EQ(diagnosis.verdict.effect, "zero_shift") << diagnosis.why;
  EXPECT_THAT(diagnosis.verdict.where, testing::ElementsAre("j3"));
}

TEST(OrderOfRows, StandsForTheTimeAndIsSaid) {
  TwoSessions sessions;
  DataSet& data = sessions.before;
  const int rows = data.rows.rows();
  data.order_is_time = true;
  data.rows.time = Eigen::VectorXd::LinSpaced(rows, 0, rows - 1);
  for (int row = 25; row < rows; ++row)
    data.rows.q(row, 2) -= 5e-4;  // the 26th and all that follow
  const Diagnosis diagnosis = diagnose(sessions.robot, data, without_simulation());
  EXPECT_EQ(diagnosis.verdict.effect, "zero_shift") << diagnosis.why;
  EXPECT_THAT(diagnosis.verdict.where, testing::ElementsAre("j3"));
  int told = 0, before = 0, behind = 0;
  ASSERT_EQ(std::sscanf(diagnosis.verdict.shape.c_str(), "from row %d on, between rows %d and %d",
                        &told, &before, &behind),
            3)
      << diagnosis.verdict.shape;
  EXPECT_NEAR(told, 26, 1);
  EXPECT_LE(before, 25);
  EXPECT_GE(behind, 26);
  EXPECT_LE(behind - before, 3);
  EXPECT_THAT(diagnosis.warnings, testing::Contains(testing::HasSubstr("order is taken for it")));
}

TEST(RowsPutAside, AreOfferedToACauseThatActsInThemAlone) {
  TwoSessions sessions;
  DataSet& data = sessions.before;
  const int rows = data.rows.rows();
  data.rows.time = Eigen::VectorXd::LinSpaced(rows, 0, 10.0 * (rows - 1));
  data.rows.q.col(2).tail(6).array() -= 1e-3;  // beyond what the geometry's fit takes for noise
  const Diagnosis diagnosis = diagnose(sessions.robot, data, without_simulation());
  EXPECT_EQ(diagnosis.verdict.effect, "zero_shift") << diagnosis.why;
  EXPECT_THAT(diagnosis.verdict.where, testing::ElementsAre("j3"));
  EXPECT_LE(diagnosis.outliers.size(), 1U);
}

/// Of many rows a step is looked for between few at first: those between that moment and its own
/// are beyond the noise, and must speak for a finer one all the same.
TEST(RowsPutAside, SpeakForTheMomentOfAStepThatAFewMomentsMissed) {
  const TwoSessions sessions;
  DataSet data = sessions.before;
  std::vector<int> twice(2 * static_cast<std::size_t>(data.rows.rows()));
  for (std::size_t i = 0; i < twice.size(); ++i) twice[i] = static_cast<int>(i / 2);
  data.rows = taken(data.rows, twice);
  const auto rows = static_cast<int>(data.rows.rows());
  data.rows.time = Eigen::VectorXd::LinSpaced(rows, 0, 10.0 * (rows - 1));
  data.rows.repeat.assign(twice.size(), -1);
  for (const int first : {53, 55, 57, 59}) {
    DataSet stepped = data;
    stepped.rows.q.col(2).tail(rows - first).array() -= 5e-3;
    const Diagnosis diagnosis = diagnose(sessions.robot, stepped, without_simulation());
    EXPECT_EQ(diagnosis.verdict.effect, "zero_shift") << diagnosis.why;
    EXPECT_TRUE(diagnosis.outliers.empty()) << first;
    int told = 0, before = 0, behind = 0;
    ASSERT_EQ(std::sscanf(diagnosis.verdict.shape.c_str(), "from %d s on, between %d and %d s",
                          &told, &before, &behind),
              3)
        << diagnosis.verdict.shape;
    EXPECT_LT(before, 10 * first) << diagnosis.verdict.shape;
    EXPECT_GE(behind, 10 * first) << diagnosis.verdict.shape;
    EXPECT_LE(behind - before, 30) << diagnosis.verdict.shape;
  }
}

TEST(AskedEffects, StepBetweenTheRowsWhereItHappened) {
  TwoSessions sessions;
  DataSet& data = sessions.before;
  const int rows = data.rows.rows();
  data.rows.time = Eigen::VectorXd::LinSpaced(rows, 0, 10.0 * (rows - 1));
  for (const int first : {22, 23, 24, 25, 26}) {
    const Eigen::VectorXd before = data.rows.q.col(2);
    data.rows.q.col(2).tail(rows - first).array() -= 2e-3;
    const ChosenEffects chosen = choose_effects(sessions.robot, data, {"zero_shift@j3"});
    data.rows.q.col(2) = before;
    ASSERT_EQ(chosen.effects.size(), 1U) << chosen.problem;
    EXPECT_NEAR(*chosen.effects.front().shape.moment, 10 * first - 5, 11);
  }
}

/// A drift of a fifth of a millimetre over the rows, a second from one to the next.
Diagnosis of_drift(bool order_is_time) {
  TwoSessions sessions;
  DataSet& data = sessions.before;
  const int rows = data.rows.rows();
  data.order_is_time = order_is_time;
  data.rows.time = Eigen::VectorXd::LinSpaced(rows, 0, rows - 1);
  for (int row = 0; row < rows; ++row)
    data.rows.position.row(row) += 2e-4 * row / rows * Eigen::RowVector3d(1, -0.5, 0.5);
  return diagnose(sessions.robot, data, without_simulation());
}

TEST(OrderOfRows, MakesADriftHalfAsSureAndNamesItAllTheSame) {
  const CauseResult by_time = of_drift(false).verdict, by_order = of_drift(true).verdict;
  EXPECT_EQ(by_time.effect, "base_drift");
  EXPECT_GT(by_time.probability, 0.94);
  EXPECT_THAT(by_time.confounded_with, testing::IsEmpty());
  EXPECT_EQ(by_order.effect, "base_drift");
  EXPECT_NEAR(by_order.probability, by_time.probability / 2, 0.01);
  EXPECT_NEAR(by_order.together, by_time.probability, 0.01);
  EXPECT_THAT(by_order.confounded_with, testing::ElementsAre("unknown"));
}

}  // namespace
}  // namespace selfcal
