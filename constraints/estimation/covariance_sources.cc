// With C0 the posterior of the free unknowns and Lambda the precision of their priors
//   C0 = (C0 - C0 Lambda C0) + C0 Lambda C0,
// the first of the rows' noise, the second of the priors; the others come on top. The rows' part is
// that of each set, C0 R_s^T R_s C0, a share of it the encoders' rounding, another what repeats
// differ by beside that.
#include "constraints/estimation/covariance_sources.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "constraints/equations/resolution.h"
#include "constraints/estimation/half_samples.h"
#include "constraints/estimation/posterior.h"
#include "constraints/fitting/noise.h"
#include "constraints/identifiability/endpoint_sigma.h"
#include "constraints/solution.h"
#include "constraints/statistics.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

/// Halves in time of rows with independent noise differ by up to so much more than is expected.
constexpr double kMoreThanChance = 1.5;
/// How often any of the halves by configuration shows a law where there is none.
constexpr double kByChance = 0.05;

Eigen::MatrixXd prior_part(const Equations& equations, const Adjusted& adjusted) {
  const Eigen::MatrixXd& C = adjusted.fitted.covariance;
  return transposed_product(C, prior_precision(equations, adjusted.prior).asDiagonal() * C);
}

/// Rows that a row of the set is a repeat of, itself among them, on average over its rows that took
/// part.
double rows_of_a_configuration(const Equations& equations, int set,
                               const std::vector<char>& outlier) {
  const Observations& rows = equations.data().rows;
  std::map<int, double> count;  // by repeat
  double all = 0, squares = 0;
  for (const SetPlan::Item& item : equations.plan(set).items) {
    if (outlier[static_cast<size_t>(item.row)]) continue;
    ++all;
    if (const int repeat = rows.repeat[static_cast<size_t>(item.row)]; repeat >= 0)
      ++count[repeat];
    else
      ++squares;
  }
  for (const auto& [repeat, times] : count) squares += times * times;
  return all > 0 ? squares / all : 1;
}

/// Of the lengths, or of the angles where the set has no lengths.
double of_set(const DataSet& data, size_t set, const Scale& scale) {
  return data.sets[set].method->has_lengths() ? scale.length : scale.angle;
}

/// Of the set's noise, so many times more: repeats, which differ by `spread`, have the rest of what
/// is left of the rows in common (the design effect of Kish, 1 + (n - 1) rho).
double shared_by_repeats(const Equations& equations, const Fit& fitted, int set, double spread) {
  const auto s = static_cast<size_t>(set);
  const double left = of_set(equations.data(), s, fitted.noise.estimated[s]);
  const double used = of_set(equations.data(), s, fitted.noise.used[s]);
  const double rho = std::max(0.0, 1 - std::pow(spread / left, 2));
  const double n = rows_of_a_configuration(equations, set, fitted.noise.outlier);
  return std::max(0.0, std::pow(left / used, 2) * (1 + (n - 1) * rho) - 1);
}

/// What immediate repeats differ by, by set (m, or rad without lengths); negative without any.
std::vector<double> spreads_of_repeats(const Equations& equations, const Fit& fitted) {
  const DataSet& data = equations.data();
  std::vector<double> spreads(data.sets.size(), -1);
  if (data.rows.repeat.empty()) return spreads;
  const std::vector<RowResidual> residuals = equations.residuals(fitted.state);
  for (size_t s = 0; s < spreads.size(); ++s)
    if (!equations.plan(static_cast<int>(s)).items.empty()) {
      const RepeatSpreads each =
          repeat_spreads(data, static_cast<int>(s), residuals, fitted.noise.outlier);
      spreads[s] = of_set(data, s, {each.length.sigma(), each.angle.sigma()});
    }
  return spreads;
}

/// By how much the squares of what is left of the rows are more than a data sheet or repeats say of
/// their noise, on average over the rows; a set that neither speaks of has no more.
double over_stated(const Equations& equations, const Fit& fitted,
                   const std::vector<double>& spreads) {
  double sum = 0, count = 0;
  for (size_t s = 0; s < spreads.size(); ++s) {
    const int set = static_cast<int>(s);
    const DataSet& data = equations.data();
    const auto rows = static_cast<double>(equations.plan(set).items.size());
    const double told = std::max(of_set(data, s, equations.stated(set)), spreads[s]);
    const double left = of_set(data, s, fitted.noise.estimated[s]);
    const double over = told > 0 ? std::pow(left / told, 2) : 1;
    sum += rows * std::max(1.0, over);
    count += rows;
  }
  return count > 0 ? sum / count : 1;
}

/// The noise of the rows by where it comes from; `all` is what they add up to where rows err apart.
std::vector<CovarianceSource> noise_parts(const Equations& equations, const Adjusted& adjusted,
                                          const std::vector<double>& spreads,
                                          const Eigen::MatrixXd& all) {
  const Fit& fitted = adjusted.fitted;
  const std::vector<double> rounding =
      resolution_shares(equations, fitted.state, fitted.noise.used, fitted.noise.outlier);
  const Observations& rows = equations.data().rows;
  Eigen::MatrixXd encoders = Eigen::MatrixXd::Zero(all.rows(), all.cols()), repeats = encoders,
                  shared = encoders;
  for (int s = 0; s < static_cast<int>(rounding.size()); ++s) {
    if (equations.plan(s).items.empty()) continue;
    const double told = spreads[static_cast<size_t>(s)];
    const double spread = std::max(0.0, told);
    const double in_common = told < 0 ? 0 : shared_by_repeats(equations, fitted, s, spread);
    const double coarse = std::min(1.0, rounding[s]);
    const double used = of_set(equations.data(), static_cast<size_t>(s), fitted.noise.used[s]);
    const double repeated = std::clamp(std::pow(spread / used, 2) - coarse, 0.0, 1 - coarse);
    if (coarse + repeated + in_common == 0) continue;
    Weighting alone{fitted.noise.used, fitted.noise.outlier};
    alone.passed_over = true;
    for (int row = 0; row < rows.rows(); ++row)
      if (rows.set[static_cast<size_t>(row)] != s) alone.outlier[static_cast<size_t>(row)] = 1;
    const Eigen::MatrixXd R = equations.linearise(fitted.state, alone).R;
    const Eigen::MatrixXd half =
        R.leftCols(equations.columns()) * fitted.covariance.topLeftCorner(all.rows(), all.cols());
    const Eigen::MatrixXd of_its_rows = transposed_product(half, half);
    encoders += coarse * of_its_rows;
    repeats += repeated * of_its_rows;
    shared += in_common * of_its_rows;
  }
  const double freedoms = freedoms_left(equations, adjusted);
  return {{kNoiseOfRows, all - encoders - repeats, freedoms},
          {"resolution of the encoders", encoders},
          {"repeatability, from repeats", repeats, freedoms},
          {"noise that repeats share", shared, freedoms}};
}

/// The end position's, of a covariance whose first columns are the robot's parameters (m^2).
double squared(const Eigen::MatrixXd& weight, const Eigen::MatrixXd& C) {
  return std::pow(endpoint_rms(weight, C.topLeftCorner(weight.rows(), weight.cols())), 2);
}

/// What halves of the rows differ by more than they should.
struct BeyondChance {
  Eigen::MatrixXd in_time;
  Eigen::MatrixXd beside;  ///< what those of the configurations show more of than these
  double freedoms_in_time = HUGE_VAL, freedoms_beside = HUGE_VAL;
};

/// A sum of squares of normal variables is nearly a chi-square of these freedoms (Satterthwaite).
double freedoms_of(const Eigen::MatrixXd& weight, const Eigen::MatrixXd& expected) {
  const Eigen::MatrixXd of_normal = product(weight, expected);
  return std::pow(of_normal.trace(), 2) / of_normal.cwiseProduct(of_normal.transpose()).sum();
}

/// `noise` is what the rows' noise makes, and `by_repeats` what repeats share makes more of it: of
/// halves in proportion.
BeyondChance beyond_chance(const Equations& equations, const Adjusted& adjusted,
                           const Eigen::MatrixXd& weight, const Eigen::MatrixXd& noise,
                           const Eigen::MatrixXd& by_repeats) {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(by_repeats.rows(), by_repeats.cols());
  BeyondChance found{none, none};
  if (weight.isZero(0)) return found;
  const double of_noise = squared(weight, noise);
  const double more = of_noise > 0 ? 1 + squared(weight, by_repeats) / of_noise : 1;
  const HalfSampling halves = half_samples(equations, adjusted);
  const double in_time = squared(weight, halves.in_time.seen);
  const double of_time =
      std::max(0.0, in_time - kMoreThanChance * more * squared(weight, halves.in_time.expected));
  if (of_time > 0) {
    found.in_time = of_time / in_time * halves.in_time.seen;
    found.freedoms_in_time = kHalvesInTime * freedoms_of(weight, halves.in_time.expected);
  }
  double most = of_time;
  for (const HalfSamples& each : halves.by_configuration) {
    const double seen = squared(weight, each.seen);
    const double expected = more * squared(weight, each.expected);
    const double freedoms = freedoms_of(weight, each.expected);
    const double tries = static_cast<double>(halves.by_configuration.size());
    if (seen - expected <= most ||
        chi_square_exceeds(freedoms * seen / expected, freedoms) > kByChance / tries)
      continue;
    found.beside = (seen - expected - of_time) / seen * each.seen;
    found.freedoms_beside = freedoms;
    most = seen - expected;
  }
  return found;
}

}  // namespace

double freedoms_left(const Equations& equations, const Adjusted& adjusted) {
  const Eigen::MatrixXd& C = adjusted.fitted.covariance;
  double determined = equations.nuisance_dimensions();
  for (int c = 0; c < equations.robot_columns(); ++c)
    if (adjusted.prior.free[static_cast<size_t>(c)])
      determined += 1 - C(c, c) * std::pow(prior_weight(equations, adjusted.prior, c), 2);
  return adjusted.fitted.at.equations - determined;
}

std::vector<CovarianceSource> covariance_sources(const Equations& equations,
                                                 const Adjusted& adjusted, const Eigen::MatrixXd& R,
                                                 const Eigen::MatrixXd& weight) {
  const Eigen::MatrixXd& fitted = adjusted.fitted.covariance;
  const Eigen::MatrixXd priors = prior_part(equations, adjusted), noise = fitted - priors;
  const Eigen::MatrixXd exact =
      adjusted.scale < 0 ? fitted : posterior(equations, adjusted, R, false);
  const std::vector<double> spreads = spreads_of_repeats(equations, adjusted.fitted);
  std::vector<CovarianceSource> sources = noise_parts(equations, adjusted, spreads, noise);
  const Eigen::MatrixXd& by_repeats = sources.back().C;
  BeyondChance halves = beyond_chance(equations, adjusted, weight, noise, by_repeats);
  const double apart = squared(weight, noise);
  const double together = squared(weight, halves.in_time) + squared(weight, by_repeats);
  const Structure structure{apart > 0 ? 1 + together / apart : 1,
                            over_stated(equations, adjusted.fitted, spreads)};
  sources.push_back({"the maker's tolerances", priors});
  sources.push_back({"held scale", exact - fitted});
  sources.push_back({kWhatWasGiven, posterior(equations, adjusted, R, true, structure) - exact});
  sources.push_back({kSharedErrors, std::move(halves.in_time), halves.freedoms_in_time});
  sources.push_back({kImitatedLaws, std::move(halves.beside), halves.freedoms_beside});
  return sources;
}

Eigen::MatrixXd sum(const std::vector<CovarianceSource>& sources) {
  Eigen::MatrixXd C = sources.front().C;
  for (size_t i = 1; i < sources.size(); ++i) C += sources[i].C;
  return C;
}

}  // namespace selfcal
