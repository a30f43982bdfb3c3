// What methods say of their nuisance parameters: reports, equations between them, links between
// groups.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/contracts/method_case.h"

namespace selfcal {
namespace {

constexpr double kStep = 1e-6;
// Relative to the derivative: coefficients a b c grow as 1 / d and lose (h / d)^2, d above 2 mm.
constexpr double kOwnRelative = 1e-6;
constexpr int kOwnInstances = 20;

void expect_near(double derivative, double difference, const std::string& what) {
  EXPECT_NEAR(derivative, difference, kOwnRelative * std::max(1.0, std::abs(derivative))) << what;
}

/// Own values moved by h along freedom k.
Eigen::VectorXd moved(const Method& method, Eigen::VectorXd nuisance, int k, double h) {
  method.retract(nuisance, h * Eigen::VectorXd::Unit(method.tangent_dimension(), k));
  return nuisance;
}

class OwnUnknowns : public testing::TestWithParam<MethodCase> {
 protected:
  static const Eigen::VectorXd* reference_of(const Instance& at) {
    return at.referred() ? &at.reference : nullptr;
  }
};

TEST_P(OwnUnknowns, AreReportedWithTheirGradients) {
  Random random(71);
  for (int i = 0; i < kOwnInstances; ++i) {
    const Instance at = random_instance(GetParam(), random);
    const auto reports = at.method().report(at.nuisance, reference_of(at));
    for (int k = 0; k < at.method().tangent_dimension(); ++k) {
      const auto plus =
          at.method().report(moved(at.method(), at.nuisance, k, kStep), reference_of(at));
      const auto minus =
          at.method().report(moved(at.method(), at.nuisance, k, -kStep), reference_of(at));
      ASSERT_EQ(plus.size(), reports.size());
      for (size_t n = 0; n < reports.size(); ++n) {
        ASSERT_EQ(reports[n].D_own.size(), at.method().tangent_dimension());
        expect_near(reports[n].D_own[k], (plus[n].value - minus[n].value) / (2 * kStep),
                    reports[n].name);
      }
    }
  }
}

TEST_P(OwnUnknowns, AreReportedWithTheirGradientsToTheReference) {
  Random random(72);
  for (int i = 0; i < kOwnInstances; ++i) {
    const Instance at = random_instance(GetParam(), random);
    if (!at.referred()) return;
    const auto reports = at.method().report(at.nuisance, &at.reference);
    for (int k = 0; k < at.referred()->tangent_dimension(); ++k) {
      const Eigen::VectorXd up = moved(*at.referred(), at.reference, k, kStep);
      const Eigen::VectorXd down = moved(*at.referred(), at.reference, k, -kStep);
      const auto plus = at.method().report(at.nuisance, &up),
                 minus = at.method().report(at.nuisance, &down);
      for (size_t n = 0; n < reports.size(); ++n)
        expect_near(reports[n].D_reference[k], (plus[n].value - minus[n].value) / (2 * kStep),
                    reports[n].name);
    }
  }
}

TEST_P(OwnUnknowns, AreReportedUnderNamesOfTheirOwnIfThereAreAny) {
  Random random(73);
  const Instance at = random_instance(GetParam(), random);
  std::set<std::string> names;
  const auto reports = at.method().report(at.nuisance, reference_of(at));
  for (const NuisanceReport& each : reports) names.insert(each.name);
  EXPECT_EQ(names.size(), reports.size());
  EXPECT_FALSE(names.contains(""));
  EXPECT_EQ(reports.empty(), at.method().tangent_dimension() == 0);
}

TEST_P(OwnUnknowns, HaveEquationsWithTheirDerivatives) {
  Random random(74);
  for (int i = 0; i < kOwnInstances; ++i) {
    const Instance at = random_instance(GetParam(), random);
    const auto equations = at.method().own_equations(at.nuisance, reference_of(at));
    for (size_t n = 0; n < equations.size(); ++n) {
      EXPECT_GT(equations[n].sigma, 0);
      for (int k = 0; k < at.method().tangent_dimension(); ++k) {
        const auto value = [&](double h) {
          const Eigen::VectorXd nuisance = moved(at.method(), at.nuisance, k, h);
          return at.method().own_equations(nuisance, reference_of(at))[n].residual;
        };
        expect_near(equations[n].D_own[k], (value(kStep) - value(-kStep)) / (2 * kStep), "own");
      }
      for (int k = 0; at.referred() && k < at.referred()->tangent_dimension(); ++k) {
        const auto value = [&](double h) {
          const Eigen::VectorXd reference = moved(*at.referred(), at.reference, k, h);
          return at.method().own_equations(at.nuisance, &reference)[n].residual;
        };
        expect_near(equations[n].D_reference[k], (value(kStep) - value(-kStep)) / (2 * kStep),
                    "reference");
      }
    }
  }
}

TEST_P(OwnUnknowns, OfLinkedGroupsHaveResidualsWithTheirDerivatives) {
  Random random(75);
  for (int i = 0; i < kOwnInstances; ++i) {
    const Instance at = random_instance(GetParam(), random);
    for (const GroupDistance& link : at.method().links()) {
      const Eigen::VectorXd a = at.groups.col(link.a), b = at.groups.col(link.b);
      const auto value = [&](const Eigen::VectorXd& first, const Eigen::VectorXd& second) {
        Eigen::VectorXd D_a, D_b;
        return at.method().link_residual(link, first, second, D_a, D_b);
      };
      const auto turned = [&](Eigen::VectorXd group, int k, double h) {
        at.method().retract_group(group, h * Eigen::VectorXd::Unit(at.method().group_freedom(), k));
        return group;
      };
      Eigen::VectorXd D_a, D_b;
      at.method().link_residual(link, a, b, D_a, D_b);
      for (int k = 0; k < at.method().group_freedom(); ++k) {
        expect_near(D_a[k],
                    (value(turned(a, k, kStep), b) - value(turned(a, k, -kStep), b)) / (2 * kStep),
                    "first group");
        expect_near(D_b[k],
                    (value(a, turned(b, k, kStep)) - value(a, turned(b, k, -kStep))) / (2 * kStep),
                    "second group");
      }
    }
  }
}

TEST_P(OwnUnknowns, OfATouchedPlaneAreThoseOfThatPlane) {
  Random random(77);
  const Instance at = random_instance(GetParam(), random);
  const auto plane = at.method().plane(at.nuisance, reference_of(at));
  EXPECT_EQ(plane.has_value(), at.method().touches() == TouchedSurface::plane);
  if (!plane || at.referred()) return;
  const Plane turned{-plane->n, plane->d ? std::optional(-*plane->d) : std::nullopt};
  for (const Plane& wanted : {*plane, turned}) {
    const auto back = at.method().plane(at.method().nuisance_of(wanted), nullptr);
    ASSERT_TRUE(back);
    const double side = back->n.dot(wanted.n);
    EXPECT_NEAR(std::abs(side), 1, 1e-15);  // rounding
    ASSERT_EQ(back->d.has_value(), wanted.d.has_value());
    if (wanted.d) {
      EXPECT_NEAR(side * *back->d, *wanted.d, 1e-15);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, OwnUnknowns, testing::ValuesIn(method_cases()), title_of);

std::vector<std::pair<std::string, double>> plane_report(const Eigen::VectorXd& nuisance) {
  const std::vector<Set> sets = make_sets("s: {method: plane}");
  std::vector<std::pair<std::string, double>> list;
  for (const NuisanceReport& each : sets[0].method->report(nuisance, nullptr))
    list.emplace_back(each.name, each.value);
  return list;
}

TEST(PlaneReport, GivesADistanceOfAtLeastZeroAndTheChaptersCoefficients) {
  using testing::Pair;
  // n.p = -0.5 with n = z is -z = 0.5, or 2 z + 1 = 0.
  EXPECT_THAT(plane_report(Eigen::Vector4d(0, 0, 1, -0.5)),
              testing::ElementsAre(Pair("nx", 0), Pair("ny", 0), Pair("nz", -1), Pair("d", 0.5),
                                   Pair("a", 0), Pair("b", 0), Pair("c", 2)));
}

TEST(PlaneReport, OfAPlaneThroughTheOriginHasNoCoefficients) {
  EXPECT_EQ(plane_report(Eigen::Vector4d(0, 0, 1, 0)).size(), 4u);
}

TEST(KnownPlane, HasTheNormalAndDistanceOfItsCoefficients) {
  Random random(76);
  // a x + b y + c z + 1 = 0 holds at (0, 0, 0.5) for c = -2.
  Instance at = random_instance({"", "s: {method: plane, plane: [0.1, 0.2, -2.0]}"}, random);
  place(at.now, 0, {Eigen::Matrix3d::Identity(), {0, 0, 0.5}});
  place(at.now, 1, {Eigen::Matrix3d::Identity(), {-10, 0, 0}});
  EXPECT_NEAR(at.evaluate().r(0, 0), 0, 1e-15);  // rounding
  EXPECT_NEAR(at.evaluate().r(1, 0), 0, 1e-15);
}

}  // namespace
}  // namespace selfcal
