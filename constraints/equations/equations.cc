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
#include "kinematics/size.h"

namespace selfcal {
namespace {

/// Adds G (of one side) times columns of Psi to the rows of W, equation by equation.
template <class Runs>
void add_product(const MethodOutput::Block& G, const PsiBlock& psi, int equations, const Runs& runs,
                 Eigen::MatrixXd& W) {
  for (int a = 0; a < equations; ++a)
    for (const auto& run : runs) {
      std::array<kernels::LaneProduct, 6> products;
      size_t terms = 0;
      for (int c = 0; c < 6; ++c)
        if ((G.col(6 * a + c) != 0).any())
          products[terms++] = {G.col(6 * a + c).data(), psi.col(run.from).data() + c * kLanes};
      kernels::add_products(products.data(), terms, kLanes, static_cast<size_t>(run.count),
                            static_cast<size_t>(psi.rows()), W.col(run.to).data() + a * kLanes,
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
    make_parts(s);
    nuisance_at_.push_back(nuisance_end_);
    nuisance_count_.push_back(plans_[s].items.empty() ? 0
                                                      : data.sets[s].method->tangent_dimension());
    nuisance_end_ += nuisance_count_.back();
    for (int i = 0; i < nuisance_count_.back(); ++i)
      nuisance_unit_.push_back(
          data.sets[s].method->tangent_quantity(i) == Quantity::length ? size_of(robot) : 1);
    quantities_.push_back(data.sets[s].method->equations());
    known_at_.push_back(known_end_);
    if (!plans_[s].items.empty())
      known_end_ += static_cast<int>(data.sets[s].method->known_lengths().size());
  }
  shared_.assign(data.sets.size(), 0);
  for (size_t s = 0; s < data.sets.size(); ++s)
    if (data.sets[s].reference >= 0 && !plans_[s].items.empty())
      shared_[data.sets[s].reference] = 1;
  for (int s = 0; s < static_cast<int>(data.sets.size()); ++s) propagate_readings(s);
}

/// Ends with a cluster, where the set has groups; differences that share a touch hang on all before
/// them.
void Equations::make_parts(int set) {
  constexpr int kFewestItems = 2048;  // of a part, the last one apart
  const SetPlan& plan = plans_[set];
  const int items = static_cast<int>(plan.items.size());
  if (items == 0) return;
  const bool apart = !data_.sets[set].method->shares_touches();
  const bool grouped = !plan.clusters.front().groups.empty();
  size_t cluster = 0;
  for (int first = 0; first < items;) {
    Part part{set, first, apart ? std::min(first + kFewestItems, items) : items, cluster};
    while (grouped && plan.clusters[cluster].last < part.last) ++cluster;
    if (grouped) part.last = plan.clusters[cluster++].last;
    parts_.push_back(part);
    first = part.last;
  }
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
    std::array<int, kLanes> rows;
    for (int lane = 0; lane < kLanes; ++lane) {
      const SetPlan::Item& item = plans_[set].items[first + std::min(lane, count - 1)];
      rows[lane] = previous ? item.previous : item.row;
    }
    for (Eigen::Index j = 0; j < into.q.cols(); ++j)
      for (int lane = 0; lane < kLanes; ++lane) into.q(lane, j) = data_.rows.q(rows[lane], j);
    if (conditions_matter_)
      into.conditions = conditions(data_.rows, std::vector<int>(rows.begin(), rows.end()));
  };
  block.count = count;
  for (int lane = 0; lane < count; ++lane) block.rows[lane] = plans_[set].items[first + lane].row;
  load(block.now, false);
  block.closure = robot_.locate(block.now, state.xi, method.body(), block.X_now,
                                jacobian ? &block.psi_now : nullptr);
  if (method.paired()) {
    load(block.before, true);
    block.closure.add(robot_.locate(block.before, state.xi, method.body(), block.X_before,
                                    jacobian ? &block.psi_before : nullptr));
  }
  const int equations = static_cast<int>(quantities_[set].size());
  block.factor.setOnes(kLanes, equations);
  block.out.resize(equations, method.tangent_dimension(),
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
  for (int lane = 0; lane < block.count; ++lane) {
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

void Equations::chain_rule(const Block& block, int set, const Layout& layout,
                           Eigen::MatrixXd& W) const {
  const Set& s = data_.sets[set];
  const int equations = static_cast<int>(quantities_[set].size());
  W.setZero(equations * kLanes, layout.width());
  add_product(block.out.G_now, block.psi_now, equations, layout.robot, W);
  if (s.method->paired())
    add_product(block.out.G_before, block.psi_before, equations, layout.robot, W);
  if (block.G_axes.cols() > 0)
    add_product(block.G_axes, block.psi_axes, equations, layout.robot, W);
  const auto own_block = [&](const MethodOutput::Block& D, int of, int at) {
    const int m = nuisance_count_[of];
    for (int a = 0; m > 0 && a < equations; ++a)
      W.block(a * kLanes, at, kLanes, m) = D.middleCols(a * m, m).matrix();
  };
  own_block(block.out.D_own, set, layout.own);
  if (s.reference >= 0) own_block(block.out.D_reference, s.reference, layout.reference);
  if (layout.motions >= 0) beside_unknowns(block, set, layout, W);
  for (int a = 0; a < equations; ++a)
    W.col(W.cols() - 1).segment(a * kLanes, kLanes) = -block.out.r.col(a).matrix();
}

void Equations::beside_unknowns(const Block& block, int set, const Layout& layout,
                                Eigen::MatrixXd& W) const {
  const Method& method = *data_.sets[set].method;
  const int equations = static_cast<int>(quantities_[set].size());
  const std::array<Layout::Run, 1> motions = {{{0, layout.motions, kMotions}}};
  PsiBlock psi;
  motion_columns(block.X_now, psi);
  add_product(block.out.G_now, psi, equations, motions, W);
  if (method.paired()) {
    motion_columns(block.X_before, psi);
    add_product(block.out.G_before, psi, equations, motions, W);
  }
  if (block.G_axes.cols() > 0) {
    motion_columns(block.X_axes, psi);
    add_product(block.G_axes, psi, equations, motions, W);
  }
  const std::vector<KnownLength> known = method.known_lengths();
  Eigen::VectorXd by_length(equations);
  for (int a = 0; a < equations; ++a)
    by_length[a] = quantities_[set][static_cast<size_t>(a)] == Quantity::length ? 1 : 0;
  for (size_t i = 0; i < known.size(); ++i) {
    if (!known[i].by_row) continue;
    auto column = W.col(layout.known + static_cast<Eigen::Index>(i));
    for (int lane = 0; lane < block.count; ++lane) {
      const Eigen::VectorXd by =
          block.independent ? Eigen::VectorXd(block.independent[lane] * by_length) : by_length;
      for (int a = 0; a < equations; ++a) column[a * kLanes + lane] = block.factor(lane, a) * by[a];
    }
  }
}

}  // namespace selfcal
