// A bug stops the program and names its place, in every build that is shipped.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstdio>
#include <vector>

#include "kinematics/expects.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

TEST(BugsDeathTest, StopWhereACallExpectsWhatDoesNotHold) {
  EXPECT_DEATH(expects(false, "two and two are four"),
               "a bug: expected that two and two are four .*bugs.cc:[0-9]+");
}

TEST(BugsDeathTest, StopWhereAMatrixIsAskedForWhatItDoesNotHave) {
  volatile Eigen::Index past = 3;
  const Eigen::VectorXd three = Eigen::VectorXd::Ones(3);
  EXPECT_DEATH(std::printf("%g", three[past]), "Eigen/.*:[0-9]+: .*Assertion");
  EXPECT_DEATH(std::printf("%g", (three + Eigen::VectorXd::Ones(past + 1)).sum()),
               "Eigen/.*:[0-9]+: .*Assertion");
}

#ifdef _GLIBCXX_ASSERTIONS
TEST(BugsDeathTest, StopWhereAListIsAskedForWhatItDoesNotHave) {
  volatile size_t past = 3;
  const std::vector<int> three(3);
  EXPECT_DEATH(std::printf("%d", three[past]), "stl_vector.h:[0-9]+: .*Assertion");
}
#endif

TEST(BugsDeathTest, StopWhereARobotIsAskedForABodyThatItHasNot) {
  const auto robot = robot_of(kind_examples().at("serial"));
  const Eigen::VectorXd q = Eigen::VectorXd::Zero(3);
  EXPECT_DEATH(locate(*robot, values(*robot), q, link_body(99)),
               "expected that a body of the robot");
}

}  // namespace
}  // namespace selfcal
