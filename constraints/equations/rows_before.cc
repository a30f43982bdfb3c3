// Of two rows that an equation has, one is at an odd place of its group: the equations are formed
// again with all such readings a little off, joint by joint, and what is left of W is the other
// row's.
#include "constraints/equations/rows_before.h"

namespace selfcal {
namespace {

constexpr double kOff = 1e-5;  ///< rad or m

}  // namespace

RowsBefore rows_before(const Equations& equations, const State& state,
                       const std::vector<Scale>& scale, const std::vector<char>& outlier,
                       const DenseEquations& dense) {
  const DataSet& data = equations.data();
  RowsBefore before;
  std::vector<int> of(static_cast<std::size_t>(data.rows.rows()), -1);
  std::vector<char> odd(of.size(), 0);
  bool any = false;
  for (int s = 0; s < static_cast<int>(data.sets.size()); ++s)
    for (const SetPlan::Item& item : equations.plan(s).items) {
      if (item.previous < 0) continue;
      of[static_cast<std::size_t>(item.row)] = item.previous;
      odd[static_cast<std::size_t>(item.row)] = !odd[static_cast<std::size_t>(item.previous)];
      any = true;
    }
  if (!any) return before;
  before.of = std::move(of);
  const Robot& robot = equations.robot();
  const auto joints = static_cast<int>(robot.joints().size());
  before.by_joint.setZero(dense.y.size(), joints);
  for (int j = 0; j < joints; ++j) {
    const int zero = robot.variable_parameter(j);
    if (zero < 0) continue;
    DataSet moved = data;
    for (int row = 0; row < data.rows.rows(); ++row)
      if (odd[static_cast<std::size_t>(row)]) moved.rows.q(row, j) += kOff;
    const Eigen::VectorXd y = Equations(robot, moved, Use::fit).dense(state, scale, outlier).y;
    if (y.size() != dense.y.size()) continue;  // a loop at its edge is open, or no longer
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      const int row = dense.row[static_cast<std::size_t>(i)];
      if (row < 0 || before.of[static_cast<std::size_t>(row)] < 0) continue;
      const double by_odd = (dense.y[i] - y[i]) / kOff;
      before.by_joint(i, j) =
          odd[static_cast<std::size_t>(row)] ? dense.W(i, zero) - by_odd : by_odd;
    }
  }
  return before;
}

}  // namespace selfcal
