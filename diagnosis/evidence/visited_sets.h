// The sets of causes that a search has visited.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "diagnosis/evidence/hypothesis.h"

namespace selfcal {

class VisitedSets {
 public:
  /// `cause`: by candidate, the number of its cause (CauseNumbers); outlives this.
  explicit VisitedSets(const std::vector<int>& cause) : cause_(cause) {}

  void reserve(std::size_t sets) { list_.reserve(sets); }
  void add(const CompactHypothesis& set);
  const CompactHypothesis& last() const { return list_.back(); }
  CompactHypothesis& last() { return list_.back(); }
  /// Log weight of the best that ever came.
  double top() const { return top_; }
  std::vector<CompactHypothesis>& list() { return list_; }
  const std::vector<CompactHypothesis>& list() const { return list_; }
  bool has(const CompactHypothesis& set) const;

  /// Of those with the same candidates and structure, reached by different ways, the best; of those
  /// that came since the last time, or of all.
  void keep_best();
  void keep_best_of_all();
  /// Those of so many candidates leave if they are impossible.
  void drop_impossible(int size);
  /// The best of `size` candidates in the structures asked for. Not one cause in all its shapes:
  /// two of each cause and structure.
  std::vector<CompactHypothesis> best_of(int size, int most,
                                         const std::function<bool(int structure)>& in) const;
  /// The very best of so many candidates; null where there is none.
  const CompactHypothesis* best(int size) const;

 private:
  const std::vector<int>& cause_;
  std::vector<CompactHypothesis> list_;
  std::size_t distinct_ = 0;  ///< the first of them that are known to be
  double top_ = -INFINITY;
};

}  // namespace selfcal
