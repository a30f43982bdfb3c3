#include "diagnosis/search/sign_flip_test.h"

#include <gtest/gtest.h>

#include "diagnosis/evidence/discrepancy.h"
#include "kinematics/size.h"
#include "tests/diagnosis/two_sessions.h"

namespace selfcal {
namespace {

TEST(LeastProbabilityOfNone, IsThatOfThePublishedTable) {
  // Sellke, Bayarri and Berger, The American Statistician 55 (2001), table 1.
  EXPECT_NEAR(least_probability_of_none(0.1), 0.385, 5e-4);
  EXPECT_NEAR(least_probability_of_none(0.05), 0.289, 5e-4);
  EXPECT_NEAR(least_probability_of_none(0.01), 0.111, 5e-4);
  EXPECT_NEAR(least_probability_of_none(0.001), 0.0184, 5e-5);
  EXPECT_EQ(least_probability_of_none(0.5), 0.5);
}

TEST(ShareAsGood, GoesOnBeyondTheResamplesAsTheirTailDoes) {
  std::vector<double> found;
  for (int i = 1; i <= 199; ++i) found.push_back(-std::log(i / 200.0));  // exponential, exactly
  EXPECT_DOUBLE_EQ(share_as_good(found, 3), 10.0 / 200);
  // The truth is e^-9 = 1.2e-4; two sigma of a tail of 39 make it larger, at most by e^(0.24
  // x 7.4).
  EXPECT_GT(share_as_good(found, 9), 1.2e-4);
  EXPECT_LT(share_as_good(found, 9), 8e-4);
  EXPECT_LT(share_as_good(found, 20), share_as_good(found, 9));
  EXPECT_EQ(share_as_good(found, 1e4), 1e-6) << "nobody knows a tail so far";
  EXPECT_EQ(share_as_good({0.5, 3, 1, 2}, 9), 1.0 / 5) << "four are no tail";
  std::vector<double> without(199, -INFINITY);
  EXPECT_EQ(share_as_good(without, 9), 1.0 / 200) << "nothing found at all is none either";
}

TEST(NullDistribution, CountsWhatIsAsGoodAndTheRowsThemselves) {
  const NullDistribution null({0.5, 3, 1, 2});
  EXPECT_EQ(null.p_of(4), 1.0 / 5);
  EXPECT_EQ(null.p_of(3), 2.0 / 5);
  EXPECT_EQ(null.p_of(0), 1);
}

/// A session's rows as the search sees them.
struct Seen {
  explicit Seen(const DataSet& session, double most_outliers = 0.02)
      : data(session),
        options(with(most_outliers)),
        linearised(TwoSessions(2).robot, data, options, {}),
        rows(linearised.kept()),
        evaluator(linearised.whitened(),
                  structures(data.rows, rows, linearised.ends(), size_of(linearised.geometry()),
                             linearised.joint_errors()),
                  linearised.candidates(), linearised.parameters(), options.search) {}

  static DiagnosisOptions with(double most_outliers) {
    DiagnosisOptions options = quick();
    options.most_outliers = most_outliers;
    return options;
  }

  const DataSet data;
  const DiagnosisOptions options;
  LinearisedModel linearised;
  const DenseEquations rows;
  EvidenceEvaluator evaluator;
};

/// 20 um of normal noise more.
DataSet noisy(int rows, unsigned seed) {
  DataSet data = TwoSessions(rows).before;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, kTrackerNoise);
  for (double& each : data.rows.position.reshaped()) each += normal(random);
  return data;
}

TEST(NullDistribution, LetsNoiseHaveTheOutliersThatTheSearchMayPutAside) {
  DataSet data = noisy(120, 5);
  for (const int row : {3, 21, 36, 48, 66, 87})
    data.rows.position(row, row % 3) += 3e-4;  // ten sigma
  Seen seen(data, 0);                          // nothing is put aside yet
  const NullDistribution with(seen.linearised, seen.evaluator, data.rows, 40, 1, 0.1),
      without(seen.linearised, seen.evaluator, data.rows, 40, 1, 0);
  double more = 0, less = 0;
  for (double found = -10; found < 40; found += 0.5) {
    more += with.p_of(found) > without.p_of(found);
    less += with.p_of(found) < without.p_of(found);
  }
  EXPECT_GE(more, 3) << "noise looks more like a cause once it may leave rows out";
  EXPECT_EQ(less, 0);
}

TEST(EvidenceEvaluator, FindsTheSameInManyRowsAtOnceAsInOneAfterTheOther) {
  Seen seen(noisy(60, 2));
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd Y(seen.evaluator.rows().rows().y.size(), 6);
  for (double& each : Y.reshaped()) each = normal(random);
  const auto statistics = seen.evaluator.statistics_of(Y, EvidenceEvaluator::Of::noise_alone);
  const auto found = seen.evaluator.best_found_in(statistics);
  ASSERT_EQ(found.size(), 6);
  for (int i = 0; i < 6; ++i) {
    seen.evaluator.condition_on(statistics, i);
    const EvidenceEvaluator::Found alone = seen.evaluator.best_found();
    EXPECT_NEAR(found[i].log_odds, alone.log_odds, 1e-9);
    EXPECT_EQ(found[i].hypothesis.candidates, alone.hypothesis.candidates);
  }
}

TEST(EvidenceEvaluator, SearchesCoarselyForTheSameFamilies) {
  DiagnosisOptions options = quick();
  options.search.extended_singles = 4;
  options.search.extended_pairs = options.search.extended_further = 0;
  const DataSet data = noisy(60, 3);
  const LinearisedModel linearised(TwoSessions(2).robot, data, options, {});
  const EvidenceEvaluator evaluator(
      linearised.whitened(),
      structures(data.rows, linearised.kept(), linearised.ends(), size_of(linearised.geometry()),
                 linearised.joint_errors()),
      linearised.candidates(), linearised.parameters(), options.search);
  const Posterior whole = evaluator.search(), coarse = evaluator.search_coarsely(4);
  EXPECT_NEAR(coarse.none, whole.none, 1e-6);
  EXPECT_NEAR(coarse.unknown, whole.unknown, 1e-6);
  for (const auto& [family, probability] : whole.family)
    if (probability > 1e-6) {
      EXPECT_NEAR(coarse.family.at(family), probability, 1e-6) << family;
    }
}

TEST(UnknownByChance, IsRareForStructureAndNotForNoise) {
  double sum = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Seen noise(noisy(60, seed));
    sum += p_of_unknown(noise.linearised, noise.evaluator, {}, noise.data.rows, 99, 1) / 8;
  }
  EXPECT_NEAR(sum, 0.5, 0.3) << "even between 0 and 1: within three sigma of the mean of eight";
  // A bulge of the cell of five times the noise, which no known effect makes.
  DataSet data = noisy(120, 1);
  for (auto p : data.rows.position.rowwise()) p.z() += 1.5e-4 * std::sin(4 * p.x() + 5 * p.y());
  const Seen bulge(data);
  EXPECT_LE(p_of_unknown(bulge.linearised, bulge.evaluator, {}, data.rows, 99, 1), 0.01);
}

}  // namespace
}  // namespace selfcal
