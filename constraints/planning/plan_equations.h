// The equations that configurations would give before anything is measured there, unit by unit.
//
// A unit is what a plan takes or leaves whole: one configuration or, where a method compares a row
// with the one before, two.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/methods/data_set.h"
#include "kinematics/robot.h"

namespace selfcal {

/// Rows of the data set that a unit has.
using Unit = std::vector<int>;

class PlanEquations {
 public:
  /// `state` says where everything lies; its groups are all that there will be.
  PlanEquations(const Robot& robot, const std::vector<Set>& sets, State state);

  const State& state() const { return state_; }
  /// Columns: the robot's parameters, the own freedoms of each set, those of each set's groups.
  Eigen::Index columns() const { return columns_; }
  /// By set: the noise its data sheet says, else 20 um, 20 urad.
  std::vector<Scale> scale(const std::vector<Set>& sets) const;
  /// Whitened rows of each unit of `data`; none of a unit that the robot cannot take.
  std::vector<Eigen::MatrixXd> of_units(const DataSet& data, const std::vector<Unit>& units) const;
  /// Whitened rows that no configuration carries (a known distance between groups).
  Eigen::MatrixXd of_none(const DataSet& data) const;
  /// 1 sigma of each column before anything is measured: the makers' tolerances of the robot's
  /// parameters (of those that are fixed how far they are believed), the robot's size or a radian
  /// of the others.
  Eigen::VectorXd tolerance() const;

 private:
  struct Found {
    Eigen::MatrixXd W;  ///< equations x columns()
    std::vector<int> row;
  };
  Found dense(const DataSet& data) const;

  const Robot& robot_;
  State state_;
  std::vector<Eigen::Index> own_at_, group_at_;  ///< first column by set
  std::vector<double> place_unit_;               ///< by column behind the robot's: m, rad, 1
  Eigen::Index columns_ = 0;
};

}  // namespace selfcal
