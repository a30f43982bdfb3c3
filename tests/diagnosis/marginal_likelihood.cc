// The evidence against the same integral worked out whole: with flat priors on the geometry,
//   log p(y) = -1/2 log|S| - 1/2 log|A' S^-1 A| - nu/2 log(y' P y) + const,  nu = n - rank A
// where S is the covariance of noise and causes, P = S^-1 - S^-1 A (A' S^-1 A)^-1 A' S^-1.
#include "diagnosis/evidence/marginal_likelihood.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <random>

#include "constraints/statistics.h"

namespace selfcal {
namespace {

Eigen::MatrixXd random_matrix(int rows, int columns, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Eigen::MatrixXd M(rows, columns);
  for (double& x : M.reshaped()) x = normal(random);
  return M;
}

/// Any covariance, as noise of which all equations share a part.
std::shared_ptr<const NoiseBlocks> one_block(const Eigen::MatrixXd& covariance) {
  std::vector<int> all(static_cast<size_t>(covariance.rows()));
  std::iota(all.begin(), all.end(), 0);
  return std::make_shared<const NoiseBlocks>(std::vector<std::vector<int>>{all},
                                             [&](int i, int j) { return covariance(i, j); });
}

struct Case {
  Case() {
    std::mt19937_64 random(3);
    rows.A = random_matrix(14, 3, random);
    rows.weight = rows.pull = Eigen::VectorXd::Zero(3);
    rows.C = random_matrix(14, 4, random);
    rows.y = random_matrix(14, 1, random);
    structure.blocks = one_block(Eigen::MatrixXd::Identity(14, 14));
  }
  MarginalLikelihood likelihood() const {
    return {std::make_shared<const Whitened>(rows), structure,
            Groups{first.columns, second.columns}};
  }
  Whitened rows;
  DiscrepancyCovariance structure;
  Block first{{0, 1}, Eigen::Vector2d(0.5, 2), 0};
  Block second{{3}, Eigen::VectorXd::Constant(1, 1.5), 1};
};

double worked_out_whole(const Whitened& rows, const Eigen::MatrixXd& noise,
                        const std::vector<MarginalLikelihood::Term>& terms) {
  Eigen::MatrixXd S = noise;
  for (const MarginalLikelihood::Term& term : terms)
    for (size_t k = 0; k < term.block->columns.size(); ++k) {
      const Eigen::VectorXd c = rows.C.col(term.block->columns[k]) * term.size *
                                term.block->unit[static_cast<Eigen::Index>(k)];
      S += c * c.transpose();
    }
  const Eigen::MatrixXd inverse = S.inverse();
  const Eigen::MatrixXd information = rows.A.transpose() * inverse * rows.A;
  const Eigen::MatrixXd P =
      inverse - inverse * rows.A * information.inverse() * rows.A.transpose() * inverse;
  const double nu = static_cast<double>(rows.A.rows() - rows.A.cols());
  return -0.5 * std::log(S.determinant()) - 0.5 * std::log(information.determinant()) -
         nu / 2 * std::log(rows.y.dot(P * rows.y));
}

constexpr double kEvidenceRounding = 1e-9;

TEST(MarginalLikelihood, GivesTheEvidenceThatTheWholeIntegralGives) {
  const Case one;
  const MarginalLikelihood likelihood = one.likelihood();
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(14, 14);
  const std::vector<MarginalLikelihood::Term> none, both{{&one.first, 1.3}, {&one.second, 0.4}};
  EXPECT_NEAR(likelihood.log_evidence(none), worked_out_whole(one.rows, I, none),
              kEvidenceRounding);
  EXPECT_NEAR(likelihood.log_evidence(both), worked_out_whole(one.rows, I, both),
              kEvidenceRounding);
  EXPECT_NEAR(likelihood.log_evidence(both, likelihood.gram({0, 1, 3})),
              likelihood.log_evidence(both), kEvidenceRounding);
}

/// log of the integral over s of s^-(nu + 1) exp(-Q / 2 s^2) from `least` on, over the same from 0
/// on in closed form: by the trapezium rule in log s.
double share_of_large_noise(double Q, double nu, double least) {
  double above = 0, all = 0;
  constexpr double kStep = 1e-5;
  for (double log_s = -8; log_s < 8; log_s += kStep) {
    const double each = std::exp(-nu * log_s - Q / 2 * std::exp(-2 * log_s));
    all += each;
    if (std::exp(log_s) >= least) above += each;
  }
  return std::log(above / all);
}

TEST(MarginalLikelihood, TakesNoNoiseForLessThanItsDataSheetSays) {
  Case one;
  const std::vector<MarginalLikelihood::Term> none, both{{&one.first, 1.3}, {&one.second, 0.4}};
  const MarginalLikelihood free = one.likelihood();
  const double nu = free.freedom();
  const double left = nu * free.estimate(both).variance;
  for (const double least : {0.5, 1.0, 2.0}) {
    one.rows.least = least * least;
    const MarginalLikelihood bound = one.likelihood();
    EXPECT_NEAR(bound.log_evidence(none) - free.log_evidence(none),
                share_of_large_noise(free.total(), nu, least), 1e-3);
    EXPECT_NEAR(bound.log_evidence(both) - free.log_evidence(both),
                share_of_large_noise(left, nu, least), 1e-3);
    EXPECT_GE(bound.estimate(both).variance, least * least);
  }
}

/// log of the integral over s and v = s u of one column's likelihood times its prior, which has
/// 0.99 of its mass where v is positive, over the same with a prior that is even: by sums.
double worth_of_sign(double yy, double g, double G, double nu, double prior) {
  double signed_sum = 0, even_sum = 0;
  constexpr double kStep = 0.01;
  for (double log_s = -5; log_s < 5; log_s += kStep)
    for (double in_priors = -8 + kStep / 2; in_priors < 8; in_priors += kStep) {
      const double u = in_priors * prior, s = std::exp(log_s);
      const double each = std::exp(-nu * log_s - (yy / (s * s) - 2 * g * u / s + G * u * u) / 2 -
                                   in_priors * in_priors / 2);
      even_sum += each;
      signed_sum += 2 * (u > 0 ? 0.99 : 0.01) * each;
    }
  return std::log(signed_sum / even_sum);
}

TEST(MarginalLikelihood, BelievesTheSignThatPhysicsAllows) {
  Case one;
  const Block even = one.second;
  one.second.positive = {0};
  for (const double truth : {0.8, 0.0, -0.8}) {
    std::mt19937_64 random(11);
    one.rows.y = truth * one.rows.C.col(3) + 0.7 * random_matrix(14, 1, random).col(0);
    const MarginalLikelihood likelihood = one.likelihood();
    const std::vector<MarginalLikelihood::Term> with{{&one.second, 1}}, without{{&even, 1}};
    const double worth = likelihood.log_evidence(with) - likelihood.log_evidence(without);
    EXPECT_NEAR(worth,
                worth_of_sign(likelihood.total(), likelihood.right()[3], likelihood.gram({3})(0, 0),
                              likelihood.freedom(), even.unit[0]),
                1e-3);
    EXPECT_LE(worth, std::log(1.98));
    EXPECT_GE(worth, std::log(0.02));
    EXPECT_NEAR(likelihood.given(with).log_evidence({}), likelihood.log_evidence(with),
                kEvidenceRounding);
    EXPECT_NEAR(likelihood.log_evidence(with, likelihood.gram({3})), likelihood.log_evidence(with),
                kEvidenceRounding);
  }
}

TEST(MarginalLikelihood, WeighsStructureAsPartOfTheNoise) {
  Case one;
  std::mt19937_64 random(5);
  const Eigen::MatrixXd B = random_matrix(14, 14, random);
  const Eigen::MatrixXd noise = Eigen::MatrixXd::Identity(14, 14) + B * B.transpose() / 14;
  one.structure = {.kind = 1, .kappa = 1, .blocks = one_block(noise)};
  const MarginalLikelihood likelihood = one.likelihood();
  const std::vector<MarginalLikelihood::Term> terms{{&one.first, 1}};
  EXPECT_NEAR(likelihood.log_evidence(terms), worked_out_whole(one.rows, noise, terms),
              kEvidenceRounding);
}

/// Structure over noise that pairs of equations share, by the few directions that hold it; and the
/// same covariance as a whole.
struct Kernel {
  Kernel() {
    std::mt19937_64 random(9);
    std::vector<std::vector<int>> pairs;
    for (int i = 0; i < 14; i += 2) pairs.push_back({i, i + 1});
    const auto noise =
        std::make_shared<const NoiseBlocks>(pairs, [](int i, int j) { return i == j ? 1.3 : 0.2; });
    const Eigen::MatrixXd F = random_matrix(14, rank, random);
    fast = {.kind = 2,
            .kappa = 1.7,
            .blocks = noise,
            .kernel = std::make_shared<const KernelBasis>(basis_of_root(*noise, F)),
            .noise = 1.4};
    const Eigen::MatrixXd whole =
        DiscrepancyCovariance{.blocks = noise}.matrix() + 1.7 * 1.7 * F * F.transpose();
    plain = {.kind = 2, .kappa = 1.7, .blocks = one_block(whole), .noise = 1.4};
  }
  static constexpr int rank = 5;
  DiscrepancyCovariance fast, plain;
};

TEST(MarginalLikelihood, SaysOfAKernelByItsDirectionsWhatTheWholeCovarianceSays) {
  const Kernel kernel;
  EXPECT_EQ(kernel.fast.kernel->variance.size(), Kernel::rank);
  EXPECT_TRUE(kernel.fast.matrix().isApprox(kernel.plain.matrix(), 1e-12));
  Case one;
  one.rows.weight = Eigen::Vector3d(0.3, 2, 0);
  one.rows.pull = Eigen::Vector3d(1, -0.5, 0);
  one.rows.least = 0.2;
  one.first.positive = {1};
  const auto likelihood = [&](const DiscrepancyCovariance& structure) {
    Case of = one;
    of.structure = structure;
    return of.likelihood();
  };
  const MarginalLikelihood fast = likelihood(kernel.fast), plain = likelihood(kernel.plain);
  const std::vector<MarginalLikelihood::Term> first{{&one.first, 1.3}}, second{{&one.second, 0.4}},
      both{{&one.first, 1.3}, {&one.second, 0.4}};
  EXPECT_NEAR(fast.freedom(), plain.freedom(), kEvidenceRounding);
  EXPECT_NEAR(fast.total(), plain.total(), kEvidenceRounding);
  EXPECT_NEAR(fast.log_evidence({}), plain.log_evidence({}), kEvidenceRounding);
  EXPECT_NEAR(fast.log_evidence(first), plain.log_evidence(first), kEvidenceRounding);
  EXPECT_NEAR(fast.log_evidence(both), plain.log_evidence(both), kEvidenceRounding);
  EXPECT_NEAR(fast.given(first).log_evidence(second), plain.given(first).log_evidence(second),
              kEvidenceRounding);
  EXPECT_TRUE(fast.products({0, 3}).isApprox(plain.products({0, 3}), kEvidenceRounding));
  const std::vector<int> some = {0, 3};
  for (const MarginalLikelihood* each : {&fast, &plain})
    EXPECT_TRUE(
        each->gram(some).isApprox(plain.products(some)(Eigen::all, some), kEvidenceRounding));
  EXPECT_TRUE(fast.estimate(both).mean.isApprox(plain.estimate(both).mean, kEvidenceRounding));
  EXPECT_TRUE(fast.mean(both).isApprox(plain.estimate(both).mean, kEvidenceRounding));
  EXPECT_TRUE(
      fast.estimate(both).covariance.isApprox(plain.estimate(both).covariance, kEvidenceRounding));
  EXPECT_NEAR(fast.gained_without(both, one.rows.y, {2, 9}),
              plain.gained_without(both, one.rows.y, {2, 9}), kEvidenceRounding);
  std::mt19937_64 random(4);
  const Eigen::MatrixXd Y = random_matrix(14, 3, random);
  EXPECT_TRUE(fast.statistics_of(Y).g.isApprox(plain.statistics_of(Y).g, kEvidenceRounding));
  EXPECT_TRUE(fast.statistics_of(Y).yy.isApprox(plain.statistics_of(Y).yy, kEvidenceRounding));
  const Eigen::VectorXd draw = kernel.fast.coloured(Y.col(0));
  EXPECT_NEAR(draw.dot(kernel.fast.matrix().inverse() * draw), Y.col(0).squaredNorm(),
              kEvidenceRounding);
}

TEST(MarginalLikelihood, WeighsEverySizeOfABlockBySpectrumAsByItself) {
  Case one;
  one.first.positive = {0};
  one.rows.least = 0.5;
  const MarginalLikelihood likelihood = one.likelihood();
  constexpr std::array kTried{0.25, 1.0, 16.0};
  for (const Block* block : {&one.first, &one.second}) {
    std::array<double, kTried.size()> logs{};
    std::vector<double> spectrum;
    likelihood.add_spectrum(*block, kTried, spectrum);
    EXPECT_EQ(spectrum.size(), MarginalLikelihood::spectrum_size(*block, kTried.size()));
    likelihood.log_evidences(*block, kTried, spectrum.data(), logs.data());
    for (size_t i = 0; i < kTried.size(); ++i) {
      const MarginalLikelihood::Term term{block, kTried[i]};
      EXPECT_NEAR(logs[i], likelihood.log_evidence({&term, 1}), kEvidenceRounding);
      EXPECT_LE(logs[i], likelihood.at_most(*block));
    }
  }
}

TEST(LowRankRoot, TakesAsManyColumnsAsTheCovarianceHasDirections) {
  std::mt19937_64 random(6);
  const Eigen::MatrixXd F = random_matrix(12, 4, random), K = F * F.transpose();
  const auto root = low_rank_root(K, 12);
  ASSERT_TRUE(root);
  EXPECT_EQ(root->cols(), 4);
  EXPECT_TRUE((*root * root->transpose()).isApprox(K, kEvidenceRounding));
  EXPECT_FALSE(low_rank_root(K, 3));
}

TEST(Tails, AreThoseOfTheExactDistributions) {
  for (const double freedom : {10.0, 57.5, 700.0}) {
    const NoiseTail tail(freedom);
    for (double sigmas = -5; sigmas < 12; sigmas += 0.37) {
      const double value = freedom + sigmas * std::sqrt(2 * freedom);
      if (value <= 0) continue;
      EXPECT_NEAR(tail.log_below(value), log_chi_square_below(value, freedom), 1e-4);
    }
    for (double t = -8; t < 8; t += 0.31)
      EXPECT_NEAR(student_below_nearly(t, freedom), student_below(t, freedom), 1e-5);
  }
}

TEST(MarginalLikelihood, GivenSomeCausesWeighsOthersAsTogether) {
  const Case one;
  const MarginalLikelihood likelihood = one.likelihood();
  const std::vector<MarginalLikelihood::Term> first{{&one.first, 1.3}}, second{{&one.second, 0.4}};
  std::vector<MarginalLikelihood::Term> both = first;
  both.push_back(second.front());
  EXPECT_NEAR(likelihood.given(first).log_evidence(second), likelihood.log_evidence(both),
              kEvidenceRounding);
}

TEST(MarginalLikelihood, GainsByEquationsLeftOutWhatTheRowsWithoutThemGive) {
  const Case one;
  const MarginalLikelihood likelihood = one.likelihood();
  const std::vector<int> out{2, 9};
  std::vector<int> rest;
  for (int i = 0; i < 14; ++i)
    if (std::ranges::count(out, i) == 0) rest.push_back(i);
  Whitened fewer = one.rows;
  fewer.A = one.rows.A(rest, Eigen::all);
  fewer.C = one.rows.C(rest, Eigen::all);
  fewer.y = one.rows.y(rest);
  const std::vector<MarginalLikelihood::Term> none, both{{&one.first, 1.3}, {&one.second, 0.4}};
  const auto gain = [&](const Whitened& rows) {
    const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(rows.A.rows(), rows.A.rows());
    return worked_out_whole(rows, I, both) - worked_out_whole(rows, I, none);
  };
  EXPECT_NEAR(likelihood.gained_without(both, one.rows.y, out), gain(fewer) - gain(one.rows),
              kEvidenceRounding);
  EXPECT_EQ(likelihood.gained_without(both, one.rows.y, {}), 0);
}

TEST(MarginalLikelihood, WeighsOtherRowsWithoutLookingAtThem) {
  Case one;
  const MarginalLikelihood likelihood = one.likelihood();
  Eigen::MatrixXd Y(one.rows.y.size(), 2);
  Y << one.rows.y, 3 * one.rows.y;
  one.rows.y *= 3;
  ObservedRows observed(likelihood.rows(), Y, false);
  EXPECT_NEAR(likelihood.log_evidences_of(observed)[1], one.likelihood().log_evidence({}),
              kEvidenceRounding);
}

TEST(MarginalLikelihood, NeverExplainsMoreThanThereIs) {
  // A strong cause that pulls the geometry far from its priors: what it explains is taken from the
  // rows and from the strain on the priors.
  Case one;
  one.rows.weight.setConstant(3);
  one.rows.pull.setConstant(20);
  one.rows.y = 50 * one.rows.C.col(0) + 40 * one.rows.A.col(1);
  one.first.unit = Eigen::Vector2d(100, 100);
  const MarginalLikelihood likelihood = one.likelihood();
  const std::vector<MarginalLikelihood::Term> first{{&one.first, 16}};
  EXPECT_GT(likelihood.estimate(first).variance, 0);
  EXPECT_GE(likelihood.given(first).total(), 0);
  EXPECT_LT(likelihood.given(first).total(), likelihood.total());
}

TEST(MarginalLikelihood, EstimatesACauseThatIsThereWithinItsSigma) {
  Case one;
  std::mt19937_64 random(7);
  one.rows.y = 3.0 * one.rows.C.col(0) - 1.0 * one.rows.C.col(1) +
               1e-3 * random_matrix(14, 1, random).col(0);
  one.first.unit = Eigen::Vector2d(1e5, 1e5);  // over the noise
  const MarginalLikelihood likelihood = one.likelihood();
  const std::vector<MarginalLikelihood::Term> terms{{&one.first, 1}};
  const MarginalLikelihood::Estimate estimate = likelihood.estimate(terms);
  const Eigen::VectorXd sigma =
      (estimate.variance * estimate.covariance.diagonal().array()).sqrt().matrix();
  EXPECT_NEAR(estimate.mean[0], 3, 4 * sigma[0]);
  EXPECT_NEAR(estimate.mean[1], -1, 4 * sigma[1]);
  EXPECT_NEAR(std::sqrt(estimate.variance), 1e-3, 1e-3) << "nine freedoms: within a factor of two";
}

}  // namespace
}  // namespace selfcal
