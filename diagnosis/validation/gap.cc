// closed = 1 - (after^2 - floor^2) / (before^2 - floor^2); its interval by resampling the rows that
// judge.
#include "diagnosis/validation/gap.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace selfcal {
namespace {

constexpr int kResamples = 1000;
constexpr double kWithinFloor = 1.05;  ///< before over floor below which nothing can be said

using Square = double JudgedRow::*;

std::optional<double> fraction(const std::vector<JudgedRow>& rows, Square square) {
  double before = 0, after = 0, floor = 0;
  for (const JudgedRow& row : rows) {
    before += row.before;
    after += row.*square;
    floor += row.floor;
  }
  if (!(before > kWithinFloor * kWithinFloor * floor)) return std::nullopt;
  return 1 - (after - floor) / (before - floor);
}

/// A resample that lies within the floor says that nothing is closed.
Closed closed(const std::vector<JudgedRow>& rows, Square square, unsigned long long seed) {
  Closed part{fraction(rows, square)};
  if (!part.fraction) return part;
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<size_t> pick(0, rows.size() - 1);
  std::vector<double> list;
  std::vector<JudgedRow> drawn(rows.size());
  for (int i = 0; i < kResamples; ++i) {
    for (JudgedRow& row : drawn) row = rows[pick(random)];
    list.push_back(fraction(drawn, square).value_or(0));
  }
  std::sort(list.begin(), list.end());
  part.least = list[static_cast<size_t>(0.025 * kResamples)];
  part.most = list[static_cast<size_t>(0.975 * kResamples)];
  return part;
}

double rms(const std::vector<JudgedRow>& rows, Square square) {
  double sum = 0;
  for (const JudgedRow& row : rows) sum += row.*square;
  return rows.empty() ? 0 : std::sqrt(sum / static_cast<double>(rows.size()));
}

double largest(const std::vector<JudgedRow>& rows, Square square) {
  double most = 0;
  for (const JudgedRow& row : rows) most = std::max(most, row.*square);
  return std::sqrt(most);
}

}  // namespace

Gap gap_of(const std::vector<JudgedRow>& rows, unsigned long long seed) {
  Gap gap;
  gap.rows = static_cast<int>(rows.size());
  if (rows.empty()) return gap;
  gap.rms_nominal = rms(rows, &JudgedRow::nominal);
  gap.rms_before = rms(rows, &JudgedRow::before);
  gap.rms_after = rms(rows, &JudgedRow::after);
  gap.rms_all = rms(rows, &JudgedRow::all);
  gap.max_before = largest(rows, &JudgedRow::before);
  gap.max_after = largest(rows, &JudgedRow::after);
  gap.max_all = largest(rows, &JudgedRow::all);
  gap.noise_floor = rms(rows, &JudgedRow::floor);
  gap.closed = closed(rows, &JudgedRow::after, seed);
  gap.closed_all = closed(rows, &JudgedRow::all, seed);
  return gap;
}

}  // namespace selfcal
