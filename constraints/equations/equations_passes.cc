// One pass over all rows, part by part on all processors: to R of what is left of the sets, or to
// sums of products.
#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>

#include "constraints/equations/equations_inner.h"
#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {

Eigen::VectorXd Equations::geodesic_acceleration(const State& state, const Weighting& weighting,
                                                 const NormalEquations& at,
                                                 const Eigen::VectorXd& step) const {
  const GeodesicStep geodesic_acceleration{stepped(state, at, GeodesicStep::kPart * step),
                                           stepped(state, at, 0 * step),
                                           stepped(state, at, -GeodesicStep::kPart * step)};
  Pass pass{state, weighting, {}};
  pass.bend = &geodesic_acceleration;
  const NormalEquations products = sum_products(pass, at.columns);
  return products.H.rightCols(1).topRows(products.H.rows() - 1);
}

NormalEquations Equations::normal_equations(const State& state, const Weighting& weighting,
                                            const std::vector<int>& columns) const {
  return sum_products({state, weighting, {}}, columns);
}

/// What one part gives.
struct Equations::Swept {
  Rows rows;
  Passed passed;
};

template <class Take>
void Equations::sweep(const Pass& pass, const std::vector<Layout>& layouts, Passed& out,
                      const Take& take) const {
  out.norms.reserve(items_of_all());
  const auto make = [&](int i) {
    const Part& part = parts_[static_cast<size_t>(i)];
    const Layout& layout = layouts[static_cast<size_t>(part.set)];
    Swept swept{Rows(layout.width(), pass.products), {}};
    swept.passed.norms.reserve(static_cast<size_t>(part.last - part.first));
    sweep_part(part, pass, layout, swept.rows, swept.passed);
    swept.rows.finish();
    return swept;
  };
  in_order(static_cast<int>(parts_.size()), parts_at_once(items_of_all()), make,
           [&](int i, Swept swept) {
             out.cost += swept.passed.cost;
             out.equations += swept.passed.equations;
             out.norms.insert(out.norms.end(), swept.passed.norms.begin(),
                              swept.passed.norms.end());
             std::ranges::move(swept.passed.clusters, std::back_inserter(out.clusters));
             take(parts_[static_cast<size_t>(i)].set, swept.rows);
           });
}

std::vector<Equations::Layout> Equations::layouts(const Pass& pass) const {
  std::vector<Layout> list;
  for (int s = 0; s < static_cast<int>(plans_.size()); ++s)
    list.push_back(plans_[s].items.empty() ? Layout() : layout(s, pass));
  return list;
}

NormalEquations Equations::sum_products(const Pass& what, const std::vector<int>& columns) const {
  Pass pass = what;
  pass.products = true;
  for (const int column : columns)
    if (column < robot_columns()) pass.robot.push_back(column);
  pass.width = static_cast<int>(columns.size()) + 1;
  expects(pass.width == static_cast<int>(pass.robot.size()) + nuisance_columns() + 1,
          "all own columns take part");
  NormalEquations result;
  result.columns = columns;
  result.H.setZero(pass.width, pass.width);
  const std::vector<Layout> of_sets = layouts(pass);
  sweep(pass, of_sets, result, [&](int set, const Rows& rows) {
    const std::vector<int>& global = of_sets[static_cast<size_t>(set)].global;
    result.H(global, global) += rows.products();
  });
  return result;
}

/// What is left of a set's rows beyond its lone columns meets that of the others in one factor; the
/// rows above it are put on top.
Linearised Equations::linearise(const State& state, const Weighting& weighting, bool beside) const {
  Pass pass{state, weighting, {}, beside};
  pass.robot.resize(static_cast<size_t>(robot_columns()));
  std::iota(pass.robot.begin(), pass.robot.end(), 0);
  pass.width = columns() + (beside ? kMotions + known_lengths() : 0) + 1;
  Linearised result;
  const std::vector<Layout> of_sets = layouts(pass);
  std::vector<std::optional<Rows>> factors(of_sets.size());
  sweep(pass, of_sets, result, [&](int set, Rows& rows) {
    std::optional<Rows>& factor = factors[static_cast<size_t>(set)];
    if (factor)
      factor->push(rows.rows());
    else
      factor = std::move(rows);
  });
  std::vector<char> lone(static_cast<size_t>(pass.width), 0);
  Eigen::MatrixXd on_top = Eigen::MatrixXd::Zero(pass.width, pass.width);
  Eigen::Index tops = 0;
  std::vector<Eigen::MatrixXd> rest(of_sets.size());
  for (size_t s = 0; s < of_sets.size(); ++s) {
    if (!factors[s]) continue;
    factors[s]->finish();
    const Layout& of_set = of_sets[s];
    Eigen::MatrixXd rows = factors[s]->rows();
    const auto kept = static_cast<Eigen::Index>(eliminate(rows, of_set.lone).size());
    on_top(Eigen::seqN(tops, kept), of_set.global) = rows.topRows(kept);
    tops += kept;
    for (int k = 0; k < of_set.lone; ++k)
      lone[static_cast<size_t>(of_set.global[static_cast<size_t>(k)])] = 1;
    rest[s] = rows.bottomRightCorner(rows.rows() - kept, of_set.width() - of_set.lone);
  }
  std::vector<int> shared, place(static_cast<size_t>(pass.width), -1);
  for (int c = 0; c < pass.width; ++c)
    if (!lone[static_cast<size_t>(c)]) {
      place[static_cast<size_t>(c)] = static_cast<int>(shared.size());
      shared.push_back(c);
    }
  StreamingQr qr(static_cast<int>(shared.size()));
  for (size_t s = 0; s < of_sets.size(); ++s) {
    Eigen::MatrixXd rows =
        Eigen::MatrixXd::Zero(rest[s].rows(), static_cast<Eigen::Index>(shared.size()));
    for (int k = of_sets[s].lone; k < of_sets[s].width(); ++k)
      rows.col(place[static_cast<size_t>(of_sets[s].global[static_cast<size_t>(k)])]) =
          rest[s].col(k - of_sets[s].lone);
    qr.push(rows);
  }
  on_top(Eigen::seqN(tops, static_cast<Eigen::Index>(shared.size())), shared) = qr.R();
  triangularise(on_top);
  result.R = std::move(on_top);
  return result;
}

State Equations::stepped(const State& state, const Linearised& at,
                         const Eigen::VectorXd& step) const {
  return stepped(state, at.clusters, step, step);
}

State Equations::stepped(const State& state, const NormalEquations& at,
                         const Eigen::VectorXd& step) const {
  return stepped(state, at.clusters, step, step(at.columns));
}

State Equations::stepped(const State& state, const std::vector<ClusterFactor>& clusters,
                         const Eigen::VectorXd& step, const Eigen::VectorXd& of_columns) const {
  State next = state;
  next.xi += step.head(robot_columns());
  size_t cluster_index = 0;
  for (int s = 0; s < static_cast<int>(plans_.size()); ++s) {
    const Method& method = *data_.sets[s].method;
    if (nuisance_count_[s] > 0)
      method.retract(next.nuisance[s], step.segment(nuisance_at_[s], nuisance_count_[s]));
    const int freedom = method.group_freedom();
    for (const SetPlan::Cluster& cluster : plans_[s].clusters) {
      if (cluster.groups.empty()) continue;
      const Eigen::MatrixXd& factor = clusters[cluster_index++].rows;
      const Eigen::Index local = factor.rows();
      const Eigen::VectorXd right =
          factor.rightCols(1) - factor.middleCols(local, of_columns.size()) * of_columns;
      Eigen::VectorXd move = right;
      for (Eigen::Index i = local - 1; i >= 0; --i) {
        const double diagonal = factor(i, i);
        move[i] -= factor.row(i).segment(i + 1, local - 1 - i).dot(move.tail(local - 1 - i));
        move[i] = std::abs(diagonal) > 1e-12 ? move[i] / diagonal : 0;
      }
      for (size_t g = 0; g < cluster.groups.size(); ++g)
        method.retract_group(next.groups[s].col(cluster.groups[g]),
                             move.segment(static_cast<Eigen::Index>(g) * freedom, freedom));
    }
  }
  return next;
}

}  // namespace selfcal
