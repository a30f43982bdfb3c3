// Least squares from which rows can be taken away, one after the other.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "constraints/fitting/noise.h"
#include "constraints/fitting/prior.h"

namespace selfcal {

/// What a row's absence does to the least squares.
struct Deletion {
  int row = 0, set = 0;
  std::vector<Eigen::Index> equations;
  Eigen::MatrixXd part;  ///< I - H of its equations
  double drop = 0;       ///< of the sum of squares
};

/// Least squares of all equations and priors, whitened. With Q_p the orthogonal columns of the own
/// unknowns of a surface or a group, and Q those of the robot's beyond all of these,
///   H = Q Q^T + sum Q_p Q_p^T,
/// so that a hundred surfaces cost no more than one of as many touches; without rows D
///   left - (I - H)_D (I - H)_DD^-1 left_D.
class RowDeletion {
 public:
  /// Of the rows in `noise` that are not put aside.
  RowDeletion(const Equations& equations, const State& state, const Noise& noise,
              const Prior& prior);

  /// Of the rows that are not taken away.
  std::vector<Deletion> deletions() const;
  /// What is left of each equation without the row, and what noise of one leaves there then.
  struct Left {
    Eigen::VectorXd left, freedom;
  };
  Left left_without(const Deletion& of) const;
  /// Without the row from now on.
  void take_away(const Deletion& of);

  /// By equation: of the data set, -1 of none or of one taken away.
  const std::vector<int>& row() const { return row_; }
  const std::vector<int>& set() const { return set_; }  ///< -1 of none
  const std::vector<Quantity>& quantity() const { return quantity_; }
  const Eigen::VectorXd& left() const { return left_; }
  /// What noise of one leaves there: the diagonal of I - H.
  const Eigen::VectorXd& freedom() const { return freedom_; }

 private:
  /// Own unknowns that share equations with each other and with the robot's alone.
  struct OwnPart {
    std::vector<int> columns;  ///< of W
    std::vector<Eigen::Index> equations;
  };
  /// The columns of W by what equations connect of them.
  static std::vector<OwnPart> own_parts(const Eigen::MatrixXd& W, const std::vector<int>& columns);
  void take_quantities();
  /// Takes from [robot | y] what the part's own columns explain; what their priors, in rows of A
  /// from `at` on, then ask of the robot's stands there.
  void put_beyond(const Prior& prior, const Eigen::MatrixXd& W, const OwnPart& part,
                  Eigen::Index at, Eigen::MatrixXd& A);
  /// What two equations share by own unknowns.
  double own_product(Eigen::Index a, Eigen::Index b) const;
  /// Of I - H, those rows taken away that are.
  double product(Eigen::Index a, Eigen::Index b) const;
  /// The same, of the row's equations.
  Eigen::MatrixXd columns(const Deletion& of) const;

  const Equations& equations_;
  Eigen::MatrixXd Q_;                             ///< Q^T, a column an equation
  std::vector<Eigen::VectorXd> Q_own_;            ///< the same of its own part
  std::vector<int> part_;                         ///< by equation; -1 without own unknowns
  std::vector<std::vector<Eigen::Index>> parts_;  ///< equations of each
  Eigen::VectorXd left_, freedom_;
  std::vector<Eigen::VectorXd> taken_;  ///< what the rows taken away take from I - H
  std::vector<int> row_, set_;
  std::vector<Quantity> quantity_;
};

}  // namespace selfcal
