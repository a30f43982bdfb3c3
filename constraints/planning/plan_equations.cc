#include "constraints/planning/plan_equations.h"

#include <cmath>
#include <map>

#include "constraints/identifiability/given_doubt.h"
#include "constraints/planning/touch_rows.h"
#include "kinematics/size.h"

namespace selfcal {
PlanEquations::PlanEquations(const Robot& robot, const std::vector<Set>& sets, State state)
    : robot_(robot),
      state_(std::move(state)),
      columns_(static_cast<Eigen::Index>(robot.parameters().size())) {
  const double size = size_of(robot);
  for (const Set& set : sets) {
    own_at_.push_back(columns_);
    columns_ += set.method->tangent_dimension();
    for (int i = 0; i < set.method->tangent_dimension(); ++i)
      place_unit_.push_back(set.method->tangent_quantity(i) == Quantity::length ? size : 1);
  }
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const Method& method = *sets[s].method;
    group_at_.push_back(columns_);
    columns_ += state_.groups[s].cols() * method.group_freedom();
    const int lengths = static_cast<int>(method.group_names().size());
    for (Eigen::Index g = 0; g < state_.groups[s].cols(); ++g)
      for (int i = 0; i < method.group_freedom(); ++i)
        place_unit_.push_back(i < lengths ? size : 1);
  }
}

std::vector<Scale> PlanEquations::scale(const std::vector<Set>& sets) const {
  std::vector<Scale> list;
  for (const Set& set : sets) list.push_back({touch_noise(set), angle_noise(set)});
  return list;
}

Eigen::VectorXd PlanEquations::tolerance() const {
  Eigen::VectorXd list(columns_);
  list.tail(static_cast<Eigen::Index>(place_unit_.size())) =
      std::sqrt(kPlaceVariance) *
      Eigen::Map<const Eigen::VectorXd>(place_unit_.data(),
                                        static_cast<Eigen::Index>(place_unit_.size()));
  Eigen::Index i = 0;
  for (const Parameter& each : robot_.parameters())
    list[i++] = each.free ? each.tolerance : doubt_of_fixed(each);
  return list;
}

PlanEquations::Found PlanEquations::dense(const DataSet& data) const {
  const Equations equations(robot_, data, Use::fit);
  const DenseEquations found =
      equations.dense(state_, scale(data.sets), std::vector<char>(data.rows.set.size(), 0));
  Found placed{Eigen::MatrixXd::Zero(found.W.rows(), columns_), found.row};
  const Eigen::Index robot_columns = equations.robot_columns();
  placed.W.leftCols(robot_columns) = found.W.leftCols(robot_columns);
  Eigen::Index from = equations.columns();
  for (std::size_t s = 0; s < data.sets.size(); ++s) {
    const int set = static_cast<int>(s), own = equations.tangent_dimension(set);
    placed.W.middleCols(own_at_[s], own) = found.W.middleCols(equations.own_at(set), own);
    const Eigen::Index groups = state_.groups[s].cols() * data.sets[s].method->group_freedom();
    placed.W.middleCols(group_at_[s], groups) = found.W.middleCols(from, groups);
    from += groups;
  }
  return placed;
}

std::vector<Eigen::MatrixXd> PlanEquations::of_units(const DataSet& data,
                                                     const std::vector<Unit>& units) const {
  const Found found = dense(data);
  std::map<int, std::vector<Eigen::Index>> by_row;
  for (std::size_t i = 0; i < found.row.size(); ++i)
    by_row[found.row[i]].push_back(static_cast<Eigen::Index>(i));
  std::vector<Eigen::MatrixXd> list;
  for (const Unit& unit : units) {
    std::vector<Eigen::Index> rows;
    for (const int row : unit)
      if (const auto at = by_row.find(row); at != by_row.end())
        rows.insert(rows.end(), at->second.begin(), at->second.end());
    list.push_back(found.W(rows, Eigen::all));
  }
  return list;
}

Eigen::MatrixXd PlanEquations::of_none(const DataSet& data) const {
  const Found found = dense(data);
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < found.row.size(); ++i)
    if (found.row[i] < 0) rows.push_back(static_cast<Eigen::Index>(i));
  return found.W(rows, Eigen::all);
}

}  // namespace selfcal
