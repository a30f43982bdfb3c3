#include "constraints/measurement_context.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinematics/corrected_robot.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr int kMostStarted = 300;  // rows that say where a device stands

std::vector<Eigen::Vector3d> tips(const Robot& robot, const DataSet& data, int set) {
  std::vector<Eigen::Vector3d> points;
  for (int row = 0; row < data.rows.rows(); ++row)
    if (data.rows.set[row] == set)
      points.push_back(seen_poses(robot, data.rows.q.row(row).transpose()).back().translation());
  return points;
}

/// Some rows of a set, spread over them: enough to say where something stands.
std::vector<int> some_rows(const DataSet& data, int set) {
  const auto step = 1 + std::ranges::count(data.rows.set, set) / kMostStarted;
  std::vector<int> rows;
  for (int row = 0, i = 0; row < data.rows.rows(); ++row)
    if (data.rows.set[row] == set && i++ % step == 0) rows.push_back(row);
  return rows;
}

/// Direction in which the points spread least, out of the surface that they lie on: where most of
/// the links are that the kind gives, or the world's origin is.
Eigen::Vector3d thin_direction(const Robot& robot, const DataSet& data, int set,
                               const std::vector<Eigen::Vector3d>& points,
                               const Eigen::Vector3d& centre) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) spread += (p - centre) * (p - centre).transpose();
  const Symmetric eigen = symmetric_eigen(spread);
  const Eigen::Vector3d n = eigen.vectors.col(0);
  int outside = 0;
  for (const int row : some_rows(data, set)) {
    const std::vector<Eigen::Isometry3d> poses =
        seen_poses(robot, data.rows.q.row(row).transpose());
    for (size_t i = 0; i + 1 < poses.size(); ++i) {
      const double away = n.dot(poses[i].translation() - poses.back().translation());
      outside += (away > 0) - (away < 0);
    }
  }
  const double side = outside != 0 ? outside : -n.dot(centre);
  return side < 0 ? Eigen::Vector3d(-n) : n;
}

/// Its rows hold lengths that an instrument measured.
bool measures_lengths(const Method& method) {
  const std::vector<std::string> columns = method.columns();
  const std::vector<MeasuredColumn> own = method.measures();
  return std::ranges::count(columns, "x") > 0 ||
         std::ranges::any_of(
             own, [](const MeasuredColumn& each) { return each.quantity == Quantity::length; });
}

/// Own values of a set that fit its rows best with the robot as it is; none where it has no place
/// at any of them.
Eigen::VectorXd own_values(const Robot& robot, const DataSet& data, int set) {
  const Method& method = *data.sets[set].method;
  const Eigen::VectorXd xi = values(robot);
  std::vector<int> rows;
  std::vector<Location> X;
  Locations link, tip;
  for (const int row : some_rows(data, set)) {
    const ConfigurationBlock block = block_of(data.rows.q.row(row).transpose());
    if (!robot.locate(block, xi, Body::endpoint, tip, nullptr).closes()) continue;
    robot.locate(block, xi, Body::last_link, link, nullptr);
    rows.push_back(row);
    X.push_back(method.body() == Body::last_link ? link.at(0) : tip.at(0));
  }
  if (rows.empty()) return {};
  const Location tool = {link.R(0).transpose() * tip.R(0),
                         link.R(0).transpose() * (tip.p(0) - link.p(0))};
  return method.start(X, rows, data.rows, nullptr, tool);
}

MeasuredSet measured_set(const Robot& robot, const DataSet& data, int set) {
  const Method& method = *data.sets[set].method;
  MeasuredSet context;
  context.name = data.sets[set].name;
  context.touch = method.touches();
  context.lengths = measures_lengths(method);
  const std::vector<Eigen::Vector3d> points = tips(robot, data, set);
  context.without_rows = points.empty();
  if (context.without_rows) return context;
  for (const Eigen::Vector3d& p : points) context.centre += p / static_cast<double>(points.size());
  // What is off there matters times an error of scale, which is of second order.
  if (context.lengths)
    if (const Eigen::VectorXd own = own_values(robot, data, set); own.size() > 0)
      context.device = method.device(own);
  if (context.touch != TouchedSurface::plane) return context;
  for (int row = 0; row < data.rows.rows() && data.rows.normal.rows() > 0; ++row)
    if (data.rows.set[row] == set && data.rows.normal.row(row).allFinite())
      context.normal += data.rows.normal.row(row).transpose();
  context.normal = context.normal.norm() > 1e-6
                       ? Eigen::Vector3d(context.normal.normalized())
                       : thin_direction(robot, data, set, points, context.centre);
  return context;
}

/// The thermometer's record, ascending in time.
void take_record(const Observations& rows, MeasurementContext& context) {
  if (rows.time.size() == 0) return;
  std::vector<int> order;
  for (int row = 0; row < rows.rows(); ++row)
    if (std::isfinite(rows.time[row])) order.push_back(row);
  if (order.empty()) return;
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return rows.time[a] < rows.time[b]; });
  context.begin = rows.time[order.front()];
  context.end = rows.time[order.back()];
  for (const int row : order)
    if (rows.temperature.size() > 0 && std::isfinite(rows.temperature[row])) {
      context.times.push_back(rows.time[row]);
      context.temperatures.push_back(rows.temperature[row]);
    }
  if (context.temperatures.empty()) return;
  context.reference =
      std::accumulate(context.temperatures.begin(), context.temperatures.end(), 0.0) /
      static_cast<double>(context.temperatures.size());
}

}  // namespace

MeasurementContext context_of(const Robot& robot, const DataSet& data) {
  MeasurementContext context;
  for (int s = 0; s < static_cast<int>(data.sets.size()); ++s)
    context.sets.push_back(measured_set(robot, data, s));
  take_record(data.rows, context);
  context.loads = data.rows.wrench.size() > 0 && !data.rows.wrench.array().isNaN().all();
  context.velocities = data.rows.velocity.size() > 0 && !data.rows.velocity.array().isNaN().all();
  context.speeds = context.velocities && data.speeds;
  return context;
}

std::shared_ptr<const Robot> in_context(std::shared_ptr<const Robot> robot, const DataSet& data,
                                        Problems& problems) {
  const std::vector<const Effect*> effects = effects_of(*robot);
  if (effects.empty()) return robot;
  MeasurementContext context = context_of(*robot, data);
  std::vector<Node> entries;
  for (const Effect* effect : effects) {
    entries.push_back(effect->entry());
    if (!effect->of_machine() && context.find(effect->at()) < 0)
      context.sets.push_back({.name = effect->at(), .without_rows = true});
  }
  return correct(robot, entries, context, problems);
}

}  // namespace selfcal
