#include "diagnosis/evidence/rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <tuple>

#include "constraints/methods/instrument.h"
#include "constraints/statistics.h"
#include "diagnosis/constants.h"
#include "diagnosis/evidence/visits.h"

namespace selfcal {

RowPlaces::RowPlaces(const std::vector<int>& row_of_equation) {
  std::ranges::copy_if(row_of_equation, std::back_inserter(rows), [](int row) { return row >= 0; });
  std::ranges::sort(rows);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  for (const int row : row_of_equation)
    of.push_back(row < 0 ? -1
                         : static_cast<int>(std::ranges::lower_bound(rows, row) - rows.begin()));
}
namespace {

/// Variance of the log of a variance that is told from the middle of so many freedoms, times these:
/// 2 over the efficiency of 0.37 (Rousseeuw and Croux 1993).
constexpr double kOfMedian = 5.4;

/// From the middle of the residuals: no false row moves it, and where structure that nobody knows
/// adds to the noise it holds both.
double robust_variance(const DenseEquations& all, const Eigen::VectorXd& residuals,
                       double unknowns) {
  std::vector<double> sizes;
  for (size_t i = 0; i < all.row.size(); ++i)
    if (all.row[i] >= 0) sizes.push_back(std::abs(residuals[static_cast<Eigen::Index>(i)]));
  const auto n = static_cast<double>(sizes.size());
  const double spent = std::min(unknowns, kDiagnosis.rows.most_taken * n);
  return std::pow(kDiagnosis.rows.median_to_sigma * median(std::move(sizes)), 2) / (1 - spent / n);
}

}  // namespace

std::vector<Scale> pooled_noise(const DataSet& data, const Fit& fitted) {
  struct Pooled {
    double lengths = 0, angles = 0, rows = 0;  // squares of both
  };
  std::map<Instrument, Pooled> by_instrument;
  for (size_t s = 0; s < fitted.rows.size(); ++s) {
    if (fitted.rows[s] == 0) continue;
    Pooled& pooled = by_instrument[instrument_of(data.sets[s])];
    pooled.lengths += fitted.rows[s] * std::pow(fitted.noise.estimated[s].length, 2);
    pooled.angles += fitted.rows[s] * std::pow(fitted.noise.estimated[s].angle, 2);
    pooled.rows += fitted.rows[s];
  }
  std::vector<Scale> noise = fitted.noise.estimated;
  for (size_t s = 0; s < noise.size(); ++s) {
    const Set& set = data.sets[s];
    if (const auto found = by_instrument.find(instrument_of(set)); found != by_instrument.end()) {
      const Pooled& pooled = found->second;
      noise[s] = {std::sqrt(pooled.lengths / pooled.rows), std::sqrt(pooled.angles / pooled.rows)};
    } else if (set.noise > 0 || set.noise_angle > 0) {
      noise[s] = {set.noise > 0 ? set.noise : noise[s].length,
                  set.noise_angle > 0 ? set.noise_angle : noise[s].angle};
    }
  }
  return noise;
}

namespace {

/// What is left of rows that have one noise.
struct LeftOfRows {
  std::vector<double> sizes;
  double freedom = 0, least = 0, variance = 1;

  void operator+=(const LeftOfRows& other) {
    sizes.insert(sizes.end(), other.sizes.begin(), other.sizes.end());
    freedom += other.freedom;
    least = std::max(least, other.least);
  }
  double log_sigma() const { return std::sqrt(kOfMedian / freedom); }
};

}  // namespace

std::vector<Scale> unlike_noise(const DataSet& data, const DenseEquations& rows,
                                const Eigen::VectorXd& residuals, const Eigen::VectorXd& leaves,
                                const std::vector<Scale>& least) {
  struct LeftOfSet {
    LeftOfRows lengths, angles;
    LeftOfRows& of(Quantity quantity) { return quantity == Quantity::angle ? angles : lengths; }
  };
  std::vector<LeftOfSet> of_set(data.sets.size());
  for (size_t i = 0; i < rows.row.size(); ++i) {
    if (rows.row[i] < 0) continue;
    LeftOfRows& left = of_set[static_cast<size_t>(data.rows.set[rows.row[i]])].of(rows.quantity[i]);
    left.sizes.push_back(std::abs(residuals[static_cast<Eigen::Index>(i)]));
    left.freedom += leaves[static_cast<Eigen::Index>(i)];
  }
  // Sets of few rows stand together.
  using Key = std::tuple<Instrument, int, Quantity>;
  const auto key_of = [&](size_t s, Quantity quantity) {
    const bool alone = of_set[s].of(quantity).freedom >= kDiagnosis.rows.fewest_of_set;
    return Key(instrument_of(data.sets[s]), alone ? static_cast<int>(s) : -1, quantity);
  };
  constexpr std::array kQuantities = {Quantity::length, Quantity::angle};
  std::map<Key, LeftOfRows> alike;
  for (size_t s = 0; s < of_set.size(); ++s)
    for (const Quantity each : kQuantities) {
      of_set[s].of(each).least = least[s].of(each);
      alike[key_of(s, each)] += of_set[s].of(each);
    }
  // Those that their own unknowns meet tell nothing.
  std::erase_if(alike, [](const auto& each) {
    return each.second.freedom < kDiagnosis.rows.fewest_freedoms;
  });
  std::vector<Scale> unlike(data.sets.size());
  const LeftOfRows *quietest = nullptr, *loudest = nullptr;
  double squares = 0, freedom = 0;
  for (auto& [key, left] : alike) {
    const double share = left.freedom / static_cast<double>(left.sizes.size());
    left.variance = std::max(
        std::pow(left.least, 2),
        std::pow(kDiagnosis.rows.median_to_sigma * median(std::move(left.sizes)), 2) / share);
    squares += left.freedom * left.variance;
    freedom += left.freedom;
    if (!quietest || left.variance < quietest->variance) quietest = &left;
    if (!loudest || left.variance > loudest->variance) loudest = &left;
  }
  if (!quietest || quietest->variance <= 0 ||
      std::log(loudest->variance / quietest->variance) <=
          kDiagnosis.rows.unlike * std::hypot(quietest->log_sigma(), loudest->log_sigma()))
    return unlike;
  const auto over_all = [&](size_t s, Quantity quantity) {
    const auto found = alike.find(key_of(s, quantity));
    return found == alike.end() ? 1 : std::sqrt(found->second.variance * freedom / squares);
  };
  for (size_t s = 0; s < unlike.size(); ++s)
    unlike[s] = {over_all(s, Quantity::length), over_all(s, Quantity::angle)};
  return unlike;
}

std::vector<Scale> declared_noise(const DataSet& data) {
  std::vector<Scale> declared;
  for (const Set& set : data.sets) declared.push_back({set.noise, set.noise_angle});
  if (data.rows.repeat.empty()) return declared;
  const std::vector<int> visit = visits(data.rows);  // what lies between two may have a cause
  std::map<int, int> rows_of;
  for (int row = 0; row < data.rows.rows(); ++row)
    if (data.rows.repeat[row] >= 0 && !data.rows.check[row] && ++rows_of[visit[row]] > 1)
      declared[static_cast<size_t>(data.rows.set[row])] = {0, 0};
  return declared;
}

/// Of each stretch of `step` configurations one, at a place within it that goes by the golden
/// ratio: how a session alternates (approaches, surfaces, payloads) cannot keep step with that.
std::vector<char> weighed_rows(const Observations& rows, double equations, double most) {
  std::vector<char> take(static_cast<size_t>(rows.rows()), 0);
  const std::vector<int> configuration = configurations(rows);
  const int most_of_one = kDiagnosis.rows.most_of_configuration;
  std::map<int, int> of_configuration;
  double all = 0, at_most = 0;
  for (size_t row = 0; row < take.size(); ++row) {
    if (rows.check[row]) continue;
    all += 1;
    at_most += ++of_configuration[configuration[row]] <= most_of_one;
  }
  of_configuration.clear();
  const double step = std::max(1.0, equations / most * at_most / std::max(all, 1.0));
  std::map<int, char> decided;  // by configuration
  double stretches = 0, count = 0;
  const auto next = [&] {
    const double within = stretches * std::numbers::phi;
    return std::floor((stretches + within - std::floor(within)) * step);
  };
  for (size_t row = 0; row < take.size(); ++row) {
    if (rows.check[row]) continue;
    const auto [found, made] = decided.try_emplace(configuration[row], count >= next());
    take[row] = found->second && ++of_configuration[configuration[row]] <= most_of_one;
    if (!made) continue;
    stretches += take[row];
    count += 1;
  }
  return take;
}

std::vector<int> equations_of(const DenseEquations& all, const std::vector<char>& take) {
  std::vector<int> rows;
  for (size_t i = 0; i < all.row.size(); ++i)
    if (all.row[i] < 0 || take[static_cast<size_t>(all.row[i])])
      rows.push_back(static_cast<int>(i));
  return rows;
}

void add_labels(const DenseEquations& all, const std::vector<int>& equations, DenseEquations& to) {
  for (const int i : equations) {
    to.row.push_back(all.row[static_cast<size_t>(i)]);
    to.quantity.push_back(all.quantity[static_cast<size_t>(i)]);
  }
}

DenseEquations kept(const DenseEquations& all, const std::vector<char>& take) {
  const std::vector<int> rows = equations_of(all, take);
  DenseEquations some{all.W(rows, Eigen::all), all.y(rows), all.shift(rows, Eigen::all), {}, {}};
  add_labels(all, rows, some);
  return some;
}

std::vector<char> outliers_among(const DenseEquations& all, const Eigen::VectorXd& residuals,
                                 double unknowns, std::size_t rows, double most) {
  const double variance = robust_variance(all, residuals, unknowns);
  std::vector<double> squares(rows, 0);
  std::vector<int> count(rows, 0);
  for (size_t i = 0; i < all.row.size(); ++i)
    if (all.row[i] >= 0) {
      squares[all.row[i]] += std::pow(residuals[static_cast<Eigen::Index>(i)], 2);
      ++count[all.row[i]];
    }
  std::vector<std::pair<double, int>> far;
  std::map<int, double> limits;  // by equations of a row
  for (size_t row = 0; row < rows; ++row) {
    if (count[row] == 0) continue;
    const double sigmas = std::sqrt(squares[row] / variance);
    const auto [found, made] = limits.try_emplace(count[row], 0.0);
    if (made) found->second = chi_quantile(count[row], kDiagnosis.rows.far);
    const double limit = found->second;
    if (sigmas > limit) far.emplace_back(-sigmas / limit, static_cast<int>(row));
  }
  std::sort(far.begin(), far.end());
  const auto n = static_cast<double>(std::ranges::count_if(count, [](int c) { return c > 0; }));
  const double allowed = most * n + 2 * std::sqrt(most * n);
  std::vector<char> outlier(rows, 0);
  for (size_t i = 0; i < far.size() && static_cast<double>(i) < allowed; ++i)
    outlier[far[i].second] = 1;
  return outlier;
}

std::vector<Eigen::Isometry3d> ends(const Robot& robot, const Observations& rows) {
  std::vector<Eigen::Isometry3d> list;
  for (int row = 0; row < rows.rows(); ++row)
    list.push_back(seen_poses(robot, rows.q.row(row).transpose()).back());
  return list;
}

Eigen::MatrixXd tips(const Robot& robot, const Observations& rows) {
  Eigen::MatrixXd tips(rows.rows(), 3);
  Eigen::Index row = 0;
  for (const Eigen::Isometry3d& end : ends(robot, rows))
    tips.row(row++) = end.translation().transpose();
  return tips;
}

}  // namespace selfcal
