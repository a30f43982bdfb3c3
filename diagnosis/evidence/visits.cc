// The analysis of variance of a nested design (Searle, Casella and McCulloch, Variance Components,
// chapter 3): with s^2 within visits and v^2 between those of one configuration,
//   E[sum over visits of (mean - mean of means)^2] = sum over configurations
//       of (n - 1) v^2 + (1 - 1/n) sum over its n visits of s^2 / m,   m rows of a visit.
#include "diagnosis/evidence/visits.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "diagnosis/constants.h"

namespace selfcal {
namespace {

struct Sum {
  double n = 0, sum = 0, squares = 0;
  void add(double x) {
    n += 1;
    sum += x;
    squares += x * x;
  }
  double mean() const { return sum / n; }
  double about_mean() const { return squares - sum * sum / n; }
};

}  // namespace

std::vector<int> visits(const Observations& rows) {
  std::vector<int> visit(static_cast<size_t>(rows.rows()), 0);
  const std::vector<int> configuration = configurations(rows);
  const bool timed = rows.time.size() > 0 && rows.time.allFinite();
  int last = -1, count = -1;
  for (const int row : in_time(rows)) {
    const bool again = last >= 0 && configuration[row] == configuration[last] &&
                       !(timed && rows.time[row] - rows.time[last] > kAtOnce);
    count += !again;
    visit[row] = count;
    last = row;
  }
  return visit;
}

double noise_of_visits(const Observations& data, const DenseEquations& rows,
                       const Eigen::VectorXd& left) {
  if (data.repeat.empty()) return 0;
  const std::vector<int> visit = visits(data);
  const std::vector<int> configuration = configurations(data);
  using Key = std::pair<int, int>;  // visit or configuration, which of the row's equations
  std::map<Key, Sum> of_visit;
  std::map<Key, std::set<int>> visits_of;
  int equation = 0;
  for (size_t i = 0; i < rows.row.size(); ++i) {
    const int row = rows.row[i];
    equation = i > 0 && rows.row[i - 1] == row ? equation + 1 : 0;
    if (row < 0 || data.repeat[row] < 0) continue;
    of_visit[{visit[row], equation}].add(left[static_cast<Eigen::Index>(i)]);
    visits_of[{configuration[row], equation}].insert(visit[row]);
  }
  double within = 0, of_repeats = 0, between = 0, again = 0, of_means = 0;
  for (const auto& [key, sum] : of_visit) {
    within += sum.about_mean();
    of_repeats += sum.n - 1;
  }
  for (const auto& [key, list] : visits_of) {
    const auto n = static_cast<double>(list.size());
    Sum means;
    for (const int each : list) {
      const Sum& sum = of_visit[{each, key.second}];
      means.add(sum.mean());
      of_means += (1 - 1 / n) / sum.n;
    }
    between += means.about_mean();
    again += n - 1;
  }
  if (of_repeats < kDiagnosis.rows.fewest_visits || again < kDiagnosis.rows.fewest_visits ||
      within <= 0)
    return 0;
  const double own = (between / (within / of_repeats) - of_means) / again;
  return std::sqrt(
      std::clamp(own, 0.0, kDiagnosis.rows.most_of_visits * kDiagnosis.rows.most_of_visits));
}

}  // namespace selfcal
