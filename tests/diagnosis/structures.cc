#include "constraints/equations/resolution.h"
#include "diagnosis/evidence/discrepancy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/files/yaml.h"
#include "kinematics/make_robot.h"

namespace selfcal {
namespace {

TEST(ReadingSteps, FindsTheDigitToWhichEachJointIsRounded) {
  Eigen::MatrixXd q(4, 3);
  q << 0.614132, -1.41970, 0.1234567, 0.614130, 0.74838, 0.7654321, -0.2, 1.2, 0.5, 1.000002,
      3.00005, 0.1;
  const Eigen::VectorXd steps = reading_steps(q);
  EXPECT_NEAR(steps[0], 2e-6, 1e-12);
  EXPECT_NEAR(steps[1], 1e-5, 1e-12);
  EXPECT_NEAR(steps[2], 1e-7, 1e-13);
}

TEST(ReadingSteps, SaysNothingOfReadingsThatAreNotRounded) {
  EXPECT_EQ(reading_steps(Eigen::MatrixXd::Constant(3, 1, 0.12345678912345))[0], 0);
}

const ReadingErrors kNoErrors{Eigen::MatrixXd::Zero(3, 1), Eigen::VectorXd::Zero(1)};

TEST(ReadingSteps, AreNotBelievedWhereTheyWouldMakeMoreThanAllThatIsLeft) {
  Eigen::MatrixXd q(4, 3);
  q << 0.15, 0.002, 0, -0.35, 0.013, 0, 1.05, -0.44, 0, 0.55, 0.871, 0;
  // Half a step of the first joint, 0.05 rad, moves an equation by 25 sigma; of the second, 1 mrad,
  // by 0.5; the third stands still.
  const Eigen::MatrixXd by_joint = Eigen::MatrixXd::Constant(10, 3, 1000);
  EXPECT_NEAR(reading_steps(q)[0], 0.05, 1e-12);
  EXPECT_EQ(credible_steps(q, by_joint)[0], 0);
  EXPECT_NEAR(credible_steps(q, by_joint)[1], 1e-3, 1e-12);
  EXPECT_EQ(credible_steps(q, by_joint)[2], 0);
}

/// Three touches of one plane, the last two one configuration.
struct Touches {
  Touches() {
    data.q.resize(3, 1);
    data.q << 0.1, 0.5, 0.5;
    data.set = {0, 0, 0};
    data.repeat = {-1, 4, 4};
    rows.row = {0, 1, 2};
    rows.shift = Eigen::MatrixXd::Zero(3, 3);
    rows.shift.col(2).setConstant(1e5);
    ends[0].translation().x() = 1;
  }
  Observations data;
  DenseEquations rows;
  std::vector<Eigen::Isometry3d> ends = std::vector(3, Eigen::Isometry3d::Identity());
};

TEST(Structures, RepeatsShareTheRoundingOfTheirReading) {
  const Touches t;
  // Readings are whole multiples of 0.05 rad: half of it moves every equation by 0.6 sigma.
  const auto list = noise_alone(
      t.data, t.rows, {Eigen::MatrixXd::Constant(3, 1, 24), Eigen::VectorXd::Constant(1, 0.05)});
  const Eigen::MatrixXd S = list.front().matrix();
  EXPECT_NEAR(S(0, 0), 1.12, 1e-12);
  EXPECT_NEAR(S(1, 2), 0.12, 1e-12);
  EXPECT_NEAR(S(0, 1), 0, 1e-12);
}

TEST(Structures, BeginWithNoiseAndShareWhatIsCloseInEachSense) {
  const Touches t;
  const auto list = structures(t.data, t.rows, t.ends, 4 / 3.0, {kNoErrors, t.data.q});
  EXPECT_EQ(list.front().kind, 0);
  double noise = 0, unknown = 0;
  for (const DiscrepancyCovariance& each : list) {
    (each.kind == 0 ? noise : unknown) += each.probability;
    const Eigen::MatrixXd S = each.matrix();
    EXPECT_GE(S(1, 2), S(0, 1)) << "repeats are closest, whatever close means";
    EXPECT_NE(each.kind, static_cast<int>(KernelDomain::time)) << "the rows carry no time";
  }
  EXPECT_NEAR(noise, 1, 1e-12);
  EXPECT_NEAR(unknown, 1, 1e-12);
}

TEST(Structures, LetTimeBeSharedAsTheToolSeesIt) {
  // Three directions of the tool that a turn of it about the world's y carries into each other.
  Touches t;
  t.data.repeat.clear();
  t.data.time.resize(3);
  t.data.time << 0, 0, 1000;
  t.ends[1].linear() = Eigen::AngleAxisd(std::acos(-1) / 2, Eigen::Vector3d::UnitY()).matrix();
  const auto of_time = [&] {
    const auto list = structures(t.data, t.rows, t.ends, 4 / 3.0, {kNoErrors, t.data.q});
    const auto found =
        std::ranges::find(list, static_cast<int>(KernelDomain::time), &DiscrepancyCovariance::kind);
    return found->matrix();
  };
  EXPECT_NEAR(of_time()(0, 1), 0, 1e-12) << "one world's direction, two of the tool";
  t.rows.shift.row(1) = Eigen::RowVector3d(1e5, 0, 0);
  EXPECT_GT(of_time()(0, 1), 0.1) << "both along the tool's z";
  EXPECT_NEAR(of_time()(0, 2), 0, 1e-6) << "long after";
}

// A turn of the base about the world's y, through the middle of all places, moves what lies off it
// the other way on the other side; directions across that axis' motions have nothing in common.
TEST(Structures, LetTimeBeSharedAsTheBaseMoves) {
  Touches t;
  t.data.repeat.clear();
  t.data.time.resize(3);
  t.data.time << 0, 0, 1000;
  for (Eigen::Index i = 0; i < 3; ++i) t.rows.shift.row(i) = Eigen::RowVector3d(0, 0, 1e5);
  t.ends[0].translation() = Eigen::Vector3d(1, 0, 0);
  t.ends[1].translation() = Eigen::Vector3d(-1, 0, 0);
  t.ends[2].translation() = Eigen::Vector3d::Zero();
  const auto of_base = [&](double size) {
    const auto list = structures(t.data, t.rows, t.ends, size, {kNoErrors, t.data.q});
    const auto found =
        std::ranges::find(list, static_cast<int>(KernelDomain::base), &DiscrepancyCovariance::kind);
    return Eigen::MatrixXd(found->matrix() - Eigen::MatrixXd::Identity(3, 3));
  };
  // d . d + (c x d) . (c x d) over the size squared: 1 - 1 of a size of one.
  EXPECT_NEAR(of_base(1)(0, 1), 0, 1e-12);
  EXPECT_GT(of_base(2)(0, 1), 0);
  EXPECT_LT(of_base(0.5)(0, 1), 0);
  EXPECT_NEAR(of_base(2)(0, 2), 0, 1e-6) << "long after";
}

TEST(Structures, KnowDistancesThatNoShiftChanges) {
  Touches t;
  t.data.repeat.clear();
  t.rows.shift.setZero();
  t.data.time.resize(3);
  t.data.time << 0, 0, 1000;
  const auto list = structures(t.data, t.rows, t.ends, 4 / 3.0, {kNoErrors, t.data.q});
  const auto of = [&](KernelDomain domain) {
    return std::ranges::find(list, static_cast<int>(domain), &DiscrepancyCovariance::kind);
  };
  ASSERT_NE(of(KernelDomain::time), list.end());
  EXPECT_GT(of(KernelDomain::time)->matrix()(0, 1), 0.1) << "an instrument that drifts";
  EXPECT_EQ(of(KernelDomain::base), list.end()) << "no motion of the base changes them";
}

TEST(Structures, TakeNoAngleOfAPoseForAnother) {
  Touches t;
  t.data.repeat.clear();
  t.rows.shift.setZero();
  t.rows.row = {0, 0, 0};
  t.data.time.resize(3);
  t.data.time << 0, 500, 1000;
  for (const auto& each : structures(t.data, t.rows, t.ends, 4 / 3.0, {kNoErrors, t.data.q}))
    EXPECT_TRUE(each.matrix().isDiagonal()) << "kind " << each.kind;
}

TEST(Structures, HoldJointErrorsThatAreFunctionsOfTwoReadings) {
  Observations data;
  data.q.resize(2, 2);
  data.q << 0.1234567891, 0.2, 1.1234567891, 0.2;
  data.set = {0, 0};
  DenseEquations rows;
  rows.row = {0, 1};
  rows.shift = Eigen::MatrixXd::Identity(2, 3);
  Eigen::MatrixXd by_joint(2, 2);
  by_joint << 3, 0, 4, 5;
  const auto list = structures(data, rows, std::vector(2, Eigen::Isometry3d::Identity()), 1,
                               {{by_joint, Eigen::VectorXd::Zero(2)}, data.q});
  const auto found =
      std::ranges::find(list, static_cast<int>(KernelDomain::turned), &DiscrepancyCovariance::kind);
  ASSERT_NE(found, list.end());
  const Eigen::MatrixXd S = found->matrix();
  // The first joint's column of mean square 1 is (3, 4) sqrt 2 / 5; its reading differs by a
  // radian, half of what errors are smooth over, the other's does not.
  const double both = 12 * 2.0 / 25, alike = (1 + std::exp(-0.5 / 4)) / 2;
  EXPECT_NEAR(S(0, 1), found->kappa * found->kappa * both * alike, 1e-12);
}

TEST(Structures, CompareAJointThatSlidesByWhatItMovesWhateverTheSizeOfTheRobot) {
  for (const double size : {0.1, 1.0, 10.0}) {
    Problems problems;
    Node node = *parse_yaml(
        "robot: r\nkind: serial\nframes:\n"
        "  - {name: a, joint: revolute}\n  - {name: b, joint: prismatic}\n",
        "r.yaml");
    const auto robot = make_robot(node, problems);
    Eigen::MatrixXd q(3, 2);
    q << 0.1, -0.2 * size, 0.5, 0.1 * size, 0.9, 0.2 * size;
    const Eigen::MatrixXd alike = comparable_readings(*robot, q);
    EXPECT_EQ(alike.col(0), q.col(0));
    EXPECT_NEAR(alike(2, 1) - alike(0, 1), std::numbers::pi, 1e-15);
    EXPECT_NEAR(alike(1, 1) - alike(0, 1), 0.75 * std::numbers::pi, 1e-15);
  }
}

}  // namespace
}  // namespace selfcal
