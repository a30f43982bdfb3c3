// closed = 1 - (after^2 - floor^2) / (before^2 - floor^2). Its interval: blocks of rows are drawn
// with replacement (Kuensch 1989: rows that follow each other err alike), and with each draw the
// floor's variance, which nu freedoms tell up to nu / chi-square(nu).
#include "diagnosis/validation/gap.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <random>
#include <utility>

#include "diagnosis/constants.h"

namespace selfcal {
namespace {

using Square = double ValidationRow::*;

struct Sums {
  double before = 0, after = 0, floor = 0;
};

/// By block.
std::vector<Sums> sums_of(const std::vector<ValidationRow>& rows, Square square) {
  std::map<int, Sums> blocks;
  for (const ValidationRow& row : rows) {
    Sums& sums = blocks[row.block];
    sums.before += row.before;
    sums.after += row.*square;
    sums.floor += row.floor;
  }
  std::vector<Sums> list;
  for (const auto& [block, sums] : blocks) list.push_back(sums);
  return list;
}

std::optional<double> fraction(const Sums& of) {
  if (!(of.before >
        kDiagnosis.validation.within_floor * kDiagnosis.validation.within_floor * of.floor))
    return std::nullopt;
  return 1 - (of.after - of.floor) / (of.before - of.floor);
}

Sums total(const std::vector<Sums>& list) {
  Sums sum;
  for (const Sums& each : list) {
    sum.before += each.before;
    sum.after += each.after;
    sum.floor += each.floor;
  }
  return sum;
}

/// A resample within the floor may say anything: it counts at either end.
Closed closed(const std::vector<ValidationRow>& rows, Square square, unsigned long long seed,
              double floor_freedom) {
  const std::vector<Sums> blocks = sums_of(rows, square);
  Closed part{fraction(total(blocks))};
  part.too_few = blocks.size() < kDiagnosis.validation.fewest_blocks;
  if (!part.fraction || part.too_few) return part;
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<size_t> pick(0, blocks.size() - 1);
  std::chi_squared_distribution<double> spread(std::isfinite(floor_freedom) ? floor_freedom : 1);
  std::vector<double> low, high;
  std::vector<Sums> drawn(blocks.size());
  for (int i = 0; i < kDiagnosis.validation.resamples; ++i) {
    for (Sums& each : drawn) each = blocks[pick(random)];
    Sums sum = total(drawn);
    if (std::isfinite(floor_freedom)) sum.floor *= floor_freedom / spread(random);
    const std::optional<double> each = fraction(sum);
    low.push_back(each.value_or(-INFINITY));
    high.push_back(each.value_or(INFINITY));
  }
  std::sort(low.begin(), low.end());
  std::sort(high.begin(), high.end());
  part.least = low[static_cast<size_t>(kDiagnosis.validation.beside_interval *
                                       kDiagnosis.validation.resamples)];
  part.most = high[static_cast<size_t>((1 - kDiagnosis.validation.beside_interval) *
                                       kDiagnosis.validation.resamples)];
  return part;
}

double rms(const std::vector<ValidationRow>& rows, Square square) {
  double sum = 0;
  for (const ValidationRow& row : rows) sum += row.*square;
  return rows.empty() ? 0 : std::sqrt(sum / static_cast<double>(rows.size()));
}

double largest(const std::vector<ValidationRow>& rows, Square square) {
  double most = 0;
  for (const ValidationRow& row : rows) most = std::max(most, row.*square);
  return std::sqrt(most);
}

}  // namespace

Gap gap_of(const std::vector<ValidationRow>& all, unsigned long long seed, double floor_freedom,
           std::string validated_on) {
  Gap gap;
  gap.validated_on = std::move(validated_on);
  gap.with_false_rows = {rms(all, &ValidationRow::before), rms(all, &ValidationRow::after),
                         rms(all, &ValidationRow::all)};
  std::vector<ValidationRow> rows;
  std::ranges::copy_if(all, std::back_inserter(rows),
                       [](const ValidationRow& row) { return !row.false_reading; });
  const auto most = kDiagnosis.validation.most_false * static_cast<double>(all.size());
  if (static_cast<double>(all.size() - rows.size()) > std::max(1.0, most)) rows = all;
  gap.rows = static_cast<int>(rows.size());
  gap.false_rows = static_cast<int>(all.size() - rows.size());
  if (rows.empty()) return gap;
  gap.rms_nominal = rms(rows, &ValidationRow::nominal);
  gap.rms_before = rms(rows, &ValidationRow::before);
  gap.rms_after = rms(rows, &ValidationRow::after);
  gap.rms_all = rms(rows, &ValidationRow::all);
  gap.max_before = largest(rows, &ValidationRow::before);
  gap.max_after = largest(rows, &ValidationRow::after);
  gap.max_all = largest(rows, &ValidationRow::all);
  gap.noise_floor = rms(rows, &ValidationRow::floor);
  gap.closed = closed(rows, &ValidationRow::after, seed, floor_freedom);
  gap.closed_all = closed(rows, &ValidationRow::all, seed, floor_freedom);
  return gap;
}

}  // namespace selfcal
