// How far rows hold two causes apart: what one of them leaves when the geometry and the other one
// explain it, in squared sigmas, and what each further row adds to that.
//
// The least squares behind it are kept as a triangle R, z of [X | t] = Q [R | z]: X the columns of
// geometry, surfaces and the other cause, t what the first one does at its size. A row (x, t) adds
//   (t - x' R^-1 z)^2 / (1 + |R^-T x|^2)
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
  Separation(const LinearisedModel& view, const std::vector<Node>& cause,
             const std::vector<Node>& other, const DataSet& data, int first);

  /// Squared sigmas of the cause beyond geometry and the other one, of the rows that count.
  double apart() const { return left_; }
  /// What a further row would add to it.
  double gain(int row) const;
  void take(int row);
  void take_all();

 private:
  struct Equation {
    Eigen::VectorXd x;
    double t = 0;
  };
  void add(const Eigen::MatrixXd& X, const Eigen::VectorXd& t);

  Eigen::MatrixXd R_;
  Eigen::VectorXd z_;
  double left_ = 0;
  int first_ = 0;
  std::vector<std::vector<Equation>> further_;  ///< by row from `first` on
};

}  // namespace selfcal
