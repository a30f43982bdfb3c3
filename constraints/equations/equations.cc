// From rows and a state to R of [W | Delta Y] (11.21 to 11.26), block by block.
//
// For each row r(X, own, group) of a method, W = G Psi (chain rule) and Delta Y = -r, both divided
// by the set's sigma and by the root of the row's Huber weight.
#include "constraints/equations/equations_inner.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kinematics/corrected_robot.h"
#include "kinematics/kernels/kernels.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

/// Adds G (of one side) times Psi to the rows of W, equation by equation.
void add_product(const MethodOutput::Block& G, const PsiBlock& psi, int equations,
                 Eigen::MatrixXd& W) {
  for (int a = 0; a < equations; ++a) {
    std::array<kernels::LaneProduct, 6> products;
    size_t terms = 0;
    for (int c = 0; c < 6; ++c)
      if ((G.col(6 * a + c) != 0).any())
        products[terms++] = {G.col(6 * a + c).data(), psi.data() + c * kLanes};
    kernels::add_products(products.data(), terms, kLanes, static_cast<size_t>(psi.cols()),
                          static_cast<size_t>(psi.rows()), W.data() + a * kLanes,
                          static_cast<size_t>(W.rows()));
  }
}

/// Columns of a rigid motion of the world: shifts, then turns about the origin.
void motion_columns(const Locations& X, PsiBlock& psi) {
  psi.setZero(6 * kLanes, kMotions);
  for (int lane = 0; lane < kLanes; ++lane) {
    const Eigen::Matrix3d turn = -skew(X.p(lane));
    for (int i = 0; i < 3; ++i) {
      psi(i * kLanes + lane, i) = 1;
      psi((3 + i) * kLanes + lane, 3 + i) = 1;
      for (int k = 0; k < 3; ++k) psi(k * kLanes + lane, 3 + i) = turn(k, i);
    }
  }
}

/// The three equations from `a` on of a lane of D, vectors or their derivatives, times `A`.
void turn(const Eigen::Matrix3d& A, int lane, Eigen::Index a, Eigen::Index equations,
          MethodOutput::Block& D) {
  using Derivatives = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Index m = D.cols() / equations;
  Derivatives part(3, m);
  for (int i = 0; i < 3; ++i) part.row(i) = D.row(lane).segment((a + i) * m, m).matrix();
  part = (A * part).eval();
  for (int i = 0; i < 3; ++i) D.row(lane).segment((a + i) * m, m) = part.row(i).array();
}

}  // namespace

double RowResidual::sigmas(const Scale& scale) const {
  return std::hypot(length / scale.length, angle / scale.angle) / factor;
}

Equations::Equations(const Robot& robot, const DataSet& data, Use use)
    : robot_(robot),
      data_(data),
      conditions_matter_(!effects_of(robot).empty()),
      plans_(data.sets.size()),
      stated_(data.sets.size()),
      independent_(data.sets.size()) {
  nuisance_end_ = robot_columns();
  for (int s = 0; s < static_cast<int>(data.sets.size()); ++s) {
    make_plan(s, use);
    nuisance_at_.push_back(nuisance_end_);
    nuisance_count_.push_back(plans_[s].items.empty() ? 0
                                                      : data.sets[s].method->tangent_dimension());
    nuisance_end_ += nuisance_count_.back();
    known_at_.push_back(known_end_);
    if (!plans_[s].items.empty())
      known_end_ += static_cast<int>(data.sets[s].method->known_lengths().size());
  }
  for (int s = 0; s < static_cast<int>(data.sets.size()); ++s) propagate_readings(s);
}

std::size_t Equations::items_of_all() const {
  std::size_t count = 0;
  for (const SetPlan& plan : plans_) count += plan.items.size();
  return count;
}

int Equations::group_freedoms(int set) const {
  size_t groups = 0;
  for (const SetPlan::Cluster& cluster : plans_[set].clusters) groups += cluster.groups.size();
  return static_cast<int>(groups) * data_.sets[set].method->group_freedom();
}

int Equations::nuisance_dimensions() const {
  int freedoms = nuisance_columns();
  for (int s = 0; s < static_cast<int>(plans_.size()); ++s) freedoms += group_freedoms(s);
  return freedoms;
}

void Equations::evaluate(int set, int first, int count, const State& state, Block& block,
                         bool jacobian) const {
  const Set& s = data_.sets[set];
  const Method& method = *s.method;
  const auto load = [&](ConfigurationBlock& into, bool previous) {
    into.q.resize(kLanes, data_.rows.q.cols());
    into.count = count;
    std::vector<int> rows(kLanes);
    for (int lane = 0; lane < kLanes; ++lane) {
      const SetPlan::Item& item = plans_[set].items[first + std::min(lane, count - 1)];
      rows[lane] = previous ? item.previous : item.row;
      into.q.row(lane) = data_.rows.q.row(rows[lane]).array();
    }
    if (conditions_matter_) into.conditions = conditions(data_.rows, rows);
  };
  block.rows.resize(count);
  for (int lane = 0; lane < count; ++lane) block.rows[lane] = plans_[set].items[first + lane].row;
  load(block.now, false);
  block.closure = robot_.locate(block.now, state.xi, method.body(), block.X_now,
                                jacobian ? &block.psi_now : nullptr);
  if (method.paired()) {
    load(block.before, true);
    block.closure.add(robot_.locate(block.before, state.xi, method.body(), block.X_before,
                                    jacobian ? &block.psi_before : nullptr));
  }
  block.quantities = method.equations();
  block.out.resize(static_cast<int>(block.quantities.size()), method.tangent_dimension(),
                   s.reference < 0 ? 0 : data_.sets[s.reference].method->tangent_dimension(),
                   method.group_freedom());
  MethodInput in;
  in.count = count;
  in.data = &data_.rows;
  in.rows = block.rows.data();
  in.now = &block.X_now;
  in.before = &block.X_before;
  in.nuisance = &state.nuisance[set];
  in.reference = s.reference < 0 ? nullptr : &state.nuisance[s.reference];
  in.groups = &state.groups[set];
  method.evaluate(in, block.out);
  for (int lane = 0; !block.closure.closes() && lane < kLanes; ++lane)
    if (!block.closure.closes(lane)) block.out.clear(lane);
  make_independent(set, first, block);
  block.G_axes.resize(kLanes, 0);
  if (!method.vectors()) return;
  robot_.locate(block.now, state.xi, Body::first_link, block.X_axes,
                jacobian ? &block.psi_axes : nullptr);
  into_axes(block);
}

void Equations::into_axes(Block& block) const {
  MethodOutput& out = block.out;
  const Eigen::Index equations = out.r.cols();
  block.G_axes.setZero(kLanes, 6 * equations);
  for (int lane = 0; lane < static_cast<int>(block.rows.size()); ++lane) {
    const Eigen::Matrix3d to_axes = block.X_axes.R(lane).transpose();
    for (Eigen::Index a = 0; a < equations; a += 3) {
      const Eigen::Vector3d r = out.r.row(lane).segment<3>(a).matrix().transpose();
      const Eigen::Matrix3d by_turn = to_axes * skew(r);
      for (int i = 0; i < 3; ++i)
        block.G_axes.row(lane).segment<3>(6 * (a + i) + 3) = by_turn.row(i).array();
      for (MethodOutput::Block* D : {&out.r, &out.G_now, &out.D_group})
        turn(to_axes, lane, a, equations, *D);
    }
  }
}

RowResidual row_residual(const MethodOutput& out, const std::vector<Quantity>& quantities,
                         const Closure& closure, int lane, int row, int set, double factor) {
  RowResidual r{row, set};
  r.factor = factor;
  for (size_t a = 0; a < quantities.size(); ++a) {
    const double value = out.r(lane, static_cast<Eigen::Index>(a));
    const bool angle = quantities[a] == Quantity::angle;
    r.scalars.set(a, value);
    (angle ? r.angle : r.length) += value * value;
    ++(angle ? r.angles : r.lengths);
  }
  r.length = std::sqrt(r.length);
  r.angle = std::sqrt(r.angle);
  if (!closure.closes(lane)) r.length = HUGE_VAL;
  return r;
}

Eigen::Vector3d shortest_way(const MethodOutput& out, const std::vector<Quantity>& quantities,
                             int lane) {
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMostEquations, 3> G(quantities.size(), 3);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostEquations, 1> r(quantities.size());
  Eigen::Index count = 0;
  for (size_t a = 0; a < quantities.size(); ++a) {
    if (quantities[a] == Quantity::angle) continue;
    const auto column = static_cast<Eigen::Index>(a);
    G.row(count) = out.G_now.row(lane).segment<3>(6 * column).matrix();
    r[count++] = out.r(lane, column);
  }
  if (count == 0) return Eigen::Vector3d::Zero();
  return -Eigen::MatrixXd(G.topRows(count)).completeOrthogonalDecomposition().solve(r.head(count));
}

std::vector<RowResidual> Equations::residuals(const State& state) const {
  std::vector<RowResidual> list;
  list.reserve(items_of_all());
  Block block;
  for (int s = 0; s < static_cast<int>(plans_.size()); ++s) {
    const int items = static_cast<int>(plans_[s].items.size());
    for (int first = 0; first < items; first += kLanes) {
      const int count = std::min(kLanes, items - first);
      evaluate(s, first, count, state, block, false);
      for (int lane = 0; lane < count; ++lane) {
        list.push_back(row_residual(block.out, block.quantities, block.closure, lane,
                                    block.rows[lane], s, data_.rows.factor(block.rows[lane])));
        if (!block.closure.closes(lane)) continue;
        list.back().at = block.X_now.p(lane);
        list.back().way = shortest_way(block.out, block.quantities, lane);
      }
    }
  }
  return list;
}

void Equations::chain_rule(const Block& block, int set, bool beside, Eigen::MatrixXd& W) const {
  const Set& s = data_.sets[set];
  const int equations = static_cast<int>(block.quantities.size());
  W.setZero(equations * kLanes, columns() + (beside ? kMotions + known_lengths() : 0) + 1);
  add_product(block.out.G_now, block.psi_now, equations, W);
  if (s.method->paired()) add_product(block.out.G_before, block.psi_before, equations, W);
  if (block.G_axes.cols() > 0) add_product(block.G_axes, block.psi_axes, equations, W);
  const auto own_block = [&](const MethodOutput::Block& D, int of) {
    const int m = nuisance_count_[of];
    for (int a = 0; m > 0 && a < equations; ++a)
      W.block(a * kLanes, nuisance_at_[of], kLanes, m) = D.middleCols(a * m, m).matrix();
  };
  own_block(block.out.D_own, set);
  if (s.reference >= 0) own_block(block.out.D_reference, s.reference);
  if (beside) beside_unknowns(block, set, W);
  for (int a = 0; a < equations; ++a)
    W.col(W.cols() - 1).segment(a * kLanes, kLanes) = -block.out.r.col(a).matrix();
}

void Equations::beside_unknowns(const Block& block, int set, Eigen::MatrixXd& W) const {
  const Method& method = *data_.sets[set].method;
  const int equations = static_cast<int>(block.quantities.size());
  PsiBlock psi;
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(W.rows(), kMotions);
  motion_columns(block.X_now, psi);
  add_product(block.out.G_now, psi, equations, M);
  if (method.paired()) {
    motion_columns(block.X_before, psi);
    add_product(block.out.G_before, psi, equations, M);
  }
  if (block.G_axes.cols() > 0) {
    motion_columns(block.X_axes, psi);
    add_product(block.G_axes, psi, equations, M);
  }
  W.middleCols(columns(), kMotions) = M;
  const std::vector<KnownLength> known = method.known_lengths();
  Eigen::VectorXd by_length(equations);
  for (int a = 0; a < equations; ++a)
    by_length[a] = block.quantities[static_cast<size_t>(a)] == Quantity::length ? 1 : 0;
  for (size_t i = 0; i < known.size(); ++i) {
    if (!known[i].by_row) continue;
    auto column = W.col(columns() + kMotions + known_at_[set] + static_cast<Eigen::Index>(i));
    for (int lane = 0; lane < static_cast<int>(block.rows.size()); ++lane) {
      const Eigen::VectorXd by =
          block.independent ? Eigen::VectorXd(block.independent[lane] * by_length) : by_length;
      for (int a = 0; a < equations; ++a) column[a * kLanes + lane] = by[a];
    }
  }
}

State Equations::stepped(const State& state, const Linearised& at,
                         const Eigen::VectorXd& step) const {
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
      const Eigen::MatrixXd& factor = at.clusters[cluster_index++].rows;
      const Eigen::Index local = factor.rows();
      const Eigen::VectorXd right =
          factor.rightCols(1) - factor.middleCols(local, step.size()) * step;
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
