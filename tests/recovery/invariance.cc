// Arms of three to nine joints, some of which slide, are parallel or coincide, in usual rows and
// near their singularities: the same answer, and the same diagnosis, whatever the order of the
// rows, and wherever the instrument stands; and the truth within its own sigma.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "constraints/estimation/identification.h"
#include "diagnosis/diagnosis.h"
#include "io/files/robot_file.h"
#include "tests/recovery/session.h"

namespace selfcal::recovery {
namespace {

constexpr double kNoise = 20e-6;           // m
constexpr double kSameWithinSigma = 1e-3;  // where the iteration ends

std::unique_ptr<Robot> arm_with(int joints) {
  std::string text =
      "robot: arm\nkind: serial\nframes:\n  - {name: base, joint: fixed, theta: 0.4, r: 0.4}\n";
  for (int j = 1; j <= joints; ++j) {
    text += "  - {name: j" + std::to_string(j) + ", joint: ";
    if (j == 4 && joints > 6) {
      text += "prismatic, alpha: pi/2, d: 0.1, limits: [0.1, 0.7]}\n";
      continue;
    }
    // The third axis is parallel to the second, the sixth to the fifth.
    const bool parallel = j % 3 == 0;
    text += std::string("revolute, alpha: ") +
            (parallel     ? "0"
             : j % 2 == 0 ? "-pi/2"
                          : "pi/2") +
            ", d: " + (parallel ? "0.4" : "0.05") + ", r: " + (j % 2 == 0 ? "0.1" : "0.3") +
            ", limits: [-2.4, 2.4]}\n";
  }
  auto robot = selfcal::robot_of(
      text + "  - {name: tool, joint: fixed, d: 0.1, theta: 0.7, r: 0.15}\n", "arm");
  EXPECT_TRUE(robot.has_value()) << robot.error().what;
  return std::move(*robot);
}

/// The same rows, in another order.
DataSet reordered(const DataSet& data, Random& random) {
  std::vector<int> order(static_cast<size_t>(data.rows.rows()));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  DataSet other = data;
  other.rows = taken(data.rows, order);
  return other;
}

/// The same rows, measured from elsewhere.
DataSet seen_from(const DataSet& data, const Eigen::Isometry3d& place) {
  DataSet other = data;
  for (Eigen::Index row = 0; row < other.rows.position.rows(); ++row)
    other.rows.position.row(row) =
        (place * Eigen::Vector3d(data.rows.position.row(row).transpose())).transpose();
  return other;
}

void expect_same(const Solution& other, const Solution& one, const std::string& what) {
  EXPECT_EQ(other.verdict.answer, one.verdict.answer) << what << ": " << other.verdict.why;
  EXPECT_EQ(other.outliers.size(), one.outliers.size()) << what;
  for (size_t i = 0; i < one.parameters.size(); ++i) {
    const ParameterResult& a = one.parameters[i];
    const ParameterResult& b = other.parameters[i];
    EXPECT_EQ(a.status, b.status) << what << ": " << a.parameter.name;
    EXPECT_LE(std::abs(b.value - a.value), kSameWithinSigma * std::max(a.sigma, 1e-9))
        << what << ": " << a.parameter.name;
  }
}

class ArmOf : public testing::TestWithParam<int> {};

TEST_P(ArmOf, SoManyJointsIsTheSameInAnyOrderAndFromAnywhere) {
  const auto robot = arm_with(GetParam());
  Random random(11);
  std::normal_distribution<double> normal;
  Eigen::VectorXd truth = nominal_values(*robot);
  for (Eigen::Index i = 0; i < truth.size(); ++i)
    if (robot->parameters()[static_cast<size_t>(i)].free) truth[i] += 5e-4 * normal(random);
  const std::vector<SetPart> parts = {
      {"tracker", entry({{"method", "position"}, {"frame", "unknown"}, {"noise", "2e-5"}}), 150}};
  const Session session = make_session(*robot, truth, parts, kNoise, random);
  ASSERT_EQ(session.unreached, "");
  const Solution one = identify(*robot, session.data);
  EXPECT_EQ(one.verdict.answer, Answer::improved) << one.verdict.why;
  EXPECT_NEAR(one.residual.check.rms_after, std::sqrt(3.0) * kNoise, 0.5 * kNoise);
  expect_same(identify(*robot, reordered(session.data, random)), one, "in another order");
  const Eigen::Isometry3d far = Eigen::Translation3d(7, -12, 3) *
                                Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, -2, 0.5).normalized());
  expect_same(identify(*robot, seen_from(session.data, far)), one, "from elsewhere");
}

/// An arm that is hard on the numerics, and so are its rows.
struct Hard {
  std::string name, j5;  ///< the fifth joint: its frame and its limits
};

class HardArm : public testing::TestWithParam<Hard> {
 protected:
  std::shared_ptr<const Robot> robot() const {
    auto robot = selfcal::robot_of(
        "robot: arm\nkind: serial\nframes:\n"
        "  - {name: base, joint: fixed, r: 0.4}\n"
        "  - {name: j1, joint: revolute, alpha: 0.1, limits: [-2.4, 2.4]}\n"
        "  - {name: j2, joint: revolute, alpha: -pi/2, d: 0.1, limits: [-2.0, 2.0]}\n"
        "  - {name: j3, joint: revolute, d: 0.5, limits: [-2.4, 2.4]}\n"
        "  - {name: j4, joint: revolute, alpha: pi/2, r: 0.5, limits: [-2.4, 2.4]}\n"
        "  - {name: j5, joint: revolute, " +
            GetParam().j5 +
            "}\n"
            "  - {name: j6, joint: revolute, alpha: pi/2, limits: [-2.4, 2.4]}\n"
            "  - {name: tool, joint: fixed, d: 0.1, theta: 0.7, r: 0.15}\n",
        "arm");
    EXPECT_TRUE(robot.has_value()) << robot.error().what;
    return std::move(*robot);
  }

  static DataSet tracked(const Robot& robot, Random& random) {
    std::normal_distribution<double> normal;
    Eigen::VectorXd truth = nominal_values(robot);
    for (Eigen::Index i = 0; i < truth.size(); ++i)
      if (robot.parameters()[static_cast<size_t>(i)].free) truth[i] += 5e-4 * normal(random);
    const std::vector<SetPart> parts = {
        {"tracker", entry({{"method", "position"}, {"frame", "unknown"}, {"noise", "2e-5"}}), 150}};
    Session session = make_session(robot, truth, parts, kNoise, random);
    EXPECT_EQ(session.unreached, "");
    // Whatever order they come in, this is when they were taken.
    session.data.rows.time = Eigen::VectorXd::LinSpaced(session.data.rows.rows(), 0, 1490);
    return std::move(session.data);
  }
};

TEST_P(HardArm, IsTheSameInAnyOrderAndFromAnywhere) {
  const auto arm = robot();
  Random random(12);
  const DataSet data = tracked(*arm, random);
  const Solution one = identify(*arm, data);
  EXPECT_NEAR(one.residual.check.rms_after, std::sqrt(3.0) * kNoise, 0.5 * kNoise);
  expect_same(identify(*arm, reordered(data, random)), one, "in another order");
  const Eigen::Isometry3d far = Eigen::Translation3d(-3, 5, 1) *
                                Eigen::AngleAxisd(1.1, Eigen::Vector3d(2, 1, -1).normalized());
  expect_same(identify(*arm, seen_from(data, far)), one, "from elsewhere");
}

TEST_P(HardArm, IsDiagnosedTheSameInAnyOrderAndFromAnywhere) {
  const auto arm = robot();
  Random random(13);
  DataSet data = tracked(*arm, random);
  // The third gear is uneven by a tenth of a millimetre at the end.
  for (Eigen::Index row = 0; row < data.rows.q.rows(); ++row)
    data.rows.q(row, 2) += 2e-4 * std::sin(3 * data.rows.q(row, 2));
  DiagnosisOptions options;
  options.simulated_sessions = 0;
  const Diagnosis one = diagnose(arm, data, options);
  EXPECT_EQ(one.verdict.effect, "transmission_error");
  EXPECT_EQ(one.verdict.where, std::vector<std::string>{"j3"});
  const Eigen::Isometry3d far(Eigen::Translation3d(4, 0, -2) *
                              Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ()));
  const Diagnosis again = diagnose(arm, reordered(seen_from(data, far), random), options);
  EXPECT_EQ(again.verdict.effect, one.verdict.effect);
  EXPECT_EQ(again.verdict.where, one.verdict.where);
  EXPECT_NEAR(again.verdict.probability, one.verdict.probability, 0.02);
  EXPECT_NEAR(again.gap.rms_before, one.gap.rms_before, 1e-3 * one.gap.rms_before);
}

INSTANTIATE_TEST_SUITE_P(
    Numerics, HardArm,
    testing::Values(Hard{"Usual", "alpha: -pi/2, limits: [-2.0, 2.0]"},
                    Hard{"CoincidentAxes", "limits: [-2.0, 2.0]"},
                    Hard{"NearlyCoincidentAxes", "alpha: 1.0e-3, limits: [-2.0, 2.0]"},
                    Hard{"SingularWrist", "alpha: -pi/2, limits: [-0.01, 0.01]"},
                    Hard{"HardlyMovedJoint", "alpha: -pi/2, theta: 0.5, limits: [-0.02, 0.02]"}),
    [](const auto& each) { return each.param.name; });

INSTANTIATE_TEST_SUITE_P(Joints, ArmOf, testing::Range(3, 10));

}  // namespace
}  // namespace selfcal::recovery
