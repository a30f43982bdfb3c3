#include "constraints/slips/misfit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "constraints/estimation/adjustment.h"
#include "constraints/estimation/angles.h"
#include "constraints/estimation/judgement.h"
#include "constraints/fitting/fit.h"
#include "constraints/identifiability/gauge.h"
#include "constraints/statistics.h"

namespace selfcal {
namespace {

constexpr double kWide = 20;  // times the tolerance, of base and tool: a metre, a radian
constexpr int kFitSteps = 60;

}  // namespace

Misfit misfit(const Robot& robot, const DataSet& data, const PlacedBy& moves) {
  Misfit result;
  const Equations equations(robot, data, Use::fit);
  Prior prior;
  prior.centre = nominal_values(robot);
  prior.sigma.resize(prior.centre.size());
  const auto& parameters = robot.parameters();
  for (size_t i = 0; i < parameters.size(); ++i) {
    const bool placed =
        is_placed(parameters[i]) && (moves.tool || parameters[i].part != Part::tool);
    prior.free.push_back(placed && parameters[i].free && parameters[i].tolerance > 0);
    prior.sigma[static_cast<Eigen::Index>(i)] = kWide * parameters[i].tolerance;
  }
  for (const auto& notes : {held_base(robot, equations), held_orientation(robot, equations)})
    for (const Note& note : notes) prior.free[find_parameter(robot, note.parameter)] = 0;
  const int zero = moves.zero_of < 0 ? -1 : robot.variable_parameter(moves.zero_of);
  if (zero >= 0) {
    prior.free[static_cast<size_t>(zero)] = 1;
    prior.sigma[zero] = robot.joints()[static_cast<size_t>(moves.zero_of)].range() / 2;
  }
  State start{values(robot), {}, {}};
  equations.start(start);
  FitRule rule;
  rule.most_iterations = kFitSteps;
  const Fit placed = fit(equations, start, prior, rule);
  result.equations = placed.at.equations;
  result.unknowns =
      static_cast<int>(std::ranges::count(prior.free, char{1})) + equations.nuisance_dimensions();
  const Judged judged = judge(robot, data, equations, placed);
  std::vector<double> lengths, angles;
  for (const RowResidual& row : judged.fit)
    (row.lengths > 0 ? lengths : angles).push_back(row.size());
  result.any = !lengths.empty() || !angles.empty();
  result.lengths = !lengths.empty();
  if (result.any) result.left = median(std::move(result.lengths ? lengths : angles));
  std::vector<std::vector<double>> of_set(data.sets.size()), turned = of_set;
  for (const RowResidual& row : judged.fit) {
    if (row.lengths > 0) of_set[static_cast<size_t>(row.set)].push_back(row.size());
    if (row.angles > 0) turned[static_cast<size_t>(row.set)].push_back(row.angle);
  }
  for (std::vector<double>& each : of_set) result.by_set.push_back(median(std::move(each)));
  for (std::vector<double>& each : turned)
    if (!each.empty()) result.angle = std::max(result.angle, median(std::move(each)));
  if (moves.tool) result.angles = gross_angles(robot, data, judged, judged);
  result.tool_moved = tool_moved(robot, placed.state.xi);
  if (zero >= 0) result.zero_moved = placed.state.xi[zero] - prior.centre[zero];
  return result;
}

double tool_moved(const Robot& robot, const Eigen::VectorXd& values) {
  const auto& parameters = robot.parameters();
  double squares = 0;
  for (size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].part == Part::tool && parameters[i].quantity == Quantity::length)
      squares += std::pow(values[static_cast<Eigen::Index>(i)] - parameters[i].nominal, 2);
  return std::sqrt(squares);
}

}  // namespace selfcal
