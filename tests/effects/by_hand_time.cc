// What comes with warmth and time, by numbers worked by hand.
#include "tests/effects/by_hand.h"

namespace selfcal {
namespace {

/// A pedestal of 0.5 m that is base, links of (0.3, 0, 0.4) and 0.8 m with a fixed frame of 0.2 m
/// in between, a tool of 0.1 m; every axis along the world's at q = 0.
const char* const kColumn =
    "robot: column\nkind: serial\nframes:\n"
    "  - {name: base, joint: fixed, r: 0.5}\n"
    "  - {name: j1, joint: revolute, d: 0.3, r: 0.4}\n"
    "  - {name: elbow, joint: fixed, d: 0.2}\n"
    "  - {name: j2, joint: revolute, d: 0.8}\n"
    "  - {name: tool, joint: fixed, d: 0.1}\n";

/// How far 5 K, 20 ppm/K each, move the tip of kColumn at `q`, with `more` keys.
Eigen::Vector3d grown(const std::string& more, const Eigen::VectorXd& q) {
  Held held{q};
  held.temperature = 25;
  return moved(kColumn, "[{effect: thermal_expansion, reference: 20, alpha: 2.0e-5" + more + "}]",
               held)
      .p;
}

TEST(ThermalExpansionByHand, GrowsTheLengthsOfTheMovingLinks) {
  // 5 K x 20e-6 /K = 1e-4 of (0.3 + 0.2 + 0.8, 0, 0.4) m = (130, 0, 40) um: neither the pedestal
  // nor the tool takes part.
  const std::string warm = "[{effect: thermal_expansion, reference: 20, alpha: 2.0e-5}]";
  Held held{numbers({0, 0})};
  held.temperature = 25;
  expect_near(moved(kColumn, warm, held).p, 130e-6, 0, 40e-6, 1e-15);
  // At q1 = 90 degrees what follows j1 lies along y; its own 0.3 m stay along x. j2 turns the tool.
  held.q = numbers({90 * kDegree, 90 * kDegree});
  expect_near(moved(kColumn, warm, held).p, 30e-6, 100e-6, 40e-6, 1e-15);
  held.temperature = kUnknown;
  expect_near(moved(kColumn, warm, held).p, 0, 0, 0);
}

TEST(ThermalExpansionByHand, GrowsTheToolAsWellWhereToldSo) {
  // 1e-4 of the tool's 0.1 m too, which lies against x at q1 = q2 = 90 degrees.
  expect_near(grown(", tool: true", numbers({0, 0})), 140e-6, 0, 40e-6, 1e-15);
  expect_near(grown(", tool: true", numbers({90 * kDegree, 90 * kDegree})), 20e-6, 100e-6, 40e-6,
              1e-15);
}

TEST(ThermalExpansionByHand, GrowsWhatCarriesTheRobotWhereToldSo) {
  // 1e-4 of the pedestal's 0.5 m too.
  expect_near(grown(", base: true", numbers({0, 0})), 130e-6, 0, 90e-6, 1e-15);
}

TEST(ThermalExpansionByHand, HasTheWorldsOriginForAFootWithoutABaseFrame) {
  // 1e-4 of r = 0.4 m and d = 0.3 m of the first frame of all.
  const std::string arm = with_frames(
      "  - {name: j1, joint: revolute, d: 0.3, r: 0.4}\n  - {name: tool, joint: fixed, d: 0.1}\n");
  Held held;
  held.temperature = 25;
  expect_near(moved(arm, "[{effect: thermal_expansion, reference: 20, alpha: 2.0e-5}]", held).p,
              30e-6, 0, 40e-6, 1e-15);
}

/// A thermometer that reads 20 C + 10 K/h from the first second on, every minute for an hour.
MeasurementContext ramp() {
  MeasurementContext context;
  for (int minute = 0; minute <= 60; ++minute) {
    context.times.push_back(60.0 * minute);
    context.temperatures.push_back(20 + minute / 6.0);
  }
  context.end = 3600;
  context.reference = 25;
  return context;
}

TEST(ThermalExpansionByHand, LagsBehindARampAsAFirstOrderSystemDoes) {
  // Begun in balance, the answer to a ramp s t is s (t - L (1 - exp(-t / L))). With L = 600 s and
  // s = 10 K/h, at t = 1200 s: (1200 - 600 (1 - exp(-2))) / 360 = 681.201 / 360 = 1.892226 K, times
  // 50e-6 /K and 1.3 m: 122.9947 um. At 1230 s: 707.241 / 360 = 1.964558 K, 127.6963 um; between
  // two samples stands the chord, h^2 / 8 s / L exp(-t / L) = 2.7e-4 K or 0.0174 um above.
  const std::string slow = "[{effect: thermal_expansion, lag: 600, reference: 20, alpha: 5.0e-5}]";
  Held held{numbers({0, 0})};
  held.temperature = 99;  // the sensor's own is not asked for
  held.time = 1200;
  EXPECT_NEAR(moved(kColumn, slow, held, ramp()).p.x(), 122.9947e-6, 1e-10);
  held.time = 1230;
  EXPECT_NEAR(moved(kColumn, slow, held, ramp()).p.x(), 127.7137e-6, 1e-10);
}

TEST(ThermalExpansionByHand, HasTheReferenceOfItsRows) {
  // 25 C, the ramp's mean: at 23 C, -2 K x 50e-6 /K x 1.3 m = -130 um.
  Held held{numbers({0, 0})};
  held.temperature = 23;
  const std::string warm = "[{effect: thermal_expansion, alpha: 5.0e-5}]";
  EXPECT_NEAR(moved(kColumn, warm, held, ramp()).p.x(), -130e-6, 1e-12);
}

MeasurementContext an_hour() {
  MeasurementContext context;
  context.begin = 1000;
  context.end = 4600;
  return context;
}

TEST(BaseDriftByHand, GoesFromNothingToAllBetweenTheFirstRowAndTheLast) {
  Held held;
  const std::string away = "[{effect: base_drift, x: 1.0e-4, z: -2.0e-4}]";
  for (const auto& [time, share] : {std::pair(1000.0, 0.0), std::pair(1900.0, 0.25),
                                    std::pair(4600.0, 1.0), std::pair(kUnknown, 0.0)}) {
    held.time = time;
    expect_near(moved(kTurntable, away, held, an_hour()).p, share * 100e-6, 0, share * -200e-6,
                1e-15);
  }
}

TEST(BaseDriftByHand, TurnsAboutTheWorldsOrigin) {
  // A quarter of 400 urad about z moves the tip at (1, 0, 0) by 100 um along y.
  Held held;
  held.time = 1900;
  const Moved by = moved(kTurntable, "[{effect: base_drift, rz: 4.0e-4}]", held, an_hour());
  expect_near(by.p, 0, 100e-6, 0, 1e-15);
  expect_near(by.turn, 0, 0, 100e-6, 1e-15);
  // About y the tip goes down: (0, 1, 0) x (1, 0, 0) = (0, 0, -1).
  expect_near(moved(kTurntable, "[{effect: base_drift, ry: 4.0e-4}]", held, an_hour()).p, 0, 0,
              -100e-6, 1e-15);
}

TEST(BaseDriftByHand, SettlesWithItsTimeConstant) {
  // One time constant of 1800 s after the first row, in an hour: (1 - e^-1) / (1 - e^-2) =
  // 0.6321206 / 0.8646647 = 0.7310586.
  Held held;
  held.time = 2800;
  const std::string settling = "[{effect: base_drift, settle: 1800, y: 1.0e-4}]";
  expect_near(moved(kTurntable, settling, held, an_hour()).p, 0, 73.10586e-6, 0, 1e-11);
  held.time = 4600;
  expect_near(moved(kTurntable, settling, held, an_hour()).p, 0, 100e-6, 0, 1e-15);
}

TEST(BaseDriftByHand, MovesAtOnce) {
  Held held;
  const std::string away = "[{effect: base_drift, moment: 1900, x: 1.0e-4, rz: 4.0e-4}]";
  held.time = 1899;
  expect_near(moved(kTurntable, away, held, an_hour()).p, 0, 0, 0, 1e-15);
  for (const double time : {1900.0, 9000.0}) {
    held.time = time;
    expect_near(moved(kTurntable, away, held, an_hour()).p, 100e-6, 400e-6, 0, 1e-15);
  }
  held.time = kUnknown;
  expect_near(moved(kTurntable, away, held, an_hour()).p, 0, 0, 0, 1e-15);
}

TEST(BaseDriftByHand, HasNotBegunBeforeItsBeginAndIsOverAfterItsEnd) {
  Held held;
  for (const char* shape : {"x: 1.0e-4", "settle: 10, x: 1.0e-4", "half_waves: [1], x1: 1.0e-4"}) {
    const std::string away = "[{effect: base_drift, " + std::string(shape) + "}]";
    held.time = 0;
    expect_near(moved(kTurntable, away, held, an_hour()).p, 0, 0, 0, 1e-15);
    held.time = 9000;
    expect_near(moved(kTurntable, away, held, an_hour()).p, 100e-6, 0, 0, 1e-15);
  }
}

TEST(BaseDriftByHand, WandersBySoManyHalfWaves) {
  // A third of the way: (1 - cos 60 deg) / 2 = 0.25 of the first, (1 - cos 120 deg) / 2 = 0.75 of
  // the second; at the end 1 and 0.
  Held held;
  const std::string wandering =
      "[{effect: base_drift, half_waves: [1, 2], x1: 1.0e-4, x2: -4.0e-5, rz2: 2.0e-4}]";
  held.time = 2200;
  const Moved third = moved(kTurntable, wandering, held, an_hour());
  expect_near(third.p, 25e-6 - 30e-6, 150e-6, 0, 1e-15);
  expect_near(third.turn, 0, 0, 150e-6, 1e-11);
  held.time = 4600;
  expect_near(moved(kTurntable, wandering, held, an_hour()).p, 100e-6, 0, 0, 1e-15);
  held.time = kUnknown;
  expect_near(moved(kTurntable, wandering, held, an_hour()).p, 0, 0, 0, 1e-15);
}

}  // namespace
}  // namespace selfcal
