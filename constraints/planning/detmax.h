// DETMAX: of many possible measurements, the few that together are the best.
//
// Exchange algorithm of Mitchell (Technometrics 16, 1974) as Kamali et al. use it: from a random
// choice, the best of those left is added and then the worst of all removed, until the one removed
// is the one just added. Then the best exchange of any pair (Fedorov 1972) as long as one gains.
// Best is what the objective says; by default the observability index
//   O1 = (s_1 ... s_m)^(1/m) / sqrt(n),   s_i the singular values of the n chosen rows of W,
// which det(WᵀW) = (s_1 ... s_m)² orders for choices of one size.
#pragma once

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "constraints/planning/design.h"
#include "constraints/progress.h"

namespace selfcal {

struct Exchange {
  std::vector<int> chosen;  ///< indices of candidates, ascending
  double o1 = 0;  ///< n the count of chosen measurements; 0 where they do not see everything
  int exchanges = 0;
};

/// `count` of `candidates` at random, ascending.
std::vector<int> random_choice(int candidates, int count, std::mt19937_64& random);

/// Mitchell's and Fedorov's exchanges of the chosen of `design` for better ones, as many; return
/// how often.
int add_and_drop(Design& design, const Progress& progress = {});
int exchange_pairs(Design& design, const Progress& progress = {});
/// The one, then the other.
int exchange(Design& design, const Progress& progress = {});

/// Leaves the chosen out one after another, always the one that tells least: the merit by how many
/// are left, from none to all.
std::vector<double> left_out_one_by_one(Design& design, const Progress& progress = {});

/// `count` of the candidates, at least 1 and at most all of them, by O1 from a random choice.
/// Columns are parameters that all candidates together determine.
Exchange detmax(const std::vector<Eigen::MatrixXd>& candidates, int count, std::mt19937_64& random);

}  // namespace selfcal
