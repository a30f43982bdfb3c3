// One sweep over the rows of a set: weights, groups eliminated as they pass.
//
// Each row of W and Delta Y is divided by its set's sigma and multiplied by the root of its Huber
// weight.
#include <algorithm>
#include <cmath>

#include "constraints/equations/equations_inner.h"
#include "constraints/equations/shared_touches.h"
#include "constraints/statistics.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {

/// Collects the rows of one cluster after another, eliminates the groups' columns and passes the
/// rest on.
class Equations::Gatherer {
 public:
  Gatherer(const Layout& layout, int width, Rows& rest)
      : layout_(layout), width_(width), rest_(rest) {}

  /// A new cluster with `local` freedoms.
  void begin(int local) {
    local_ = local;
    filled_ = 0;
    rows_.resize(std::max(4 * local, 192), local + layout_.width());
  }

  /// A row to be filled by the caller, zero to begin with.
  Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> next() {
    if (filled_ == rows_.rows()) eliminate();
    rows_.row(filled_).setZero();
    return rows_.row(filled_++);
  }

  /// The cluster's factor, in the columns of the whole system.
  ClusterFactor finish() {
    const std::vector<Eigen::Index> steps = eliminate();
    ClusterFactor factor{Eigen::MatrixXd::Zero(local_, local_ + width_)};
    for (size_t i = 0; i < steps.size(); ++i) {
      const auto from = rows_.row(static_cast<Eigen::Index>(i));
      auto row = factor.rows.row(steps[i]);
      row.head(local_) = from.head(local_);
      for (int k = 0; k < layout_.width(); ++k)
        row[local_ + layout_.global[static_cast<size_t>(k)]] = from[local_ + k];
    }
    return factor;
  }

 private:
  /// What the rows say of the local freedoms stays on top, by the freedoms returned; the rest goes.
  std::vector<Eigen::Index> eliminate() {
    auto rows = rows_.topRows(filled_);
    std::vector<Eigen::Index> steps = selfcal::eliminate(rows, local_);
    const auto kept = static_cast<Eigen::Index>(steps.size());
    rest_.push(rows.bottomRightCorner(filled_ - kept, rows_.cols() - local_));
    filled_ = kept;
    return steps;
  }

  const Layout& layout_;
  Eigen::Index width_, local_ = 0, filled_ = 0;
  Eigen::MatrixXd rows_;
  Rows& rest_;
};

Eigen::MatrixXd Equations::own_equations(int set, const Pass& pass, const Layout& layout,
                                         Passed& out) const {
  const int reference = data_.sets[set].reference;
  if (plans_[set].items.empty()) return {};
  const auto equations = data_.sets[set].method->own_equations(
      pass.state.nuisance[set], reference < 0 ? nullptr : &pass.state.nuisance[reference]);
  Eigen::MatrixXd rows =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(equations.size()), layout.width());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const OwnEquation& each = equations[static_cast<size_t>(i)];
    auto row = rows.row(i);
    const double sigma = pass.weighting.structural ? 1 : each.sigma;
    row.segment(layout.own, nuisance_count_[set]) = each.D_own.transpose() / sigma;
    row.segment(layout.reference, nuisance_count_[reference]) =
        each.D_reference.head(nuisance_count_[reference]).transpose() / sigma;
    if (layout.known >= 0) row[layout.known + i] = 1 / sigma;
    // Hardly bent: a plane's step, a length.
    row[row.size() - 1] = pass.bend ? 0 : -each.residual / sigma;
    out.cost += std::pow(each.residual / sigma, 2);
    ++out.equations;
  }
  return rows;
}

void Equations::weigh(int set, const Weighting& weighting, Block& block, Passed& out) const {
  const int equations = static_cast<int>(quantities_[set].size());
  const Scale& scale = weighting.scale[set];
  const double soft = chi_quantile(equations, weighting.soft_quantile);
  const size_t first = out.norms.size();
  add_norms(set, block, out.norms);
  Lanes root_weight = Lanes::Zero(kLanes);
  for (int lane = 0; lane < block.count; ++lane) {
    const int row = block.rows[lane];
    const double noise = data_.rows.factor(row);
    if (weighting.outlier[row]) continue;
    if (!block.closure.closes(lane)) {  // a step that leads here is none to take
      out.cost = HUGE_VAL;
      continue;
    }
    const RowNorm& norm = out.norms[first + static_cast<size_t>(lane)];
    const double length = norm.length / scale.length, angle = norm.angle / scale.angle;
    const double t = std::sqrt(length * length + angle * angle) / noise;
    root_weight[lane] = (t > soft ? std::sqrt(soft / t) : 1) / noise;  // Huber
    out.cost += t > soft ? soft * (2 * t - soft) : t * t;
    out.equations += equations;
  }
  const auto scaled = [&](MethodOutput::Block& D) {
    const Eigen::Index columns = D.cols() / equations;
    for (int a = 0; columns > 0 && a < equations; ++a)
      D.middleCols(a * columns, columns).colwise() *= block.factor.col(a);
  };
  for (int a = 0; a < equations; ++a)
    block.factor.col(a) = root_weight / scale.of(quantities_[set][static_cast<size_t>(a)]);
  MethodOutput& D = block.out;
  for (MethodOutput::Block* each :
       {&D.r, &D.G_now, &D.D_own, &D.D_reference, &D.D_group, &block.G_axes})
    scaled(*each);
  if (data_.sets[set].method->paired()) scaled(D.G_before);
}

void Equations::share(int set, int first, int count, SharedTouches& shared, Eigen::MatrixXd& W,
                      Passed& out) const {
  for (int lane = 0; lane < count; ++lane) {
    const SetPlan::Item& item = plans_[set].items[first + lane];
    const double before = W(lane, W.cols() - 1);
    shared.whiten(item.row, item.previous, W.row(lane));
    out.cost += std::pow(W(lane, W.cols() - 1), 2) - std::pow(before, 2);
  }
}

void Equations::gather(int set, const SetPlan::Cluster& cluster, int lane, const Block& block,
                       const Eigen::MatrixXd& W, Gatherer& gatherer) const {
  const int freedom = data_.sets[set].method->group_freedom();
  const int at = freedom * cluster.place(data_.rows.group[block.rows[lane]]);
  for (int a = 0; a < static_cast<int>(quantities_[set].size()); ++a) {
    auto row = gatherer.next();
    row.segment(at, freedom) = block.out.D_group.row(lane).segment(a * freedom, freedom).matrix();
    row.tail(W.cols()) = W.row(a * kLanes + lane);
  }
}

double Equations::link_row(int set, const GroupDistance& link, double sigma, const State& state,
                           Eigen::Index at_a, Eigen::Index at_b,
                           Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> row) const {
  const Method& method = *data_.sets[set].method;
  Eigen::VectorXd D_a, D_b;
  const double r = method.link_residual(link, state.groups[set].col(link.a),
                                        state.groups[set].col(link.b), D_a, D_b);
  row.segment(at_a, D_a.size()) = D_a.transpose() / sigma;
  row.segment(at_b, D_b.size()) = D_b.transpose() / sigma;
  return r / sigma;
}

void Equations::gather_links(int set, const SetPlan::Cluster& cluster, const Pass& pass,
                             const Layout& layout, Gatherer& gatherer, Passed& out) const {
  const int freedom = data_.sets[set].method->group_freedom();
  const int local = freedom * static_cast<int>(cluster.groups.size());
  for (const GroupDistance& link : cluster.links) {
    auto row = gatherer.next();
    const double sigma = pass.weighting.structural ? 1 : link.noise;
    const double r = link_row(set, link, sigma, pass.state, freedom * cluster.place(link.a),
                              freedom * cluster.place(link.b), row);
    if (layout.known >= 0) row[local + layout.known + link.known] = 1 / sigma;
    row[row.size() - 1] = pass.bend ? 0 : -r;
    out.cost += r * r;
    ++out.equations;
  }
}

void Equations::bend_right_side(int set, int first, int count,
                                const GeodesicStep& geodesic_acceleration, Block& block) const {
  Block ahead, middle, behind;
  evaluate(set, first, count, geodesic_acceleration.ahead, ahead, false);
  evaluate(set, first, count, geodesic_acceleration.middle, middle, false);
  evaluate(set, first, count, geodesic_acceleration.behind, behind, false);
  block.out.r = (ahead.out.r - 2 * middle.out.r + behind.out.r) * block.factor /
                (GeodesicStep::kPart * GeodesicStep::kPart);
}

bool Equations::weighs_nothing(int set, int first, int count, const Weighting& weighting) const {
  const auto from = plans_[set].items.begin() + first;
  return std::all_of(from, from + count, [&](const SetPlan::Item& item) {
    return weighting.outlier[static_cast<size_t>(item.row)] != 0;
  });
}

/// Blocks are full however small the clusters are: one goes on where the last one ended.
void Equations::sweep_part(const Part& part, const Pass& pass, const Layout& layout, Rows& rows,
                           Passed& out) const {
  const SetPlan& plan = plans_[part.set];
  const Method& method = *data_.sets[part.set].method;
  const int freedom = method.group_freedom();
  Gatherer gatherer(layout, pass.width, rows);
  Block block;
  Eigen::MatrixXd W;
  SharedTouches shared;
  auto cluster = plan.clusters.begin() + static_cast<std::ptrdiff_t>(part.cluster);
  for (int first = part.first; first < part.last; first += kLanes) {
    const int count = std::min(kLanes, part.last - first);
    if (pass.weighting.passed_over && cluster->groups.empty() &&
        weighs_nothing(part.set, first, count, pass.weighting)) {
      out.norms.resize(out.norms.size() + static_cast<size_t>(count));
      continue;
    }
    evaluate(part.set, first, count, pass.state, block, true);
    weigh(part.set, pass.weighting, block, out);
    if (pass.bend) bend_right_side(part.set, first, count, *pass.bend, block);
    chain_rule(block, part.set, layout, W);
    if (method.shares_touches()) share(part.set, first, count, shared, W, out);
    if (cluster->groups.empty()) {
      rows.push_block(W, count);
      continue;
    }
    for (int lane = 0; lane < count; ++lane) {
      if (first + lane == cluster->first)
        gatherer.begin(static_cast<int>(cluster->groups.size()) * freedom);
      gather(part.set, *cluster, lane, block, W, gatherer);
      if (first + lane + 1 < cluster->last) continue;
      gather_links(part.set, *cluster, pass, layout, gatherer, out);
      out.clusters.push_back(gatherer.finish());
      ++cluster;
    }
  }
  if (part.last == static_cast<int>(plan.items.size()))
    rows.push(own_equations(part.set, pass, layout, out));
}

}  // namespace selfcal
