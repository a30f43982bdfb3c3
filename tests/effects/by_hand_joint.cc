// What a joint does by itself, by numbers worked by hand: transmission, play, coupling, a shifted
// zero, a late reading.
#include "tests/effects/by_hand.h"

namespace selfcal {
namespace {

TEST(TransmissionErrorByHand, IsSineAndCosineOfTheJointsAngle) {
  // At 90 degrees the sine is 1, the cosine 0: 100 urad; the tip stands at (0, 1, 0) and moves by
  // 100 um along -x. At 0 it is the other way: 200 urad, along y.
  const std::string periodic = "[{effect: transmission_error, at: j1, sin1: 1.0e-4, cos1: 2.0e-4}]";
  const Moved quarter = moved(kTurntable, periodic, {numbers({90 * kDegree})});
  expect_near(quarter.p, -100e-6, 0, 0);
  expect_near(quarter.turn, 0, 0, 100e-6);
  expect_near(moved(kTurntable, periodic, {}).p, 0, 200e-6, 0, 3e-8);
  // Two waves a turn at 45 degrees: sin 90 = 1. Twelve and a half at 7.2 degrees: sin 90 again.
  for (const auto& [wave, angle] : {std::pair("2", 45.0), std::pair("12.5", 7.2)}) {
    const std::string of_wave = std::string("[{effect: transmission_error, at: j1, waves: ") +
                                wave + ", sin" + wave + ": 1.0e-4, cos" + wave + ": 5.0e-4}]";
    expect_near(moved(kTurntable, of_wave, {numbers({angle * kDegree})}).turn, 0, 0, 100e-6);
  }
  // A spindle of one wave a metre at 0.25 m: 2 pi x 0.25 = 90 degrees: 100 um.
  const std::string slide = with_frames("  - {name: j1, joint: prismatic}\n");
  expect_near(moved(slide, periodic, {numbers({0.25})}).p, 0, 0, 100e-6);
}

TEST(BacklashByHand, IsHalfThePlayBehindTheLastMotion) {
  // 200 urad of play: the joint stands 100 urad behind, on the side that it came from.
  const std::string loose = "[{effect: backlash, at: j1, play: 2.0e-4}]";
  Held held;
  for (const auto& [dq, turn] : {std::pair(0.3, -100e-6), std::pair(-1e-3, 100e-6),
                                 std::pair(0.0, 0.0), std::pair(kUnknown, 0.0)}) {
    held.velocity = numbers({dq});
    expect_near(moved(kTurntable, loose, held).turn, 0, 0, turn);
  }
  held.velocity.resize(0);
  expect_near(moved(kTurntable, loose, held).turn, 0, 0, 0);
}

TEST(BacklashByHand, IsTakenUpByTheLoadWhereItIsSaidSo) {
  // The weight turns the arm down (about +y) at q = 0: +100 urad; at 180 degrees, on the other
  // side, -100 urad. The last motion does not matter.
  const std::string loose = "[{effect: backlash, at: j1, by: load, play: 2.0e-4}]";
  Held held;
  held.velocity = numbers({1});
  expect_near(moved(kPendulum, loose, held).turn, 0, 100e-6, 0);
  held.q = numbers({180 * kDegree});
  expect_near(moved(kPendulum, loose, held).turn, 0, -100e-6, 0);
}

TEST(JointCouplingByHand, DragsTheJointByAShareOfTheOther) {
  // 1e-3 of 0.5 rad: 500 urad about the world's z, whatever j1 itself reads.
  const std::string two = with_frames(
      "  - {name: j1, joint: revolute}\n  - {name: j2, joint: revolute, alpha: 1, d: 1}\n");
  const std::string dragged = "[{effect: joint_coupling, at: j1, from: j2, kappa_j2: 1.0e-3}]";
  for (const double q1 : {0.0, 2.0})
    expect_near(moved(two, dragged, {numbers({q1, 0.5})}).turn, 0, 0, 500e-6);
}

TEST(JointCouplingByHand, NamesItsUnitByTheTwoJoints) {
  const auto arm = std::shared_ptr<const Robot>(
      robot_of(with_frames("  - {name: a, joint: revolute}\n  - {name: b, joint: revolute}\n"
                           "  - {name: c, joint: prismatic}\n")));
  for (const auto& [at, from, unit] :
       {std::tuple("a", "b", "1"), std::tuple("a", "c", "rad/m"), std::tuple("c", "a", "m/rad")}) {
    Problems problems;
    const auto entry =
        parsed(std::string("{effect: joint_coupling, at: ") + at + ", from: " + from + "}");
    const auto robot = correct(arm, {entry}, {}, problems);
    ASSERT_NE(robot, nullptr);
    EXPECT_EQ(robot->parameters().back().unit(), unit);
  }
}

TEST(ZeroShiftByHand, StepsAtItsMoment) {
  // 1 mrad from second 100 on; second order of 1e-3: 5e-7. A row without a time has none.
  const std::string shifted = "[{effect: zero_shift, at: j1, moment: 100, step: 1.0e-3}]";
  for (const auto& [time, step] :
       {std::pair(0.0, 0.0), std::pair(99.999, 0.0), std::pair(100.0, 1e-3),
        std::pair(5000.0, 1e-3), std::pair(kUnknown, 0.0)}) {
    Held held;
    held.time = time;
    const Moved by = moved(kTurntable, shifted, held);
    expect_near(by.turn, 0, 0, step, 1e-15);
    expect_near(by.p, 0, step, 0, 1e-6);
  }
}

TEST(ZeroShiftByHand, FollowsTheTemperatureWhereItIsSaid) {
  // 20 urad/K times 4 K from 21 C; a row without a temperature has none.
  const std::string warped =
      "[{effect: zero_shift, at: j1, by: temperature, reference: 21, k: 2.0e-5}]";
  for (const auto& [celsius, turn] :
       {std::pair(25.0, 80e-6), std::pair(21.0, 0.0), std::pair(kUnknown, 0.0)}) {
    Held held;
    held.temperature = celsius;
    expect_near(moved(kTurntable, warped, held).turn, 0, 0, turn, 1e-12);
  }
}

TEST(TriggerLatencyByHand, TakesTheJointsBackByVelocityTimesDelay) {
  // 2 ms late at 0.05 rad/s: the joint was 100 urad short of where it was read when the touch
  // happened. Rows that touch nothing, or whose velocity is not known, are not late.
  const std::string late = "[{effect: trigger_latency, delay: 2.0e-3}]";
  Held held;
  held.velocity = numbers({0.05});
  held.normal = Eigen::Vector3d::UnitZ();
  expect_near(moved(kTurntable, late, held).turn, 0, 0, -100e-6);
  held.normal.setConstant(kUnknown);
  expect_near(moved(kTurntable, late, held).turn, 0, 0, 0);
  MeasurementContext context;  // of a set that is touched no row needs a normal
  context.sets = {{"ball", TouchedSurface::curved}, {"tracker"}};
  held.set = 0;
  expect_near(moved(kTurntable, late, held, context).turn, 0, 0, -100e-6);
  held.set = 1;
  expect_near(moved(kTurntable, late, held, context).turn, 0, 0, 0);
  held.set = -1;
  held.normal = Eigen::Vector3d::UnitZ();
  held.velocity = numbers({kUnknown});
  expect_near(moved(kTurntable, late, held).turn, 0, 0, 0);
}

TEST(TriggerLatencyByHand, TakesCoupledJointsBackByTheVelocityOfTheirVariables) {
  // Two arms of 1 m along x, the second driven from the base by a gear of 0.5: its own angle turns
  // by 0.5 x 0.06 - 0.02 = 0.01 rad/s. In 2 ms 40 urad of the first at 2 m and 20 urad of the
  // second at 1 m: 100 um back along y, 60 urad about z.
  const std::string coupled =
      "robot: arm\nkind: serial\ncoupling: [[1, 0], [-1, 1]]\nframes:\n"
      "  - {name: j1, joint: revolute}\n  - {name: j2, joint: revolute, d: 1, gear: 0.5}\n"
      "  - {name: tool, joint: fixed, d: 1}\n";
  Held held{numbers({0, 0})};
  held.velocity = numbers({0.02, 0.06});
  held.normal = Eigen::Vector3d::UnitZ();
  const Moved by = moved(coupled, "[{effect: trigger_latency, delay: 2.0e-3}]", held);
  expect_near(by.turn, 0, 0, -60e-6);
  expect_near(by.p, 0, -100e-6, 0);
}

}  // namespace
}  // namespace selfcal
