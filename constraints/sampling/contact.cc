#include "constraints/sampling/contact.h"

#include "constraints/sampling/newton.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kContactSteps = 30;
constexpr double kMet = 1e-12;  // size of what is left of the wanted residual
constexpr double kFarthest =
    0.3;  // units of readings: farther away it is another place, not a little off

}  // namespace

bool move_to_residual(const Robot& robot, const DataSet& data, const State& truth, int row,
                      const Eigen::VectorXd& wanted, Eigen::VectorXd& q,
                      const std::vector<int>& held) {
  ConfigurationBlock block = block_of(q);
  Locations before;
  if (!robot.locate(block, truth.xi, data.sets[data.rows.set[row]].method->body(), before, nullptr)
           .closes())
    return false;
  NewtonStep newton(robot, data, truth, row, before, held);
  const Eigen::ArrayXd units = units_of_readings(robot);
  for (int step = 0; step < kContactSteps; ++step) {
    newton.evaluate(block);
    if (!newton.closes(0)) return false;
    const Eigen::VectorXd miss = newton.miss(0, wanted);
    const Eigen::VectorXd there = block.q.row(0).matrix().transpose();
    if (!(((there - q).array() / units).matrix().norm() < kFarthest)) return false;
    if (newton.size_of_miss(0, miss) < kMet) {
      q = there;
      return true;
    }
    block.q.rowwise() += newton.step(0, miss).transpose().array();
  }
  return false;
}

}  // namespace selfcal
