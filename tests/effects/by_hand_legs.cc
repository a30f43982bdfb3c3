// Legs that give way, warm up and have play, by numbers worked by hand on a delta in the middle of
// its readings: rods of 0.25 m that lean by 0.15 m over 0.2 m, so that their unit vectors are
// (-0.6 cos, -0.6 sin, -0.8) of 0, 120 and 240 degrees. When rod 1 grows by dl and the others do
// not,
//   -0.6 dx - 0.8 dz = dl,   0.6 dx = 1.6 dz,   dy = 0:   dx = -dl / 0.9, dz = -dl / 2.4.
#include <functional>

#include "constraints/sampling/random_poses.h"
#include "tests/effects/by_hand.h"
#include "tests/kinematics/kind_examples.h"

namespace selfcal {
namespace {

const char* const kDelta =
    "robot: printer\nkind: linear-delta\ntowers:\n"
    "  - {radius: 0.15, angle: 0, rod: 0.25, endstop: 0.5}\n"
    "  - {radius: 0.15, angle: 2.0943951023931953, rod: 0.25, endstop: 0.5}\n"
    "  - {radius: 0.15, angle: 4.1887902047863905, rod: 0.25, endstop: 0.5}\n";

Held level() {
  Held held;
  held.q = Eigen::VectorXd::Zero(3);
  return held;
}

/// With the wrench on the tip (N).
Held loaded(double x, double y, double z) {
  Held held = level();
  held.wrench = numbers({x, y, z, 0, 0, 0});
  return held;
}

TEST(LegComplianceByHand, LetsAKilogramStretchARod) {
  // 9.81 N hang on three rods: 9.81 / 2.4 = 4.0875 N in each, 40.875 um of 1e-5 m/N.
  const Moved hung = moved(kDelta, "[{effect: leg_compliance, at: tower1, c: 1.0e-5}]", level());
  expect_near(hung.p, -45.417e-6, 0, -17.031e-6);
  EXPECT_LT(hung.turn.norm(), 1e-15);
}

TEST(LegComplianceByHand, GivesWayToTheWrench) {
  // A push of 9 N along x: by the same rods, -9 / 0.9 = -10 N, that is compression: 100 um shorter.
  const Moved pushed =
      moved(kDelta, "[{effect: leg_compliance, at: tower1, mass: 0, c: 1.0e-5}]", loaded(9, 0, 0));
  expect_near(pushed.p, 111.111e-6, 0, 41.667e-6, 1e-7);  // and its second order
}

TEST(LegThermalGrowthByHand, LengthensARodByItsShare) {
  // 0.25 m x 1e-5 x 8 K = 20 um.
  Held held = level();
  held.temperature = 28;
  const char* const warm = "[{effect: leg_thermal_growth, at: tower1, alpha: 1.0e-5}]";
  expect_near(moved(kDelta, warm, held).p, -22.222e-6, 0, -8.333e-6);
  held.temperature = kUnknown;
  expect_near(moved(kDelta, warm, held).p, 0, 0, 0, 0);
}

TEST(JointClearanceByHand, GoesToTheSideThatTheLoadPullsTo) {
  const char* const loose = "[{effect: joint_clearance, at: tower1, play: 4.0e-5}]";
  expect_near(moved(kDelta, loose, loaded(0, 0, -3)).p, -22.222e-6, 0, -8.333e-6);
  expect_near(moved(kDelta, loose, loaded(0, 0, 3)).p, 22.222e-6, 0, 8.333e-6);
  expect_near(moved(kDelta, loose, level()).p, 0, 0, 0, 0);
  const char* const heavy = "[{effect: joint_clearance, at: tower1, mass: 1, play: 4.0e-5}]";
  expect_near(moved(kDelta, heavy, loaded(0, 0, 3)).p, -22.222e-6, 0, -8.333e-6);
  expect_near(moved(kDelta, heavy, loaded(0, 0, 10)).p, 22.222e-6, 0, 8.333e-6);
}

const char* const kDeltaWeighs = "masses: {effector: 0.3, carriages: 0.2, rods: 0.12}\n";

TEST(JointComplianceByHand, LetsACarriageSinkUnderItsShareOfADelta) {
  // 0.2 kg, half of its rods and a third of the effector with the other halves: 0.2 + 0.06 + 0.16
  // kg, 4.1202 N, 41.202 um of 1e-5 m/N. When carriage 1 sinks by s, -0.6 dx - 0.8 (dz + s) = 0 and
  // 0.6 dx = 1.6 dz: dx = -s / 1.125, dz = -s / 3.
  const char* const soft = "[{effect: joint_compliance, at: tower1, c: 1.0e-5}]";
  expect_near(moved(std::string(kDelta) + kDeltaWeighs, soft, level()).p, -36.624e-6, 0, -13.734e-6,
              1e-8);
}

TEST(BacklashByHand, LiesWhereTheWeightOfADeltaPutsIt) {
  const char* const loose = "[{effect: backlash, at: tower1, by: load, play: 9.0e-5}]";
  expect_near(moved(std::string(kDelta) + kDeltaWeighs, loose, level()).p, -40e-6, 0, -15e-6, 1e-8);
}

TEST(LegComplianceByHand, StretchesARodByWhatTheFileSaysHangsOnIt) {
  // The effector and three half rods, 0.48 kg: 4.7088 N / 2.4 = 1.962 N, 19.62 um.
  const Moved hung = moved(std::string(kDelta) + kDeltaWeighs,
                           "[{effect: leg_compliance, at: tower1, c: 1.0e-5}]", level());
  expect_near(hung.p, -21.8e-6, 0, -8.175e-6);
}

/// Joints on circles of 0.6 cos 40 and 0.3 m, pairs 20 degrees apart in the base and 100 in the
/// platform: chain i leads from base to platform over 0.3 m across, so that one of 0.5 m rises, or
/// hangs, by 0.4 m. Together they turn nothing and shift nothing to a side; a change of all by dl
/// moves the platform by dl / 0.8, and a load along z puts 1 / (6 x 0.8) of it into each.
std::string six_chains(const std::function<std::string(double, double, double, double)>& chain) {
  std::string text;
  for (int i = 0; i < 6; ++i) {
    const double side = i % 2 == 0 ? -1 : 1, third = 120.0 * (i / 2);
    const double a = kDegree * (third + side * 10), b = kDegree * (third + side * 50);
    const double base = 0.6 * std::cos(40 * kDegree);
    text += chain(base * std::cos(a), base * std::sin(a), 0.3 * std::cos(b), 0.3 * std::sin(b));
  }
  return text;
}

std::string pair_text(double x, double y) { return format_number(x) + ", " + format_number(y); }

/// The platform stands on its legs.
std::string standing() {
  return "robot: hexapod\nkind: gough-stewart\nlegs:\n" +
         six_chains([](double ax, double ay, double bx, double by) {
           return "  - {base: [" + pair_text(ax, ay) + ", 0], platform: [" + pair_text(bx, by) +
                  ", 0], limits: [0.4, 0.6]}\n";
         });
}

/// The platform hangs from carriages on six upright rails, which stand at z = 1 m.
std::string hanging() {
  return "robot: slider\nkind: hexaslide\nchains:\n" +
         six_chains([](double ax, double ay, double bx, double by) {
           return "  - {rail_start: [" + pair_text(ax, ay) + ", 1.5], rail_direction: [0, 0], " +
                  "platform: [" + pair_text(bx, by) + ", 0], length: 0.5, limits: [0.3, 0.7]}\n";
         });
}

/// The same of every chain.
std::string of_all(const std::string& part, const std::string& entry) {
  std::string list;
  for (int i = 1; i <= 6; ++i)
    list += (i > 1 ? ", {" : "[{") + entry + ", at: " + part + std::to_string(i) + "}";
  return list + "]";
}

/// In the middle of its readings, with a load along z on the tip (N).
Held of_six(double load) {
  Held held;
  held.q = Eigen::VectorXd::Constant(6, 0.5);
  held.wrench = numbers({0, 0, load, 0, 0, 0});
  return held;
}

TEST(LegComplianceByHand, LetsAPlatformSinkOnItsLegsAndFromItsLinks) {
  // 48 N: 10 N in each, 100 um of 1e-5 m/N, 125 um of height, and the second order.
  const std::string soft = "effect: leg_compliance, mass: 0, c: 1.0e-5";
  const Moved stands = moved(standing(), of_all("leg", soft), of_six(-48));
  expect_near(stands.p, 0, 0, -125e-6, 2e-7);
  EXPECT_LT(stands.turn.norm(), 1e-12);
  const Moved hangs = moved(hanging(), of_all("chain", soft), of_six(-48));
  expect_near(hangs.p, 0, 0, -125e-6, 2e-7);
  EXPECT_LT(hangs.turn.norm(), 1e-12);
}

TEST(LegComplianceByHand, LetsAPlatformSinkUnderItselfAndItsLegs) {
  // All legs longer by dl: the platform rises by 1.25 dl, their directions by 0.9 dl, so that a
  // piston's centre rises by 1.25 - 0.1 x 0.9 = 1.16 and a cylinder's by 0.2 x 0.9 = 0.18. In each
  // leg 9.81 (3 x 1.25 / 6 + 1.16 + 2 x 0.18) = 21.04245 N, 210.4245 um, 263.0306 um of height.
  const Moved stands = moved(standing() +
                                 "masses: {platform: 3, cylinders: 2, cylinder_com: 0.2, pistons: "
                                 "1, piston_com: 0.1}\n",
                             of_all("leg", "effect: leg_compliance, c: 1.0e-5"), of_six(0));
  expect_near(stands.p, 0, 0, -263.0306e-6, 1e-9);
  // Half of each link and the platform hang on the links: 9.81 x 6 / 6 / 0.8 = 12.2625 N.
  const std::string weighs = "masses: {platform: 3, carriages: 2, links: 1}\n";
  const Moved hangs =
      moved(hanging() + weighs, of_all("chain", "effect: leg_compliance, c: 1.0e-5"), of_six(0));
  expect_near(hangs.p, 0, 0, -153.28125e-6, 1e-9);
  // A carriage carries itself, its link and a sixth of the platform: 9.81 x 3.5 = 34.335 N.
  const Moved sags =
      moved(hanging() + weighs, of_all("chain", "effect: joint_compliance, c: 1.0e-5"), of_six(0));
  expect_near(sags.p, 0, 0, -343.35e-6, 1e-9);
}

TEST(LegThermalGrowthByHand, RaisesAPlatformOnItsLegsAndLowersItOnItsLinks) {
  // 0.5 m x 1e-5 x 8 K = 40 um of each, 50 um of height.
  const std::string warm = "effect: leg_thermal_growth, alpha: 1.0e-5";
  Held held = of_six(0);
  held.temperature = 28;
  expect_near(moved(standing(), of_all("leg", warm), held).p, 0, 0, 50e-6, 1e-7);
  expect_near(moved(hanging(), of_all("chain", warm), held).p, 0, 0, -50e-6, 1e-7);
  // Where no leg is named all grow alike.
  expect_near(moved(standing(), "[{" + warm + "}]", held).p, 0, 0, 50e-6, 1e-7);
  expect_near(moved(hanging(), "[{" + warm + "}]", held).p, 0, 0, -50e-6, 1e-7);
}

TEST(JointClearanceByHand, LowersAPlatformByHalfThePlayUnderALoad) {
  // Legs are pushed, links are pulled: by 20 um of 40.
  const std::string loose = "effect: joint_clearance, play: 4.0e-5";
  expect_near(moved(standing(), of_all("leg", loose), of_six(-3)).p, 0, 0, -25e-6, 1e-7);
  expect_near(moved(standing(), of_all("leg", loose), of_six(3)).p, 0, 0, 25e-6, 1e-7);
  expect_near(moved(hanging(), of_all("chain", loose), of_six(-3)).p, 0, 0, -25e-6, 1e-7);
  expect_near(moved(hanging(), of_all("chain", loose), of_six(0)).p, 0, 0, 0, 0);
}

/// Six legs under a platform share its weight so that their pushes hold it.
TEST(LegLoadByHand, IsInBalanceOnAPlatform) {
  const auto robot = robot_of(kind_examples().at("gough-stewart"));
  const ConfigurationBlock block = block_of(random_poses(*robot, nullptr, 1, 3).row(0).transpose());
  Locations X;
  PsiBlock psi;
  robot->locate(block, values(*robot), Body::endpoint, X, &psi);
  Eigen::Matrix<double, 6, 6> T, J;
  for (int c = 0; c < 6; ++c)
    for (int j = 0; j < 6; ++j) T(c, j) = psi(c, robot->leg_parameter(j));
  // Pushes f along the legs' unit vectors n_j at the spherical joints, and the weight: none is
  // left.
  const Eigen::Matrix<double, 6, 1> weight = numbers({0, 0, -98.1, 0, 0, 0});
  const Eigen::VectorXd push = -T.transpose() * weight;
  Eigen::Matrix<double, 6, 1> sum = weight;
  for (int j = 0; j < 6; ++j) {
    const Location leg = locate(*robot, values(*robot), block.q.row(0).transpose(),
                                body_behind(j, PassiveKind::universal));
    const Eigen::Vector3d n = leg.R.col(2);
    const Eigen::Vector3d joint =
        leg.p + robot->leg_lengths(values(*robot), block.q.row(0).transpose())[j] * n;
    sum.head<3>() += push[j] * n;
    sum.tail<3>() += (joint - X.p(0)).cross(push[j] * n);
  }
  EXPECT_LT(sum.norm(), 1e-10);
}

}  // namespace
}  // namespace selfcal
