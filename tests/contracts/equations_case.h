// A small data set with every way in which equations hang together (nuisance parameters, a set that
// refers to another, groups, linked groups, pairs), and its system from central differences.
#pragma once

#include <vector>

#include "constraints/sampling/configurations.h"
#include "constraints/statistics.h"
#include "tests/contracts/arm.h"
#include "tests/contracts/method_case.h"

namespace selfcal {

struct EquationsCase {
  std::unique_ptr<Robot> robot;
  DataSet data;
  State state;  ///< near the truth
  Weighting weighting;

  explicit EquationsCase(unsigned long long seed, std::unique_ptr<Robot> arm = six_axis_arm())
      : robot(std::move(arm)) {
    data.sets = make_sets(
        "tracker: {method: location, frame: unknown}\n"
        "point: {method: position, frame: unknown, point: unknown}\n"
        "bar: {method: distance}\n"
        "tip: {method: position-constraint,"
        " apart: [{groups: [g0, g1], distance: 0.3, noise: 0.01}]}\n"
        "nest: {method: location-constraint}\n"
        "gauge: {method: plane, parallel_to: {set: table, distance: 0.2, noise: 0.01}}\n"
        "table: {method: plane}\n"
        "ball: {method: sphere}\n"
        "globe: {method: sphere, radius: 0.15}\n");
    std::vector<SampleRequest> requests;
    for (size_t s = 0; s < data.sets.size(); ++s) {
      data.sets[s].groups.clear();  // drawn rows name their own; the link is of the first two
      SampleRequest request;
      request.set = static_cast<int>(s);
      request.rows = s == 2 ? 40 : 12;  // more pairs than lanes
      requests.push_back(request);
    }
    Random random(seed);
    state = sample_rows(*robot, values(*robot), requests, random, data).truth;
    weighting.scale.assign(data.sets.size(), {0.02, 0.03});
    weighting.outlier.assign(data.rows.rows(), 0);
    std::normal_distribution<double> normal(0, 0.01);
    for (double& v : state.xi) v += normal(random);
  }

  /// The state after a step of [robot | own of each set | groups of each set].
  State stepped(const Equations& equations, const Eigen::VectorXd& step) const {
    State next = state;
    next.xi += step.head(equations.robot_columns());
    Eigen::Index at = equations.robot_columns();
    for (size_t s = 0; s < data.sets.size(); ++s) {
      const Method& method = *data.sets[s].method;
      method.retract(next.nuisance[s], step.segment(at, method.tangent_dimension()));
      at += method.tangent_dimension();
    }
    for (size_t s = 0; s < data.sets.size(); ++s) {
      const Method& method = *data.sets[s].method;
      for (Eigen::Index g = 0; g < next.groups[s].cols(); ++g) {
        method.retract_group(next.groups[s].col(g), step.segment(at, method.group_freedom()));
        at += method.group_freedom();
      }
    }
    return next;
  }

  int all_columns(const Equations& equations) const {
    int count = equations.columns();
    for (size_t s = 0; s < data.sets.size(); ++s)
      count += static_cast<int>(state.groups[s].cols()) * data.sets[s].method->group_freedom();
    return count;
  }

  /// Residuals over sigma: rows, then equations between nuisance parameters, then links.
  Eigen::VectorXd residuals(const Equations& equations, const State& at) const {
    std::vector<double> list;
    for (const RowResidual& row : equations.residuals(at)) {
      const auto quantities = data.sets[row.set].method->equations();
      for (size_t a = 0; a < quantities.size(); ++a)
        list.push_back(row.scalars[a] / weighting.scale[row.set].of(quantities[a]));
    }
    for (size_t s = 0; s < data.sets.size(); ++s) {
      const Set& set = data.sets[s];
      const Eigen::VectorXd* reference = set.reference < 0 ? nullptr : &at.nuisance[set.reference];
      for (const OwnEquation& each : set.method->own_equations(at.nuisance[s], reference))
        list.push_back(each.residual / each.sigma);
      for (const GroupDistance& link : set.method->links()) {
        Eigen::VectorXd D_a, D_b;
        list.push_back(set.method->link_residual(link, at.groups[s].col(link.a),
                                                 at.groups[s].col(link.b), D_a, D_b) /
                       link.noise);
      }
    }
    return Eigen::Map<Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
  }

  /// Weights by the definition: 0 for rows put aside, Huber's root beyond the quantile, else 1.
  Eigen::VectorXd root_weights(const Equations& equations) const {
    std::vector<double> list;
    for (const RowResidual& row : equations.residuals(state)) {
      const int count = row.lengths + row.angles;
      const double t = row.sigmas(weighting.scale[row.set]);
      const double soft = chi_quantile(count, weighting.soft_quantile);
      const double weight = weighting.outlier[row.row] ? 0 : t > soft ? std::sqrt(soft / t) : 1;
      list.insert(list.end(), count, weight);
    }
    const Eigen::Index rows = static_cast<Eigen::Index>(list.size());
    Eigen::VectorXd weights = Eigen::VectorXd::Ones(residuals(equations, state).size());
    weights.head(rows) = Eigen::Map<Eigen::VectorXd>(list.data(), rows);
    return weights;
  }

  /// Dense [W | Delta Y], columns [robot | own | groups | Delta Y], weighed; W by differences.
  Eigen::MatrixXd dense(const Equations& equations) const {
    constexpr double h = 1e-6;
    const int columns = all_columns(equations);
    const Eigen::VectorXd r = residuals(equations, state), weights = root_weights(equations);
    Eigen::MatrixXd W(r.size(), columns + 1);
    for (int c = 0; c < columns; ++c) {
      const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(columns, c);
      W.col(c) = (residuals(equations, stepped(equations, step)) -
                  residuals(equations, stepped(equations, -step))) /
                 (2 * h);
    }
    W.rightCols(1) = -r;
    return weights.asDiagonal() * W;
  }
};

}  // namespace selfcal
