// DETMAX: of many possible measurements, the few that see the parameters best together.
//
// Exchange algorithm of Mitchell (Technometrics 16, 1974) as Kamali et al. use it: from a random
// choice, the best of those left is added and then the worst of all removed, until the one removed
// is the one just added. Best is what the observability index asks for,
//   O1 = (s_1 ... s_m)^(1/m) / sqrt(n),   s_i the singular values of the n chosen rows of W,
// which det(WᵀW) = (s_1 ... s_m)² orders for choices of one size.
#pragma once

#include <Eigen/Dense>
#include <random>
#include <vector>

namespace selfcal {

struct Exchange {
  std::vector<int> chosen;  ///< indices of candidates, ascending
  double o1 = 0;  ///< n the count of chosen measurements; 0 where they do not see everything
  int exchanges = 0;
};

/// `count` of the candidates, at least 1 and at most all of them. A candidate is what one
/// measurement adds to W: k x m (k may differ), whitened, of parameters that all
/// candidates together determine.
Exchange detmax(const std::vector<Eigen::MatrixXd>& candidates, int count, std::mt19937_64& random);

}  // namespace selfcal
