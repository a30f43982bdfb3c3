// The linearised system of one fit at a state, with the priors: steps from there, and what they
// would make of it.
#pragma once

#include <utility>
#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/fitting/prior.h"

namespace selfcal {

class FitSystem {
 public:
  FitSystem(const Equations& equations, const Prior& prior, State start, Weighting weighting);

  const State& state() const { return state_; }
  /// Of W that are free; all other entries of a step are zero.
  const std::vector<int>& columns() const { return columns_; }
  /// What the pass over the rows at the state left.
  const Passed& passed() const;
  /// -2 log posterior up to a constant.
  double cost() const { return cost_; }
  /// The same state with other weights.
  void weigh(Weighting weighting);

  /// Triangular [W | Delta Y] of the rows and the priors, `columns()` alone.
  Eigen::MatrixXd triangle();
  /// Least-squares step of a triangle, damped by lambda; spread to all columns.
  Eigen::VectorXd step(const Eigen::MatrixXd& triangle, double lambda) const;
  /// `v` with half its geodesic acceleration (Transtrum and Sethna), which bends the step along a
  /// curved valley of the residual; `v` alone where that is no small correction and so says little.
  Eigen::VectorXd with_geodesic_acceleration(const Eigen::VectorXd& v, double lambda) const;
  /// Length of a step in the posterior sigmas of a triangle.
  double whitened(const Eigen::MatrixXd& triangle, const Eigen::VectorXd& step) const;
  /// Length of a step in the robot's size, or rad.
  double in_units(const Eigen::VectorXd& step) const { return step.cwiseQuotient(units_).norm(); }

  /// What the last step that was not taken would have made of the rows.
  struct Tried {
    double cost = 0;
    std::vector<RowNorm> norms;  ///< as Passed's
  };
  /// Goes on by `step` if the cost is none the higher there, or becomes so once the groups of rows
  /// have settled for the other values: where these turn far, shared points go round a bend that
  /// no step of all values takes.
  bool go(const Eigen::VectorXd& step);
  const Tried& tried() const { return tried_; }

  /// (R^T R)^-1 (11.35, whitened), spread to all columns.
  Eigen::MatrixXd covariance();
  /// By a QR of the rows from now on, where products would do: all digits are told then.
  void use_factor();
  /// The factor after use_factor(); the system is of no use any more.
  Linearised take_factor() { return std::move(factor_); }

 private:
  /// A state with what a pass over the rows at it left.
  struct Trial {
    State state;
    Linearised factor = {};
    NormalEquations products = {};
    double cost = 0;
  };
  Trial at(State state) const;
  /// The same after a step of the groups' values alone.
  Trial with_groups_settled(const Trial& trial) const;
  void linearise();
  State stepped(const Eigen::VectorXd& step) const;
  double prior_cost(const State& state) const;
  /// What the priors add to W^T Delta Y.
  Eigen::VectorXd pull() const;
  /// [L^T | L^-1 b] of the normal equations L L^T with the priors, damped by lambda; empty where
  /// they are not regular.
  Eigen::MatrixXd root(const Eigen::MatrixXd& H, const Eigen::VectorXd& b, double lambda) const;
  /// Scale of the damping: steps are held short against the priors, not against what the rows say,
  /// so that a long move along a curved valley of the residual stays possible.
  Eigen::VectorXd damping() const;
  /// Length of a step in units of the damping.
  double damped_length(const Eigen::VectorXd& step) const;

  const Equations& equations_;
  const Prior& prior_;
  const std::vector<int> columns_;
  const Eigen::VectorXd units_;  ///< what a change of each column is measured by
  const bool has_groups_;
  State state_;
  Weighting weighting_;
  bool by_factor_ = false;  ///< the normal equations would leave a direction to rounding
  Linearised factor_;
  NormalEquations products_;
  double cost_ = 0;
  Tried tried_;
};

}  // namespace selfcal
