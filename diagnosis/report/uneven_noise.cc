// Ranks of the squares against what they may go along with (Spearman); in several directions at
// once R^2 (n - 1) of the regression of the ranks, a chi-square.
#include "diagnosis/report/uneven_noise.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <vector>

#include "constraints/statistics.h"
#include "diagnosis/constants.h"
#include "diagnosis/search/naming.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

constexpr double kStep = 1e-3;  ///< s, of a derivative along the velocity
constexpr const char* kOtherEnd = "as at the other end";

/// What a configuration's rows leave, in units of its set's.
struct Loudness {
  std::vector<int> row;  ///< the first of each configuration's
  Eigen::VectorXd squares;
};

/// Standardised ranks; of equal values the mean.
Eigen::VectorXd ranks(const Eigen::VectorXd& values) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](Eigen::Index i) { return values[i]; });
  Eigen::VectorXd rank(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first;
    while (last + 1 < order.size() && values[order[last + 1]] == values[order[first]]) ++last;
    for (std::size_t i = first; i <= last; ++i)
      rank[order[i]] = static_cast<double>(first + last) / 2;
    first = last + 1;
  }
  rank.array() -= rank.mean();
  return rank / std::max(rank.norm() / std::sqrt(static_cast<double>(rank.size())), 1e-12);
}

/// Those of one number by row are one, such as configurations.
Loudness loudness(const LinearisedModel& linearised, const DataSet& data,
                  const std::vector<int>& number) {
  const DenseEquations rows = linearised.kept();
  const Eigen::VectorXd left = linearised.left();
  const Eigen::VectorXd leaves = linearised.geometry_leaves(linearised.whitened_geometry());
  struct Sum {
    int row = -1;
    double squares = 0, freedom = 0;
  };
  std::map<int, Sum> sums;
  std::map<int, Sum> of_set;
  for (std::size_t i = 0; i < rows.row.size(); ++i) {
    const int row = rows.row[i];
    if (row < 0) continue;
    const auto at = static_cast<Eigen::Index>(i);
    Sum& sum = sums[number[static_cast<std::size_t>(row)]];
    if (sum.row < 0) sum.row = row;
    for (Sum* each : {&sum, &of_set[data.rows.set[static_cast<std::size_t>(row)]]}) {
      each->squares += left[at] * left[at];
      each->freedom += leaves[at];
    }
  }
  Loudness all;
  std::vector<double> squares;
  for (const auto& [key, sum] : sums) {
    const Sum& set = of_set[data.rows.set[static_cast<std::size_t>(sum.row)]];
    if (!(sum.freedom > kDiagnosis.uneven.least_freedom) || !(set.squares > 0)) continue;
    all.row.push_back(sum.row);
    squares.push_back(sum.squares / sum.freedom / (set.squares / set.freedom));
  }
  all.squares =
      Eigen::Map<const Eigen::VectorXd>(squares.data(), static_cast<Eigen::Index>(squares.size()));
  return all;
}

/// m/s, of the tool; NaN where a row says nothing.
Eigen::VectorXd tool_speeds(const LinearisedModel& linearised, const DataSet& data,
                            const std::vector<int>& rows) {
  Eigen::VectorXd speeds =
      Eigen::VectorXd::Constant(static_cast<Eigen::Index>(rows.size()), std::nan(""));
  if (!data.speeds || data.rows.velocity.rows() == 0) return speeds;
  const Robot& robot = linearised.geometry();
  const Eigen::VectorXd& xi = linearised.adjusted().fitted.state.xi;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::VectorXd q = data.rows.q.row(rows[i]).transpose();
    const Eigen::VectorXd v = data.rows.velocity.row(rows[i]).transpose();
    if (!v.allFinite()) continue;
    const Eigen::Vector3d way =
        locate(robot, xi, q + kStep * v).p - locate(robot, xi, q - kStep * v).p;
    speeds[static_cast<Eigen::Index>(i)] = way.norm() / (2 * kStep);
  }
  return speeds;
}

/// The third of the configurations where `along` is least, and that where it is most.
struct Thirds {
  std::vector<Eigen::Index> least, most;
};

Thirds thirds(const Eigen::VectorXd& along) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(along.size()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](Eigen::Index i) { return along[i]; });
  const auto third = static_cast<std::ptrdiff_t>(order.size() / 3);
  return {{order.begin(), order.begin() + third}, {order.end() - third, order.end()}};
}

/// rms of the one third over that of the other.
double times_as_much(const Eigen::VectorXd& squares, const Thirds& of) {
  return std::sqrt(squares(of.most).sum() / std::max(squares(of.least).sum(), 1e-12));
}

/// One row in every so many of the file, that scatters more than all others or is put aside as
/// false more often.
UnevenNoise one_in_every(const LinearisedModel& linearised, const DataSet& data) {
  std::vector<int> number(static_cast<std::size_t>(data.rows.rows()));
  std::iota(number.begin(), number.end(), 0);
  Loudness all = loudness(linearised, data, number);
  for (std::size_t row = 0; row < number.size(); ++row)
    if (linearised.outlier()[row]) all.row.push_back(static_cast<int>(row));
  const Eigen::Index kept = all.squares.size();
  all.squares.conservativeResize(static_cast<Eigen::Index>(all.row.size()));
  all.squares.tail(all.squares.size() - kept).setConstant(kDiagnosis.uneven.put_aside);
  UnevenNoise most;
  int asked = 0;
  for (int every = 2; every <= kDiagnosis.uneven.most_every; ++every)
    for (int first = 0; first < every; ++first) {
      Eigen::VectorXd is(all.squares.size());
      for (Eigen::Index i = 0; i < is.size(); ++i)
        is[i] = all.row[static_cast<std::size_t>(i)] % every == first ? 1 : 0;
      if (is.sum() < kDiagnosis.uneven.fewest_of_every) continue;
      ++asked;
      const double p = probability_of_even(all.squares, is);
      if (p >= most.p) continue;
      most.p = p;
      most.times = std::sqrt(is.dot(all.squares) / is.sum() /
                             std::max(all.squares.dot((1 - is.array()).matrix()) /
                                          (static_cast<double>(is.size()) - is.sum()),
                                      1e-12));
      most.where = "in one of every " + std::to_string(every) + " rows (" +
                   std::to_string(first + 1) + ", " + std::to_string(first + 1 + every) + ", " +
                   std::to_string(first + 1 + 2 * every) + ", …)";
    }
  most.than = "as in all others";
  most.p = std::min(1.0, most.p * asked);
  return most;
}

}  // namespace

double probability_of_even(const Eigen::VectorXd& squares, const Eigen::MatrixXd& along) {
  const auto n = static_cast<double>(squares.size());
  const Eigen::VectorXd loud = ranks(squares);
  if (along.cols() == 1) {
    const double z = ranks(along.col(0)).dot(loud) / n * std::sqrt(n - 1);
    return std::erfc(z / std::sqrt(2.0)) / 2;
  }
  Eigen::MatrixXd X(along.rows(), along.cols());
  for (Eigen::Index c = 0; c < along.cols(); ++c) X.col(c) = ranks(along.col(c));
  const double explained = (X * least_squares(X, loud)).squaredNorm() / n;
  return -std::expm1(log_chi_square_below(explained * (n - 1), static_cast<double>(along.cols())));
}

std::optional<UnevenNoise> uneven_noise(const LinearisedModel& linearised, const DataSet& data) {
  const Loudness all = loudness(linearised, data, configurations(data.rows));
  if (all.squares.size() < kDiagnosis.uneven.fewest) return std::nullopt;
  std::vector<UnevenNoise> asked;
  const Eigen::VectorXd speeds = tool_speeds(linearised, data, all.row);
  if (speeds.allFinite())
    asked.push_back({"where the tool moves fast", kOtherEnd,
                     times_as_much(all.squares, thirds(speeds)),
                     probability_of_even(all.squares, speeds)});
  const Eigen::MatrixXd places = linearised.tips()(all.row, Eigen::all);
  Eigen::MatrixXd X(places.rows(), 4);
  X << places, Eigen::VectorXd::Ones(places.rows());
  const Thirds that_way = thirds(X * least_squares(X, ranks(all.squares)));
  const Eigen::Vector3d middle = places(that_way.most, Eigen::all).colwise().mean();
  asked.push_back({with_figures("about (%.2g, %.2g, %.2g) m", middle.x(), middle.y(), middle.z()),
                   kOtherEnd, times_as_much(all.squares, that_way),
                   probability_of_even(all.squares, places)});
  asked.push_back(one_in_every(linearised, data));
  UnevenNoise& most = *std::ranges::min_element(asked, {}, &UnevenNoise::p);
  most.p = std::min(1.0, most.p * static_cast<double>(asked.size()));
  if (most.p > kDiagnosis.uneven.by_chance || most.times < kDiagnosis.uneven.times)
    return std::nullopt;
  return most;
}

std::string uneven_in_words(const UnevenNoise& uneven) {
  return "the rows scatter " + with_figures("%.2g", uneven.times) + " times as much " +
         uneven.where + " " + uneven.than +
         with_figures(" (even noise does so in %.2g of cases)",
                      std::max(uneven.p, kDiagnosis.naming.least_p));
}

void doubt_even_noise(const LinearisedModel& linearised, const DataSet& data,
                      Diagnosis& diagnosis) {
  if (diagnosis.verdict.effect != kNone) return;
  const std::optional<UnevenNoise> uneven = uneven_noise(linearised, data);
  if (!uneven) return;
  diagnosis.uneven = uneven_in_words(*uneven);
  diagnosis.p_value = std::max(uneven->p, kDiagnosis.naming.least_p);
  say_unknown(kDiagnosis.uneven.probability, diagnosis.candidates, diagnosis.verdict);
}

std::string warning_of_uneven_noise(const LinearisedModel& linearised, const DataSet& data,
                                    const Diagnosis& diagnosis) {
  if (!names_effect(diagnosis.verdict.effect)) return {};
  const std::optional<UnevenNoise> uneven = uneven_noise(linearised, data);
  return uneven ? uneven_in_words(*uneven) : std::string();
}

}  // namespace selfcal
