#include "constraints/planning/detmax.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "constraints/identifiability/observability.h"

namespace selfcal {
namespace {

constexpr double kGain = 1e-9;        // a smaller relative gain is rounding
constexpr int kExchangesAfresh = 25;  // exchanges after which the design is made anew

/// A merit that is so much better counts. Merits are logarithms or, negative, variances.
bool gains(double merit, double over) {
  return merit > over + kGain * std::max(1e-3, std::abs(over));
}

class Search {
 public:
  Search(Design& design, const Progress& progress) : design_(design), progress_(progress) {}

  int add_and_drop() {
    while (add_one_drop_one()) count();
    design_.refresh();
    return exchanges_;
  }
  int exchange_pairs() {
    while (exchange_best_pair()) count();
    design_.refresh();
    return exchanges_;
  }

 private:
  void count() {
    if (++exchanges_ % kExchangesAfresh == 0) design_.refresh();
    if (progress_)
      progress_("exchanging configurations",
                exchanges_ / (exchanges_ + static_cast<double>(design_.chosen().size())));
  }

  bool add_one_drop_one() {
    for (int kind = 0; kind < design_.kinds(); ++kind)
      if (add_one_drop_one(kind)) return true;
    return false;
  }

  bool add_one_drop_one(int kind) {
    const double before = design_.merit();
    const int added = design_.best(+1, kind).first;
    if (added < 0) return false;
    design_.change(added, +1);
    const auto [removed, merit] = design_.best(-1, kind);
    const bool better = removed >= 0 && gains(merit, before);
    design_.change(better ? removed : added, -1);
    return better;
  }

  bool exchange_best_pair() {
    const double before = design_.merit();
    double most = before;
    int out = -1, in = -1;
    for (const int each : design_.chosen()) {
      const auto [instead, merit] = design_.best_instead_of(each);
      if (instead < 0 || !gains(merit, most)) continue;
      most = merit;
      out = each;
      in = instead;
    }
    if (out < 0) return false;
    design_.change(in, +1);
    design_.change(out, -1);
    if (gains(design_.merit(), before)) return true;
    design_.change(out, +1);
    design_.change(in, -1);
    return false;
  }

  Design& design_;
  const Progress& progress_;
  int exchanges_ = 0;
};

}  // namespace

std::vector<int> random_choice(int candidates, int count, std::mt19937_64& random) {
  std::vector<int> order(static_cast<std::size_t>(candidates));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  order.resize(static_cast<std::size_t>(count));
  std::sort(order.begin(), order.end());
  return order;
}

int add_and_drop(Design& design, const Progress& progress) {
  return Search(design, progress).add_and_drop();
}

int exchange_pairs(Design& design, const Progress& progress) {
  return Search(design, progress).exchange_pairs();
}

int exchange(Design& design, const Progress& progress) {
  const int exchanges = add_and_drop(design, progress);
  return exchanges + exchange_pairs(design, progress);
}

Exchange detmax(const std::vector<Eigen::MatrixXd>& candidates, int count,
                std::mt19937_64& random) {
  Design design(candidates, {});
  design.choose(random_choice(static_cast<int>(candidates.size()), count, random));
  Exchange result;
  result.exchanges = exchange(design);
  result.chosen = design.chosen();
  Eigen::Index at = 0;
  for (const int i : result.chosen) at += candidates[i].rows();
  Eigen::MatrixXd W(at, candidates.front().cols());
  at = 0;
  for (const int i : result.chosen) {
    W.middleRows(at, candidates[i].rows()) = candidates[i];
    at += candidates[i].rows();
  }
  if (W.rows() >= W.cols()) result.o1 = observability(W, count).o1;
  return result;
}

}  // namespace selfcal
