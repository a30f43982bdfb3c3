// Newton's step on the residual of a row of one set, at up to kLanes configurations at once:
//   dq = (G J)^+ (wanted - r),   J the joint Jacobian of the method's body,
// the least change of the readings that makes the residual what is wanted as far as it is linear.
#pragma once

#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/methods/data_set.h"

namespace selfcal {

/// A method that measures under a constraint (a link of known length) is brought to its lengths;
/// its angles are what the instrument then reads.
class NewtonStep {
 public:
  /// Of `rows` of `data`, all of one set, a lane each and the last in the lanes after them, with
  /// parameters, own and group values `truth`; the residual of a paired method is counted against
  /// `before`. All must outlive this.
  NewtonStep(const Robot& robot, const DataSet& data, const State& truth, std::vector<int> rows,
             const Locations& before, const std::vector<int>& held = {});

  /// Takes residuals and derivatives at `block`.
  void evaluate(const ConfigurationBlock& block);

  const Locations& X() const { return X_; }  ///< of the method's body
  bool closes(int lane) const { return closure_.closes(lane); }
  /// wanted - r (lanes x equations; m, rad); `wanted` has a row for each lane.
  Eigen::ArrayXXd misses(const Eigen::ArrayXXd& wanted) const;
  /// How large each lane's miss is: lengths as parts of the robot's size, or of how far from the
  /// world's origin the body is where that is more; rad.
  Lanes sizes_of(const Eigen::ArrayXXd& misses) const;
  /// dq (lanes x joints; rad or m) of the lanes that close.
  Eigen::ArrayXXd steps(const Eigen::ArrayXXd& misses) const;

  /// Moves the lanes of `block` to where the residual is `wanted`, down to rounding, until `enough`
  /// of them are there; returns those, ascending, with X() where they then are.
  std::vector<int> reach(const Eigen::VectorXd& wanted, int enough, ConfigurationBlock& block);

 private:
  const Robot& robot_;
  const DataSet& data_;
  const State& truth_;
  const Locations& before_;
  std::vector<int> held_;  ///< joints that do not move
  int set_;
  std::vector<Quantity> quantities_;  ///< of the equations
  double size_;                       ///< of the robot (m)
  std::vector<int> rows_;
  Locations X_;
  bool evaluated_ = false;
  Closure closure_;
  PsiBlock psi_;
  Eigen::MatrixXd J_;
  Eigen::ArrayXXd GJ_;        ///< by lane, the joints of the first equation, then of the next
  Eigen::ArrayXXd products_;  ///< by lane, of GJ's rows with each other
  MethodOutput out_;
};

}  // namespace selfcal
