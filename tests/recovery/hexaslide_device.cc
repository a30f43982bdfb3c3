#include "tests/recovery/hexaslide_device.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "constraints/equations/equations.h"
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

/// Their condition number, as postures are chosen by in the paper.
Objective by_condition() { return {Criterion::condition, {}, {}, 0}; }

}  // namespace

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

void add_noise(double noise, Random& random, Observations& rows) {
  std::uniform_real_distribution<double> off(-noise, noise);
  for (int row = 0; row < rows.rows(); ++row) {
    for (double& q : rows.q.row(row)) q += off(random);
    for (auto& [name, column] : rows.measured) column[row] += off(random);
  }
}

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

}  // namespace selfcal::recovery
