#include "constraints/planning/detmax.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "constraints/identifiability/observability.h"

namespace selfcal {
namespace {

constexpr double kGain = 1e-9;               // a smaller relative gain is rounding
constexpr int kExchangesAfresh = 25;         // exchanges after which the design is made anew
constexpr std::size_t kFew = 200;            // left, of which each removal is exact
constexpr std::size_t kRemovalsAfresh = 20;  // of more, after so many

/// A merit that is so much better counts. Merits are logarithms, of which a difference is relative
/// already, or, negative, variances in whatever unit.
bool gains(double merit, double over) {
  return merit > over + kGain * std::min(1.0, std::abs(over));
}

class Search {
 public:
  Search(Design& design, const Progress& progress) : design_(design), progress_(progress) {}

  int add_and_drop() {
    return while_gaining([this] { return add_one_drop_one(); });
  }
  int exchange_pairs() {
    return while_gaining([this] { return exchange_best_pair(); });
  }

 private:
  /// Repeats an exchange for as long as it gains. Rounding adds up, most where few are chosen: what
  /// has not gained once the design is made anew is taken back, and tried again with the design
  /// made anew after each exchange. So every round ends with more merit, and the search ends.
  template <class ExchangeOne>
  int while_gaining(ExchangeOne exchange_one) {
    int counted = 0, since = 0, afresh = kExchangesAfresh;
    design_.refresh();
    std::vector<int> best = design_.chosen();
    double merit = design_.merit();
    for (;;) {
      const bool exchanged = exchange_one();
      if (exchanged) tell(counted + ++since);
      if (exchanged && since < afresh) continue;
      design_.refresh();
      if (since == 0) return counted;
      if (gains(design_.merit(), merit)) {
        merit = design_.merit();
        best = design_.chosen();
        counted += since;
        if (!exchanged) return counted;
      } else {
        design_.choose(best);
        if (afresh == 1) return counted;
        afresh = 1;
      }
      since = 0;
    }
  }

  void tell(int exchanges) const {
    if (progress_)
      progress_("exchanging configurations",
                exchanges / (exchanges + static_cast<double>(design_.chosen().size())));
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
      if (instead < 0 || instead == each || !gains(merit, most)) continue;
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

std::vector<double> left_out_one_by_one(Design& design, const Progress& progress) {
  std::vector<double> merit{design.merit()};
  const std::size_t all = design.chosen().size();
  for (std::size_t left = all; left > 0; --left) {
    if (progress && left % kRemovalsAfresh == 0)
      progress("how many are enough", 1 - static_cast<double>(left) / static_cast<double>(all));
    design.change(design.best(-1).first, -1);
    if (left < kFew || left % kRemovalsAfresh == 0) design.refresh();
    merit.push_back(design.merit());
  }
  std::reverse(merit.begin(), merit.end());
  return merit;
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
