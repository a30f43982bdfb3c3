// Noise of which some equations share a part: a covariance of small blocks, S = L L'.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <vector>

namespace selfcal {

class NoiseBlocks {
 public:
  /// Every equation stands in one of `blocks`; `covariance` is asked for two of one block.
  NoiseBlocks(std::vector<std::vector<int>> blocks,
              const std::function<double(int, int)>& covariance);

  Eigen::Index equations() const { return equations_; }
  double log_volume() const { return log_volume_; }  ///< log |L|
  /// X (equations x any) becomes L^-1 X.
  void whiten(Eigen::MatrixXd& X) const;
  /// L^-T X.
  void whiten_transposed(Eigen::MatrixXd& X) const;
  /// L X.
  void colour(Eigen::MatrixXd& X) const;

 private:
  struct Part {
    std::vector<int> equations;
    Eigen::MatrixXd root;     ///< lower Cholesky factor
    Eigen::VectorXd inverse;  ///< of its diagonal
  };
  Eigen::Index equations_ = 0;
  /// Root of an equation that shares with none, and its inverse; 1 of the others.
  Eigen::VectorXd alone_, inverse_alone_;
  std::vector<Part> parts_;
  double log_volume_ = 0;
};

}  // namespace selfcal
