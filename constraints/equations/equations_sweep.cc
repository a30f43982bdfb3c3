// One sweep over all rows: weights, groups eliminated as they pass, R of what is left.
//
// Each row of W and Delta Y is divided by its set's sigma and multiplied by the root of its Huber
// weight.
#include <algorithm>
#include <cmath>

#include "constraints/equations/equations_inner.h"
#include "constraints/equations/shared_touches.h"
#include "constraints/equations/streaming_qr.h"
#include "constraints/statistics.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {

/// Collects the rows of one cluster after another, eliminates the groups' columns and passes the
/// rest on.
class Equations::Gatherer {
 public:
  Gatherer(int global, StreamingQr& qr) : global_(global), qr_(qr) {}

  /// A new cluster with `local` freedoms.
  void begin(int local) {
    local_ = local;
    filled_ = 0;
    rows_.resize(std::max(4 * local, 192), local + global_);
  }

  /// A row to be filled by the caller, zero to begin with.
  Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> next() {
    if (filled_ == rows_.rows()) eliminate();
    rows_.row(filled_).setZero();
    return rows_.row(filled_++);
  }

  /// The cluster's factor.
  ClusterFactor finish() {
    while (filled_ < local_) next();
    eliminate();
    ClusterFactor factor;
    factor.rows = rows_.topRows(local_);
    return factor;
  }

 private:
  void eliminate() {
    auto rows = rows_.topRows(filled_);
    selfcal::eliminate(rows, local_);
    qr_.push(rows.bottomRightCorner(filled_ - local_, rows_.cols() - local_));
    filled_ = local_;
  }

  Eigen::Index global_, local_ = 0, filled_ = 0;
  Eigen::MatrixXd rows_;
  StreamingQr& qr_;
};

void Equations::own_equations(const State& state, bool structural, Linearised& out,
                              Eigen::MatrixXd& rows) const {
  for (int s = 0; s < static_cast<int>(plans_.size()); ++s) {
    const int reference = data_.sets[s].reference;
    if (plans_[s].items.empty()) continue;
    const auto equations = data_.sets[s].method->own_equations(
        state.nuisance[s], reference < 0 ? nullptr : &state.nuisance[reference]);
    for (size_t i = 0; i < equations.size(); ++i) {
      const OwnEquation& each = equations[i];
      rows.conservativeResize(rows.rows() + 1, Eigen::NoChange);
      auto row = rows.row(rows.rows() - 1);
      const double sigma = structural ? 1 : each.sigma;
      row.setZero();
      row.segment(nuisance_at_[s], nuisance_count_[s]) = each.D_own.transpose() / sigma;
      row.segment(nuisance_at_[reference], nuisance_count_[reference]) =
          each.D_reference.head(nuisance_count_[reference]).transpose() / sigma;
      if (row.size() > columns() + 1)  // the known lengths stand before Delta Y
        row[row.size() - 1 - known_lengths() + known_at_[s] + static_cast<Eigen::Index>(i)] =
            1 / sigma;
      row[row.size() - 1] = -each.residual / sigma;
      out.cost += std::pow(each.residual / sigma, 2);
      ++out.equations;
    }
  }
}

void Equations::weigh(int set, const Weighting& weighting, Block& block, Eigen::MatrixXd& W,
                      Linearised& out) const {
  const int count = static_cast<int>(block.rows.size());
  const int equations = static_cast<int>(block.quantities.size());
  const Scale& scale = weighting.scale[set];
  const double soft = chi_quantile(equations, weighting.soft_quantile);
  Lanes root_weight = Lanes::Zero(kLanes);
  for (int lane = 0; lane < count; ++lane) {
    const int row = block.rows[lane];
    const double nuisance = data_.rows.factor(row);
    out.residuals.push_back(
        row_residual(block.out, block.quantities, block.closure, lane, row, set, nuisance));
    if (weighting.outlier[row]) continue;
    if (!block.closure.closes(lane)) {  // a step that leads here is none to take
      out.cost = HUGE_VAL;
      continue;
    }
    const double t = out.residuals.back().sigmas(scale);
    root_weight[lane] = (t > soft ? std::sqrt(soft / t) : 1) / nuisance;  // Huber
    out.cost += t > soft ? soft * (2 * t - soft) : t * t;
    out.equations += equations;
  }
  const Eigen::Index freedom = block.out.D_group.cols() / equations;
  for (int a = 0; a < equations; ++a) {
    const Lanes factor = root_weight / scale.of(block.quantities[a]);
    W.middleRows(a * kLanes, kLanes).array().colwise() *= factor;
    block.out.D_group.middleCols(a * freedom, freedom).colwise() *= factor;
  }
}

void Equations::share(int set, int first, int count, SharedTouches& shared, Eigen::MatrixXd& W,
                      Linearised& out) const {
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
  for (int a = 0; a < static_cast<int>(block.quantities.size()); ++a) {
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

void Equations::gather_links(int set, const SetPlan::Cluster& cluster, const State& state,
                             const Weighting& weighting, bool bent, Gatherer& gatherer,
                             Linearised& out) const {
  const int freedom = data_.sets[set].method->group_freedom();
  for (const GroupDistance& link : cluster.links) {
    auto row = gatherer.next();
    const double sigma = weighting.structural ? 1 : link.noise;
    const double r = link_row(set, link, sigma, state, freedom * cluster.place(link.a),
                              freedom * cluster.place(link.b), row);
    if (row.size() > freedom * static_cast<Eigen::Index>(cluster.groups.size()) + columns() + 1)
      row[row.size() - 1 - known_lengths() + known_at_[set] + link.known] = 1 / sigma;
    row[row.size() - 1] = bent ? 0 : -r;
    out.cost += r * r;
    ++out.equations;
  }
}

void Equations::bend_right_side(int set, int first, int count,
                                const GeodesicStep& geodesic_acceleration,
                                Eigen::MatrixXd& W) const {
  Block ahead, middle, behind;
  evaluate(set, first, count, geodesic_acceleration.ahead, ahead, false);
  evaluate(set, first, count, geodesic_acceleration.middle, middle, false);
  evaluate(set, first, count, geodesic_acceleration.behind, behind, false);
  const Eigen::ArrayXXd r_vv =
      (ahead.out.r - 2 * middle.out.r + behind.out.r) / (GeodesicStep::kPart * GeodesicStep::kPart);
  for (Eigen::Index a = 0; a < r_vv.cols(); ++a)
    W.col(W.cols() - 1).segment(a * kLanes, kLanes) = -r_vv.col(a).matrix();
}

Eigen::MatrixXd Equations::geodesic_acceleration(const State& state, const Weighting& weighting,
                                                 const Linearised& at,
                                                 const Eigen::VectorXd& step) const {
  const GeodesicStep geodesic_acceleration{stepped(state, at, GeodesicStep::kPart * step),
                                           stepped(state, at, 0 * step),
                                           stepped(state, at, -GeodesicStep::kPart * step)};
  return sweep(state, weighting, false, &geodesic_acceleration).R;
}

Linearised Equations::linearise(const State& state, const Weighting& weighting, bool beside) const {
  return sweep(state, weighting, beside, nullptr);
}

Linearised Equations::sweep(const State& state, const Weighting& weighting, bool beside,
                            const GeodesicStep* geodesic_acceleration) const {
  const int global = columns() + (beside ? kMotions + known_lengths() : 0) + 1;
  StreamingQr qr(global);
  Gatherer gatherer(global, qr);
  Linearised result;
  result.residuals.reserve(items_of_all());
  for (int s = 0; s < static_cast<int>(plans_.size()); ++s)
    sweep_set(s, state, weighting, beside, geodesic_acceleration, qr, gatherer, result);
  Eigen::MatrixXd rows(0, global);
  own_equations(state, weighting.structural, result, rows);
  if (geodesic_acceleration) rows.rightCols(1).setZero();  // hardly bent: a plane's step, a length
  qr.push(rows);
  result.R = qr.R();
  return result;
}

/// Blocks are full however small the clusters are: one goes on where the last one ended.
void Equations::sweep_set(int set, const State& state, const Weighting& weighting, bool beside,
                          const GeodesicStep* geodesic_acceleration, StreamingQr& qr,
                          Gatherer& gatherer, Linearised& out) const {
  const SetPlan& plan = plans_[set];
  const int items = static_cast<int>(plan.items.size());
  const int freedom = data_.sets[set].method->group_freedom();
  Block block;
  Eigen::MatrixXd W;
  SharedTouches shared;
  auto cluster = plan.clusters.begin();
  for (int first = 0; first < items; first += kLanes) {
    const int count = std::min(kLanes, items - first);
    evaluate(set, first, count, state, block, true);
    chain_rule(block, set, beside, W);
    if (geodesic_acceleration) bend_right_side(set, first, count, *geodesic_acceleration, W);
    weigh(set, weighting, block, W, out);
    if (data_.sets[set].method->shares_touches()) share(set, first, count, shared, W, out);
    if (cluster->groups.empty()) {
      for (size_t a = 0; a < block.quantities.size(); ++a)
        qr.push(W.middleRows(static_cast<Eigen::Index>(a) * kLanes, count));
      continue;
    }
    for (int lane = 0; lane < count; ++lane) {
      if (first + lane == cluster->first)
        gatherer.begin(static_cast<int>(cluster->groups.size()) * freedom);
      gather(set, *cluster, lane, block, W, gatherer);
      if (first + lane + 1 < cluster->last) continue;
      gather_links(set, *cluster, state, weighting, geodesic_acceleration != nullptr, gatherer,
                   out);
      out.clusters.push_back(gatherer.finish());
      ++cluster;
    }
  }
}

}  // namespace selfcal
