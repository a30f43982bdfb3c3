// The Hexa Slide with the constraint link: Tables 1 to 3 of Rauf, Kim and Ryu, Calibration of
// parallel manipulators using a new measurement device.
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

/// A Hexa Slide off Table 1 by up to `most` in every parameter, evenly (Table 2).
std::unique_ptr<Robot> slider(double most, Random& random) {
  std::uniform_real_distribution<double> off(-most, most);
  std::string text = "robot: hsm\nkind: hexaslide\nchains:\n";
  for (const auto& chain : kTable1) {
    std::vector<std::string> v;
    for (const double figure : chain)
      v.push_back(format_number(figure + (most > 0 ? off(random) : 0)));
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

/// What the device reads at `count` postures drawn at random.
DataSet device_rows(int count, Random& random) {
  DataSet data;
  Node sets = Node::map();
  sets.set("device", entry({{"method", "constraint-link"}, {"length", "0.75"}}));
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

/// `count` of the rows, those that tell the nominal robot's parameters best together; rows that it
/// cannot take are left out.
std::vector<int> best_rows(const Robot& nominal, const DataSet& pool, int count, Random& random) {
  const Equations equations(nominal, pool, Use::fit);
  State state{nominal_values(nominal), {}, {}};
  equations.start(state);
  const DenseEquations dense =
      equations.dense(state, {Scale{}}, std::vector<char>(pool.rows.check.size(), 0));
  std::vector<Eigen::MatrixXd> candidates(static_cast<size_t>(pool.rows.rows()));
  for (Eigen::Index k = 0; k < dense.W.rows(); ++k) {
    Eigen::MatrixXd& W = candidates[static_cast<size_t>(dense.row[static_cast<size_t>(k)])];
    W.conservativeResize(W.rows() + 1, 54);
    W.bottomRows<1>() = dense.W.row(k).head<54>();
  }
  std::vector<int> rows;
  for (int row = 0; row < pool.rows.rows(); ++row)
    if (candidates[static_cast<size_t>(row)].rows() > 0) rows.push_back(row);
  std::erase_if(candidates, [](const Eigen::MatrixXd& W) { return W.rows() == 0; });
  std::vector<int> best;
  for (const int each : detmax(candidates, count, random).chosen)
    best.push_back(rows[static_cast<size_t>(each)]);
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
  const DataSet postures = device_rows(kPostures, random);
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
  const auto exact = slider(0, random);
  Problems problems;
  std::vector<Set> sets = {
      make_set("s", entry({{"method", "constraint-link"}, {"length", "0.75"}}), problems)};
  const StructuralRank told = structural(*exact, sets, std::vector<char>(54, 1), 120, 1);
  EXPECT_EQ(told.unreached, "");
  EXPECT_EQ(told.rank.total(), 54);
}

TEST(Hexaslide, IsFoundToRoundingFromAllThreeNominalSetsByThirtyExactPostures) {
  for (const double most : {1.8e-3, 2.8e-3, 9.2e-3}) {
    Random random(2);
    const auto exact = slider(0, random);
    const auto nominal = slider(most, random);
    DataSet data = device_rows(400, random);
    data.rows = taken(data.rows, best_rows(*nominal, data, 30, random));
    Options options;
    options.priors = false;
    const Solution solution = identify(*nominal, data, options);
    EXPECT_TRUE(solution.converged) << solution.stop_reason;
    const double left = (solution.values - values(*exact)).cwiseAbs().maxCoeff();
    std::printf("off by up to %.1f mm: %.1e m left, condition %.0f\n", 1e3 * most, left,
                solution.observability.condition);
    EXPECT_LT(left, 1e-11);  // rounding of 1e-16 m, magnified by a condition of some thousands
  }
}

/// What calibrations of kSeeds sliders under noise come to.
struct UnderNoise {
  double position = 0, degrees = 0;  ///< medians of the mean posture errors (m)
  double within = 0;                 ///< share of all parameters that are within their sigma
};

UnderNoise calibrated_under_noise(double noise) {
  constexpr int kSeeds = 8;
  double within = 0, all = 0;
  std::vector<double> positions, turns;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Random random(seed);
    const auto exact = slider(0, random);
    const auto nominal = slider(2.8e-3, random);
    DataSet data = device_rows(1000, random);
    data.rows = taken(data.rows, best_rows(*nominal, data, 60, random));
    add_noise(noise, random, data.rows);
    const Solution solution = identify(*nominal, data);
    EXPECT_TRUE(solution.converged) << seed << " " << solution.stop_reason;
    for (Eigen::Index i = 0; i < solution.values.size(); ++i) {
      const double sigma = solution.parameters[static_cast<size_t>(i)].sigma;
      within += std::abs(solution.values[i] - values(*exact)[i]) < sigma;
      ++all;
    }
    const PostureError error = posture_error(*exact, solution.values);
    positions.push_back(error.position);
    turns.push_back(180 / std::numbers::pi * error.turn);
  }
  const UnderNoise result{middle(positions), middle(turns), within / all};
  std::printf("noise %.0f um: %.1f um, %.4f degrees, %.1f %% within one sigma\n", 1e6 * noise,
              1e6 * result.position, result.degrees, 100 * result.within);
  return result;
}

TEST(Hexaslide, IsKnownAsWellAsPublishedUnderNoise) {
  struct Published {
    double noise, position, degrees;
  };
  for (const Published& row :
       {Published{5e-6, 19.6e-6, 0.004}, {10e-6, 32e-6, 0.005}, {50e-6, 169e-6, 0.045}}) {
    const UnderNoise result = calibrated_under_noise(row.noise);
    EXPECT_LE(result.position, row.position) << row.noise;
    EXPECT_LE(result.degrees, row.degrees) << row.noise;
    // Less than 0.683: readings that are noisy, too, turn the three angles of a row together.
    EXPECT_GT(result.within, 0.5) << row.noise;
  }
}

}  // namespace
}  // namespace selfcal::recovery
