// The Hexa Slide with the constraint link: Tables 1 to 3 of Rauf, Kim and Ryu, Calibration of
// parallel manipulators using a new measurement device. Table 3 is of a few robots by default, of
// SELFCAL_SEEDS on demand (README.md).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

#include "constraints/equations/equations.h"
#include "constraints/estimation/identification.h"
#include "constraints/identifiability/excitation.h"
#include "constraints/planning/detmax.h"
#include "kinematics/rotation.h"
#include "tests/recovery/rx90.h"
#include "tests/support/cell.h"

namespace selfcal::recovery {
namespace {

/// Table 1, in m.
constexpr double kTable1[6][9] = {
    {-.7359, -.5522, .2614, .7502, .4332, -.0611, -.1617, -.0161, .9947},
    {-.8418, -.3589, .2599, .7498, .4327, -.1708, .0288, -.0162, .9948},
    {-.1101, .8991, .2534, .0002, -.8662, -.1102, .1371, -.0161, .9946},
    {.1102, .8972, .2518, -.0002, -.8663, .1098, .1372, -.0158, .9947},
    {.8397, -.3556, .2563, -.7497, .4329, .1738, .0288, -.0161, .9948},
    {.7297, -.5463, .2539, -.7503, .4327, .0637, -.1617, -.0162, .9947}};

/// Of the 54 errors of a nominal set: the largest, the mean of their sizes, their root mean square
/// (m). Table 2.
struct NominalErrors {
  double most, mean, sigma;
};
constexpr NominalErrors kNone{0, 0, 0},
    kTable2[] = {{1.8e-3, 0.8e-3, 0.87e-3}, {2.8e-3, 1.33e-3, 1.45e-3}, {9.2e-3, 4.99e-3, 5.28e-3}};

/// Errors of either sign that have these statistics: one is the largest, the sizes of the others
/// are of a beta distribution, drawn until both means are within two per cent.
std::vector<double> drawn_errors(const NominalErrors& wanted, Random& random) {
  std::vector<double> errors(54, 0);
  if (wanted.most == 0) return errors;
  const double mean = wanted.mean / wanted.most,
               variance = std::pow(wanted.sigma / wanted.most, 2) - mean * mean,
               both = mean * (1 - mean) / variance - 1;
  std::gamma_distribution<double> a(mean * both), b((1 - mean) * both);
  std::bernoulli_distribution negative;
  for (;;) {
    double sum = 0, squares = 0;
    for (double& each : errors) {
      const double x = a(random);
      each = &each == errors.data() ? wanted.most : wanted.most * x / (x + b(random));
      sum += each / 54;
      squares += each * each / 54;
    }
    if (std::abs(sum / wanted.mean - 1) < 0.02 &&
        std::abs(std::sqrt(squares) / wanted.sigma - 1) < 0.02)
      break;
  }
  for (double& each : errors) each *= negative(random) ? -1 : 1;
  std::shuffle(errors.begin(), errors.end(), random);
  return errors;
}

/// A Hexa Slide whose parameters are off Table 1.
std::unique_ptr<Robot> slider(const NominalErrors& off, Random& random) {
  std::string text = "robot: hsm\nkind: hexaslide\nchains:\n";
  const std::vector<double> errors = drawn_errors(off, random);
  auto error = errors.begin();
  for (const auto& chain : kTable1) {
    std::vector<std::string> v;
    for (const double figure : chain) v.push_back(format_number(figure + *error++));
    text += "  - {rail_start: [" + v[0] + ", " + v[1] + ", " + v[2] + "], rail_direction: [" +
            v[3] + ", " + v[4] + "], platform: [" + v[5] + ", " + v[6] + ", " + v[7] +
            "], length: " + v[8] + "}\n";
  }
  return robot_of(text);
}

constexpr double kDevice = 0.75;  // m, between its universal joints

/// Where a platform held by the device may stand: up to 350 mm to either side, turned by up to 30
/// degrees (section 4 of the paper).
Location posture(Random& random) {
  std::uniform_real_distribution<double> across(-0.35, 0.35),
      turn(-std::numbers::pi / 6, std::numbers::pi / 6);
  Location X;
  X.p << across(random), across(random), 0;
  X.p.z() = -std::sqrt(kDevice * kDevice - X.p.squaredNorm());
  const Eigen::Vector3d about(turn(random), turn(random), turn(random));
  X.R = (Eigen::AngleAxisd(about[0], Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(about[1], Eigen::Vector3d::UnitX()) *
         Eigen::AngleAxisd(about[2], Eigen::Vector3d::UnitZ()))
            .toRotationMatrix();
  return X;
}

/// Readings of the carriages there by equation 3; nothing where one is off its rail.
std::optional<Eigen::VectorXd> carriages(const Location& X) {
  Eigen::VectorXd q(6);
  for (int i = 0; i < 6; ++i) {
    const double* t = kTable1[i];
    const double length = t[8];
    const Eigen::Vector3d a(t[3], t[4], -std::sqrt(1 - t[3] * t[3] - t[4] * t[4]));
    const Eigen::Vector3d e =
        X.p + X.R * Eigen::Vector3d(t[5], t[6], t[7]) - Eigen::Vector3d(t[0], t[1], t[2]);
    const double root = length * length - e.squaredNorm() + std::pow(a.dot(e), 2);
    if (root < 0) return std::nullopt;
    q[i] = a.dot(e) - std::sqrt(root);
    if (q[i] < 0 || q[i] > length) return std::nullopt;
  }
  return q;
}

/// What the device reads at `count` postures drawn at random; `sigma` is said of its angles and of
/// the carriages' readings.
DataSet device_rows(int count, double sigma, Random& random) {
  DataSet data;
  Node sets = Node::map(), device = entry({{"method", "constraint-link"}, {"length", "0.75"}});
  if (sigma > 0) device.set("noise_angle", Node::of(sigma)).set("noise_joints", Node::of(sigma));
  sets.set("device", std::move(device));
  Problems problems;
  data.sets = read_sets(sets, problems);
  Observations& rows = data.rows;
  rows.q.resize(count, 6);
  rows.set.assign(static_cast<size_t>(count), 0);
  rows.group.assign(static_cast<size_t>(count), -1);
  rows.check.assign(static_cast<size_t>(count), 0);
  for (const char* name : {"alpha", "beta", "phi"}) rows.measured[name].resize(count);
  for (int row = 0; row < count;) {
    const Location X = posture(random);
    const auto q = carriages(X);
    if (!q) continue;
    rows.q.row(row) = q->transpose();
    rows.measured["alpha"][row] = std::asin(X.p.y() / kDevice);
    rows.measured["beta"][row] = std::atan2(-X.p.x(), -X.p.z());
    rows.measured["phi"][row] = std::atan2(X.R(1, 0), X.R(1, 1));
    ++row;
  }
  return data;
}

/// The rows that each posture adds to W, of the nominal robot and over their noise; of postures
/// that it cannot take there are none.
std::vector<Eigen::MatrixXd> posture_rows(const Robot& nominal, const DataSet& pool) {
  const Equations equations(nominal, pool, Use::fit);
  State state{nominal_values(nominal), {}, {}};
  equations.start(state);
  Scale scale = equations.stated(0);
  if (scale.length == 0) scale = {};
  const DenseEquations dense =
      equations.dense(state, {scale}, std::vector<char>(pool.rows.check.size(), 0));
  std::vector<Eigen::MatrixXd> candidates(static_cast<size_t>(pool.rows.rows()));
  for (Eigen::Index k = 0; k < dense.W.rows(); ++k) {
    Eigen::MatrixXd& W = candidates[static_cast<size_t>(dense.row[static_cast<size_t>(k)])];
    W.conservativeResize(W.rows() + 1, 54);
    W.bottomRows<1>() = dense.W.row(k).head<54>();
  }
  return candidates;
}

/// What postures are chosen by: their condition number as in the paper; the expected error of the
/// end position in the range of the postures, which is what shall become small.
Objective by_condition() { return {Criterion::condition, {}, {}, 0}; }
Objective by_end_position(const Robot& nominal, Random& random) {
  constexpr int kWhere = 100;
  Objective objective{Criterion::sigma, {}, {}, 0};
  // Links and joints within some millimetres are known before.
  objective.prior = Eigen::MatrixXd::Identity(54, 54) / std::pow(5e-3, 2);
  objective.weight.setZero(54, 54);
  const DataSet where = device_rows(kWhere, 0, random);
  const Eigen::VectorXd xi = nominal_values(nominal);
  for (int i = 0; i < kWhere; ++i) {
    Locations X;
    PsiBlock psi;
    const ConfigurationBlock block = block_of(where.rows.q.row(i).transpose());
    if (!nominal.locate(block, xi, Body::endpoint, X, &psi).closes(0)) continue;
    for (int c = 0; c < 3; ++c) objective.weight += psi.row(c).transpose() * psi.row(c) / kWhere;
  }
  objective.weight *= 1e12;  // um^2, for exchanges gain where they are seen
  return objective;
}

struct Choice {
  std::vector<int> rows;
  double expected = 0;  ///< m, sigma of the end position in the range of the postures
};

enum class ChosenBy { chance, condition, end_position };

/// `count` of the rows: any, the best together by the condition number, or from there on by what
/// `end_position` expects of them.
Choice best_rows(const Robot& nominal, const DataSet& pool, int count, ChosenBy by,
                 const Objective& end_position, Random& random) {
  std::vector<Eigen::MatrixXd> candidates = posture_rows(nominal, pool);
  std::vector<int> rows;
  for (int row = 0; row < pool.rows.rows(); ++row)
    if (candidates[static_cast<size_t>(row)].rows() > 0) rows.push_back(row);
  std::erase_if(candidates, [](const Eigen::MatrixXd& W) { return W.rows() == 0; });
  Design as_there(candidates, by_condition());
  as_there.choose(random_choice(static_cast<int>(candidates.size()), count, random));
  if (by != ChosenBy::chance) add_and_drop(as_there);
  Design design(candidates, end_position);
  design.choose(as_there.chosen());
  if (by == ChosenBy::end_position) exchange(design);
  Choice best{{}, 1e-6 * std::sqrt(-design.merit())};
  for (const int each : design.chosen()) best.rows.push_back(rows[static_cast<size_t>(each)]);
  return best;
}

/// Uniform noise of up to `noise` m and rad on readings and angles.
void add_noise(double noise, Random& random, Observations& rows) {
  std::uniform_real_distribution<double> off(-noise, noise);
  for (int row = 0; row < rows.rows(); ++row) {
    for (double& q : rows.q.row(row)) q += off(random);
    for (auto& [name, column] : rows.measured) column[row] += off(random);
  }
}

struct PostureError {
  double position = 0, turn = 0;  ///< means (m, rad)
};

/// Of 50 postures drawn at random.
PostureError posture_error(const Robot& exact, const Eigen::VectorXd& xi) {
  constexpr int kPostures = 50;
  Random random(7);
  const DataSet postures = device_rows(kPostures, 0, random);
  PostureError error;
  for (int i = 0; i < kPostures; ++i) {
    const Eigen::VectorXd q = postures.rows.q.row(i).transpose();
    const Location is = locate(exact, values(exact), q), said = locate(exact, xi, q);
    error.position += (said.p - is.p).norm() / kPostures;
    error.turn += log_rotation(said.R * is.R.transpose()).norm() / kPostures;
  }
  return error;
}

double middle(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

TEST(Hexaslide, IsToldWholeByTheConstraintLink) {
  Random random(1);
  const auto exact = slider(kNone, random);
  Problems problems;
  std::vector<Set> sets = {
      make_set("s", entry({{"method", "constraint-link"}, {"length", "0.75"}}), problems)};
  const StructuralRank told = structural(*exact, sets, std::vector<char>(54, 1), 120, 1);
  EXPECT_EQ(told.unreached, "");
  EXPECT_EQ(told.rank.total(), 54);
}

TEST(Hexaslide, TellsOfADevicesAngleThatCountsTheOtherWay) {
  Random random(3);
  const auto nominal = slider(kTable2[0], random);
  DataSet data = device_rows(120, 5e-6, random);
  add_noise(5e-6, random, data.rows);
  data.rows.measured["phi"] *= -1;
  const Solution solution = identify(*nominal, data);
  EXPECT_NE(solution.verdict.answer, Answer::improved) << solution.verdict.why;
  EXPECT_THAT(solution.warnings,
              testing::Contains(testing::HasSubstr("check the signs and zeros of the readings")));
}

TEST(Hexaslide, HasNominalSetsOfThePublishedStatistics) {
  for (const NominalErrors& set : kTable2) {
    Random random(4);
    const std::vector<double> errors = drawn_errors(set, random);
    double most = 0, sum = 0, squares = 0, signed_sum = 0;
    for (const double each : errors) {
      most = std::max(most, std::abs(each));
      sum += std::abs(each) / 54;
      squares += each * each / 54;
      signed_sum += each / 54;
    }
    EXPECT_EQ(most, set.most);
    EXPECT_NEAR(sum, set.mean, 0.02 * set.mean);
    EXPECT_NEAR(std::sqrt(squares), set.sigma, 0.02 * set.sigma);
    EXPECT_LT(std::abs(signed_sum), 4 * set.sigma / std::sqrt(54));  // either sign alike, 4 sigma
  }
}

TEST(Hexaslide, IsFoundToRoundingFromAllThreeNominalSetsByThirtyExactPostures) {
  for (const NominalErrors& set : kTable2) {
    Random random(2);
    const auto exact = slider(kNone, random);
    const auto nominal = slider(set, random);
    DataSet data = device_rows(400, 0, random);
    const Objective judge = by_end_position(*nominal, random);
    data.rows =
        taken(data.rows, best_rows(*nominal, data, 30, ChosenBy::condition, judge, random).rows);
    Options options;
    options.priors = false;
    const Solution solution = identify(*nominal, data, options);
    EXPECT_TRUE(solution.converged) << solution.stop_reason;
    const double left = (solution.values - values(*exact)).cwiseAbs().maxCoeff();
    std::printf("off by up to %.1f mm: %.1e m left, condition %.0f\n", 1e3 * set.most, left,
                solution.observability.condition);
    EXPECT_LT(left, 1e-11);  // rounding of 1e-16 m, magnified by a condition of some thousands
  }
}

TEST(Hexaslide, IsFoundThoughAPostureAtTheEdgeOfItsReachDoesNotCloseOnTheWay) {
  constexpr double kNoise = 50e-6;
  Random random(46);
  const auto exact = slider(kNone, random);
  const auto nominal = slider(kTable2[1], random);
  DataSet data = device_rows(600, kNoise / std::sqrt(3.0), random);
  const Objective judge = by_end_position(*nominal, random);
  data.rows =
      taken(data.rows, best_rows(*nominal, data, 60, ChosenBy::condition, judge, random).rows);
  add_noise(kNoise, random, data.rows);
  const Solution solution = identify(*nominal, data);
  EXPECT_TRUE(solution.converged) << solution.stop_reason;
  EXPECT_LT(posture_error(*exact, solution.values).position, 2 * kNoise);
}

/// What calibrations of many sliders under noise come to.
struct UnderNoise {
  int robots = 0;
  double expected = 0;                   ///< m, median of the choices' end-position sigmas
  double position = 0, degrees = 0;      ///< medians of the mean posture errors (m)
  double within_one = 0, within_95 = 0;  ///< shares of all parameters that are within their sigmas
};

UnderNoise calibrated_under_noise(double noise, ChosenBy by) {
  UnderNoise result;
  result.robots = repetitions("SELFCAL_SEEDS", 3);
  double one = 0, most = 0, all = 0;
  std::vector<double> positions, turns, expected;
  const int first = repetitions("SELFCAL_FIRST_SEED", 1);
  for (int seed = first; seed < first + result.robots; ++seed) {
    Random random(seed);
    const auto exact = slider(kNone, random);
    const auto nominal = slider(kTable2[1], random);
    DataSet data = device_rows(600, noise / std::sqrt(3.0), random);
    const Objective judge = by_end_position(*nominal, random);
    const Choice choice = best_rows(*nominal, data, 60, by, judge, random);
    expected.push_back(choice.expected);
    data.rows = taken(data.rows, choice.rows);
    add_noise(noise, random, data.rows);
    const Solution solution = identify(*nominal, data);
    EXPECT_TRUE(solution.converged) << seed << " " << solution.stop_reason;
    for (Eigen::Index i = 0; i < solution.values.size(); ++i) {
      const double sigma = solution.parameters[static_cast<size_t>(i)].sigma;
      const double z = std::abs(solution.values[i] - values(*exact)[i]) / sigma;
      one += z < 1;
      most += z < 1.96;
      ++all;
    }
    const PostureError error = posture_error(*exact, solution.values);
    positions.push_back(error.position);
    turns.push_back(180 / std::numbers::pi * error.turn);
  }
  result.position = middle(positions);
  result.degrees = middle(turns);
  result.expected = middle(expected);
  result.within_one = one / all;
  result.within_95 = most / all;
  std::printf("| %.0f | %s | %d | %.1f | %.1f | %.4f | %.1f | %.1f |\n", 1e6 * noise,
              by == ChosenBy::chance      ? "chance"
              : by == ChosenBy::condition ? "condition"
                                          : "end position",
              result.robots, 1e6 * result.expected, 1e6 * result.position, result.degrees,
              100 * result.within_one, 100 * result.within_95);
  return result;
}

/// Table 3.
struct Published {
  double noise, position, degrees;
};

class HexaslideUnderNoise : public testing::TestWithParam<Published> {};

TEST_P(HexaslideUnderNoise, IsKnownAsWellAsPublishedAndBetterByPosturesChosenForTheEndPosition) {
  const Published& row = GetParam();
  const UnderNoise any = calibrated_under_noise(row.noise, ChosenBy::chance);
  const UnderNoise as_there = calibrated_under_noise(row.noise, ChosenBy::condition);
  const UnderNoise better = calibrated_under_noise(row.noise, ChosenBy::end_position);
  for (const UnderNoise* each : {&as_there, &better}) {
    EXPECT_LE(each->position, row.position);
    EXPECT_LE(each->degrees, row.degrees);
  }
  EXPECT_LT(better.expected, as_there.expected);
  EXPECT_LT(better.expected, any.expected);
  for (const UnderNoise* each : {&any, &as_there, &better}) {
    // Ten independent parameters of a robot, three sigma of each share.
    EXPECT_NEAR(each->within_one, 0.683, 3 * std::sqrt(0.683 * 0.317 / (10 * each->robots)));
    EXPECT_NEAR(each->within_95, 0.95, 3 * std::sqrt(0.95 * 0.05 / (10 * each->robots)));
  }
  if (any.robots < 50) return;  // medians of few scatter by more than the gain
  EXPECT_LT(better.position, as_there.position);
  EXPECT_LT(better.position, any.position);
}

INSTANTIATE_TEST_SUITE_P(Table3, HexaslideUnderNoise,
                         testing::Values(Published{5e-6, 19.6e-6, 0.004},
                                         Published{10e-6, 32e-6, 0.005},
                                         Published{50e-6, 169e-6, 0.045}),
                         [](const auto& made) {
                           return "Noise" + std::to_string(std::lround(1e6 * made.param.noise));
                         });

}  // namespace
}  // namespace selfcal::recovery
