// Platforms that are told lengths of another assembly mode: they stand in their own or nowhere, and
// say which.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "kinematics/robots/platform.h"
#include "kinematics/rotation.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

using platform::at_pose;
using platform::Chains;
using platform::Platform;

class AssemblyModes : public testing::TestWithParam<const char*> {};

TEST_P(AssemblyModes, AreNeverExchangedForAnotherWhateverTheLengthsFit) {
  const auto robot = robot_of(kind_examples().at(GetParam()));
  const auto& machine = dynamic_cast<const Platform&>(*robot);
  const Eigen::VectorXd xi = values(*robot);
  const Location home = *robot->home();
  const double own =
      at_pose(machine.chains(xi, *machine.readings_at(xi, home), platform::Six::Zero()), home)
          .volume;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> turn(0.8, std::numbers::pi), shift(-0.1, 0.1);
  int there = 0, elsewhere = 0, nowhere = 0, refused = 0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d(normal(random), normal(random), normal(random));
    const Location X{exp_rotation(turn(random) * axis.normalized()) * home.R,
                     home.p + Eigen::Vector3d(shift(random), shift(random), shift(random))};
    const auto q = machine.readings_at(xi, X);
    if (!q) continue;
    Locations found;
    const Closure closure = robot->locate(block_of(*q), xi, Body::endpoint, found, nullptr);
    if (!closure.closes(0)) {
      ++nowhere;
      refused += closure.why[0].find("another assembly mode") != std::string::npos;
      continue;
    }
    const Location at = found.at(0);
    const Chains chains = machine.chains(xi, *q, platform::Six::Zero());
    for (int k = 0; k < platform::kChains; ++k)
      EXPECT_NEAR((at.p + at.R * chains.joint.col(k) - chains.carrier.col(k)).norm(),
                  chains.length[k], 1e-12);
    EXPECT_GT(at_pose(chains, at).volume * own, 0) << "on the other side of the singular places";
    EXPECT_LT(log_rotation(at.R * home.R.transpose()).norm(), 2.2);
    ++((at.p - X.p).norm() + (at.R - X.R).norm() < 1e-9 ? there : elsewhere);
  }
  std::printf("%s: %d in the mode meant, %d in its own, %d in none, of these %d named as another\n",
              GetParam(), there, elsewhere, nowhere, refused);
  EXPECT_GT(elsewhere, 0);
  EXPECT_GT(refused, 0);
}

TEST_P(AssemblyModes, AreThoseOfALaneAloneWhateverStandsBesideItAndWhereverItIsSaidToBeNear) {
  const auto robot = robot_of(kind_examples().at(GetParam()));
  const Eigen::VectorXd xi = values(*robot);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform;
  ConfigurationBlock block{Eigen::ArrayXXd(kLanes, robot->joints().size()), kLanes};
  for (int lane = 0; lane < kLanes; ++lane)
    for (Eigen::Index j = 0; j < block.q.cols(); ++j) {
      const Joint& joint = robot->joints()[static_cast<std::size_t>(j)];
      // Some are far out of reach, and every other lane repeats the one before.
      const double share = lane % 6 == 2 ? -20 - 20 * uniform(random) : 0.3 + 0.4 * uniform(random);
      block.q(lane, j) =
          lane % 2 ? block.q(lane - 1, j) : joint.lower + share * (joint.upper - joint.lower);
    }
  Locations alone, together, near, wrong;
  PsiBlock psi_alone, psi;
  robot->locate(block, xi, Body::endpoint, together, &psi);
  const Locations known = together;
  wrong.rotation.colwise() = Eigen::ArrayXd::Zero(kLanes);
  wrong.position.setConstant(3);
  int open = 0;
  for (const Locations* hint :
       {static_cast<const Locations*>(nullptr), &known, static_cast<const Locations*>(&wrong)}) {
    block.near = hint;
    const Closure again = robot->locate(block, xi, Body::endpoint, near, &psi);
    for (int lane = 0; lane < kLanes; ++lane) {
      const Closure one = robot->locate(block_of(block.q.row(lane).matrix().transpose()), xi,
                                        Body::endpoint, alone, &psi_alone);
      open += !again.closes(lane);
      EXPECT_EQ(again.closes(lane), again.closes(lane - lane % 2)) << lane;
      if (!one.closes(0)) continue;  // a way to it may lead from elsewhere
      ASSERT_TRUE(again.closes(lane)) << lane;
      EXPECT_LT((near.p(lane) - alone.p(0)).norm(), 1e-11);
      EXPECT_LT((near.R(lane) - alone.R(0)).norm(), 1e-11);
      for (int c = 0; c < 6; ++c)
        EXPECT_LT((psi.row(c * kLanes + lane) - psi_alone.row(c)).norm(),
                  1e-9 * (1 + psi_alone.row(c).norm()));
    }
  }
  EXPECT_GT(open, 0);
}

INSTANTIATE_TEST_SUITE_P(Platforms, AssemblyModes, testing::Values("gough-stewart", "hexaslide"),
                         [](const auto& made) {
                           return std::string(made.param) == "hexaslide" ? "HexaSlide"
                                                                         : "GoughStewart";
                         });

TEST(SingularPlace, OfARegularHexapodIsAQuarterTurnAboutItsAxisAndSaidToBeLoose) {
  // Fichter's: joints on two circles, the platform turned by a quarter.
  Chains chains;
  for (int i = 0; i < platform::kChains; ++i) {
    const double side = i % 2 == 0 ? -1 : 1, third = 2 * std::numbers::pi / 3 * (i / 2);
    const double a = third + side * 0.2, b = third + side * 0.9;
    chains.carrier.col(i) << 0.5 * std::cos(a), 0.5 * std::sin(a), 0;
    chains.joint.col(i) << 0.3 * std::cos(b), 0.3 * std::sin(b), 0;
  }
  const Location X{exp_rotation({0, 0, std::numbers::pi / 2}), {0, 0, 0.4}};
  for (int i = 0; i < platform::kChains; ++i)
    chains.length[i] = (X.p + X.R * chains.joint.col(i) - chains.carrier.col(i)).norm();
  EXPECT_THAT(platform::close(chains, X, nullptr).open, testing::HasSubstr("loose there"));
}

}  // namespace
}  // namespace selfcal
