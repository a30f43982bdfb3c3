// Psi of a robot with effects against central differences of its locations, for every effect.
//
// Steps move the body by about 1e-5 m or rad, whatever the parameter's unit: rounding then leaves
// 2e-16 x 10 m / 1e-5 = 2e-10 of a column, cut off is 1e-10 / 6 of the third derivative (at most
// 10 m times (3.1 rad)^3, of gears). The influence does not follow the geometry, so that nothing is
// of second order in the effects' own size.
#include "kinematics/rotation.h"
#include "tests/effects/effect_case.h"

namespace selfcal {
namespace {

constexpr double kMove = 1e-5;
constexpr double kTolerance = 2e-8;  // of a column's largest entry, or of 1 m or rad
constexpr int kRobots = 6;

Locations located(const EffectInstance& at, const Eigen::VectorXd& xi, Body body) {
  Locations X;
  at.robot->locate(at.block, xi, body, X, nullptr);
  return X;
}

/// A column of Psi from the locations at plus and minus one step.
Eigen::VectorXd difference(const Locations& plus, const Locations& minus, double step) {
  Eigen::VectorXd column(6 * kLanes);
  for (int lane = 0; lane < kLanes; ++lane) {
    const Eigen::Vector3d shift = plus.p(lane) - minus.p(lane);
    const Eigen::Vector3d turn = log_rotation(plus.R(lane) * minus.R(lane).transpose());
    for (int c = 0; c < 3; ++c) {
      column[c * kLanes + lane] = shift[c] / (2 * step);
      column[(3 + c) * kLanes + lane] = turn[c] / (2 * step);
    }
  }
  return column;
}

class EffectDerivatives : public testing::TestWithParam<EffectCase> {
 protected:
  /// Columns `first` to `end` of Psi of `body` against differences. The largest entry of all.
  static double expect_columns(const EffectInstance& at, Body body, Eigen::Index first,
                               Eigen::Index end) {
    Locations X;
    PsiBlock psi;
    at.robot->locate(at.block, at.xi, body, X, &psi);
    EXPECT_EQ(psi.rows(), 6 * kLanes);
    EXPECT_EQ(psi.cols(), at.xi.size());
    for (Eigen::Index k = first; k < end; ++k) {
      const double size = std::max(1.0, psi.col(k).cwiseAbs().maxCoeff());
      const double step = kMove / size;
      Eigen::VectorXd plus = at.xi, minus = at.xi;
      plus[k] += step;
      minus[k] -= step;
      const Eigen::VectorXd column =
          difference(located(at, plus, body), located(at, minus, body), step);
      EXPECT_LT((psi.col(k) - column).cwiseAbs().maxCoeff(), kTolerance * size)
          << at.robot->parameters()[k].name;
    }
    return psi.middleCols(first, end - first).cwiseAbs().maxCoeff();
  }
};

TEST_P(EffectDerivatives, ToTheEffectsOwnParametersAreTheDifferences) {
  std::mt19937_64 random(81);
  for (int i = 0; i < kRobots; ++i) {
    SCOPED_TRACE("robot " + std::to_string(i));
    const EffectInstance at = random_instance(GetParam(), random);
    for (const Body body : {Body::endpoint, Body::last_link})
      EXPECT_GT(expect_columns(at, body, at.own(), at.xi.size()), 0);  // it acts on some lane
  }
}

TEST_P(EffectDerivatives, ToTheGeometryStayExactWhereTheEffectActs) {
  std::mt19937_64 random(82);
  for (int i = 0; i < kRobots; ++i) {
    SCOPED_TRACE("robot " + std::to_string(i));
    EffectInstance at = random_instance(GetParam(), random);
    at.xi.tail(at.xi.size() - at.own()) *= 30;  // far beyond the usual
    for (Eigen::Index k = 0; k < at.own(); ++k) at.xi[k] += uniform(random, -1e-3, 1e-3);
    for (const Body body : {Body::endpoint, Body::last_link}) expect_columns(at, body, 0, at.own());
  }
}

TEST_P(EffectDerivatives, ComeWithTheLocationsThatAreGivenWithoutThem) {
  std::mt19937_64 random(83);
  const EffectInstance at = random_instance(GetParam(), random);
  Locations X;
  PsiBlock psi;
  at.robot->locate(at.block, at.xi, Body::endpoint, X, &psi);
  const Locations alone = located(at, at.xi, Body::endpoint);
  EXPECT_TRUE((X.position == alone.position).all() && (X.rotation == alone.rotation).all());
}

TEST_P(EffectDerivatives, AreOfTheGeometryAloneWhereTheEffectIsZero) {
  std::mt19937_64 random(84);
  EffectInstance at = random_instance(GetParam(), random);
  at.xi.tail(at.xi.size() - at.own()).setZero();
  Locations X, Y;
  PsiBlock psi, geometry;
  at.robot->locate(at.block, at.xi, Body::endpoint, X, &psi);
  at.geometry->locate(at.block, at.xi.head(at.own()), Body::endpoint, Y, &geometry);
  EXPECT_TRUE((X.position == Y.position).all() && (X.rotation == Y.rotation).all());
  EXPECT_EQ(psi.leftCols(at.own()), geometry);
}

INSTANTIATE_TEST_SUITE_P(Effects, EffectDerivatives, testing::ValuesIn(effect_cases()), title_of);

TEST(EffectCases, CoverEveryListedEffect) {
  for (const std::string_view name : effect_names())
    EXPECT_THAT(effect_cases(),
                testing::Contains(testing::Field(
                    &EffectCase::entry,
                    testing::ResultOf([](const char* e) { return std::string(e) + ","; },
                                      testing::HasSubstr("effect: " + std::string(name) + ",")))))
        << name;
}

}  // namespace
}  // namespace selfcal
