#include "constraints/estimation/few_rows.h"

#include <random>
#include <vector>

namespace selfcal {
namespace {

/// Rows of a set without groups from which a fit goes over few of them first, and these few.
constexpr int kManyRows = 20000, kFewRows = 4000;

}  // namespace

std::optional<DataSet> few_of(const DataSet& data) {
  if (data.rows.rows() < kManyRows) return std::nullopt;
  std::vector<int> in_set(data.sets.size(), 0);
  for (int row = 0; row < data.rows.rows(); ++row)
    in_set[data.rows.set[row]] += !data.rows.check[row];
  std::mt19937 random(1);
  std::vector<int> rows;
  for (int row = 0; row < data.rows.rows(); ++row) {
    const int set = data.rows.set[row];
    const Method& method = *data.sets[set].method;
    const bool whole = method.group_freedom() > 0 || method.paired() || in_set[set] < kManyRows;
    if (!data.rows.check[row] &&
        (whole || random() % static_cast<unsigned>(in_set[set]) < static_cast<unsigned>(kFewRows)))
      rows.push_back(row);
  }
  if (2 * static_cast<int>(rows.size()) >= data.rows.rows()) return std::nullopt;
  return DataSet{data.sets,   taken(data.rows, rows), data.speeds, data.order_is_time,
                 data.target, data.workspace};
}

}  // namespace selfcal
