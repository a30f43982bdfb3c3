// What a change of a design makes of it against the same design made anew.
#include "constraints/planning/design.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "constraints/identifiability/observability.h"
#include "constraints/planning/detmax.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr int kCandidates = 40, kColumns = 9, kNuisance = 3;

std::vector<Eigen::MatrixXd> drawn_rows(int k, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<Eigen::MatrixXd> list(kCandidates, Eigen::MatrixXd(k, kColumns));
  for (Eigen::MatrixXd& w : list)
    for (double& each : w.reshaped()) each = normal(random);
  return list;
}

Eigen::MatrixXd rows_of_chosen(const std::vector<Eigen::MatrixXd>& rows,
                               const std::vector<int>& chosen) {
  Eigen::MatrixXd W(0, kColumns);
  for (const int i : chosen) {
    W.conservativeResize(W.rows() + rows[i].rows(), Eigen::NoChange);
    W.bottomRows(rows[i].rows()) = rows[i];
  }
  return W;
}

/// The index as observability() has it, the nuisance columns projected out; sigma as it is defined.
double by_definition(const Objective& objective, const std::vector<Eigen::MatrixXd>& rows,
                     const std::vector<int>& chosen) {
  const Eigen::MatrixXd W = rows_of_chosen(rows, chosen);
  if (objective.criterion == Criterion::sigma) {
    const Eigen::MatrixXd H = objective.prior + W.transpose() * W;
    return std::sqrt((objective.weight * H.inverse()).trace());
  }
  const Observability o =
      observability(beyond(W.rightCols(kNuisance), W.leftCols(kColumns - kNuisance)), 1);
  switch (objective.criterion) {
    case Criterion::o1:
      return o.o1;
    case Criterion::o3:
      return o.o3;
    case Criterion::o4:
      return o.o4;
    case Criterion::o5:
      return o.o5;
    default:
      return o.o2;
  }
}

/// The same from the merit.
double by_merit(const Objective& objective, double merit) {
  if (objective.criterion == Criterion::sigma) return std::sqrt(-merit);
  if (objective.criterion == Criterion::o1)  // det(WᵀW) = (s_1 ... s_m)²
    return std::exp(merit / 2 / (kColumns - kNuisance));
  return std::exp(merit);
}

Objective objective_of(Criterion criterion, std::mt19937_64& random) {
  Objective objective;
  objective.criterion = criterion;
  objective.nuisance = kNuisance;
  if (criterion != Criterion::sigma) return objective;
  objective.prior = 0.5 * Eigen::MatrixXd::Identity(kColumns, kColumns);
  const Eigen::MatrixXd J = rows_of_chosen(drawn_rows(1, random), {0, 1, 2, 3});
  objective.weight = J.transpose() * J;
  return objective;
}

TEST(Design, HasTheMeritOfItsDefinitionAfterAnyChange) {
  std::mt19937_64 random(1);
  for (const std::string_view name : criterion_names())
    for (const int k : {1, 2, 3, 6}) {
      const auto rows = drawn_rows(k, random);
      const Objective objective = objective_of(*criterion_of(name), random);
      Design design(rows, objective);
      design.choose(random_choice(kCandidates, 14, random));
      for (int i = 0; i < 6; ++i) {
        const auto [added, with] = design.best(+1);
        design.change(added, +1);
        EXPECT_NEAR(design.merit(), with, 1e-9 * std::abs(with)) << name;
        const auto [removed, without] = design.best(-1);
        design.change(removed, -1);
        EXPECT_NEAR(design.merit(), without, 1e-9 * std::abs(without)) << name;
        // The ridge of 1e-10 and rounding through a dozen changes.
        const double defined = by_definition(objective, rows, design.chosen());
        EXPECT_NEAR(by_merit(objective, design.merit()), defined, 1e-7 * defined) << name;
      }
    }
}

TEST(Design, TakesTheBestOfItsKindInsteadOfOneOfTheChosen) {
  std::mt19937_64 random(2);
  std::vector<int> kinds;  // the second stands among those of the others
  for (int i = 0; i < kCandidates; ++i) kinds.push_back(i % 5 == 3 ? 1 : i < 25 ? 0 : 2);
  for (const Criterion criterion : {Criterion::sigma, Criterion::o1})
    for (const int k : {1, 2}) {
      const auto rows = drawn_rows(k, random);
      const Objective objective = objective_of(criterion, random);
      Design design(rows, objective, kinds);
      design.choose(random_choice(kCandidates, 12, random));
      const double before = design.merit();
      const std::pair<int, double> next = design.best(+1);
      for (const int out : design.chosen()) {
        const auto [in, merit] = design.best_instead_of(out);
        int best = -1;
        double most = -HUGE_VAL;
        for (int each = 0; each < kCandidates; ++each) {
          std::vector<int> other = design.chosen();
          if (kinds[each] != kinds[out] || (each != out && std::ranges::count(other, each) > 0))
            continue;
          *std::ranges::find(other, out) = each;
          const double defined = by_definition(objective, rows, other);
          const double good = criterion == Criterion::sigma ? -defined : defined;
          if (good <= most) continue;
          most = good;
          best = each;
        }
        EXPECT_EQ(in, best);
        EXPECT_NEAR(by_merit(objective, merit), std::abs(most), 1e-7 * std::abs(most));
        EXPECT_TRUE(design.has(out));
        EXPECT_NEAR(design.merit(), before, 1e-9 * std::abs(before)) << "nothing has changed";
        EXPECT_EQ(design.best(+1).first, next.first);
        EXPECT_NEAR(design.best(+1).second, next.second, 1e-9 * std::abs(next.second));
      }
    }
}

TEST(Design, KnowsTheMeritOfMeasurementsThatAreNoCandidates) {
  std::mt19937_64 random(3);
  for (const std::string_view name : criterion_names())
    for (const int k : {1, 2, 3}) {
      auto rows = drawn_rows(k, random);
      const Objective objective = objective_of(*criterion_of(name), random);
      Design design(rows, objective);
      design.choose({0, 1, 2, 3, 4, 5, 6, 7, 8});
      const std::vector<double> with = design.merits_with({rows[20] * 2, rows[21] * 3});
      ASSERT_EQ(with.size(), 2u);
      for (const int one : {20, 21}) {
        rows[one] *= one == 20 ? 2 : 3;
        design.replace(one, rows[one]);
        design.change(one, +1);
        const double merit = with[one == 20 ? 0 : 1];
        EXPECT_NEAR(design.merit(), merit, 1e-9 * std::abs(merit)) << name;
        const double defined = by_definition(objective, rows, design.chosen());
        EXPECT_NEAR(by_merit(objective, merit), defined, 1e-7 * defined) << name;
        design.change(one, -1);
      }
    }
}

TEST(Design, IsBetterByItsOwnCriterionThanAnyOfAHundredRandomOnes) {
  std::mt19937_64 random(4);
  for (const std::string_view name : criterion_names()) {
    const auto rows = drawn_rows(1, random);
    Design design(rows, objective_of(*criterion_of(name), random));
    design.choose(random_choice(kCandidates, 15, random));
    exchange(design);
    const double reached = design.merit();
    EXPECT_EQ(design.chosen().size(), 15u);
    for (int i = 0; i < 100; ++i) {
      design.choose(random_choice(kCandidates, 15, random));
      EXPECT_GT(reached, design.merit()) << name;
    }
  }
}

}  // namespace
}  // namespace selfcal
