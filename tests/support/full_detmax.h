// DETMAX as it is written down, with a decomposition of every choice that is tried.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace selfcal {

/// O1 of the chosen candidates.
double o1_of(const std::vector<Eigen::MatrixXd>& candidates, const std::vector<int>& chosen);

struct FullSearch {
  std::vector<int> chosen;
  int exchanges = 0;
  double seconds = 0;  ///< of this thread
};
/// At most `most` exchanges from `chosen` on.
FullSearch by_full_decompositions(const std::vector<Eigen::MatrixXd>& candidates,
                                  std::vector<int> chosen, int most);

}  // namespace selfcal
