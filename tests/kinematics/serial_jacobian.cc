// Psi and the joint Jacobian of serial robots against central differences of their locations.
//
// Step 1e-5: what is cut off is h^2 / 6 of the third derivative, at most 10 m times (3.1 rad)^3 for
// a gear's column (5e-9); rounding leaves 1e-16 x 10 m / h = 1e-10.
#include <gtest/gtest.h>

#include "kinematics/rotation.h"
#include "tests/kinematics/random_robot.h"

namespace selfcal {
namespace {

constexpr double kStep = 1e-5;
constexpr double kTolerance = 1e-8;
constexpr int kRobots = 20;

Locations located(const Robot& robot, const ConfigurationBlock& block, const Eigen::VectorXd& xi,
                  Body body) {
  Locations X;
  robot.locate(block, xi, body, X, nullptr);
  return X;
}

/// (dx dy dz, rotation vector) per unit from `minus` to `plus`, laid out as a column of Psi.
Eigen::VectorXd difference(const Locations& plus, const Locations& minus) {
  Eigen::VectorXd column(6 * kLanes);
  for (int lane = 0; lane < kLanes; ++lane) {
    const Eigen::Vector3d shift = plus.p(lane) - minus.p(lane);
    const Eigen::Vector3d turn = log_rotation(plus.R(lane) * minus.R(lane).transpose());
    for (int c = 0; c < 3; ++c) {
      column[c * kLanes + lane] = shift[c] / (2 * kStep);
      column[(3 + c) * kLanes + lane] = turn[c] / (2 * kStep);
    }
  }
  return column;
}

/// A random robot at random readings, with Psi of the body.
struct Drawn {
  RandomRobot made;
  ConfigurationBlock block;
  Eigen::VectorXd xi;
  Locations X;
  PsiBlock psi;
};

Drawn drawn(std::mt19937_64& random, Body body) {
  Drawn d{random_robot(random), {}, {}, {}, {}};
  d.block = random_block(*d.made.robot, random);
  d.xi = turned_values(*d.made.robot, random);
  d.made.robot->locate(d.block, d.xi, body, d.X, &d.psi);
  return d;
}

/// Every column of `analytic` against differences; `moved(k, step)` gives the locations when what
/// column k belongs to has moved, `name(k)` is for the message.
template <class Moved, class Name>
void expect_differences(const Eigen::MatrixXd& analytic, Moved moved, Name name) {
  ASSERT_EQ(analytic.rows(), 6 * kLanes);
  for (Eigen::Index k = 0; k < analytic.cols(); ++k) {
    const Eigen::VectorXd column = difference(moved(k, kStep), moved(k, -kStep));
    EXPECT_LT((analytic.col(k) - column).cwiseAbs().maxCoeff(), kTolerance) << name(k);
  }
}

class SerialJacobian : public testing::TestWithParam<Body> {};

TEST_P(SerialJacobian, HasForEveryParameterTheColumnThatDifferencesGive) {
  std::mt19937_64 random(11);
  for (int i = 0; i < kRobots; ++i) {
    SCOPED_TRACE("robot " + std::to_string(i));
    const Drawn d = drawn(random, GetParam());
    const Robot& robot = *d.made.robot;
    ASSERT_EQ(d.psi.cols(), d.xi.size());
    const auto moved = [&](Eigen::Index p, double step) {
      Eigen::VectorXd xi = d.xi;
      xi[p] += step;
      return located(robot, d.block, xi, GetParam());
    };
    expect_differences(d.psi, moved, [&](Eigen::Index p) { return robot.parameters()[p].name; });
  }
}

TEST_P(SerialJacobian, HasForEveryReadingTheColumnThatDifferencesGive) {
  std::mt19937_64 random(12);
  for (int i = 0; i < kRobots; ++i) {
    SCOPED_TRACE("robot " + std::to_string(i));
    const Drawn d = drawn(random, GetParam());
    const Robot& robot = *d.made.robot;
    Eigen::MatrixXd J;
    robot.joint_jacobian(d.block, d.xi, GetParam(), d.psi, J);
    ASSERT_EQ(J.cols(), d.made.joints());
    const auto moved = [&](Eigen::Index j, double step) {
      ConfigurationBlock block = d.block;
      block.q.col(j) += step;
      return located(robot, block, d.xi, GetParam());
    };
    expect_differences(J, moved, [&](Eigen::Index j) { return robot.joints()[j].name; });
  }
}

TEST_P(SerialJacobian, ComesWithTheLocationsThatAreGivenWithoutIt) {
  std::mt19937_64 random(13);
  const Drawn d = drawn(random, GetParam());
  const Locations alone = located(*d.made.robot, d.block, d.xi, GetParam());
  EXPECT_TRUE((d.X.rotation == alone.rotation).all());
  EXPECT_TRUE((d.X.position == alone.position).all());
}

INSTANTIATE_TEST_SUITE_P(Bodies, SerialJacobian, testing::Values(Body::endpoint, Body::last_link),
                         [](const auto& each) {
                           return each.param == Body::endpoint ? "Endpoint" : "LastLink";
                         });

TEST(SerialJacobianOfTheLastLink, HasNothingInTheToolsColumns) {
  std::mt19937_64 random(14);
  for (int i = 0; i < kRobots; ++i) {
    const Drawn d = drawn(random, Body::last_link);
    const std::vector<Parameter>& parameters = d.made.robot->parameters();
    for (size_t p = 0; p < parameters.size(); ++p) {
      if (parameters[p].part != Part::tool) continue;
      EXPECT_TRUE(d.psi.col(static_cast<Eigen::Index>(p)).isZero(0));
    }
  }
}

}  // namespace
}  // namespace selfcal
