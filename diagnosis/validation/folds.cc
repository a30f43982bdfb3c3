#include "diagnosis/validation/folds.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "diagnosis/constants.h"

namespace selfcal {
namespace {

constexpr int kStretches = kDiagnosis.validation.stretches * kDiagnosis.validation.folds;

/// By row, of those that `counts` holds: how many of their set's configurations were taken before
/// among them; `count` by set.
template <class Counts>
std::vector<int> places(const Observations& rows, Counts counts, std::map<int, int>& count) {
  const std::vector<int> configuration = configurations(rows);
  std::vector<int> place(configuration.size(), -1);
  std::map<int, int> known;  // by configuration
  for (const int row : in_time(rows)) {
    if (!counts(row)) continue;
    int& in_set = count[rows.set[row]];
    const auto [found, made] = known.try_emplace(configuration[row], in_set);
    in_set += made;
    place[row] = found->second;
  }
  return place;
}

}  // namespace

DataSet with_fold(const DataSet& data, int fold) {
  DataSet part = data;
  std::map<int, int> count;
  const std::vector<int> place = places(
      data.rows, [&](int row) { return data.rows.check[row] != kCopy; }, count);
  for (int row = 0; row < data.rows.rows(); ++row)
    if (place[row] >= 0) {
      const int stretch = place[row] * kStretches / count[data.rows.set[row]];
      part.rows.check[row] = stretch % kDiagnosis.validation.folds == fold;
    }
  return part;
}

std::vector<int> validation_blocks(const DataSet& data) {
  std::map<int, int> count;
  const std::vector<int> place = places(
      data.rows, [&](int row) { return data.rows.check[row] && data.rows.check[row] != kCopy; },
      count);
  std::vector<int> block(place.size(), -1);
  std::map<std::pair<int, int>, int> number;  // by set and its own number of the block
  for (int row = 0; row < data.rows.rows(); ++row) {
    if (place[row] < 0) continue;
    const int set = data.rows.set[row];
    const int length = static_cast<int>(std::lround(std::cbrt(static_cast<double>(count[set]))));
    const std::pair<int, int> key{set, place[row] / std::max(length, 1)};
    block[row] = number.try_emplace(key, static_cast<int>(number.size())).first->second;
  }
  return block;
}

}  // namespace selfcal
