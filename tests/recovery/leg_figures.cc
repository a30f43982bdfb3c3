// Platforms from locations by the inverse model, six problems of seven parameters (Khalil and
// Dombre, 11.57 to 11.64), against the whole robot by the direct model.
#include "constraints/axes/leg_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/kinematics/kind_examples.h"
#include "tests/recovery/rx90.h"

namespace selfcal::recovery {
namespace {

struct Located {
  std::unique_ptr<Robot> robot;
  Eigen::VectorXd truth;
  DataSet data;
  const platform::Platform& platform() const {
    return dynamic_cast<const platform::Platform&>(*robot);
  }
};

Located located(const std::string& kind, double noise, int seed) {
  Random random(seed);
  Located made{robot_of(kind_examples().at(kind)), {}, {}};
  std::normal_distribution<double> normal;
  made.truth = nominal_values(*made.robot);
  for (double& value : made.truth) value += 1e-3 * normal(random);
  Session session = make_session(*made.robot, made.truth,
                                 {{"arm", entry({{"method", "location"}}), 90}}, noise, random);
  EXPECT_EQ(session.unreached, "");
  made.data = std::move(session.data);
  return made;
}

class LegByLeg : public testing::TestWithParam<const char*> {};

TEST_P(LegByLeg, FindsThePlatformFromExactRows) {
  const Located made = located(GetParam(), 0, 1);
  const LegFigures found = leg_figures(made.platform(), made.data, nominal_values(*made.robot));
  ASSERT_EQ(found.problem, "");
  EXPECT_EQ(found.rows, 60);
  EXPECT_LT(found.rms, 1e-14);
  const double worst = (found.xi - made.truth).cwiseAbs().maxCoeff();
  std::printf("%s: %.1e\n", GetParam(), worst);
  EXPECT_LT(worst, 1e-11);  // rounding of 1e-16 m, magnified by a condition of some thousands
}

TEST_P(LegByLeg, AgreesWithTheWholeRobotWithinItsSigmas) {
  double squares = 0, apart = 0;
  int count = 0;
  for (int seed = 1; seed <= 5; ++seed) {
    const Located made = located(GetParam(), 20e-6, seed);
    const LegFigures legs = leg_figures(made.platform(), made.data, nominal_values(*made.robot));
    const Solution whole = identify(*made.robot, made.data);
    ASSERT_TRUE(whole.converged) << whole.stop_reason;
    for (std::size_t i = 0; i < whole.parameters.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const double sigma = whole.parameters[i].sigma;
      squares += std::pow((legs.xi[k] - made.truth[k]) / sigma, 2);
      apart += std::pow((legs.xi[k] - whole.values[k]) / sigma, 2);
      ++count;
    }
  }
  std::printf("%s: chain by chain off by %.2f sigma of the whole robot's, from it by %.2f\n",
              GetParam(), std::sqrt(squares / count), std::sqrt(apart / count));
  // The whole robot weighs positions and turns as they deserve and knows the maker's figures: chain
  // by chain is worse, but by a factor and not by an order.
  EXPECT_GT(std::sqrt(squares / count), 0.8);
  EXPECT_LT(std::sqrt(squares / count), 4);
  EXPECT_LT(std::sqrt(apart / count), 4);
}

TEST_P(LegByLeg, FindsThePlatformFromAFileThatIsDecimetresOff) {
  const Located made = located(GetParam(), 0, 2);
  Random random(6);
  std::uniform_real_distribution<double> off(-0.15, 0.15);
  Eigen::VectorXd far = made.truth;
  for (Eigen::Index i = 0; i < far.size(); ++i)
    if (made.robot->parameters()[static_cast<std::size_t>(i)].quantity == Quantity::length)
      far[i] += off(random);
  const LegFigures found = leg_figures(made.platform(), made.data, far);
  EXPECT_LT((found.xi - made.truth).cwiseAbs().maxCoeff(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Platforms, LegByLeg, testing::Values("gough-stewart", "hexaslide"),
                         [](const auto& made) {
                           return std::string(made.param) == "hexaslide" ? "HexaSlide"
                                                                         : "GoughStewart";
                         });

TEST(LegByLegRows, SaysWhenLocationsAreTooFew) {
  Located made = located("gough-stewart", 0, 1);
  made.data.rows = taken(made.data.rows, {0, 1, 2, 3, 4, 5, 6});
  EXPECT_NE(leg_figures(made.platform(), made.data, made.truth).problem, "");
}

}  // namespace
}  // namespace selfcal::recovery
