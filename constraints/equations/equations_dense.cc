// The equations one by one, the groups' unknowns as columns of their own.
#include "constraints/equations/equations_inner.h"
#include "constraints/equations/shared_touches.h"

namespace selfcal {
namespace {

/// Appends equations to growing storage.
class Collector {
 public:
  explicit Collector(Eigen::Index columns) : columns_(columns) {}
  /// A row of zeros [W | Delta Y | shift].
  Eigen::RowVectorXd& add(int row) {
    out_.row.push_back(row);
    return rows_.emplace_back(Eigen::RowVectorXd::Zero(columns_ + 4));
  }
  DenseEquations finish() {
    const auto n = static_cast<Eigen::Index>(rows_.size());
    out_.W.resize(n, columns_);
    out_.y.resize(n);
    out_.shift.resize(n, 3);
    for (Eigen::Index i = 0; i < n; ++i) {
      out_.W.row(i) = rows_[static_cast<size_t>(i)].head(columns_);
      out_.y[i] = rows_[static_cast<size_t>(i)][columns_];
      out_.shift.row(i) = rows_[static_cast<size_t>(i)].tail<3>();
    }
    return std::move(out_);
  }

 private:
  Eigen::Index columns_;
  std::vector<Eigen::RowVectorXd> rows_;
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
  Collector collector(all);
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
          Eigen::RowVectorXd& row = collector.add(block.rows[lane]);
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
  Passed unused;
  const Weighting weighting{scale, outlier};
  const Pass pass{state, weighting, {}};
  for (int s = 0; s < static_cast<int>(plans_.size()); ++s) {
    const Eigen::MatrixXd between = own_equations(s, pass, whole_layout(s, false), unused);
    for (const auto& each : between.rowwise()) {
      Eigen::RowVectorXd& row = collector.add(-1);
      row.head(columns()) = each.head(columns());
      row[all] = each[columns()];
    }
  }
  return collector.finish();
}

}  // namespace selfcal
