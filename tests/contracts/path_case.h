// Rows of any method on any robot, which need not hold: what the formulas of the equations are held
// to.
#pragma once

#include <memory>
#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/sampling/random_poses.h"
#include "tests/contracts/method_case.h"

namespace selfcal {

/// Rows of every set of the case, measured where the robot stands, with parameters a little off:
/// touches need not hold, for that changes no formula.
struct PathCase {
  std::shared_ptr<const Robot> robot;
  DataSet data;
  State state;
  Weighting weighting;

  PathCase(std::shared_ptr<const Robot> of, const MethodCase& each, int rows_of_a_set)
      : robot(std::move(of)) {
    data.sets = make_sets(each.sets);
    if (!answers()) return;
    Random random(73);
    const int sets = static_cast<int>(data.sets.size()), count = rows_of_a_set * sets;
    make_rows(count, random);
    const Eigen::VectorXd truth = values(*robot);
    state.nuisance.resize(data.sets.size());
    state.groups.resize(data.sets.size());
    for (const bool referring : {false, true})
      for (int s = 0; s < sets; ++s)
        if ((data.sets[static_cast<size_t>(s)].reference >= 0) == referring)
          make_set_rows(s, truth, random);
    state.xi = truth;
    std::normal_distribution<double> normal(0, 1e-3);
    for (double& v : state.xi) v += normal(random);
    weighting.scale.assign(data.sets.size(), {3e-3, 5e-3});
    weighting.outlier.assign(static_cast<size_t>(count), 0);
    for (size_t row = 3; row < weighting.outlier.size(); row += 11) weighting.outlier[row] = 1;
    weighting.soft_quantile = 0.9;  // some rows are weighed down
  }

  bool answers() const { return lacking_body(*robot, data.sets).empty(); }

 private:
  void make_rows(int count, Random& random) {
    Observations& rows = data.rows;
    const auto n = static_cast<size_t>(count);
    std::uniform_real_distribution<double> part(-1, 1);
    const auto numbers = [&](Eigen::Index columns, double most) {
      return Eigen::MatrixXd(
          Eigen::MatrixXd::NullaryExpr(count, columns, [&] { return most * part(random); }));
    };
    rows.q = random_poses(*robot, nullptr, count, 5);
    rows.position.setZero(count, 3);
    rows.orientation.setZero(count, 4);
    rows.orientation.col(0).setOnes();
    rows.normal = numbers(3, 1).rowwise().normalized();
    rows.wrench = numbers(6, 50);
    rows.velocity = numbers(rows.q.cols(), 0.5);
    rows.temperature = numbers(1, 5).array() + 20;
    rows.time = numbers(1, 1700).array() + 1800;
    rows.noise_factor = numbers(1, 0.5).array() + 1.5;
    rows.check.assign(n, 0);
    for (int row = 0; row < count; ++row) {
      rows.set.push_back(row % static_cast<int>(data.sets.size()));
      rows.group.push_back(row / 7 % 5);
    }
    for (const Set& set : data.sets)
      for (const MeasuredColumn& column : set.method->measures())
        rows.measured[column.name].setConstant(count, 0.4);
  }

  void make_set_rows(int s, const Eigen::VectorXd& truth, Random& random) {
    Set& set = data.sets[static_cast<size_t>(s)];
    const Method& method = *set.method;
    const auto at = [&](int row) {
      return locate(*robot, truth, data.rows.q.row(row).transpose(), method.body());
    };
    const Eigen::VectorXd* reference =
        set.reference < 0 ? nullptr : &state.nuisance[static_cast<size_t>(set.reference)];
    Eigen::VectorXd& nuisance = state.nuisance[static_cast<size_t>(s)];
    nuisance = method.through(at(s), reference, random);
    set.groups = {"g0", "g1", "g2", "g3", "g4"};
    Eigen::MatrixXd& groups = state.groups[static_cast<size_t>(s)];
    for (Eigen::Index g = 0; method.group_freedom() > 0 && g < 5; ++g) {
      const Eigen::VectorXd start = method.start_group({at(s + static_cast<int>(g))});
      groups.conservativeResize(start.size(), 5);
      groups.col(g) = start;
    }
    std::vector<int> last(5, -1);
    for (int row = 0; row < data.rows.rows(); ++row) {
      if (data.rows.set[static_cast<size_t>(row)] != s) continue;
      int& before = last[static_cast<size_t>(data.rows.group[static_cast<size_t>(row)])];
      if (!method.constrains())
        method.measure(at(row), at(before < 0 ? row : before), nuisance, data.rows, row);
      before = row;
    }
  }
};

}  // namespace selfcal
