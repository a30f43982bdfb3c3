#include "diagnosis/report/row_choice.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/constants.h"
#include "diagnosis/report/separation.h"

namespace selfcal {
RowChoice choose_rows(const LinearisedModel& linearised, const DataSet& data, int first,
                      const std::vector<CausePair>& pairs, int most) {
  std::vector<Separation> causes;
  std::vector<double> before;
  for (const CausePair& each : pairs) {
    causes.emplace_back(linearised, each.one, each.other, data, first);
    before.push_back(causes.back().apart());
  }
  RowChoice choice;
  std::vector<char> is_taken(static_cast<size_t>(data.rows.rows()), 0);
  const auto left = [&](int row) {
    double sum = 0;
    for (size_t k = 0; k < pairs.size(); ++k)
      sum += pairs[k].weight *
             std::exp(-(causes[k].apart() - before[k] + (row < 0 ? 0 : causes[k].gain(row))) / 2);
    return sum;
  };
  const double at_first = left(-1);
  while (static_cast<int>(choice.rows.size()) < most) {
    const double now = left(-1);
    if (now <= kDiagnosis.further_rows.least_confusion * at_first) break;
    int best = -1;
    double least = (1 - kDiagnosis.further_rows.least_gain) * now;
    for (int row = first; row < data.rows.rows(); ++row) {
      if (is_taken[static_cast<size_t>(row)] != 0) continue;
      if (const double then = left(row); then < least) {
        least = then;
        best = row;
      }
    }
    if (best < 0) break;
    for (Separation& each : causes) each.take(best);
    is_taken[static_cast<size_t>(best)] = 1;
    choice.rows.push_back(best);
  }
  for (size_t k = 0; k < pairs.size(); ++k) choice.apart.push_back(causes[k].apart() - before[k]);
  return choice;
}

}  // namespace selfcal
