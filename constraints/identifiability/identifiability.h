// Which columns of W the rows can tell apart (Khalil and Dombre, 11.4.2.1).
//
// Columns are taken in the order of preference; one that depends on those taken before is grouped
// with them. So the first independent ones win, and the same marks come out every time.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/solution.h"

namespace selfcal {

/// When a column counts as dependent: what is left of it after projecting the ones taken before
/// out.
struct RankRule {
  /// Structural question, tau = r epsilon max |R_ii| (11.28), r the count of rows; 0 for real data.
  double rows = 0;
  /// Real data (whitened W): a parameter that the rows determine no better than this, rad or the
  /// same of the robot's size (see size_of).
  double least_sigma = 2.0e-3;
  /// The same for gear ratios, which act on the whole joint angle.
  double least_ratio_sigma = 1.0e-4;
  std::vector<double> least;  ///< by column of R, in place of least_sigma; empty: that for all
};

struct ColumnRank {
  Status status = Status::identified;
  /// Grouped: position in `order` of each carrier and its coefficient (column = sum coefficient
  /// carrier), of at least one.
  std::vector<std::pair<int, double>> carriers;
};

/// Ranks the columns order[leading...] of R given that the columns order[0...leading) (own
/// unknowns) are unknown as well. One entry for each of order[leading...].
std::vector<ColumnRank> rank_columns(const Eigen::MatrixXd& R, const std::vector<int>& order,
                                     int leading, const RankRule& rule);

/// Status and carriers of every parameter of the robot from R of `equations` at `state`;
/// `rule.least` is filled in from the robot. Nuisance parameters carry by their values' names
/// (S.nx), each with how far it moves. Parameters that `free_mask` leaves out are fixed (or held)
/// and have no say.
struct Identifiability {
  std::vector<Status> status;
  std::vector<std::vector<Carrier>> grouped_with;
  int total() const;
};
Identifiability identifiability(const Equations& equations, const Eigen::MatrixXd& R,
                                const State& state, const std::vector<char>& free_mask,
                                const RankRule& rule);

}  // namespace selfcal
