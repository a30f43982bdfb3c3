// A heap gives the best of some hundred thousand one after the other: few are taken.
#include "diagnosis/evidence/visited_sets.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace selfcal {

void VisitedSets::add(const CompactHypothesis& set) {
  list_.push_back(set);
  top_ = std::max(top_, set.log_weight);
}

bool VisitedSets::has(const CompactHypothesis& set) const {
  return std::ranges::any_of(list_, [&](const auto& each) { return each.key() == set.key(); });
}

void VisitedSets::keep_best() {
  const auto first = list_.begin() + static_cast<std::ptrdiff_t>(distinct_);
  std::sort(first, list_.end(), [](const CompactHypothesis& a, const CompactHypothesis& b) {
    return std::tuple(a.key(), -a.log_weight) < std::tuple(b.key(), -b.log_weight);
  });
  const auto same = [](const CompactHypothesis& a, const CompactHypothesis& b) {
    return a.key() == b.key();
  };
  list_.erase(std::unique(first, list_.end(), same), list_.end());
  distinct_ = list_.size();
}

void VisitedSets::keep_best_of_all() {
  distinct_ = 0;
  keep_best();
}

void VisitedSets::drop_impossible(int size) {
  std::erase_if(list_, [&](const CompactHypothesis& each) {
    return each.count == size && each.impossible.value_or(false);
  });
  distinct_ = list_.size();
}

std::vector<CompactHypothesis> VisitedSets::best_of(
    int size, int most, const std::function<bool(int structure)>& in) const {
  std::vector<const CompactHypothesis*> list;
  for (const CompactHypothesis& each : list_)
    if (each.count == size && in(each.structure) && std::isfinite(each.log_weight))
      list.push_back(&each);
  const auto worse = [](const CompactHypothesis* a, const CompactHypothesis* b) {
    return a->log_weight != b->log_weight ? a->log_weight < b->log_weight : a > b;
  };
  std::ranges::make_heap(list, worse);
  std::map<std::pair<std::vector<int>, int>, int> taken;
  std::vector<CompactHypothesis> diverse;
  while (!list.empty() && static_cast<int>(diverse.size()) < most) {
    std::ranges::pop_heap(list, worse);
    const CompactHypothesis& each = *list.back();
    list.pop_back();
    std::vector<int> causes;
    for (const int c : each.all()) causes.push_back(cause_[static_cast<std::size_t>(c)]);
    if (++taken[{causes, each.structure}] <= 2) diverse.push_back(each);
  }
  return diverse;
}

const CompactHypothesis* VisitedSets::best(int size) const {
  const CompactHypothesis* best = nullptr;
  for (const CompactHypothesis& each : list_)
    if (each.count == size && (!best || each.log_weight > best->log_weight)) best = &each;
  return best;
}

}  // namespace selfcal
