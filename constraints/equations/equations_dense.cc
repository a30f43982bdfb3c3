// The equations one by one, the groups' unknowns as columns of their own.
#include "constraints/equations/equations_inner.h"
#include "constraints/equations/shared_touches.h"

namespace selfcal {
namespace {

/// Equations one after the other; the storage is of as many as there can be from the first on,
/// since two of it would be the most that a diagnosis ever needs.
class Collector {
 public:
  Collector(Eigen::Index most, Eigen::Index columns)
      : columns_(columns), row_(columns + 4), out_{{}, Eigen::VectorXd(most), {}, {}, {}} {
    out_.W.resize(most, columns);
    out_.shift.resize(most, 3);
  }
  /// A row of zeros [W | Delta Y | shift], which is taken at the next call.
  Eigen::RowVectorXd& add(int row, Quantity quantity = Quantity::length) {
    take();
    out_.row.push_back(row);
    out_.quantity.push_back(quantity);
    return row_.setZero();
  }
  DenseEquations finish() {
    take();
    const auto n = static_cast<Eigen::Index>(out_.row.size());
    if (n < out_.y.size()) {
      out_.W.conservativeResize(n, columns_);
      out_.y.conservativeResize(n);
      out_.shift.conservativeResize(n, 3);
    }
    return std::move(out_);
  }

 private:
  void take() {
    if (out_.row.empty()) return;
    const auto i = static_cast<Eigen::Index>(out_.row.size()) - 1;
    out_.W.row(i) = row_.head(columns_);
    out_.y[i] = row_[columns_];
    out_.shift.row(i) = row_.tail<3>();
  }

  Eigen::Index columns_;
  Eigen::RowVectorXd row_;
  DenseEquations out_;
};

}  // namespace

DenseEquations Equations::dense(const State& state, const std::vector<Scale>& scale,
                                const std::vector<char>& outlier) const {
  std::vector<Eigen::Index> groups_at;
  Eigen::Index all = columns();
  for (size_t s = 0; s < plans_.size(); ++s) {
    groups_at.push_back(all);
    all += state.groups[s].cols() * data_.sets[s].method->group_freedom();
  }
  Passed unused;
  const Weighting weighting{scale, outlier};
  const Pass pass{state, weighting, {}};
  std::vector<Eigen::MatrixXd> between;
  Eigen::Index most = 0;
  for (int s = 0; s < static_cast<int>(plans_.size()); ++s) {
    between.push_back(own_equations(s, pass, whole_layout(s, false), unused));
    const auto kept = std::ranges::count_if(
        plans_[s].items, [&](const SetPlan::Item& item) { return !outlier[item.row]; });
    most += kept * static_cast<Eigen::Index>(quantities_[s].size()) + between.back().rows();
    for (const SetPlan::Cluster& cluster : plans_[s].clusters)
      most += static_cast<Eigen::Index>(cluster.links.size());
  }
  Collector collector(most, all);
  Block block;
  Eigen::MatrixXd W;
  for (int s = 0; s < static_cast<int>(plans_.size()); ++s) {
    const Method& method = *data_.sets[s].method;
    const int items = static_cast<int>(plans_[s].items.size()), freedom = method.group_freedom();
    SharedTouches shared;
    const Layout layout = whole_layout(s, true);
    for (int first = 0; first < items; first += kLanes) {
      const int count = std::min(kLanes, items - first);
      evaluate(s, first, count, state, block, true);
      chain_rule(block, s, layout, W);
      for (int lane = 0; lane < count; ++lane) {
        if (outlier[block.rows[lane]] || !block.closure.closes(lane)) continue;
        for (int a = 0; a < static_cast<int>(quantities_[s].size()); ++a) {
          Eigen::RowVectorXd& row = collector.add(block.rows[lane], quantities_[s][a]);
          row.head(columns()) = W.row(a * kLanes + lane).head(columns());
          row[all] = W(a * kLanes + lane, W.cols() - 1);
          row.tail<3>() = W.row(a * kLanes + lane).segment<3>(columns());
          if (freedom > 0)
            row.segment(groups_at[s] + freedom * data_.rows.group[block.rows[lane]], freedom) =
                block.out.D_group.row(lane).segment(a * freedom, freedom).matrix();
          row /= scale[s].of(quantities_[s][a]) * data_.rows.factor(block.rows[lane]);
          if (method.shares_touches())
            shared.whiten(block.rows[lane], plans_[s].items[first + lane].previous, row);
        }
      }
    }
    for (const SetPlan::Cluster& cluster : plans_[s].clusters)
      for (const GroupDistance& link : cluster.links) {
        Eigen::RowVectorXd& row = collector.add(-1);
        row[all] = -link_row(s, link, link.noise, state, groups_at[s] + freedom * link.a,
                             groups_at[s] + freedom * link.b, row);
      }
  }
  for (const Eigen::MatrixXd& of_set : between)
    for (const auto& each : of_set.rowwise()) {
      Eigen::RowVectorXd& row = collector.add(-1);
      row.head(columns()) = each.head(columns());
      row[all] = each[columns()];
    }
  return collector.finish();
}

}  // namespace selfcal
