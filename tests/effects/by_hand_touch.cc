// What belongs to a touch, by numbers worked by hand: the probe and the surface.
#include "tests/effects/by_hand.h"

namespace selfcal {
namespace {

TEST(ProbePretravelByHand, DependsOnTheAngleToTheStylusAndOnTheSideOfIt) {
  // The stylus is z. Normals at 30 degrees to it, sin 30 = 0.5, from azimuth psi:
  //   psi = 0:   5 + 0.5 (10 + 4 cos 0)   = 12 um
  //   psi = 60:  5 + 0.5 (10 + 4 cos 180) =  8 um
  //   psi = 30:  5 + 0.5 (10 + 4 cos 90)  = 10 um
  // and along the stylus itself 5 um. The contact lies that far out along the normal.
  const std::string probe = "[{effect: probe_pretravel, p0: 5.0e-6, p1: 1.0e-5, p3: 4.0e-6}]";
  Held held;
  for (const auto& [phi, psi, pretravel] :
       {std::tuple(30.0, 0.0, 12e-6), std::tuple(30.0, 60.0, 8e-6), std::tuple(30.0, 30.0, 10e-6),
        std::tuple(0.0, 0.0, 5e-6), std::tuple(150.0, 0.0, 12e-6)}) {
    const double sine = std::sin(phi * kDegree);
    held.normal = {sine * std::cos(psi * kDegree), sine * std::sin(psi * kDegree),
                   std::cos(phi * kDegree)};
    const Eigen::Vector3d shift = moved(kTurntable, probe, held).p;
    EXPECT_LT((shift - pretravel * held.normal).norm(), 1e-15) << phi << " " << psi;
  }
  // The azimuth turns with the tool: a quarter turn of the joint makes psi = 0 of psi = 90.
  held.q = numbers({90 * kDegree});
  held.normal = {0, 0.5, std::cos(30 * kDegree)};
  EXPECT_LT((moved(kTurntable, probe, held).p - 12e-6 * held.normal).norm(), 1e-15);
  // Feet a twelfth of a turn aside: at psi = 30 degrees sin 90 brings all of q3.
  const std::string aside = "[{effect: probe_pretravel, p0: 5.0e-6, p1: 1.0e-5, q3: 4.0e-6}]";
  held.q = numbers({0});
  held.normal = {0.5 * std::cos(30 * kDegree), 0.25, std::cos(30 * kDegree)};
  EXPECT_LT((moved(kTurntable, aside, held).p - 12e-6 * held.normal).norm(), 1e-15);
  held.normal.setConstant(kUnknown);  // nothing was touched
  expect_near(moved(kTurntable, probe, held).p, 0, 0, 0, 0);
}

TEST(ProbePretravelByHand, TakesTheNormalOfItsPlaneWhereTheRowHasNone) {
  // On the table the stylus (z) stands along the normal: p0 alone, along z. A row's own normal
  // along x goes before: sin phi is 1, psi 0, so that p0 + p1 + p3 = 5 + 14 = 19 um. On a ball, at
  // a normal (0.6, 0, -0.8), 0.6 (p1 + p3) = 8.4 um, for p0 is as another radius there.
  const std::string probe = "[{effect: probe_pretravel, p0: 5.0e-6, p1: 1.0e-5, p3: 4.0e-6}]";
  MeasurementContext context;
  context.sets = {{"table", TouchedSurface::plane, {1, 0, 0}, {0, 0, 1}},
                  {"ball", TouchedSurface::curved, {0.7, 0, 0.4}},
                  {"tracker"}};
  Held held;
  held.set = 0;
  expect_near(moved(kTurntable, probe, held, context).p, 0, 0, 5e-6, 1e-15);
  for (const int set : {1, 2}) {
    held.set = set;
    expect_near(moved(kTurntable, probe, held, context).p, 0, 0, 0, 0);
  }
  held.set = 0;
  held.normal = {1, 0, 0};
  expect_near(moved(kTurntable, probe, held, context).p, 19e-6, 0, 0, 1e-15);
  held.set = 1;
  held.normal = {0.6, 0, -0.8};
  expect_near(moved(kTurntable, probe, held, context).p, 0.6 * 8.4e-6, 0, -0.8 * 8.4e-6, 1e-15);
}

/// A table whose middle is at (0.8, -0.1, 0): the tip at (1, 0, 0) has u = 0.2, v = 0.1 m there. Of
/// a vertical normal u is the world's x and v = n x u its y.
MeasurementContext table() {
  MeasurementContext context;
  context.sets = {{"other", TouchedSurface::plane, {0, 0, 0}, {0, 0, 1}},
                  {"table", TouchedSurface::plane, {0.8, -0.1, 0}, {0, 0, 2}}};
  return context;
}

TEST(PlaneFormErrorByHand, TakesTheHeightOfTheSurfaceOff) {
  // h = 1e-3 x 0.04 + 2e-3 x 0.02 + 3e-3 x 0.01 = 40 + 40 + 30 = 110 um above the plane: the tip
  // that rests on it is 110 um too high.
  const std::string warped =
      "[{effect: plane_form_error, at: table, a: 1.0e-3, b: 2.0e-3, c: 3.0e-3}]";
  Held held;
  held.set = 1;
  expect_near(moved(kTurntable, warped, held, table()).p, 0, 0, -110e-6, 1e-15);
  held.set = 0;  // another surface
  expect_near(moved(kTurntable, warped, held, table()).p, 0, 0, 0, 0);
}

TEST(FixtureShiftByHand, LiftsAndTiltsTheSurfaceFromItsMomentOn) {
  // Shift 100 um out; 100 urad about u = x lift a point at v = 0.1 m by 10 um; 100 urad about v = y
  // lower a point at u = 0.2 m by 20 um: 90 um in all.
  Held held;
  held.set = 1;
  held.time = 500;
  for (const auto& [entry, height] :
       {std::pair("shift: 1.0e-4", 100e-6), std::pair("tilt_u: 1.0e-4", 10e-6),
        std::pair("tilt_v: 1.0e-4", -20e-6),
        std::pair("shift: 1.0e-4, tilt_u: 1.0e-4, tilt_v: 1.0e-4", 90e-6)}) {
    const std::string moving =
        "[{effect: fixture_shift, at: table, moment: 500, " + std::string(entry) + "}]";
    held.time = 500;
    expect_near(moved(kTurntable, moving, held, table()).p, 0, 0, -height, 1e-15);
    held.time = 499.9;
    expect_near(moved(kTurntable, moving, held, table()).p, 0, 0, 0, 0);
  }
}

TEST(FixtureShiftByHand, GoesAlongTheNormalOfAWall) {
  // Of a wall whose outward normal n is -x, u is the world's y, the first axis across it, and
  // v = n x u = -z. It stands 100 um further out, towards -x; that is taken off: 100 um along +x.
  MeasurementContext context = table();
  context.sets[1].normal = {-1, 0, 0};
  Held held;
  held.set = 1;
  held.time = 1;
  expect_near(moved(kTurntable, "[{effect: fixture_shift, at: table, moment: 0, shift: 1.0e-4}]",
                    held, context)
                  .p,
              100e-6, 0, 0, 1e-15);
  // From the middle the tip lies at (0.2, 0.1, 0): u = 0.1 m, v = 0. So 100 urad about u do
  // nothing, and about v they lower the surface by 10 um, to +x; taken off: 10 um along -x.
  expect_near(moved(kTurntable, "[{effect: fixture_shift, at: table, moment: 0, tilt_u: 1.0e-4}]",
                    held, context)
                  .p,
              0, 0, 0, 1e-15);
  expect_near(moved(kTurntable, "[{effect: fixture_shift, at: table, moment: 0, tilt_v: 1.0e-4}]",
                    held, context)
                  .p,
              -10e-6, 0, 0, 1e-15);
}

TEST(FixtureShiftByHand, TakesABallBackToWhereItStood) {
  MeasurementContext context;
  context.sets = {{"ball", TouchedSurface::curved, {1, 0, 0}}};
  const std::string moving =
      "[{effect: fixture_shift, at: ball, moment: 500, x: 1.0e-4, y: -2.0e-4, z: 3.0e-4}]";
  Held held;
  held.set = 0;
  held.time = 500;
  expect_near(moved(kTurntable, moving, held, context).p, -1e-4, 2e-4, -3e-4, 1e-15);
  held.time = 499.9;
  expect_near(moved(kTurntable, moving, held, context).p, 0, 0, 0, 0);
  held.set = -1;
  held.time = 500;
  expect_near(moved(kTurntable, moving, held, context).p, 0, 0, 0, 0);
}

}  // namespace
}  // namespace selfcal
