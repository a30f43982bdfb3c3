#include "constraints/sampling/contact.h"

#include <algorithm>
#include <iterator>

#include "constraints/sampling/newton.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kContactSteps = 30;
constexpr double kMet = 1e-12;  // size of what is left of the wanted residual
constexpr double kFarthest =
    0.3;  // units of readings: farther away it is another place, not a little off

using Moved = std::vector<std::optional<Eigen::VectorXd>>;

/// Up to kLanes rows.
Moved moved(const Robot& robot, const DataSet& data, const State& truth,
            const std::vector<int>& rows, const Eigen::ArrayXXd& wanted, const Eigen::ArrayXXd& q,
            const std::vector<int>& held) {
  const auto count = static_cast<int>(rows.size());
  const Eigen::ArrayXd units = units_of_readings(robot);
  ConfigurationBlock block{q, count};
  Locations before;
  Closure closure = robot.locate(
      block, truth.xi, data.sets[data.rows.set[rows.front()]].method->body(), before, nullptr);
  NewtonStep newton(robot, data, truth, rows, before, held);
  Moved moved(rows.size());
  std::vector<char> going(rows.size(), 1);
  for (int step = 0; step < kContactSteps; ++step) {
    newton.evaluate(block);
    const Eigen::ArrayXXd misses = newton.misses(wanted);
    const Lanes sizes = newton.sizes_of(misses);
    const Eigen::ArrayXXd steps = newton.steps(misses);
    bool any = false;
    for (int lane = 0; lane < count; ++lane) {
      const auto l = static_cast<std::size_t>(lane);
      if (!going[l]) continue;
      const Eigen::ArrayXd off = (block.q.row(lane) - q.row(lane)).transpose() / units;
      if (!closure.closes(lane) || !newton.closes(lane) || !(off.matrix().norm() < kFarthest)) {
        going[l] = 0;
        block.q.row(lane) = q.row(lane);
      } else if (sizes[lane] < kMet) {
        going[l] = 0;
        moved[l] = block.q.row(lane).matrix().transpose();
      } else {
        any = true;
        block.q.row(lane) += steps.row(lane);
      }
    }
    if (!any) break;
  }
  return moved;
}

}  // namespace

bool move_to_residual(const Robot& robot, const DataSet& data, const State& truth, int row,
                      const Eigen::VectorXd& wanted, Eigen::VectorXd& q,
                      const std::vector<int>& held) {
  const auto there =
      moved_to_residuals(robot, data, truth, {row}, wanted.transpose(), q.transpose(), held)
          .front();
  if (there) q = *there;
  return there.has_value();
}

std::vector<std::optional<Eigen::VectorXd>> moved_to_residuals(
    const Robot& robot, const DataSet& data, const State& truth, const std::vector<int>& rows,
    const Eigen::MatrixXd& wanted, const Eigen::MatrixXd& q, const std::vector<int>& held) {
  Moved all;
  for (std::size_t first = 0; first < rows.size(); first += kLanes) {
    const std::size_t count = std::min<std::size_t>(kLanes, rows.size() - first);
    const auto at = static_cast<Eigen::Index>(first), lanes = static_cast<Eigen::Index>(count);
    const std::vector<int> some(rows.begin() + at, rows.begin() + at + lanes);
    Moved part = moved(robot, data, truth, some, wanted.middleRows(at, lanes).array(),
                       q.middleRows(at, lanes).array(), held);
    std::ranges::move(part, std::back_inserter(all));
  }
  return all;
}

}  // namespace selfcal
