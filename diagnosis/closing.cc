// closed = 1 - (after^2 - floor^2) / (before^2 - floor^2); its interval by resampling the rows that
// judge. A judging row that neither model comes near is a false one: it would drown both figures,
// is left out of them and named.
#include "diagnosis/closing.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "constraints/judgement.h"
#include "constraints/statistics.h"
#include "kinematics/corrected_robot.h"

namespace selfcal {
namespace {

constexpr int kResamples = 1000;
constexpr double kFar = 1 - 1e-6;
constexpr double kBeyond = 1.25;       ///< a judging row's prediction has an error of its own
constexpr double kWithinFloor = 1.05;  ///< before over floor below which nothing can be said

struct Row {
  double before = 0, after = 0, floor = 0;  ///< squares (m^2)
};

std::optional<double> closed(const std::vector<Row>& rows) {
  double before = 0, after = 0, floor = 0;
  for (const Row& row : rows) {
    before += row.before;
    after += row.after;
    floor += row.floor;
  }
  if (!(before > kWithinFloor * kWithinFloor * floor)) return std::nullopt;
  return std::clamp(1 - (after - floor) / (before - floor), 0.0, 1.0);
}

void add_interval(const std::vector<Row>& rows, unsigned long long seed, Gap& gap) {
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<size_t> pick(0, rows.size() - 1);
  std::vector<double> list;
  std::vector<Row> drawn(rows.size());
  for (int i = 0; i < kResamples; ++i) {
    for (Row& row : drawn) row = rows[pick(random)];
    list.push_back(closed(drawn).value_or(0));
  }
  std::sort(list.begin(), list.end());
  gap.closed_least = list[static_cast<size_t>(0.025 * kResamples)];
  gap.closed_most = list[static_cast<size_t>(0.975 * kResamples)];
}

double rms(const std::vector<Row>& rows, double Row::*square) {
  double sum = 0;
  for (const Row& row : rows) sum += row.*square;
  return rows.empty() ? 0 : std::sqrt(sum / static_cast<double>(rows.size()));
}

double largest(const std::vector<Row>& rows, double Row::*square) {
  double most = 0;
  for (const Row& row : rows) most = std::max(most, row.*square);
  return std::sqrt(most);
}

Adjusted adjusted_model(const Equations& equations, const std::vector<double>& effect_sigma,
                        const DiagnosisOptions& options) {
  Options free;
  free.most_rejected = options.most_rejected;
  free.seed = options.seed;
  free.effect_sigma = effect_sigma;
  free.free = {"K*"};
  for (const Parameter& p : equations.robot().parameters())
    if (p.part == Part::effect) free.free.push_back(p.name);
  return adjust(equations, free, {});
}

}  // namespace

Closing close_gap(const std::shared_ptr<const Robot>& geometry, const Adjusted& before,
                  const DataSet& data, const Correction& correction, const Site& site, double noise,
                  const DiagnosisOptions& options) {
  Closing closing;
  Problems problems;
  closing.model = correct(geometry, correction.entries, site, problems);
  const Equations plain(*geometry, data, Use::fit), corrected(*closing.model, data, Use::fit);
  closing.after = adjusted_model(corrected, correction.sigma, options);
  const Judged nominal = judge(*geometry, data, plain, before.before);
  const Judged geometric = judge(*geometry, data, plain, before.fitted);
  const Judged whole = judge(*closing.model, data, corrected, closing.after.fitted);
  std::vector<Row> rows;
  double nominal_squares = 0;
  for (size_t i = 0; i < whole.check.size(); ++i) {
    const RowResidual& b = geometric.check[i];
    const RowResidual& a = whole.check[i];
    if (a.lengths == 0) continue;
    const double near = std::min(a.length, b.length), limit = chi_quantile(a.lengths, kFar);
    if (near > kBeyond * limit * std::max(noise, whole.check_scale[a.set].length)) {
      closing.rejected.push_back({a.row + 1, data.sets[a.set].name, a.length, true,
                                  "neither the geometry nor the named effects come near it"});
      continue;
    }
    rows.push_back({b.length * b.length, a.length * a.length, noise * noise * a.lengths});
    nominal_squares += std::pow(nominal.check[i].length, 2);
  }
  Gap& gap = closing.gap;
  gap.rows = static_cast<int>(rows.size());
  if (rows.empty()) return closing;
  gap.rms_nominal = std::sqrt(nominal_squares / static_cast<double>(rows.size()));
  gap.rms_before = rms(rows, &Row::before);
  gap.rms_after = rms(rows, &Row::after);
  gap.max_before = largest(rows, &Row::before);
  gap.max_after = largest(rows, &Row::after);
  gap.noise_floor = rms(rows, &Row::floor);
  gap.closed_fraction = closed(rows);
  if (gap.closed_fraction) add_interval(rows, options.seed, gap);
  return closing;
}

}  // namespace selfcal
