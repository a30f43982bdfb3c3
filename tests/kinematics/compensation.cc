// Commands that put a calibrated robot where it is wanted, by its own forward kinematics.
#include "kinematics/inverse/compensation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <numbers>
#include <random>

#include "constraints/sampling/random_poses.h"
#include "io/files/robot_file.h"
#include "kinematics/corrected_robot.h"
#include "kinematics/inverse/compensation_stream.h"
#include "kinematics/rotation.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"
#include "tests/support/arm_of_size.h"

namespace selfcal {
namespace {

using Robots = std::pair<std::shared_ptr<const Robot>, std::shared_ptr<const Robot>>;

/// The robot of `text`, and one off by 1 mm and 1 mrad in every parameter, with `effects`.
Robots off_by_a_millimetre(const std::string& text, const std::string& effects = "") {
  std::shared_ptr<const Robot> nominal = robot_of(text);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Eigen::VectorXd xi = values(*nominal);
  for (std::size_t i = 0; i < nominal->parameters().size(); ++i)
    if (const Parameter& p = nominal->parameters()[i]; p.free)
      xi[static_cast<Eigen::Index>(i)] += 1e-3 * normal(random);
  std::string file = robot_text(*nominal, xi);
  if (!effects.empty()) file += "effects: " + effects + "\n";
  return {nominal, robot_of(file)};
}

/// Poses of the nominal robot all over its range, and the largest errors of the calibrated one
/// there by the commands. Some of them stand at a limit, or where the wrist is stretched and a
/// millimetre turns its joints by more than a correction may.
void expect_compensated(const Robots& robots, int poses, double most) {
  const auto& [nominal, calibrated] = robots;
  const Eigen::VectorXd xi = values(*calibrated);
  const Compensation compensation(nominal, calibrated);
  const Eigen::MatrixXd q = random_poses(*nominal, nullptr, poses, 7);
  double error = 0, angle = 0;
  std::map<Reach, int> count;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Location wanted = locate(*nominal, values(*nominal), q.row(i).transpose());
    const Command command = compensation.command(wanted, Eigen::VectorXd(q.row(i).transpose()));
    ++count[command.status];
    if (command.status != Reach::reached) {
      EXPECT_EQ(command.q.size(), 0);
      continue;
    }
    EXPECT_TRUE(within_limits(*nominal, command.q));
    const Location is = locate(*calibrated, xi, command.q);
    error = std::max(error, (is.p - wanted.p).norm());
    if (nominal->joints().size() >= 6)
      angle = std::max(angle, log_rotation(is.R * wanted.R.transpose()).norm());
  }
  std::printf("%s: %d of %d poses, %.2g m and %.2g rad at most; %d singular, %d at a limit\n",
              nominal->name().c_str(), count[Reach::reached], poses, error, angle,
              count[Reach::singular], count[Reach::limit]);
  EXPECT_EQ(count[Reach::out_of_reach], 0);
  EXPECT_GT(count[Reach::reached], 0.9 * poses);
  EXPECT_LT(error, most);
  EXPECT_LT(angle, most);
}

std::string shipped(const std::string& name) {
  const auto robot = load_robot(SELFCAL_SOURCE_DIR "/app/examples/" + name + ".robot.yaml");
  return robot_text(**robot, values(**robot));
}

TEST(Compensation, PutsTheIrb1600WhereItIsWantedToUnderAMicrometre) {
  expect_compensated(off_by_a_millimetre(shipped("irb1600")), 10000, 1e-8);
}

/// Poses that the calibrated arm itself can have, with readings to stay near: the whole pose is to
/// be had though five joints cannot have any.
TEST(Compensation, OfFiveJointsReachesTheWholePoseWhereTheyCan) {
  const auto [nominal, calibrated] = off_by_a_millimetre(R"({robot: five, kind: serial, frames: [
    {name: base, joint: fixed, r: 0.147},
    {name: a1, joint: revolute, limits: [-2.9, 2.9]},
    {name: a2, joint: revolute, alpha: -pi/2, d: 0.033, theta: -pi/2, limits: [-1.1, 1.5]},
    {name: a3, joint: revolute, d: 0.155, limits: [-2.5, 2.5]},
    {name: a4, joint: revolute, d: 0.135, theta: -pi/2, limits: [-1.7, 1.7]},
    {name: a5, joint: revolute, alpha: -pi/2, limits: [-2.9, 2.9]},
    {name: tool, joint: fixed, r: 0.2175}]})");
  const Compensation compensation(nominal, calibrated);
  const Eigen::VectorXd xi = values(*calibrated);
  const Eigen::MatrixXd q = 0.9 * random_poses(*nominal, nullptr, 100, 7);
  int whole = 0, near = 0;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Location wanted = locate(*calibrated, xi, q.row(i).transpose());
    const Eigen::VectorXd beside = q.row(i).transpose().array() + 0.05;
    const Command command = compensation.command(wanted, beside);
    if (command.status != Reach::reached) continue;
    const Location is = locate(*calibrated, xi, command.q);
    EXPECT_LT((is.p - wanted.p).norm(), 1e-8) << i;
    whole += log_rotation(is.R * wanted.R.transpose()).norm() < 1e-7;
    near += (command.q - beside).lpNorm<Eigen::Infinity>() < 0.3;
  }
  std::printf("five joints: %d of 100 whole poses, %d near the readings\n", whole, near);
  EXPECT_GE(whole, 95);
  EXPECT_GE(near, 95);
}

TEST(Compensation, IsTheSameForRobotsOfTenCentimetresAndTenMetres) {
  const std::shared_ptr<const Robot> one = arm_of_size(1);
  const Eigen::MatrixXd q = random_poses(*one, nullptr, 100, 7);
  const auto commands = [&](double scale) {
    const std::shared_ptr<const Robot> nominal = arm_of_size(scale);
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    Eigen::VectorXd xi = values(*nominal);
    for (std::size_t i = 0; i < nominal->parameters().size(); ++i)
      if (const Parameter& p = nominal->parameters()[i]; p.free)
        xi[static_cast<Eigen::Index>(i)] +=
            1e-3 * (p.quantity == Quantity::length ? scale : 1) * normal(random);
    const std::shared_ptr<const Robot> calibrated = robot_of(robot_text(*nominal, xi));
    const Compensation compensation(nominal, calibrated);
    std::vector<Command> list;
    std::vector<StreamedCommand> streamed;
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      const Eigen::VectorXd near = q.row(i).transpose();
      const Location wanted = locate(*nominal, values(*nominal), near);
      list.push_back(compensation.command(wanted, near));
      streamed.push_back(CompensationStream::of(calibrated, near)->command(wanted));
    }
    return std::pair(list, streamed);
  };
  const auto [expected, followed] = commands(1);
  for (const double scale : {0.1, 10.0}) {
    const auto [found, streamed] = commands(scale);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].status, expected[i].status) << scale << " " << i;
      EXPECT_EQ(streamed[i].status, followed[i].status) << scale << " " << i;
      if (found[i].status != Reach::reached || expected[i].status != Reach::reached) continue;
      EXPECT_EQ(found[i].iterations, expected[i].iterations) << scale << " " << i;
      EXPECT_LT((found[i].q - expected[i].q).cwiseAbs().maxCoeff(), 1e-9) << scale << " " << i;
    }
  }
}

TEST(Compensation, TakesEffectsAlong) {
  expect_compensated(
      off_by_a_millimetre(shipped("rx90"),
                          "[{effect: transmission_error, at: j2, sin1: 1.0e-3, cos1: 5.0e-4}]"),
      200, 1e-8);
}

TEST(Compensation, HoldsAtTheLoadAndTheTemperatureThatAreGiven) {
  const auto [nominal, calibrated] = off_by_a_millimetre(
      shipped("rx90"),
      "[{effect: tool_compliance, at: probe, mass: 1, bend_x: 1.0e-4, bend_y: 1.0e-4}, {effect: "
      "thermal_expansion, alpha: 1.2e-5, reference: 20}]");
  OperatingPoint at;
  at.mass = 8;
  at.centre = {0.02, 0, 0.1};
  at.temperature = 32;
  const Compensation loaded(nominal, calibrated, at), cold(nominal, calibrated);
  const Eigen::VectorXd xi = values(*calibrated);
  const Eigen::MatrixXd q = random_poses(*nominal, nullptr, 40, 3);
  int reached = 0;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Eigen::VectorXd near = q.row(i).transpose();
    const Location wanted = locate(*nominal, values(*nominal), near);
    const Command command = loaded.command(wanted, near), plain = cold.command(wanted, near);
    if (command.status != Reach::reached || plain.status != Reach::reached) continue;
    ++reached;
    // The weight by hand, in the tool's axes where it really is.
    ConfigurationBlock block = block_of(command.q);
    const Eigen::Vector3d force = wanted.R.transpose() * Eigen::Vector3d(0, 0, -9.81 * at.mass);
    block.conditions.wrench.resize(1, 6);
    block.conditions.wrench << force.transpose(), at.centre.cross(force).transpose();
    block.conditions.temperature = Eigen::VectorXd::Constant(1, at.temperature);
    Locations X;
    calibrated->locate(block, xi, Body::endpoint, X, nullptr);
    EXPECT_LT((X.p(0) - wanted.p).norm(), 1e-8);
    block.q.rowwise() = plain.q.transpose().array();
    calibrated->locate(block, xi, Body::endpoint, X, nullptr);
    // 12 K on more than a decimetre.
    EXPECT_GT((X.p(0) - wanted.p).norm(), 1e-5) << "what load and warmth do is compensated";
  }
  EXPECT_GT(reached, 30);
}

TEST(Compensation, GivesEverySolutionWithinTheLimitsNearestFirst) {
  const auto [nominal, calibrated] = off_by_a_millimetre(shipped("rx90"));
  const Compensation compensation(nominal, calibrated);
  const Eigen::VectorXd near = (Eigen::VectorXd(6) << 0.3, -0.6, 0.9, 0.4, 1.2, 0.2).finished();
  const Location wanted = locate(*nominal, values(*nominal), near);
  const std::vector<Command> all = compensation.commands(wanted, near);
  EXPECT_GE(all.size(), 2U);
  double before = 0;
  for (const Command& each : all) {
    EXPECT_EQ(each.status, Reach::reached);
    const Location is = locate(*calibrated, values(*calibrated), each.q);
    EXPECT_LT((is.p - wanted.p).norm(), 1e-8);
    EXPECT_TRUE(within_limits(*nominal, each.q));
    const double apart = (each.q - near).cwiseAbs().maxCoeff();
    EXPECT_GE(apart, before - 0.02) << "the corrections are a few hundredths";
    before = apart;
  }
  EXPECT_EQ(all.front().q, compensation.command(wanted, near).q);
}

TEST(Compensation, TurnsAJointRoundThatACorrectionBringsBeyondItsLimit) {
  const std::string text = shipped("rx90");
  const std::shared_ptr<const Robot> nominal = robot_of(text);
  Eigen::VectorXd xi = values(*nominal);
  xi[find_parameter(*nominal, "j4.theta")] -= 2e-3;
  const std::shared_ptr<const Robot> calibrated = robot_of(robot_text(*nominal, xi));
  const Compensation compensation(nominal, calibrated);
  // Within the limit of joint 4, 4.71 rad, by less than it is off.
  const Eigen::VectorXd near = (Eigen::VectorXd(6) << 0.3, -0.5, 0.8, 4.7095, 1.95, 0.4).finished();
  const Location wanted = locate(*nominal, values(*nominal), near);
  const Command command = compensation.command(wanted, near);
  ASSERT_EQ(command.status, Reach::reached);
  EXPECT_NEAR(command.q[3], near[3] + 2e-3 - 2 * std::numbers::pi, 1e-6);
  EXPECT_TRUE(within_limits(*nominal, command.q));
  EXPECT_LT((locate(*calibrated, values(*calibrated), command.q).p - wanted.p).norm(), 1e-8);
}

TEST(Compensation, ReadsAParallelRobotOffItsIdentifiedChains) {
  const auto [nominal, calibrated] = off_by_a_millimetre(kind_examples().at("gough-stewart"));
  const Compensation compensation(nominal, calibrated);
  const Eigen::VectorXd q = random_poses(*nominal, nullptr, 1, 2).row(0).transpose();
  const Command command =
      compensation.command(locate(*nominal, values(*nominal), q), Eigen::VectorXd(q));
  EXPECT_EQ(command.status, Reach::reached);
  EXPECT_EQ(command.iterations, 0);
}

TEST(Compensation, WorksForRobotsWithLoops) {
  for (const char* kind : {"linear-delta", "gough-stewart", "hexaslide"})
    expect_compensated(off_by_a_millimetre(kind_examples().at(kind)), 60, 1e-8);
}

const char* const kTwoLinks =
    "robot: planar\nkind: serial\nframes:\n"
    "  - {name: j1, joint: revolute, limits: [-1, 1]}\n"
    "  - {name: j2, joint: revolute, d: 1, limits: [-2, 2]}\n"
    "  - {name: tool, joint: fixed, d: 1}\n";

Command of_two_links(const Location& wanted, const char* calibrated = kTwoLinks) {
  const std::shared_ptr<const Robot> nominal = robot_of(kTwoLinks), other = robot_of(calibrated);
  const Compensation compensation(nominal, other);
  return compensation.command(wanted, std::nullopt);
}

/// A robot whose inverse has no closed form: no three of its axes meet or are parallel.
const char* const kWithoutClosedForm =
    "robot: crooked\nkind: serial\nframes:\n"
    "  - {name: base, joint: fixed, r: 0.4}\n"
    "  - {name: j1, joint: revolute, r: 0.3, limits: [-2.5, 2.5]}\n"
    "  - {name: j2, joint: revolute, alpha: -1.5, d: 0.15, limits: [-1.5, 1.5]}\n"
    "  - {name: j3, joint: prismatic, alpha: 1.4, d: 0.1, r: 0.5, limits: [-0.1, 0.3]}\n"
    "  - {name: j4, joint: revolute, alpha: 0.02, r: 0.3, limits: [-2.5, 2.5]}\n"
    "  - {name: j5, joint: revolute, alpha: -1.5, d: 0.15, limits: [-1.5, 1.5]}\n"
    "  - {name: j6, joint: revolute, alpha: 1.5, d: 0.05, limits: [-1.5, 1.5]}\n"
    "  - {name: tool, joint: fixed, d: 0.03, r: 0.12}\n";

TEST(Compensation, ReachesWhereTheCalibratedRobotIsNearTheReadingsThatAreAskedFor) {
  for (const std::string& text :
       {shipped("rx90"), shipped("irb1600"), std::string(kWithoutClosedForm)}) {
    const auto [nominal, calibrated] = off_by_a_millimetre(text);
    const Compensation compensation(nominal, calibrated);
    // Among them places at the edge of its reach and of the joints' ways, where the nominal robot
    // is elsewhere or does not get to.
    const Eigen::MatrixXd q = random_poses(*nominal, nullptr, 500, 7);
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      const Eigen::VectorXd near = q.row(i).transpose();
      const Command command =
          compensation.command(locate(*calibrated, values(*calibrated), near), near);
      EXPECT_EQ(command.status, Reach::reached) << nominal->name() << " " << i;
    }
  }
}

/// A wrist that is nearly stretched: the nominal robot's nearest solution may be the other one.
TEST(Compensation, DoesNotTurnAWristRoundThatIsWhereItIsWanted) {
  const auto [nominal, calibrated] = off_by_a_millimetre(shipped("irb1600"));
  const Compensation compensation(nominal, calibrated);
  Eigen::MatrixXd q = random_poses(*nominal, nullptr, 200, 7);
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    q(i, 4) = 0.06 * static_cast<double>(i) / static_cast<double>(q.rows() - 1) - 0.03;
    const Eigen::VectorXd here = q.row(i).transpose();
    const Location wanted = locate(*calibrated, values(*calibrated), here);
    const Command command = compensation.command(wanted, here);
    ASSERT_EQ(command.status, Reach::reached) << i;
    EXPECT_LT((command.q - here).cwiseAbs().maxCoeff(), 0.3) << i;
    const auto all = compensation.commands(wanted, here);
    EXPECT_LT((all.front().q - here).cwiseAbs().maxCoeff(), 0.3) << i;
    for (std::size_t k = 1; k < all.size(); ++k)
      EXPECT_GT((all[k].q - all.front().q).cwiseAbs().maxCoeff(), 1e-6) << i;
  }
}

TEST(Compensation, TriesEverySolutionBeforeItSaysThatThereIsNone) {
  const auto [nominal, calibrated] = off_by_a_millimetre(kWithoutClosedForm);
  const Compensation compensation(nominal, calibrated);
  const Eigen::MatrixXd q = random_poses(*nominal, nullptr, 300, 7);
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Eigen::VectorXd near = q.row(i).transpose();
    const Location wanted = locate(*nominal, values(*nominal), near);
    EXPECT_EQ(compensation.command(wanted, near).status,
              compensation.commands(wanted, near).front().status)
        << i;
  }
}

TEST(Compensation, SaysWhatIsInTheWay) {
  const Eigen::Matrix3d level = Eigen::Matrix3d::Identity();
  EXPECT_EQ(of_two_links({level, {1.2, 0.3, 0}}).status, Reach::reached);
  // Half a metre farther than both links are long.
  const Command far = of_two_links({level, {2.5, 0, 0}});
  EXPECT_EQ(far.status, Reach::out_of_reach);
  EXPECT_EQ(far.q.size(), 0);
  EXPECT_NEAR(far.error, 0.5, 1e-3);
  // Behind it: within reach, but not for joint 1.
  EXPECT_EQ(of_two_links({level, {-1.9, 0, 0}}).status, Reach::limit);
  // A hair farther than the nominal robot reaches, which one that is longer by 2 mm does.
  EXPECT_EQ(of_two_links({level, {2.001, 0, 0}},
                         "robot: planar\nkind: serial\nframes:\n"
                         "  - {name: j1, joint: revolute, limits: [-1, 1]}\n"
                         "  - {name: j2, joint: revolute, d: 1.002, limits: [-2, 2]}\n"
                         "  - {name: tool, joint: fixed, d: 1}\n")
                .status,
            Reach::reached);
  // Stretched: the nominal robot just gets there, one that is shorter by 2 mm does not.
  const Command stretched = of_two_links({level, {2, 0, 0}},
                                         "robot: planar\nkind: serial\nframes:\n"
                                         "  - {name: j1, joint: revolute, limits: [-1, 1]}\n"
                                         "  - {name: j2, joint: revolute, d: 0.998,"
                                         " limits: [-2, 2]}\n"
                                         "  - {name: tool, joint: fixed, d: 1}\n");
  EXPECT_EQ(stretched.status, Reach::singular);
  EXPECT_NEAR(stretched.error, 2e-3, 1e-5);
}

}  // namespace
}  // namespace selfcal
