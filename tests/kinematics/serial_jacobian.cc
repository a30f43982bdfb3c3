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

class SerialJacobian : public testing::TestWithParam<Body> {};

TEST_P(SerialJacobian, HasForEveryParameterTheColumnThatDifferencesGive) {
  std::mt19937_64 random(11);
  for (int i = 0; i < kRobots; ++i) {
    const RandomRobot made = random_robot(random);
    const ConfigurationBlock block = random_block(*made.robot, random);
    const Eigen::VectorXd xi = values(*made.robot);
    Locations X;
    PsiBlock psi;
    made.robot->locate(block, xi, GetParam(), X, &psi);
    ASSERT_EQ(psi.rows(), 6 * kLanes);
    ASSERT_EQ(psi.cols(), xi.size());
    for (Eigen::Index p = 0; p < xi.size(); ++p) {
      Eigen::VectorXd plus = xi, minus = xi;
      plus[p] += kStep;
      minus[p] -= kStep;
      const Eigen::VectorXd column = difference(located(*made.robot, block, plus, GetParam()),
                                                located(*made.robot, block, minus, GetParam()));
      EXPECT_LT((psi.col(p) - column).cwiseAbs().maxCoeff(), kTolerance)
          << "robot " << i << ", " << made.robot->parameters()[p].name;
    }
  }
}

TEST_P(SerialJacobian, HasForEveryReadingTheColumnThatDifferencesGive) {
  std::mt19937_64 random(12);
  for (int i = 0; i < kRobots; ++i) {
    const RandomRobot made = random_robot(random);
    const ConfigurationBlock block = random_block(*made.robot, random);
    const Eigen::VectorXd xi = values(*made.robot);
    Locations X;
    PsiBlock psi;
    Eigen::MatrixXd J;
    made.robot->locate(block, xi, GetParam(), X, &psi);
    made.robot->joint_jacobian(xi, psi, J);
    ASSERT_EQ(J.rows(), 6 * kLanes);
    ASSERT_EQ(J.cols(), made.joints());
    for (Eigen::Index j = 0; j < J.cols(); ++j) {
      ConfigurationBlock plus = block, minus = block;
      plus.q.col(j) += kStep;
      minus.q.col(j) -= kStep;
      const Eigen::VectorXd column = difference(located(*made.robot, plus, xi, GetParam()),
                                                located(*made.robot, minus, xi, GetParam()));
      EXPECT_LT((J.col(j) - column).cwiseAbs().maxCoeff(), kTolerance)
          << "robot " << i << ", joint " << made.robot->joints()[j].name;
    }
  }
}

TEST_P(SerialJacobian, ComesWithTheLocationsThatAreGivenWithoutIt) {
  std::mt19937_64 random(13);
  const RandomRobot made = random_robot(random);
  const ConfigurationBlock block = random_block(*made.robot, random);
  const Eigen::VectorXd xi = values(*made.robot);
  Locations X;
  PsiBlock psi;
  made.robot->locate(block, xi, GetParam(), X, &psi);
  const Locations alone = located(*made.robot, block, xi, GetParam());
  EXPECT_TRUE((X.rotation == alone.rotation).all());
  EXPECT_TRUE((X.position == alone.position).all());
}

INSTANTIATE_TEST_SUITE_P(Bodies, SerialJacobian, testing::Values(Body::endpoint, Body::last_link),
                         [](const auto& each) {
                           return each.param == Body::endpoint ? "Endpoint" : "LastLink";
                         });

TEST(SerialJacobianOfTheLastLink, HasNothingInTheToolsColumns) {
  std::mt19937_64 random(14);
  for (int i = 0; i < kRobots; ++i) {
    const RandomRobot made = random_robot(random);
    const ConfigurationBlock block = random_block(*made.robot, random);
    Locations X;
    PsiBlock psi;
    made.robot->locate(block, values(*made.robot), Body::last_link, X, &psi);
    for (size_t p = 0; p < made.robot->parameters().size(); ++p) {
      if (made.robot->parameters()[p].part != Part::tool) continue;
      EXPECT_TRUE(psi.col(static_cast<Eigen::Index>(p)).isZero(0));
    }
  }
}

}  // namespace
}  // namespace selfcal
