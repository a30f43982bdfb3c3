// Compliance of joints and links by numbers worked by hand.
#include "tests/effects/by_hand.h"

namespace selfcal {
namespace {

TEST(JointComplianceByHand, LowersTheTipByTheTorqueOfTheWeight) {
  // 10 kg x 9.81 m/s^2 x 1 m = 98.1 N m; x 1e-6 = 98.1 urad; x 1 m = 98.1 um down.
  const std::string soft = "[{effect: joint_compliance, at: j1, c: 1.0e-6}]";
  const Moved level = moved(kPendulum, soft, {});
  expect_near(level.p, 0, 0, -98.1e-6);
  expect_near(level.turn, 0, 98.1e-6, 0);
  // 60 degrees down: 98.1 cos 60 = 49.05 N m; the tip moves by 49.05 um across the arm, which
  // points along (cos 60, 0, -sin 60): (-sin 60, 0, -cos 60) x 49.05 = (-42.478, 0, -24.525) um.
  const Moved steep = moved(kPendulum, soft, {numbers({60 * kDegree})});
  expect_near(steep.p, -42.478e-6, 0, -24.525e-6);
  // Straight down: no torque.
  expect_near(moved(kPendulum, soft, {numbers({90 * kDegree})}).p, 0, 0, 0);
}

TEST(JointComplianceByHand, GivesWayToTheWrenchOnTheTool) {
  // 120 N along the tool's y, which points down: 120 N m more than the weight's 98.1; 10 N m about
  // its z, the joint's own axis: 228.1 N m in all. A force along the arm (x) and across it (z), and
  // moments about these, do nothing.
  const std::string soft = "[{effect: joint_compliance, at: j1, c: 1.0e-6}]";
  Held held;
  held.wrench = numbers({70, 120, -50, 3, 4, 10});
  expect_near(moved(kPendulum, soft, held).turn, 0, 228.1e-6, 0);
  // 90 degrees down the weight does nothing and the tool has turned along: 130 N m.
  held.q = numbers({90 * kDegree});
  expect_near(moved(kPendulum, soft, held).turn, 0, 130e-6, 0);
  // A wrench that is not known is none: 98.1 N m of the weight.
  held.q = numbers({0});
  held.wrench.setConstant(kUnknown);
  expect_near(moved(kPendulum, soft, held).turn, 0, 98.1e-6, 0);
}

TEST(JointComplianceByHand, LetsASlideSagByItsWeight) {
  // 10 kg on a vertical slide: 98.1 N down, against the axis; x 1e-6 m/N = 98.1 um.
  const std::string lift =
      "robot: lift\nkind: serial\nframes:\n"
      "  - {name: j1, joint: prismatic, mass: 10}\n"
      "  - {name: tool, joint: fixed, d: 1}\n";
  expect_near(moved(lift, "[{effect: joint_compliance, at: j1, c: 1.0e-6}]", {}).p, 0, 0, -98.1e-6);
}

/// Two links of 0.8 m and 0.5 m in one vertical plane: 5 kg at 0.4 m of the first, 3 kg at the end
/// of the second.
std::string two_links(bool with_masses) {
  const std::string m1 = with_masses ? ", mass: 5, com: [0.4, 0, 0]" : "";
  const std::string m2 = with_masses ? ", mass: 3, com: [0.5, 0, 0]" : "";
  return "robot: two\nkind: serial\nframes:\n"
         "  - {name: j1, joint: revolute, alpha: -1.5707963267948966" +
         m1 + "}\n" + "  - {name: j2, joint: revolute, d: 0.8" + m2 + "}\n" +
         "  - {name: tool, joint: fixed, d: 0.5}\n";
}

TEST(JointComplianceByHand, HasLumpsThatAreTheFirstMomentsTimesTheCompliance) {
  // tau_1 = g (5 x 0.4 + 3 x 0.8) cos q1 + g 3 x 0.5 cos(q1 + q2): with c = 1e-6 the lumps are
  //   x_j1 = 1e-6 x 9.81 x 4.4 = 43.164e-6,  x_j2 = 1e-6 x 9.81 x 1.5 = 14.715e-6.
  // At q = (30, 30) degrees: 43.164 cos 30 + 14.715 cos 60 = 37.381 + 7.358 = 44.739 urad.
  const Held held{numbers({30 * kDegree, 30 * kDegree})};
  const Moved by_masses =
      moved(two_links(true), "[{effect: joint_compliance, at: j1, c: 1.0e-6}]", held);
  expect_near(by_masses.turn, 0, 44.739e-6, 0);
  const Moved by_lumps =
      moved(two_links(false),
            "[{effect: joint_compliance, at: j1, x_j1: 43.164e-6, x_j2: 14.715e-6}]", held);
  expect_near(by_lumps.turn, 0, 44.739e-6, 0);
  expect_near(by_lumps.p - by_masses.p, 0, 0, 0, 1e-12);
  // 1 mrad of y_j1, a centre beside the first link (its frame's y points down at q1 = 0, z = y of
  // the world): torque y' x g along the axis is -sin q1 of it: -0.5 mrad at 30 degrees.
  const Moved beside =
      moved(two_links(false), "[{effect: joint_compliance, at: j1, y_j1: 1.0e-4}]", held);
  expect_near(beside.turn, 0, -50e-6, 0);
}

TEST(JointComplianceByHand, OfASpringThatStiffensGrowsWithTheSquareOfTheTorque) {
  // At q = (30, 30) degrees tau_1 = 44.739 N m (see above), and tau_1^2 = 2001.6 (N m)^2; on the
  // other side, q = (150, -30), tau_1 = 43.164 cos 150 + 14.715 cos 120 = -44.739 N m.
  for (const double side : {1.0, -1.0}) {
    const double first = side > 0 ? 30 : 150, second = side > 0 ? 30 : -30;
    const Moved by = moved(two_links(true),
                           "[{effect: joint_compliance, at: j1, c: 1.0e-6},"
                           " {effect: joint_compliance, at: j1, by: square, c2: -5.0e-9}]",
                           Held{numbers({first * kDegree, second * kDegree})});
    expect_near(by.turn, 0, side * (44.739e-6 - 10.008e-6), 0);
  }
}

TEST(JointComplianceByHand, HasForASlideOneLumpThatItsAxisTakesDown) {
  // An axis 60 degrees off the vertical, (0, -sin 60, cos 60): gravity pulls along it by -cos 60 of
  // what hangs there, 100 um for all of it: 50 um back, whatever turns behind it.
  const std::string slide =
      "robot: slide\nkind: serial\nframes:\n"
      "  - {name: j1, joint: prismatic, alpha: pi/3}\n"
      "  - {name: j2, joint: revolute, d: 0.3}\n  - {name: tool, joint: fixed, d: 1}\n";
  const Moved by =
      moved(slide, "[{effect: joint_compliance, at: j1, z_j1: 1.0e-4}]", {numbers({0.4, 1.2})});
  expect_near(by.p, 0, 43.301e-6, -25e-6);
  expect_near(by.turn, 0, 0, 0);
}

TEST(JointComplianceByHand, HasForACarriedSlideALumpTimesHowFarItIsOut) {
  // j1 about the world's y, a slide along the arm that is 0.1 + 0.4 m out: of 200 urad a metre 100
  // urad down, and of the arm's own moment 30 urad more. 60 degrees down half of both.
  const std::string boom =
      "robot: boom\nkind: serial\nframes:\n"
      "  - {name: j1, joint: revolute, alpha: -pi/2}\n"
      "  - {name: j2, joint: prismatic, d: 0.2, beta: pi/2, r: 0.1}\n"
      "  - {name: tool, joint: fixed, r: 0.3}\n";
  const std::string soft = "[{effect: joint_compliance, at: j1, x_j1: 3.0e-5, z_j2: 2.0e-4}]";
  expect_near(moved(boom, soft, {numbers({0, 0.4})}).turn, 0, 130e-6, 0);
  expect_near(moved(boom, soft, {numbers({60 * kDegree, 0.4})}).turn, 0, 65e-6, 0);
}

TEST(JointComplianceByHand, IsUsedAboutTheSecondJointWithWhatItCarriesAlone) {
  // tau_2 = g 3 x 0.5 cos 60 = 7.3575 N m.
  const Held held{numbers({30 * kDegree, 30 * kDegree})};
  expect_near(moved(two_links(true), "[{effect: joint_compliance, at: j2, c: 1.0e-5}]", held).turn,
              0, 73.575e-6, 0);
}

/// A link of 1 m along x from j1 (about y) to a wrist that carries 10 kg at 0.5 m beyond, 0.2 m
/// aside along the world's y.
const char* const kBeam =
    "robot: beam\nkind: serial\nframes:\n"
    "  - {name: j1, joint: revolute, alpha: -1.5707963267948966}\n"
    "  - {name: j2, joint: revolute, d: 1, mass: 10, com: [0.5, 0, 0.2]}\n"
    "  - {name: tool, joint: fixed, d: 0.5}\n";

TEST(LinkComplianceByHand, BendsTheLinkAsACantileverUnderForceAndMomentAtItsEnd) {
  // At the link's end: 98.1 N down, and (0.5, 0.2, 0) x (0, 0, -98.1) = (-19.62, 49.05, 0) N m. A
  // cantilever has the slope M L / EI + F L^2 / 2 EI and the deflection M L^2 / 2 EI + F L^3 / 3
  // EI. About the frame's z (the world's y), L / EI = 1e-6 rad/(N m): it turns by 49.05 + 49.05
  // = 98.1 urad and goes 24.525 + 32.7 = 57.225 um down, and 98.1 urad x 0.5 m = 49.05 um more at
  // the tip.
  const Moved bent =
      moved(kBeam, "[{effect: link_compliance, at: j1, twist: 1.0e-6}]", {numbers({0, 0})});
  expect_near(bent.p, 0, 0, -106.275e-6);
  expect_near(bent.turn, 0, 98.1e-6, 0);
  // About x, along the link: it turns by -19.62 urad and neither its end nor the tip moves.
  const Moved turned =
      moved(kBeam, "[{effect: link_compliance, at: j1, bend_x: 1.0e-6}]", {numbers({0, 0})});
  expect_near(turned.p, 0, 0, 0);
  expect_near(turned.turn, -19.62e-6, 0, 0);
  // About the frame's y (down at q = 0) gravity has no moment, but 120 N along the tool's z (the
  // world's y) have: (0.5, 0, 0) x (0, 120, 0) = 60 N m about the world's z, -60 about y of the
  // frame. The end turns by 60 + 60 = 120 urad about the world's z and goes 30 + 40 = 70 um along
  // y; the tip goes by 120 urad x 0.5 m = 60 um more.
  Held held{numbers({0, 0})};
  held.wrench = numbers({0, 0, 120, 0, 0, 0});
  const Moved pushed = moved(kBeam, "[{effect: link_compliance, at: j1, bend_y: 1.0e-6}]", held);
  expect_near(pushed.p, 0, 130e-6, 0);
  expect_near(pushed.turn, 0, 0, 120e-6);
}

}  // namespace
}  // namespace selfcal
