// Elasto-geometrical calibration as Kamali et al. did it: 50 of 875 rows, chosen by DETMAX on O1,
// identify the geometry alone and with the joints' stiffness; the other 825 judge (Table III).
//
// Of the paper's remaining 0.264 mm (mean square 0.088 mm^2) the noise here explains little. What
// measuring adds (35 um of tracker, 1 N and 0.1 N m of force sensor, 10 urad of repeatability) is a
// share of 0.06; with small things that the model lacks (springs 20 % stiffer under load, a tenth
// as much compliance across the axes, masses off by a tenth) it is 0.14. One arc minute of play at
// every joint, a gear's usual figure, would make it 0.72: the paper models neither play nor
// temperature, and measured neither.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "constraints/equations/equations.h"
#include "constraints/identifiability/identifiability.h"
#include "constraints/planning/detmax.h"
#include "tests/recovery/kamali.h"
#include "tests/recovery/kamali_plan.h"
#include "tests/support/full_detmax.h"

namespace selfcal::recovery {
namespace {

constexpr int kChosen = 50;
constexpr unsigned long long kSeed = 7;

constexpr Disturbance kMeasuring{.tracker = 35e-6, .force = 1, .moment = 0.1, .repeat = 10e-6};
constexpr Disturbance kRealistic{.tracker = 35e-6,
                                 .force = 1,
                                 .moment = 0.1,
                                 .repeat = 10e-6,
                                 .stiffening = 0.2,
                                 .links = 0.1,
                                 .masses = 0.1};

/// The rows of the experiment at nominal values: what the planning knows.
struct Planning {
  Kamali kamali;
  DataSet data = kamali.measure({}, kSeed);
  State state{nominal_values(kamali.robot()), {}, {}};
  Eigen::MatrixXd R;
  DenseEquations dense;

  explicit Planning(unsigned long long seed = 1600) : kamali(seed) {
    data.rows.check.assign(data.rows.check.size(), 0);
    const Equations equations(kamali.robot(), data, Use::fit);
    equations.start(state);
    const Weighting weighting{{{1, 1}}, std::vector<char>(data.rows.check.size(), 0)};
    R = equations.linearise(state, weighting).R;
    dense = equations.dense(state, weighting.scale, weighting.outlier);
  }

  /// Structural rank of the marked parameters.
  Identifiability rank(const std::vector<char>& candidates) const {
    RankRule rule;
    rule.rows = 3.0 * data.rows.rows();
    return identifiability(Equations(kamali.robot(), data, Use::fit), R, state, candidates, rule);
  }

  /// The identifiable columns of every row.
  std::vector<Eigen::MatrixXd> candidates() const {
    const Identifiability all = rank(kamali.candidates());
    std::vector<int> columns;
    for (size_t i = 0; i < all.status.size(); ++i)
      if (all.status[i] == Status::identified) columns.push_back(static_cast<int>(i));
    std::vector<Eigen::MatrixXd> list;
    for (Eigen::Index at = 0; at < dense.W.rows(); at += 3)
      list.push_back(dense.W(Eigen::seqN(at, 3), columns));
    return list;
  }
};

struct Row {
  double mean = 0, std = 0, max = 0;  ///< mm
};

Row in_mm(const Figures& figures) {
  const double variance = std::pow(figures.rms_after, 2) - std::pow(figures.mean_after, 2);
  return {figures.mean_after * 1e3, std::sqrt(variance) * 1e3, figures.max_after * 1e3};
}

void print(const char* what, const Row& row) {
  std::printf("  %-28s %6.3f %6.3f %6.3f\n", what, row.mean, row.std, row.max);
}

/// The maker's robot and tool on the base where it truly stands. (The paper does not say how its
/// nominal robot was placed: the nominal base of Table II is 38 mm off.)
Row nominal(const Kamali& kamali, const DataSet& data) {
  const std::vector<Parameter>& parameters = kamali.robot().parameters();
  Eigen::VectorXd xi = nominal_values(kamali.robot());
  for (size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].part == Part::base) xi[static_cast<Eigen::Index>(i)] = kamali.truth()[i];
  Eigen::VectorXd error(data.rows.rows());
  for (int row = 0; row < data.rows.rows(); ++row) {
    ConfigurationBlock block = block_of(data.rows.q.row(row).transpose());
    block.conditions = conditions(data.rows, {row});
    Locations X;
    kamali.robot().locate(block, xi, Body::endpoint, X, nullptr);
    error[row] = (X.p(0) - data.rows.position.row(row).transpose()).norm() * 1e3;
  }
  return {error.mean(), std::sqrt((error.array() - error.mean()).square().mean()),
          error.maxCoeff()};
}

struct Calibrated {
  Row nominal, geometry, elastic;
  Solution solution;  ///< with stiffness
};

Calibrated calibrate(const Kamali& kamali, const Disturbance& disturbance,
                     const std::vector<int>& chosen) {
  DataSet data = kamali.measure(disturbance, kSeed);
  for (const int row : chosen) data.rows.check[row] = 0;
  Options options;
  options.fix = kamali.others();
  Calibrated all;
  all.nominal = nominal(kamali, data);
  const Solution geometry = identify(kamali.robot(), data, options);
  all.geometry = in_mm(geometry.residual.check);
  EXPECT_EQ(geometry.values.tail<6>(), Eigen::VectorXd::Zero(6));  // effects are fixed until freed
  options.free = {"*.c"};
  all.solution = identify(kamali.robot(), data, options);
  all.elastic = in_mm(all.solution.residual.check);
  EXPECT_EQ(all.solution.residual.check.rows, 825);
  return all;
}

std::vector<int> chosen(const Planning& planning) {
  std::mt19937_64 random(kChosen);
  return detmax(planning.candidates(), kChosen, random).chosen;
}

int count(const Solution& solution, Status status) {
  return static_cast<int>(std::count_if(solution.parameters.begin(), solution.parameters.end(),
                                        [&](const auto& p) { return p.status == status; }));
}

TEST(ElastoGeometric, Identifies32OfThePapers39Parameters) {
  const Planning planning;
  const std::vector<char>& all = planning.kamali.candidates();
  ASSERT_EQ(std::count(all.begin(), all.end(), 1), 39);
  const Identifiability rank = planning.rank(all);
  EXPECT_EQ(rank.total(), 32);
  EXPECT_EQ(std::count(rank.status.begin(), rank.status.end(), Status::no_effect) +
                std::count(rank.status.begin(), rank.status.end(), Status::grouped),
            7);
  // Which of a dependent group is left out is a matter of preference. Those that the paper left out
  // (it lists the other 32) can be:
  std::vector<char> listed = all;
  for (const char* name :
       {"j1.theta", "j6.theta", "j3.r", "j6.r", "t1.alpha", "t2.beta", "t2.theta"})
    listed[find_parameter(planning.kamali.robot(), name)] = 0;
  EXPECT_EQ(planning.rank(listed).total(), 32);
}

TEST(ElastoGeometric, ChoosesRowsByDetmaxThatSeeMoreThanRandomOnes) {
  const Planning planning;
  const std::vector<Eigen::MatrixXd> candidates = planning.candidates();
  std::mt19937_64 random(kChosen);
  const Exchange choice = detmax(candidates, kChosen, random);
  ASSERT_EQ(choice.chosen.size(), 50u);
  // Another start ends elsewhere, but as high: an exchange algorithm finds no global maximum.
  const Exchange other = detmax(candidates, kChosen, random);
  EXPECT_NEAR(other.o1, choice.o1, 0.01 * choice.o1);
  // O1 of all rows is that of their average information, which a random choice has about.
  const Exchange average = detmax(candidates, static_cast<int>(candidates.size()), random);
  std::printf("O1 %.4f and %.4f after %d and %d exchanges; of all 875 rows %.4f\n", choice.o1,
              other.o1, choice.exchanges, other.exchanges, average.o1);
  EXPECT_GT(choice.o1, 1.2 * average.o1);
}

TEST(ElastoGeometric, ChoosesAsWellAsDetmaxWithFullDecompositionsFromTheSameStart) {
  const Planning planning;
  const std::vector<Eigen::MatrixXd> candidates = planning.candidates();
  ASSERT_EQ(candidates.size(), 875U);
  ASSERT_EQ(candidates.front().cols(), 32);
  std::mt19937_64 random(kChosen);
  const std::vector<int> start = random_choice(875, kChosen, random);
  const std::clock_t begin = std::clock();
  constexpr int kTimes = 20;
  std::vector<int> fast;
  for (int i = 0; i < kTimes; ++i) {
    Design design(candidates, {});
    design.choose(start);
    exchange(design);
    fast = design.chosen();
  }
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / kTimes;
  const FullSearch full = by_full_decompositions(candidates, start, 1000);
  const double ours = o1_of(candidates, fast), theirs = o1_of(candidates, full.chosen);
  std::printf(
      "O1 %.6f in %.4f s; with full decompositions %.6f in %.1f s after %d exchanges: %.0f "
      "times as long\n",
      ours, seconds, theirs, full.seconds, full.exchanges, full.seconds / seconds);
  EXPECT_GE(ours, theirs * (1 - 1e-9));
}

TEST(ElastoGeometric, LeavesWhatThePapersTableThreeLeaves) {
  const Planning planning;
  const Calibrated all = calibrate(planning.kamali, kRealistic, chosen(planning));
  std::printf("errors of 825 rows (mm)          mean    std    max\n");
  print("nominal", all.nominal);
  print("   the paper's", {2.486, 1.745, 5.954});
  print("geometry identified", all.geometry);
  print("   the paper's", {0.943, 0.479, 2.571});
  print("and stiffness", all.elastic);
  print("   the paper's", {0.264, 0.137, 0.960});
  EXPECT_EQ(count(all.solution, Status::identified), 32);
  // Nominal and geometry follow from Table II, the poses and the loads, and of the last two the
  // paper gives an outline. Twelve other draws of them gave 2.03 to 2.19 and 4.1 to 4.5 mm, 1.15
  // to 1.18 and 2.6 to 3.2 mm; the paper lies within a third of these.
  EXPECT_NEAR(all.nominal.mean, 2.486, 0.3 * 2.486);
  EXPECT_NEAR(all.nominal.max, 5.954, 0.35 * 5.954);
  EXPECT_NEAR(all.geometry.mean, 0.943, 0.3 * 0.943);
  EXPECT_NEAR(all.geometry.std, 0.479, 0.2 * 0.479);
  EXPECT_NEAR(all.geometry.max, 2.571, 0.3 * 2.571);
  // What stiffness leaves is disturbance alone; ours is smaller than the paper's (see above).
  EXPECT_LT(all.elastic.max, 0.960);
  EXPECT_LT(all.elastic.mean, 0.264);
  EXPECT_GT(all.elastic.mean, 0.056);  // the tracker's 35 um in three coordinates alone
}

TEST(ElastoGeometric, SaysWhatIsLeftOfEachCause) {
  const Planning planning;
  const std::vector<int> rows = chosen(planning);
  const double paper = std::pow(0.264, 2) + std::pow(0.137, 2);  // mean square (mm^2)
  const auto share = [&](const char* what, const Disturbance& disturbance) {
    const Row left = calibrate(planning.kamali, disturbance, rows).elastic;
    print(what, left);
    return (std::pow(left.mean, 2) + std::pow(left.std, 2)) / paper;
  };
  std::printf("left with stiffness (mm)         mean    std    max\n");
  EXPECT_LT(share("nothing", {}), 0.001);  // influence at nominal geometry: of second order
  share("tracker 35 um", {.tracker = 35e-6});
  share("wrench 1 N, 0.1 N m", {.force = 1, .moment = 0.1});
  share("repeatability 10 urad", {.repeat = 10e-6});
  share("springs 20 % stiffer", {.stiffening = 0.2});
  share("links a tenth", {.links = 0.1});
  share("masses a tenth off", {.masses = 0.1});
  const double measuring = share("all measuring", kMeasuring);
  const double realistic = share("all of these", kRealistic);
  Disturbance loose = kRealistic;
  loose.play = 2.9e-4;
  const double play = share("and 1 arcmin of play", loose);
  std::printf("shares of the paper's mean square: measuring %.2f, all %.2f, with play %.2f\n",
              measuring, realistic, play);
  EXPECT_NEAR(measuring, 0.05, 0.02);
  EXPECT_NEAR(realistic, 0.14, 0.05);
  EXPECT_NEAR(play, 0.72, 0.15);
}

TEST(ElastoGeometric, FindsTheStiffnessOfTableTwoWithinItsSigma) {
  const Planning planning;
  const Calibrated all = calibrate(planning.kamali, kMeasuring, chosen(planning));
  for (const ParameterResult& p : all.solution.parameters) {
    if (p.parameter.part != Part::effect) continue;
    EXPECT_EQ(p.status, Status::identified) << p.parameter.name;
    const double truth =
        planning.kamali.truth()[find_parameter(planning.kamali.robot(), p.parameter.name)];
    std::printf("  %s %.3e of %.3e rad/(N m), sigma %.1e\n", p.parameter.name.c_str(), p.value,
                truth, p.sigma);
    EXPECT_NEAR(p.value, truth, 4 * p.sigma) << p.parameter.name;
    EXPECT_LT(p.sigma, 0.05 * truth) << p.parameter.name;
  }
}

}  // namespace
}  // namespace selfcal::recovery
