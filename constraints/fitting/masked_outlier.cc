#include "constraints/fitting/masked_outlier.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "constraints/fitting/row_deletion.h"
#include "constraints/statistics.h"

namespace selfcal {
namespace {

constexpr double kMaskedByChance = 1e-6;
constexpr double kLeastFreedom = 1e-6;            ///< of a set without a row
constexpr double kLeastOfNoise = 1e-9;            ///< that rows which fit exactly have: rounding
constexpr Eigen::Index kMostEquations = 3000;     ///< with more, none bends the fit alone
constexpr Eigen::Index kMostEntries = 1'000'000;  ///< of the equations held at once
/// Those whose absence makes most difference: of all rows, and of those left without some.
constexpr std::size_t kMostTried = 20, kMostTriedNext = 5;
/// Rows taken away, beyond the last that is false, before the others are believed: in few
/// equations, in many.
constexpr Eigen::Index kMostHidden = 8, kFewestHidden = 2;
constexpr double kOfNoise = 1.5;  ///< of the stated noise, from which false rows may make it
/// Where several rows are false all others are met by noise, of the stated or of what it was with
/// them.
constexpr double kOfSheet = 3, kOfWhole = 0.5;
constexpr double kSheet = 4;  ///< freedoms that a data sheet's noise is worth

/// A row's drop over what the others say that it should be, and that a good row's is as large.
struct Standing {
  double ratio = 0, chance = 1;
};

/// Whether the least squares can be held whole.
bool are_few(const Equations& equations, const State& state) {
  Eigen::Index count = 0, columns = equations.columns();
  for (std::size_t s = 0; s < equations.data().sets.size(); ++s) {
    const Method& method = *equations.data().sets[s].method;
    count += static_cast<Eigen::Index>(equations.plan(static_cast<int>(s)).items.size() *
                                       method.equations().size());
    columns += state.groups[s].cols() * method.group_freedom();
  }
  return count <= kMostEquations && count * columns <= kMostEntries;
}

/// Of some residuals, over the noise.
struct SquaresLeft {
  double squares = 0, freedom = 0;
  void add(double square, double one) { squares += square, freedom += one; }
  double variance() const { return squares / freedom; }
};

/// Sets that a data sheet's noise makes one.
bool is_of_kind(const DataSet& data, int a, int b) {
  const Set &one = data.sets[static_cast<std::size_t>(a)],
            &other = data.sets[static_cast<std::size_t>(b)];
  return one.method->name() == other.method->name() && one.noise == other.noise &&
         one.noise_angle == other.noise_angle;
}

/// The noise is told by what is left without the row in its set, or in all of its kind where that
/// is more, and is no less than stated.
Standing standing(const Equations& equations, const Noise& noise, const RowDeletion& all,
                  const Deletion& of) {
  const auto [left, freedom] = all.left_without(of);
  const auto sets = equations.data().sets.size();
  std::vector<char> of_kind(sets);
  for (std::size_t s = 0; s < sets; ++s)
    of_kind[s] = is_of_kind(equations.data(), static_cast<int>(s), of.set);
  const Scale& used = noise.used[static_cast<std::size_t>(of.set)];
  SquaresLeft own, kind;
  for (Eigen::Index i = 0; i < left.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const int set = all.set()[at];
    if (set < 0 || all.row()[at] == of.row || all.row()[at] < 0 ||
        !of_kind[static_cast<std::size_t>(set)])
      continue;
    const Quantity quantity = all.quantity()[at];
    const double square = std::pow(
        left[i] * (noise.used[static_cast<std::size_t>(set)].of(quantity) / used.of(quantity)), 2);
    kind.add(square, freedom[i]);
    if (set == of.set) own.add(square, freedom[i]);
  }
  if (!(own.freedom > kLeastFreedom)) return {};
  const Scale& stated = equations.stated(of.set);
  const double sheet = std::max(stated.length / used.length, stated.angle / used.angle);
  SquaresLeft told = kind.variance() > own.variance() ? kind : own;
  if (told.variance() < std::pow(kOfNoise * sheet, 2)) told.add(kSheet * sheet * sheet, kSheet);
  const double variance = std::max(told.variance(), std::pow(std::max(sheet, kLeastOfNoise), 2));
  const auto count = static_cast<double>(of.equations.size());
  const double ratio = of.drop / count / variance;
  return {ratio, f_exceeds(ratio, count, told.freedom)};
}

/// Rows that stand out, and the variance of what is left of the others and of all, over that of
/// their noise.
struct Found {
  std::vector<int> rows = {}, first = {};  ///< `first`: that of them which stands out among all
  double rest = HUGE_VAL, whole = 0;
};

double variance_of(const RowDeletion& all) {
  SquaresLeft rest;
  for (Eigen::Index i = 0; i < all.left().size(); ++i)
    if (all.row()[static_cast<std::size_t>(i)] >= 0)
      rest.add(std::pow(all.left()[i], 2), all.freedom()[i]);
  return rest.freedom > 0 ? rest.variance() : HUGE_VAL;
}

/// By that noise, of `share` of the rows and two sigma of that.
Found standing_out(const Equations& equations, const State& state, const Noise& noise,
                   const Prior& prior, double share) {
  RowDeletion all(equations, state, noise, prior);
  std::vector<Deletion> deletions = all.deletions();
  const auto hidden = static_cast<std::size_t>(
      std::clamp(kMostEquations / std::max<Eigen::Index>(all.freedom().size(), 1), kFewestHidden,
                 kMostHidden));
  const double expected = share * static_cast<double>(deletions.size());
  const auto most =
      std::max<std::size_t>(1, static_cast<std::size_t>(expected + 2 * std::sqrt(expected)));
  Found found{.whole = variance_of(all)};
  std::vector<int> rows;
  while (rows.size() < std::min(most, found.rows.size() + hidden) && !deletions.empty()) {
    std::ranges::sort(deletions, std::greater(), &Deletion::drop);
    deletions.resize(std::min(deletions.size(), rows.empty() ? kMostTried : kMostTriedNext));
    std::vector<Standing> standings;
    for (const Deletion& each : deletions)
      standings.push_back(standing(equations, noise, all, each));
    const auto first = std::ranges::max_element(standings, {}, &Standing::ratio);
    const Deletion& row = deletions[static_cast<std::size_t>(first - standings.begin())];
    rows.push_back(row.row);
    all.take_away(row);
    if (first->chance < kMaskedByChance) {
      found.rows = rows;
      if (rows.size() == 1) found.first = rows;
      found.rest = variance_of(all);
    }
    deletions = all.deletions();
  }
  return found;
}

/// As its data sheets state it, where they do and it is more.
std::optional<Noise> as_stated(const Equations& equations, Noise noise) {
  bool more = false;
  const auto take = [&](double& used, double stated) {
    if (!(stated > 0) || used <= kOfNoise * stated) return;
    used = stated;
    more = true;
  };
  for (std::size_t s = 0; s < noise.used.size(); ++s) {
    const Scale& stated = equations.stated(static_cast<int>(s));
    take(noise.used[s].length, stated.length);
    take(noise.used[s].angle, stated.angle);
  }
  return more ? std::optional(std::move(noise)) : std::nullopt;
}

}  // namespace

std::vector<int> masked_outliers(const Equations& equations, const State& state, const Noise& noise,
                                 const Prior& prior, double share) {
  if (free_columns(equations, prior).empty() || !are_few(equations, state)) return {};
  Found found = standing_out(equations, state, noise, prior, share);
  if (found.rows.size() == 1 || found.rest < kOfWhole * kOfWhole * found.whole) return found.rows;
  // Where false rows make the noise, the tolerances bar the way to a robot that meets the others.
  if (const std::optional<Noise> stated = as_stated(equations, noise)) {
    Found some = standing_out(equations, state, *stated, prior, share);
    if (some.rest < kOfSheet * kOfSheet) return std::move(some.rows);
  }
  return std::move(found.first);
}

}  // namespace selfcal
