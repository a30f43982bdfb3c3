// How far rows hold two causes apart: what one of them leaves when the geometry and the other one
// explain it, in squared sigmas, and what each further row adds to that.
//
// The least squares behind it are kept as a triangle R, z of [X | t] = Q [R | z]: X the columns of
// geometry, surfaces and the other cause, t what the first one does at its size. The equations
// (X, t) of a further row add, with S = R^-T X',
//   (t - S' z)' (I + S' S)^-1 (t - S' z)
// to the squares that are left.
#pragma once

#include <vector>

#include "constraints/methods/data_set.h"
#include "diagnosis/evidence/linearised_model.h"

namespace selfcal {

class Separation {
 public:
  /// Of a cause from another one, each as entries of a robot file with its values; without another
  /// one from noise. Rows from `first` on are further ones, which count once they are taken.
  Separation(const LinearisedModel& linearised, const std::vector<Node>& cause,
             const std::vector<Node>& other, const DataSet& data, int first);

  /// Squared sigmas of the cause beyond geometry and the other one, of the rows that count.
  double apart() const { return left_; }
  /// What a further row would add to it.
  double gain(int row) const;
  void take(int row);
  void take_all();

 private:
  struct RowEquations {
    Eigen::MatrixXd X;  ///< equations x columns
    Eigen::VectorXd t;
  };
  void add(const Eigen::MatrixXd& X, const Eigen::VectorXd& t);

  Eigen::MatrixXd R_;
  Eigen::VectorXd z_;
  double left_ = 0;
  int first_ = 0;
  std::vector<RowEquations> further_;  ///< by row from `first` on
};

}  // namespace selfcal
