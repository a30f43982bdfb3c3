// The system of equations as a reader of the chapter would write it down: one configuration at a
// time, every row of W stored, loops in place of kernels. What the fast path is held against.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/statistics.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/rotation.h"

namespace selfcal {

/// [W | Delta Y] of the rows that take part, columns [global | groups | Delta Y], weighed.
struct PlainSystem {
  Eigen::MatrixXd W;
  double cost = 0;
  int equations = 0;
  std::vector<RowResidual> residuals;
  std::vector<RowPlace> places;  ///< of the same rows

  /// [W | Delta Y]^T [W | Delta Y] once the groups' columns are eliminated.
  Eigen::MatrixXd gram(int global) const {
    const Eigen::Index local = W.cols() - 1 - global;
    Eigen::MatrixXd kept(W.rows(), global + 1);
    kept << W.leftCols(global), W.rightCols(1);
    const Eigen::MatrixXd left = beyond(W.middleCols(global, local), kept);
    return left.transpose() * left;
  }
  /// Lengths of the global columns and of Delta Y.
  Eigen::VectorXd lengths(int global) const {
    Eigen::VectorXd list(global + 1);
    list << W.leftCols(global).colwise().norm().transpose(), W.rightCols(1).norm();
    return list;
  }
};

class PlainPath {
 public:
  PlainPath(const Equations& equations, const State& state, const Weighting& weighting)
      : equations_(equations), state_(state), weighting_(weighting) {}

  PlainSystem system() const {
    PlainSystem made;
    std::vector<Eigen::MatrixXd> parts;
    for (int s = 0; s < static_cast<int>(data().sets.size()); ++s) {
      parts.push_back(rows_of(s, made));
      parts.push_back(links_of(s, made));
      parts.push_back(own_equations_of(s, made));
    }
    Eigen::Index rows = 0;
    for (const Eigen::MatrixXd& part : parts) rows += part.rows();
    made.W.resize(rows, all_columns() + 1);
    Eigen::Index at = 0;
    for (const Eigen::MatrixXd& part : parts) {
      made.W.middleRows(at, part.rows()) = part;
      at += part.rows();
    }
    return made;
  }

 private:
  const DataSet& data() const { return equations_.data(); }
  const Method& method(int set) const { return *data().sets[static_cast<size_t>(set)].method; }

  Eigen::Index groups_at(int set) const {
    Eigen::Index at = equations_.columns();
    for (int s = 0; s < set; ++s)
      at += state_.groups[static_cast<size_t>(s)].cols() * method(s).group_freedom();
    return at;
  }
  Eigen::Index all_columns() const { return groups_at(static_cast<int>(data().sets.size())); }

  /// The body at one row, and Psi of it.
  struct Placed {
    Locations X;
    Eigen::MatrixXd psi;  // 6 x parameters
  };
  Placed placed(int row, Body body) const {
    const Robot& robot = equations_.robot();
    ConfigurationBlock block = block_of(data().rows.q.row(row).transpose());
    const auto lanes = static_cast<size_t>(block.q.rows());
    if (!effects_of_none()) block.conditions = conditions(data().rows, std::vector(lanes, row));
    Placed made;
    PsiBlock psi;
    robot.locate(block, state_.xi, body, made.X, &psi);
    made.psi.resize(6, psi.cols());
    for (int c = 0; c < 6; ++c) made.psi.row(c) = psi.row(c * block.q.rows());
    return made;
  }
  bool effects_of_none() const {
    return std::ranges::none_of(equations_.robot().parameters(),
                                [](const Parameter& p) { return p.part == Part::effect; });
  }

  /// One row: its equations as rows of [W | Delta Y], neither weighed nor over sigma.
  Eigen::MatrixXd row_of(int set, const SetPlan::Item& item, RowResidual& residual,
                         RowPlace& place) const {
    const Set& s = data().sets[static_cast<size_t>(set)];
    const std::vector<Quantity> quantities = s.method->equations();
    const auto n = static_cast<Eigen::Index>(quantities.size());
    const int m = s.method->tangent_dimension(), g = s.method->group_freedom();
    const int referred = s.reference < 0 ? 0 : method(s.reference).tangent_dimension();
    const Placed now = placed(item.row, s.method->body());
    const Placed before = s.method->paired() ? placed(item.previous, s.method->body()) : now;
    MethodOutput out;
    out.resize(static_cast<int>(n), m, referred, g);
    MethodInput in;
    in.count = 1;
    in.data = &data().rows;
    in.rows = &item.row;
    in.now = &now.X;
    in.before = &before.X;
    in.nuisance = &state_.nuisance[static_cast<size_t>(set)];
    in.reference = s.reference < 0 ? nullptr : &state_.nuisance[static_cast<size_t>(s.reference)];
    in.groups = &state_.groups[static_cast<size_t>(set)];
    s.method->evaluate(in, out);
    Eigen::VectorXd r = out.r.row(0).matrix().transpose();
    const auto by_equation = [&](const MethodOutput::Block& D, int columns) {
      Eigen::MatrixXd rows(n, columns);
      for (Eigen::Index a = 0; a < n; ++a)
        for (int k = 0; k < columns; ++k) rows(a, k) = D(0, a * columns + k);
      return rows;
    };
    Eigen::MatrixXd G = by_equation(out.G_now, 6), G_before = by_equation(out.G_before, 6);
    Eigen::MatrixXd D_group = by_equation(out.D_group, g), axes = Eigen::MatrixXd::Zero(n, 6);
    Placed link;
    if (s.method->vectors()) {  // in axes that turn with the first moving link
      link = placed(item.row, Body::first_link);
      const Eigen::Matrix3d A = link.X.R(0).transpose();
      for (Eigen::Index a = 0; a < n; a += 3) {
        axes.block(a, 3, 3, 3) = A * skew(Eigen::Vector3d(r.segment<3>(a)));
        G.middleRows<3>(a) = (A * G.middleRows<3>(a)).eval();
        D_group.middleRows<3>(a) = (A * D_group.middleRows<3>(a)).eval();
        r.segment<3>(a) = (A * r.segment<3>(a)).eval();
      }
    }
    Eigen::MatrixXd W = Eigen::MatrixXd::Zero(n, all_columns() + 1);
    W.leftCols(equations_.robot_columns()) = G * now.psi;
    if (s.method->paired()) W.leftCols(equations_.robot_columns()) += G_before * before.psi;
    if (s.method->vectors()) W.leftCols(equations_.robot_columns()) += axes * link.psi;
    W.middleCols(equations_.own_at(set), m) = by_equation(out.D_own, m);
    if (referred > 0)
      W.middleCols(equations_.own_at(s.reference), referred) =
          by_equation(out.D_reference, referred);
    if (g > 0)
      W.middleCols(groups_at(set) + g * data().rows.group[static_cast<size_t>(item.row)], g) =
          D_group;
    W.rightCols(1) = -r;
    describe(set, item.row, quantities, r, G, residual, place);
    place.at = now.X.p(0);
    return W;
  }

  void describe(int set, int row, const std::vector<Quantity>& quantities, const Eigen::VectorXd& r,
                const Eigen::MatrixXd& G, RowResidual& residual, RowPlace& place) const {
    residual.row = row;
    residual.set = set;
    residual.factor = data().rows.factor(row);
    Eigen::MatrixXd to_lengths(0, 3);
    Eigen::VectorXd lengths(0);
    for (size_t a = 0; a < quantities.size(); ++a) {
      const auto at = static_cast<Eigen::Index>(a);
      residual.scalars.set(a, r[at]);
      if (quantities[a] == Quantity::angle) {
        ++residual.angles;
        residual.angle = std::hypot(residual.angle, r[at]);
        continue;
      }
      ++residual.lengths;
      residual.length = std::hypot(residual.length, r[at]);
      to_lengths.conservativeResize(residual.lengths, 3);
      to_lengths.row(residual.lengths - 1) = G.row(at).head<3>();
      lengths.conservativeResize(residual.lengths);
      lengths[residual.lengths - 1] = r[at];
    }
    if (residual.lengths > 0) place.way = -least_squares(to_lengths, lengths);
  }

  Eigen::MatrixXd rows_of(int set, PlainSystem& made) const {
    const std::vector<SetPlan::Item>& items = equations_.plan(set).items;
    const std::vector<Quantity> quantities = method(set).equations();
    const auto n = static_cast<Eigen::Index>(quantities.size());
    const Scale& scale = weighting_.scale[static_cast<size_t>(set)];
    const double soft =
        items.empty() ? 0 : chi_quantile(static_cast<int>(n), weighting_.soft_quantile);
    Eigen::MatrixXd W(0, all_columns() + 1);
    std::vector<SetPlan::Item> kept;
    for (const SetPlan::Item& item : items) {
      RowResidual residual;
      Eigen::MatrixXd rows = row_of(set, item, residual, made.places.emplace_back());
      made.residuals.push_back(residual);
      if (weighting_.outlier[static_cast<size_t>(item.row)]) continue;
      const double t = residual.sigmas(scale);
      made.cost += t > soft ? soft * (2 * t - soft) : t * t;
      made.equations += static_cast<int>(n);
      const double weight = (t > soft ? std::sqrt(soft / t) : 1) / residual.factor;
      for (Eigen::Index a = 0; a < n; ++a)
        rows.row(a) *= weight / scale.of(quantities[static_cast<size_t>(a)]);
      W.conservativeResize(W.rows() + n, Eigen::NoChange);
      W.bottomRows(n) = rows;
      kept.push_back(item);
    }
    if (method(set).shares_touches()) independent(kept, W, made);
    return W;
  }

  /// Differences of touches of equal noise, neighbours of which correlate by -1/2: by the root of
  /// their correlation.
  static void independent(const std::vector<SetPlan::Item>& items, Eigen::MatrixXd& W,
                          PlainSystem& made) {
    Eigen::MatrixXd C = Eigen::MatrixXd::Identity(W.rows(), W.rows());
    for (size_t i = 0; i < items.size(); ++i)
      for (size_t j = 0; j < i; ++j)
        if (items[i].previous == items[j].row)
          C(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = -0.5;
    const Eigen::LLT<Eigen::MatrixXd> root(C);
    made.cost -= W.rightCols(1).squaredNorm();
    W = root.matrixL().solve(W).eval();
    made.cost += W.rightCols(1).squaredNorm();
  }

  Eigen::MatrixXd links_of(int set, PlainSystem& made) const {
    Eigen::MatrixXd W(0, all_columns() + 1);
    if (equations_.plan(set).items.empty()) return W;
    for (const GroupDistance& link : method(set).links()) {
      Eigen::VectorXd D_a, D_b;
      const auto& groups = state_.groups[static_cast<size_t>(set)];
      const double r =
          method(set).link_residual(link, groups.col(link.a), groups.col(link.b), D_a, D_b);
      W.conservativeResize(W.rows() + 1, Eigen::NoChange);
      auto row = W.bottomRows<1>();
      row.setZero();
      row.segment(groups_at(set) + link.a * D_a.size(), D_a.size()) = D_a.transpose() / link.noise;
      row.segment(groups_at(set) + link.b * D_b.size(), D_b.size()) = D_b.transpose() / link.noise;
      row[row.size() - 1] = -r / link.noise;
      made.cost += std::pow(r / link.noise, 2);
      ++made.equations;
    }
    return W;
  }

  Eigen::MatrixXd own_equations_of(int set, PlainSystem& made) const {
    Eigen::MatrixXd W(0, all_columns() + 1);
    const int reference = data().sets[static_cast<size_t>(set)].reference;
    if (equations_.plan(set).items.empty()) return W;
    for (const OwnEquation& each : method(set).own_equations(
             state_.nuisance[static_cast<size_t>(set)],
             reference < 0 ? nullptr : &state_.nuisance[static_cast<size_t>(reference)])) {
      W.conservativeResize(W.rows() + 1, Eigen::NoChange);
      auto row = W.bottomRows<1>();
      row.setZero();
      row.segment(equations_.own_at(set), equations_.tangent_dimension(set)) =
          each.D_own.transpose() / each.sigma;
      const int referred = equations_.tangent_dimension(reference);
      row.segment(equations_.own_at(reference), referred) =
          each.D_reference.head(referred).transpose() / each.sigma;
      row[row.size() - 1] = -each.residual / each.sigma;
      made.cost += std::pow(each.residual / each.sigma, 2);
      ++made.equations;
    }
    return W;
  }

  const Equations& equations_;
  const State& state_;
  const Weighting& weighting_;
};

}  // namespace selfcal
