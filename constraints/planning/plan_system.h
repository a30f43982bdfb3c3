// What a plan is judged by: the columns of interest, what is known beforehand, where the end
// position counts; and the figures that some configurations reach.
#pragma once

#include <vector>

#include "constraints/planning/criterion.h"
#include "constraints/planning/plan_equations.h"
#include "constraints/planning/plan_pool.h"
#include "constraints/solution.h"

namespace selfcal {

/// What some configurations tell, those taken already included.
struct PlanFigures {
  double sigma = 0;             ///< m, rms of the end position's 1 sigma over the workspace
  Observability observability;  ///< zeros where they do not determine all of the parameters
};

class PlanSystem {
 public:
  /// Of a plan for `count` units of the pool, which must have rows. Units that give no equation are
  /// dropped, and those beyond most(). All must outlive this.
  PlanSystem(const Robot& robot, const PoolRequest& request, const Workspace& workspace, int count,
             Pool& pool);

  const PlanEquations& equations() const { return equations_; }
  /// How many parameters so many units of the pool's kind would identify: those of the indices.
  int parameters() const { return parameters_; }
  /// A motion of the world or the target's point is taken out of the end position.
  bool aligned() const { return aligned_; }
  /// By set, the norm of a unit's rows beyond which their linearisation is not to be believed: near
  /// a singular place of the method (an inclinometer on its side) it grows without bound.
  const std::vector<double>& most() const { return most_; }
  /// Why nothing can be planned; empty where it can.
  std::string lacking() const;

  /// Those of the equations' columns that the criterion looks at: the parameters that are not
  /// exact, with their priors, for sigma, the identified ones without for indices; then all other
  /// unknowns.
  const std::vector<int>& columns(Criterion criterion) const;
  Objective objective(Criterion criterion) const;
  /// Whitened rows of each unit, of columns(criterion).
  std::vector<Eigen::MatrixXd> rows(const DataSet& data, const std::vector<Unit>& units,
                                    Criterion criterion) const;
  PlanFigures figures(const DataSet& data, const std::vector<Unit>& units) const;
  /// The part of sigma (m) that stays however many more of such units there are: of the directions
  /// that the pool and those chosen of it, which have moved since, together tell less of than is
  /// known beforehand.
  double sigma_beyond(const Pool& pool, const DataSet& chosen_data,
                      const std::vector<Unit>& chosen) const;

 private:
  Eigen::MatrixXd all_rows(const DataSet& data, const std::vector<Unit>& units) const;
  Eigen::MatrixXd priced_information(const Eigen::MatrixXd& W) const;
  Eigen::MatrixXd priced_weight() const;
  void take_prior();
  Eigen::Index robot_columns() const;
  void drop_units(Pool& pool);
  Eigen::MatrixXd given(const DataSet& data) const;
  void take_columns(const Pool& pool, const Workspace& workspace, int count);
  void take_weight(const Workspace& workspace, const Eigen::MatrixXd& unseen, bool point_unknown);
  double quietest() const;

  const Robot& robot_;
  const PoolRequest& request_;
  PlanEquations equations_;
  Eigen::MatrixXd given_;   ///< whitened rows of what is known beside the units
  Eigen::MatrixXd weight_;  ///< of all columns; without rows: no pose was found
  Eigen::VectorXd tolerance_;
  Eigen::MatrixXd prior_;  ///< information of the open columns beforehand, each over its tolerance
  std::vector<double> most_;
  std::vector<int> open_, identified_;
  int parameters_ = 0;
  bool aligned_ = false;
};

}  // namespace selfcal
