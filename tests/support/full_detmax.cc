#include "tests/support/full_detmax.h"

#include <algorithm>
#include <ctime>

#include "constraints/identifiability/observability.h"

namespace selfcal {

double o1_of(const std::vector<Eigen::MatrixXd>& candidates, const std::vector<int>& chosen) {
  const Eigen::Index k = candidates.front().rows();
  Eigen::MatrixXd W(k * static_cast<Eigen::Index>(chosen.size()), candidates.front().cols());
  for (size_t i = 0; i < chosen.size(); ++i)
    W.middleRows(k * static_cast<Eigen::Index>(i), k) = candidates[chosen[i]];
  return observability(W, static_cast<int>(chosen.size())).o1;
}

FullSearch by_full_decompositions(const std::vector<Eigen::MatrixXd>& candidates,
                                  std::vector<int> chosen, int most) {
  const std::clock_t start = std::clock();
  FullSearch search;
  for (double o1 = o1_of(candidates, chosen); search.exchanges < most; ++search.exchanges) {
    std::vector<int> best;
    double best_o1 = -1;
    for (int c = 0; c < static_cast<int>(candidates.size()); ++c) {
      if (std::ranges::count(chosen, c) > 0) continue;
      std::vector<int> with = chosen;
      with.push_back(c);
      if (const double each = o1_of(candidates, with); each > best_o1) {
        best_o1 = each;
        best = with;
      }
    }
    double left = -1;
    for (size_t out = 0; out < best.size(); ++out) {
      std::vector<int> less = best;
      less.erase(less.begin() + static_cast<std::ptrdiff_t>(out));
      const double each = o1_of(candidates, less);
      if (each <= left) continue;
      left = each;
      chosen = left > o1 * (1 + 1e-9) ? less : chosen;
    }
    if (left <= o1 * (1 + 1e-9)) break;
    o1 = left;
  }
  search.chosen = chosen;
  search.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return search;
}

}  // namespace selfcal
