// The error of a touch is a wanted residual, which moves the joints; that of an instrument is added
// to what it measures. Rows of paired methods share an error with their neighbour: each touch is
// off by sigma / sqrt(2), so that the residual of a pair has sigma.
#include "sim/disturbances.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "constraints/sampling/contact.h"
#include "kinematics/rotation.h"
#include "sim/streams.h"
#include "sim/true_sets.h"

namespace selfcal {
namespace {

constexpr int kTouchTries = 20;  // draws before a touch is given up

class Disturber {
 public:
  Disturber(const Scenario& scenario, const Robot& robot, Simulated& made)
      : scenario_(scenario),
        robot_(robot),
        made_(made),
        noise_(stream(scenario.seed, Draw::noise)),
        errors_(stream(scenario.seed, Draw::false_rows)) {}

  void run() {
    choose_false_rows();
    std::set<std::pair<int, int>> seen;  // set, group
    Observations& rows = made_.data.rows;
    std::size_t next_false = 0;
    for (int row = 0; row < rows.rows() && made_.unreached.empty(); ++row) {
      const bool is_false =
          next_false < made_.false_rows.size() && made_.false_rows[next_false] == row;
      if (is_false) ++next_false;
      if (method(row).constrains()) disturb_touch(row, is_false);
      if (!method(row).constrains() || !method(row).measures().empty())
        disturb_instrument(row, seen.emplace(rows.set[row], rows.group[row]).second);
    }
  }

 private:
  const Method& method(int row) const { return *made_.data.sets[made_.data.rows.set[row]].method; }

  void choose_false_rows() {
    std::vector<int> touches;
    for (int row = 0; row < made_.data.rows.rows(); ++row)
      if (method(row).constrains()) touches.push_back(row);
    const double share = scenario_.false_triggers.share;
    const auto count = std::lround(share * static_cast<double>(touches.size()));
    std::ranges::sample(touches, std::back_inserter(made_.false_rows), count, errors_);
  }

  double normal(double sigma) { return sigma * gauss_(noise_); }
  Eigen::Vector3d normals(double sigma) {
    const double x = normal(sigma), y = normal(sigma);
    return {x, y, normal(sigma)};
  }

  /// 1 sigma of an angle; a method without lengths may have it as its noise.
  double angle_sigma(int row) const {
    const SetScenario& set = scenario_.sets[made_.data.rows.set[row]];
    return set.noise_angle > 0 || method(row).has_lengths() ? set.noise_angle : set.noise;
  }

  /// Residual of a touch: noise in each equation.
  Eigen::VectorXd drawn_residual(int row) {
    const SetScenario& set = scenario_.sets[made_.data.rows.set[row]];
    const std::vector<Quantity> equations = method(row).equations();
    const double shared = method(row).paired() ? std::sqrt(0.5) : 1;
    Eigen::VectorXd r = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(equations.size()));
    for (Eigen::Index a = 0; a < r.size(); ++a) {
      // The angles of a method that measures under a constraint are read, not met.
      if (equations[a] == Quantity::angle && !method(row).measures().empty()) continue;
      r[a] = shared * normal(equations[a] == Quantity::angle ? angle_sigma(row) : set.noise);
    }
    return r;
  }

  /// What a false trigger adds: towards the side that the probe comes from, or anywhere.
  Eigen::VectorXd false_residual(int row) {
    const FalseTriggers& triggers = scenario_.false_triggers;
    std::uniform_real_distribution<double> sizes(triggers.least, triggers.most);
    const double size = sizes(errors_);
    const std::size_t set = made_.data.rows.set[row];
    const std::vector<Quantity> equations = method(row).equations();
    Eigen::VectorXd r = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(equations.size()));
    if (r.size() > 1) {
      std::normal_distribution<double> normal;
      for (Eigen::Index a = 0; a < r.size(); ++a)
        if (equations[a] == Quantity::length || !method(row).has_lengths()) r[a] = normal(errors_);
      return size * r.normalized();
    }
    const auto plane = true_plane(made_.data.sets, set, made_.truth.nuisance);
    const auto outward = outward_normal(scenario_, made_.data.sets, set, made_.truth.nuisance);
    r[0] = plane && plane->n.dot(*outward) < 0 ? -size : size;
    return r;
  }

  void disturb_touch(int row, bool is_false) {
    for (int attempt = 0; attempt < kTouchTries; ++attempt) {
      Eigen::VectorXd wanted = drawn_residual(row);
      if (is_false) wanted += false_residual(row);
      Eigen::VectorXd q = made_.data.rows.q.row(row).transpose();
      if (!move_to_residual(robot_, made_.data, made_.truth, row, wanted, q,
                            made_.locked[made_.data.rows.set[row]]))
        continue;
      made_.data.rows.q.row(row) = q.transpose();
      if (!method(row).measures().empty())
        method(row).measure(locate(robot_, made_.truth.xi, q, method(row).body()), {},
                            made_.truth.nuisance[made_.data.rows.set[row]], made_.data.rows, row);
      return;
    }
    made_.unreached = "set " + scenario_.sets[made_.data.rows.set[row]].name +
                      ": the noise of row " + std::to_string(row + 1) +
                      " leads where no configuration is; lessen it or move the set";
  }

  /// Cells that the method has not filled are NaN and stay it.
  void disturb_instrument(int row, bool first_of_group) {
    const SetScenario& set = scenario_.sets[made_.data.rows.set[row]];
    Observations& rows = made_.data.rows;
    rows.position.row(row) += normals(set.noise).transpose();
    const Eigen::Vector3d turn = normals(angle_sigma(row));
    if (rows.orientation.row(row).allFinite()) {
      const Eigen::Vector4d v = rows.orientation.row(row).transpose();
      const Eigen::Quaterniond q =
          Eigen::Quaterniond(exp_rotation(turn)) * Eigen::Quaterniond(v[0], v[1], v[2], v[3]);
      rows.orientation.row(row) << q.w(), q.x(), q.y(), q.z();
    }
    // The first number is drawn for every row: what an instrument measures beside leaves the draws
    // of the next row alone.
    double drawn = normal(1);
    const std::vector<MeasuredColumn> nuisance = method(row).measures();
    for (std::size_t i = 0; i < nuisance.size(); ++i) {
      if (i > 0) drawn = normal(1);
      double& value = rows.column(nuisance[i].name)[row];
      value += drawn * (nuisance[i].quantity == Quantity::angle ? angle_sigma(row) : set.noise);
      if (nuisance[i].never_negative) value = std::abs(value);
      // The first of a group has no previous row to be measured from.
      if (first_of_group && method(row).paired()) value = std::nan("");
    }
  }

  const Scenario& scenario_;
  const Robot& robot_;
  Simulated& made_;
  Random noise_, errors_;
  std::normal_distribution<double> gauss_;
};

}  // namespace

void disturb_measurements(const Scenario& scenario, const Robot& robot, Simulated& made) {
  Disturber(scenario, robot, made).run();
}

void disturb_readings(const Scenario& scenario, const std::optional<Compliance>& compliance,
                      Simulated& made) {
  Eigen::MatrixXd& q = made.data.rows.q;
  for (Eigen::Index row = 0; compliance && row < q.rows(); ++row)
    q.row(row) = reading_of(*compliance, q.row(row).transpose()).transpose();
  Random random = stream(scenario.seed, Draw::readings);
  std::normal_distribution<double> normal;
  for (Eigen::Index row = 0; row < q.rows(); ++row)
    if (const double sigma = made.data.sets[made.data.rows.set[row]].noise_joints; sigma > 0)
      for (double& reading : q.row(row)) reading += sigma * normal(random);
  if (const double step = scenario.encoder_step; step > 0) q = (q.array() / step).round() * step;
}

}  // namespace selfcal
