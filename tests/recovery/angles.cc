// Orientations that are read wrongly do not pass while the positions carry the result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recovery/rx90.h"

namespace selfcal::recovery {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// The tool on the last axis, so that the last joint moves no position.
constexpr const char* kOnTheAxis = R"(
robot: on-the-axis
kind: serial
frames:
  - {name: base, joint: fixed, theta: 1.5707963267948966, r: 0.5}
  - {name: j1, joint: revolute, alpha: 0.1, limits: [-2.79, 2.79]}
  - {name: j2, joint: revolute, alpha: -1.5707963267948966, limits: [-2.40, 2.40]}
  - {name: j3, joint: revolute, d: 0.5, limits: [-2.49, 2.49]}
  - {name: j4, joint: revolute, alpha: 1.5707963267948966, r: 0.5, limits: [-4.71, 4.71]}
  - {name: j5, joint: revolute, alpha: -1.5707963267948966, limits: [-1.83, 2.09]}
  - {name: j6, joint: revolute, alpha: 1.5707963267948966, r: 0.3, limits: [-0.07, 0.07]}
  - {name: tool, joint: fixed, r: 0.1}
)";

Session arm_session(const Robot& robot, unsigned long long seed) {
  Random random(seed);
  const Eigen::VectorXd truth = rx90_truth(robot, random, false);
  return make_session(robot, truth, {{"arm", entry({{"method", "location"}}), 120}}, 20e-6, random);
}

TEST(Angles, AreToldBesideThePositionsAndFallWithThem) {
  const auto robot = robot_of(kRx90);
  const Solution solution = identify(*robot, arm_session(*robot, 1).data);
  const AngleFigures& angle = solution.residual.check.angle;
  EXPECT_EQ(angle.rows, 40);
  EXPECT_GT(angle.rms_before, 0.5e-3);                        // of errors of 1 mrad
  EXPECT_NEAR(angle.rms_after, 1e-4 * std::sqrt(3), 0.3e-4);  // noise of 20 um / 0.2 m an axis
  EXPECT_EQ(solution.verdict.answer, Answer::improved) << solution.verdict.why;
}

TEST(Angles, OfAQuaternionInAnotherOrderAreNotPassedAndTheSlipIsNamed) {
  const auto robot = robot_of(kRx90);
  for (const bool last : {true, false}) {
    Session session = arm_session(*robot, 2);
    for (auto row : session.data.rows.orientation.rowwise()) {
      const Eigen::Vector4d q = row.transpose();
      if (last)
        row << q[1], q[2], q[3], q[0];
      else
        row << q[3], q[0], q[1], q[2];
    }
    const Solution solution = identify(*robot, session.data);
    EXPECT_EQ(solution.verdict.answer, Answer::not_determined) << solution.verdict.why;
    EXPECT_THAT(solution.warnings,
                Contains(HasSubstr("they fit where the quaternions are read in another order")));
  }
}

TEST(Angles, OfALastJointThatCountsTheOtherWayAreNotPassedAndItIsNamed) {
  const auto robot = robot_of(kOnTheAxis);
  Session session = arm_session(*robot, 3);
  session.data.rows.q.col(5) *= -1;
  const Solution solution = identify(*robot, session.data);
  ASSERT_LT(solution.residual.check.rms_after, 1e-4);  // the positions do not see it
  EXPECT_EQ(solution.verdict.answer, Answer::not_determined) << solution.verdict.why;
  EXPECT_THAT(solution.warnings, Contains(HasSubstr("j6 is read with the other sign")));
}

TEST(Angles, OfANestAreJudgedToo) {
  const auto robot = robot_of(kOnTheAxis);
  Random random(4);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  Session session = make_session(*robot, truth,
                                 {{"arm", entry({{"method", "position"}}), 90},
                                  {"nest", entry({{"method", "location-constraint"}}), 60}},
                                 20e-6, random);
  ASSERT_EQ(session.unreached, "");
  EXPECT_EQ(identify(*robot, session.data).verdict.answer, Answer::improved);
  // The last joint slips to and fro, which moves no position.
  for (Eigen::Index row = 0; row < session.data.rows.q.rows(); row += 2)
    session.data.rows.q(row, 5) += 0.1;
  const Solution slipping = identify(*robot, session.data);
  EXPECT_LT(slipping.residual.check.rms_after, 1e-4);
  EXPECT_NE(slipping.verdict.answer, Answer::improved) << slipping.verdict.why;
}

TEST(Angles, OfAnInstrumentWhoseNoiseIsStatedAsLargeAreNotGross) {
  // 40 mrad about each axis, as stated: more than any tolerance explains, but not more than noise.
  const auto robot = robot_of(kRx90);
  for (const bool stated : {true, false}) {
    Session session = arm_session(*robot, 5);
    Random random(6);
    std::normal_distribution<double> normal(0, 40e-3);
    for (auto row : session.data.rows.orientation.rowwise()) {
      const Eigen::Quaterniond q(row[0], row[1], row[2], row[3]);
      const Eigen::Vector3d turn(normal(random), normal(random), normal(random));
      const Eigen::Quaterniond turned(exp_rotation(turn) * q.toRotationMatrix());
      row << turned.w(), turned.x(), turned.y(), turned.z();
    }
    if (stated) session.data.sets[0].noise_angle = 40e-3;
    const Solution solution = identify(*robot, session.data);
    EXPECT_EQ(solution.verdict.answer, stated ? Answer::improved : Answer::not_determined)
        << solution.verdict.why;
  }
}

}  // namespace
}  // namespace selfcal::recovery
