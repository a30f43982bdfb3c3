// Every method's derivatives against central differences of its residuals: to the locations, to its
// nuisance parameters, to those of the set it refers to and to its groups'.
//
// Step 1e-6: rounding leaves 2e-16 x 1 m / h = 2e-10; cut off is h^2 / 6 of the third derivative,
// which reaches 1 / (pi - 2.5)^3 for angles and 1 / L^2 for a distance L: 1e-8 covers L down to 5
// mm.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/contracts/method_case.h"

namespace selfcal {
namespace {

constexpr double kMoveStep = 1e-6;
constexpr double kTolerance = 1e-8;
constexpr int kInstances = 4;

using Block = MethodOutput::Block;

/// Locations moved by h along component c: a shift, or a turn in the world.
Locations moved(const Locations& X, int c, double h) {
  Locations next = X;
  for (int lane = 0; lane < kLanes; ++lane) {
    Location at = X.at(lane);
    if (c < 3)
      at.p[c] += h;
    else
      at.R = exp_rotation(h * Eigen::Vector3d::Unit(c - 3)) * at.R;
    place(next, lane, at);
  }
  return next;
}

/// Residuals per unit of step: `move` changes an instance by a step h.
template <class Move>
Block difference(const Instance& at, const Move& move) {
  Instance plus = at, minus = at;
  move(plus, kMoveStep);
  move(minus, -kMoveStep);
  return (plus.evaluate().r - minus.evaluate().r) / (2 * kMoveStep);
}

/// Columns stride a + k of D, over all equations a, against the differences.
void expect_columns(const Block& D, int stride, int k, const Block& expected, const char* what) {
  for (Eigen::Index a = 0; a < expected.cols(); ++a)
    EXPECT_LT((D.col(stride * a + k) - expected.col(a)).abs().maxCoeff(), kTolerance)
        << what << ", equation " << a << ", component " << k;
}

class MethodDerivatives : public testing::TestWithParam<MethodCase> {};

TEST_P(MethodDerivatives, ToTheLocationAreTheDifferences) {
  Random random(61);
  double largest_angle = 0;
  for (int i = 0; i < kInstances; ++i) {
    const Instance at = random_instance(GetParam(), random);
    const MethodOutput out = at.evaluate();
    for (int lane = 0; lane < kLanes; ++lane)
      largest_angle = std::max(largest_angle, at.angle(out, lane));
    for (int c = 0; c < 6; ++c)
      expect_columns(out.G_now, 6, c,
                     difference(at, [c](Instance& x, double h) { x.now = moved(x.now, c, h); }),
                     "now");
  }
  const bool has_angles = testing::Value(random_instance(GetParam(), random).method().equations(),
                                         testing::Contains(Quantity::angle));
  EXPECT_EQ(largest_angle > 2.4, has_angles);  // 128 draws: large errors are among them
}

TEST_P(MethodDerivatives, ToTheLocationBeforeAreTheDifferences) {
  Random random(62);
  for (int i = 0; i < kInstances; ++i) {
    const Instance at = random_instance(GetParam(), random);
    const MethodOutput out = at.evaluate();
    EXPECT_EQ(at.method().paired(), (out.G_before != 0).any());
    for (int c = 0; c < 6; ++c)
      expect_columns(
          out.G_before, 6, c,
          difference(at, [c](Instance& x, double h) { x.before = moved(x.before, c, h); }),
          "before");
  }
}

TEST_P(MethodDerivatives, ToItsOwnUnknownsAreTheDifferencesOfRetract) {
  Random random(63);
  for (int i = 0; i < kInstances; ++i) {
    const Instance at = random_instance(GetParam(), random);
    const MethodOutput out = at.evaluate();
    const int m = at.method().tangent_dimension();
    for (int k = 0; k < m; ++k)
      expect_columns(out.D_own, m, k,
                     difference(at,
                                [=](Instance& x, double h) {
                                  x.method().retract(x.nuisance, h * Eigen::VectorXd::Unit(m, k));
                                }),
                     "own");
  }
}

TEST_P(MethodDerivatives, ToTheReferencesUnknownsAreTheDifferencesOfItsRetract) {
  Random random(64);
  for (int i = 0; i < kInstances; ++i) {
    const Instance at = random_instance(GetParam(), random);
    if (!at.referred()) return;
    const MethodOutput out = at.evaluate();
    const int m = at.referred()->tangent_dimension();
    for (int k = 0; k < m; ++k)
      expect_columns(out.D_reference, m, k,
                     difference(at,
                                [=](Instance& x, double h) {
                                  x.referred()->retract(x.reference,
                                                        h * Eigen::VectorXd::Unit(m, k));
                                }),
                     "reference");
  }
}

TEST_P(MethodDerivatives, ToAGroupsUnknownsAreTheDifferencesOfItsRetract) {
  Random random(65);
  for (int i = 0; i < kInstances; ++i) {
    const Instance at = random_instance(GetParam(), random);
    const MethodOutput out = at.evaluate();
    const int m = at.method().group_freedom();
    for (int k = 0; k < m; ++k)
      expect_columns(out.D_group, m, k,
                     difference(at,
                                [=](Instance& x, double h) {
                                  for (Eigen::Index g = 0; g < x.groups.cols(); ++g)
                                    x.method().retract_group(x.groups.col(g),
                                                             h * Eigen::VectorXd::Unit(m, k));
                                }),
                     "group");
  }
}

TEST_P(MethodDerivatives, ComeWithTheNumbersThatTheMethodSays) {
  Random random(66);
  const Instance at = random_instance(GetParam(), random);
  EXPECT_GE(at.equations(), 1);
  EXPECT_LE(at.equations(), kMostEquations);
  EXPECT_LE(at.method().group_names().size(), static_cast<size_t>(at.method().group_freedom()));
  EXPECT_TRUE(at.evaluate().r.isFinite().all());
}

INSTANTIATE_TEST_SUITE_P(Methods, MethodDerivatives, testing::ValuesIn(method_cases()), title_of);

TEST(MethodCases, CoverEveryListedMethod) {
  std::vector<std::string> covered;
  for (const MethodCase& each : method_cases())
    covered.emplace_back(make_sets(each.sets)[0].method->name());
  for (const std::string_view name : method_names())
    EXPECT_THAT(covered, testing::Contains(std::string(name)));
  EXPECT_THAT(method_names(),
              testing::IsSupersetOf({"position", "location", "distance", "position-constraint",
                                     "location-constraint", "plane", "plane-normal", "sphere"}));
}

}  // namespace
}  // namespace selfcal
