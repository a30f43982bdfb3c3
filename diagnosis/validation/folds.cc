#include "diagnosis/validation/folds.h"

#include <map>

namespace selfcal {
namespace {

constexpr int kStretches = 2 * kFolds;

/// By row: how many configurations of its set came before.
std::vector<int> places(const Observations& rows, std::map<int, int>& count) {
  std::vector<int> place;
  std::map<std::pair<int, int>, int> known;  // by set and repeat
  for (int row = 0; row < rows.rows(); ++row) {
    const int set = rows.set[row], repeat = rows.repeat.empty() ? -1 : rows.repeat[row];
    if (repeat < 0) {
      place.push_back(count[set]++);
      continue;
    }
    const auto [found, made] = known.try_emplace({set, repeat}, count[set]);
    count[set] += made;
    place.push_back(found->second);
  }
  return place;
}

}  // namespace

DataSet with_fold(const DataSet& data, int fold) {
  DataSet part = data;
  std::map<int, int> count;
  const std::vector<int> place = places(data.rows, count);
  for (int row = 0; row < data.rows.rows(); ++row) {
    const int stretch = place[row] * kStretches / count[data.rows.set[row]];
    part.rows.check[row] = stretch % kFolds == fold;
  }
  return part;
}

}  // namespace selfcal
