#include "diagnosis/report/shared_by_outliers.h"

#include <algorithm>

#include "constraints/statistics.h"
#include "diagnosis/constants.h"

namespace selfcal {
namespace {

/// Something that rows may have in common.
struct Trait {
  std::string words;       ///< "were taken after a pause"
  std::vector<char> rows;  ///< by row, whether it has it
};

std::vector<Trait> traits_of(const DataSet& data, const std::vector<Joint>& joints) {
  const Observations& rows = data.rows;
  const auto count = static_cast<std::size_t>(rows.rows());
  std::vector<Trait> list;
  const auto add = [&](std::string words, const auto& has) {
    Trait trait{std::move(words), std::vector<char>(count, 0)};
    for (std::size_t row = 0; row < count; ++row) trait.rows[row] = has(static_cast<int>(row));
    list.push_back(std::move(trait));
  };
  for (std::size_t s = 0; data.sets.size() > 1 && s < data.sets.size(); ++s)
    add("are of set " + data.sets[s].name,
        [&](int row) { return rows.set[static_cast<std::size_t>(row)] == static_cast<int>(s); });
  for (Eigen::Index j = 0; rows.velocity.rows() > 0 && j < rows.velocity.cols(); ++j)
    for (const auto& [way, sign] : {std::pair("upwards", 1), std::pair("downwards", -1)})
      add("were approached with " + joints[static_cast<std::size_t>(j)].name + " going " + way,
          [&, sign = sign](int row) { return sign * rows.velocity(row, j) > 0; });
  const std::vector<int> order = in_time(rows);
  std::vector<std::size_t> place(count);
  for (std::size_t i = 0; i < count; ++i) place[static_cast<std::size_t>(order[i])] = i;
  for (const auto& [words, third] :
       {std::pair("are of the first third of the session", std::size_t{0}),
        std::pair("are of the second third of the session", std::size_t{1}),
        std::pair("are of the last third of the session", std::size_t{2})})
    add(words, [&, third = third](int row) {
      return 3 * place[static_cast<std::size_t>(row)] / count == third;
    });
  const bool timed = rows.time.rows() > 0 && rows.time.allFinite() && !data.order_is_time;
  if (!timed || count < 2) return list;
  std::vector<double> gaps;
  for (std::size_t i = 1; i < count; ++i)
    gaps.push_back(rows.time[order[i]] - rows.time[order[i - 1]]);
  const double long_gap = kDiagnosis.shapes.pause * median(gaps);
  add("were taken after a pause", [&](int row) {
    const std::size_t i = place[static_cast<std::size_t>(row)];
    return i > 0 && gaps[i - 1] > long_gap;
  });
  return list;
}

}  // namespace

std::string shared_by_outliers(const DataSet& data, const std::vector<Joint>& joints,
                               const std::vector<Outlier>& outliers) {
  if (std::ssize(outliers) < kDiagnosis.report.fewest_alike) return {};
  const auto takes_part = [&](std::size_t row) { return data.rows.check[row] != kCopy; };
  unsigned all = 0;
  for (std::size_t row = 0; row < data.rows.check.size(); ++row) all += takes_part(row);
  const std::vector<Trait> traits = traits_of(data, joints);
  double least = kDiagnosis.report.alike_by_chance / static_cast<double>(traits.size());
  std::string words;
  for (const Trait& trait : traits) {
    unsigned having = 0;
    for (std::size_t row = 0; row < trait.rows.size(); ++row)
      having += trait.rows[row] && takes_part(row);
    const auto seen = static_cast<unsigned>(std::ranges::count_if(
        outliers, [&](const Outlier& each) { return trait.rows[each.row - 1] != 0; }));
    const double p = as_many_drawn(seen, static_cast<unsigned>(outliers.size()), having, all);
    if (p > least) continue;
    least = p;
    words = "of the " + std::to_string(outliers.size()) + " rows put aside as false " +
            std::to_string(seen) + " " + trait.words + ", as " + std::to_string(having) +
            " of all " + std::to_string(all) +
            " rows were: perhaps they are not false, and what they share is what is to be found; "
            "look at them, or take more rows of that kind";
  }
  return words;
}

}  // namespace selfcal
