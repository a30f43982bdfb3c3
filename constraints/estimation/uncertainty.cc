// Freedoms: of each source of the doubt, added up as Welch and Satterthwaite do. Lack of fit: F of
// what is left beyond the spread of immediate repeats over that spread. Residuals against noise:
// Jarque and Bera's test of their distribution, and the correlation of successive ones within a
// set. Accuracy and repeatability of poses that repeat as in ISO 9283: |mean| of the residual
// vectors, and l + 3 s of their distances from it.
#include "constraints/estimation/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "constraints/statistics.h"

namespace selfcal {
namespace {

constexpr double kCoverage = 0.95;
constexpr double kCorrelated = 0.9;
constexpr int kCells = 3;  ///< of the grid along each axis

/// Residuals that took part, over the noise of their sets, in the order of their times.
std::vector<const RowResidual*> used_rows(const DataSet& data, const Judged& after,
                                          const Noise& noise) {
  std::vector<int> place(static_cast<size_t>(data.rows.rows()));
  int at = 0;
  for (const int row : in_time(data.rows)) place[static_cast<size_t>(row)] = at++;
  const auto when = [&](const RowResidual* r) { return place[static_cast<size_t>(r->row)]; };
  std::vector<const RowResidual*> rows;
  rows.reserve(after.fit.size());
  for (const RowResidual& r : after.fit)
    if (!noise.outlier[static_cast<size_t>(r.row)]) rows.push_back(&r);
  if (!std::ranges::is_sorted(rows, {}, when)) std::ranges::stable_sort(rows, {}, when);
  return rows;
}

/// Squares of what rows of one configuration differ by, over their noise.
double spread_of_repeats(const std::vector<const RowResidual*>& same,
                         const std::vector<Quantity>& quantities, const Scale& noise) {
  double sum = 0;
  for (size_t a = 0; a < quantities.size(); ++a) {
    double mean = 0, weight = 0;
    for (const RowResidual* r : same) {
      mean += r->scalars[a] / (r->factor * r->factor);
      weight += 1 / (r->factor * r->factor);
    }
    mean /= weight;
    for (const RowResidual* r : same)
      sum += std::pow((r->scalars[a] - mean) / r->factor / noise.of(quantities[a]), 2);
  }
  return sum;
}

LackOfFit lack_of_fit(const DataSet& data, const std::vector<const RowResidual*>& rows,
                      const Noise& noise, double freedoms) {
  LackOfFit result;
  std::map<std::pair<int, int>, std::vector<const RowResidual*>> repeats;
  double all = 0;
  for (const RowResidual* r : rows) {
    all += std::pow(r->sigmas(noise.used[static_cast<size_t>(r->set)]), 2);
    const int repeat = data.rows.repeat.empty() ? -1 : data.rows.repeat[r->row];
    if (repeat >= 0) repeats[{r->set, repeat}].push_back(r);
  }
  double pure = 0;
  for (const auto& [key, same] : repeats) {
    pure += spread_of_repeats(same, data.sets[static_cast<size_t>(key.first)].method->equations(),
                              noise.used[static_cast<size_t>(key.first)]);
    for (size_t i = 1; i < same.size(); ++i)
      result.repeat_freedoms += same.front()->lengths + same.front()->angles;
  }
  result.freedoms = freedoms - result.repeat_freedoms;
  if (result.repeat_freedoms < 1 || result.freedoms < 1 || !(pure > 0)) return result;
  result.F = std::max(0.0, all - pure) / result.freedoms / (pure / result.repeat_freedoms);
  result.p_value = f_exceeds(result.F, result.freedoms, result.repeat_freedoms);
  return result;
}

/// Length scalars alone: every method's rows have them or angles alone.
ResidualTests residual_tests(const std::vector<const RowResidual*>& rows, const Noise& noise) {
  ResidualTests tests;
  std::map<int, const RowResidual*> last;  // of a set
  double squares = 0, cubes = 0, fourths = 0, products = 0, pairs = 0;
  for (const RowResidual* r : rows) {
    const double sigma = noise.used[static_cast<size_t>(r->set)].length;
    const RowResidual* before = std::exchange(last[r->set], r);
    for (int a = 0; a < r->lengths; ++a) {
      const double z = r->scalars[a] / sigma / r->factor;
      squares += z * z;
      cubes += z * z * z;
      fourths += z * z * z * z;
      tests.count += 1;
      if (!before || before->lengths <= a) continue;
      products += z * before->scalars[a] / sigma / before->factor;
      pairs += 1;
    }
  }
  if (tests.count < 8 || !(squares > 0)) return tests;
  const double n = tests.count, variance = squares / n;
  tests.skewness = cubes / n / std::pow(variance, 1.5);
  tests.kurtosis = fourths / n / (variance * variance);
  tests.normality_p = chi_square_exceeds(
      n / 6 * (std::pow(tests.skewness, 2) + std::pow(tests.kurtosis - 3, 2) / 4), 2);
  if (pairs < 8) return tests;
  tests.autocorrelation = products / pairs / variance;
  tests.autocorrelation_p = chi_square_exceeds(pairs * std::pow(tests.autocorrelation, 2), 1);
  return tests;
}

std::vector<Correlation> correlations(const Robot& robot, const Eigen::MatrixXd& C) {
  std::vector<Correlation> list;
  const auto& parameters = robot.parameters();
  for (size_t i = 0; i < parameters.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
      if (!(C(a, a) > 0 && C(b, b) > 0)) continue;
      const double r = C(a, b) / std::sqrt(C(a, a) * C(b, b));
      if (std::abs(r) > kCorrelated) list.push_back({parameters[j].name, parameters[i].name, r});
    }
  return list;
}

PoseRepeats pose_repeats(const DataSet& data, const Judged& after) {
  std::map<std::pair<int, int>, std::vector<Eigen::Vector3d>> poses;
  for (const auto* rows : {&after.fit, &after.check})
    for (const RowResidual& r : *rows)
      if (r.lengths == 3 && !data.rows.repeat.empty() && data.rows.repeat[r.row] >= 0)
        poses[{r.set, data.rows.repeat[r.row]}].emplace_back(r.scalars[0], r.scalars[1],
                                                             r.scalars[2]);
  PoseRepeats result;
  for (const auto& [key, residuals] : poses) {
    const auto n = static_cast<double>(residuals.size());
    if (n < 2) continue;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& r : residuals) mean += r / n;
    double distance = 0, squares = 0;
    for (const Eigen::Vector3d& r : residuals) distance += (r - mean).norm() / n;
    for (const Eigen::Vector3d& r : residuals)
      squares += std::pow((r - mean).norm() - distance, 2) / (n - 1);
    ++result.poses;
    result.accuracy = std::max(result.accuracy, mean.norm());
    result.repeatability = std::max(result.repeatability, distance + 3 * std::sqrt(squares));
  }
  return result;
}

/// What more rows of the same kind would not make less: all but the noise of the rows.
bool stays(const CovarianceSource& source) {
  return source.name == "the maker's tolerances" || source.name == "held scale" ||
         source.name == kWhatWasGiven || source.name == kSharedErrors ||
         source.name == kImitatedLaws;
}

/// Cells of the box that the poses span: 1 sigma, and the mean of the residual vectors there; where
/// no row has any, what is expected of it, `lasting` being 1 sigma of what stays.
std::vector<GridCell> grid(const DataSet& data, const EndpointQuestion& question,
                           const EndpointSigma& sigma, const EndpointSigma& lasting,
                           const Judged& after) {
  const auto place = [&](const Eigen::VectorXd& q) {
    return locate(*question.robot, question.xi, q).p;
  };
  Eigen::AlignedBox3d box;
  std::vector<Eigen::Vector3d> at;
  for (Eigen::Index i = 0; i < question.poses.rows(); ++i) {
    at.push_back(place(question.poses.row(i).transpose()));
    box.extend(at.back());
  }
  const auto cell_of = [&](const Eigen::Vector3d& p) {
    int cell = 0;
    for (int k = 0; k < 3; ++k) {
      const double share = (p[k] - box.min()[k]) / std::max(box.sizes()[k], 1e-9);
      cell = kCells * cell + std::clamp(static_cast<int>(kCells * share), 0, kCells - 1);
    }
    return cell;
  };
  std::map<int, GridCell> cells;
  std::map<int, double> expected;  // squares
  for (size_t i = 0; i < at.size(); ++i) {
    GridCell& cell = cells[cell_of(at[i])];
    cell.center += at[i];
    cell.sigma += std::pow(sigma.by_pose[i], 2);
    expected[cell_of(at[i])] += std::pow(lasting.by_pose[i], 2);
    cell.poses += 1;
  }
  std::map<int, Eigen::Vector3d> sums;
  for (const auto* rows : {&after.fit, &after.check})
    for (const RowResidual& r : *rows) {
      if (r.lengths != 3 || !std::isfinite(r.length)) continue;
      const int cell = cell_of(place(data.rows.q.row(r.row).transpose()));
      if (!cells.contains(cell)) continue;
      auto [sum, fresh] = sums.try_emplace(cell, Eigen::Vector3d::Zero());
      sum->second += Eigen::Vector3d(r.scalars[0], r.scalars[1], r.scalars[2]);
      cells[cell].rows += 1;
    }
  std::vector<GridCell> list;
  for (auto& [index, cell] : cells) {
    cell.center /= cell.poses;
    cell.sigma = std::sqrt(cell.sigma / cell.poses);
    cell.bias =
        cell.rows > 0 ? sums[index].norm() / cell.rows : std::sqrt(expected[index] / cell.poses);
    list.push_back(cell);
  }
  return list;
}

}  // namespace

Uncertainty uncertainty(const Equations& equations, const Adjusted& adjusted,
                        const std::vector<CovarianceSource>& sources, const Judged& after,
                        const EndpointQuestion& question, const EndpointDeviations& deviations,
                        const EndpointSigma& sigma) {
  const DataSet& data = equations.data();
  const Noise& noise = adjusted.fitted.noise;
  const Eigen::Index n = equations.robot_columns();
  Uncertainty result;
  std::map<double, double> variance;  // by the freedoms: one estimate told all that has the same
  for (const CovarianceSource& source : sources) {
    const double sigma_of_it = endpoint_rms(deviations.weight, source.C.topLeftCorner(n, n));
    result.budget.push_back({std::string(source.name), sigma_of_it});
    variance[source.freedoms > 1 ? source.freedoms : 1] += std::pow(sigma_of_it, 2);
  }
  std::vector<VariancePart> parts;
  for (const auto& [freedoms, each] : variance) parts.push_back({each, freedoms});
  result.freedoms = effective_freedoms(parts);
  result.k = student_quantile((1 + kCoverage) / 2, std::max(result.freedoms, 1.0));
  result.expanded = result.k * sigma.rms;
  const std::vector<const RowResidual*> rows = used_rows(data, after, noise);
  result.lack_of_fit = lack_of_fit(data, rows, noise, freedoms_left(equations, adjusted));
  result.residuals = residual_tests(rows, noise);
  result.correlations = correlations(equations.robot(), sum(sources));
  result.repeats = pose_repeats(data, after);
  Eigen::MatrixXd lasting = Eigen::MatrixXd::Zero(n, n);
  for (const CovarianceSource& source : sources)
    if (stays(source)) lasting += source.C.topLeftCorner(n, n);
  result.grid = grid(data, question, sigma, endpoint_sigma(deviations, lasting), after);
  return result;
}

}  // namespace selfcal
