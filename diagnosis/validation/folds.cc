#include "diagnosis/validation/folds.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "diagnosis/constants.h"

namespace selfcal {
namespace {

constexpr int kStretches = kDiagnosis.validation.stretches * kDiagnosis.validation.folds;

/// Of each of the rows `of`: how many configurations of its set came before among them; `count` by
/// set.
std::vector<int> places(const Observations& rows, const std::vector<int>& of,
                        std::map<int, int>& count) {
  std::vector<int> place;
  std::map<std::pair<int, int>, int> known;  // by set and repeat
  for (const int row : of) {
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
  std::vector<int> all(static_cast<size_t>(data.rows.rows()));
  std::iota(all.begin(), all.end(), 0);
  std::map<int, int> count;
  const std::vector<int> place = places(data.rows, all, count);
  for (int row = 0; row < data.rows.rows(); ++row) {
    const int stretch = place[row] * kStretches / count[data.rows.set[row]];
    if (data.rows.check[row] != kCopy)
      part.rows.check[row] = stretch % kDiagnosis.validation.folds == fold;
  }
  return part;
}

std::vector<int> validation_blocks(const DataSet& data) {
  std::vector<int> held_out;
  for (int row = 0; row < data.rows.rows(); ++row)
    if (data.rows.check[row]) held_out.push_back(row);
  std::map<int, int> count;
  const std::vector<int> place = places(data.rows, held_out, count);
  std::vector<int> block(static_cast<size_t>(data.rows.rows()), -1);
  std::map<std::pair<int, int>, int> number;  // by set and its own number of the block
  for (size_t i = 0; i < held_out.size(); ++i) {
    const int set = data.rows.set[held_out[i]];
    const int length = static_cast<int>(std::lround(std::cbrt(static_cast<double>(count[set]))));
    const std::pair<int, int> key{set, place[i] / std::max(length, 1)};
    block[held_out[i]] = number.try_emplace(key, static_cast<int>(number.size())).first->second;
  }
  return block;
}

}  // namespace selfcal
