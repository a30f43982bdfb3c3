// Locks of the simulated platform: how they engage, open, hold and slip.
#include <gmock/gmock.h>

#include "constraints/methods/shared/unit_normal.h"
#include "tests/sim/machine_cell.h"

namespace selfcal {
namespace {

using Outcome = MotionReply::Outcome;

const Eigen::VectorXd& platform_home() {
  static const Eigen::VectorXd q = Eigen::VectorXd::Constant(6, 0.8);
  return q;
}

struct LockCell {
  std::shared_ptr<const Robot> robot = std::move(*load_robot(example("stewart.robot.yaml")));
  Machine machine;
  explicit LockCell(const std::string& settings) : machine(machine_with(settings)) {}

  Machine machine_with(const std::string& settings) const {
    Problems problems;
    Machine made(scenario_of("robot: r\nseed: 5\nerrors: {length: 1.0e-3}\nmachine: {" + settings +
                             "}\nsets:\n  a: {method: locked-joint, lock: {leg: 1, joint: "
                             "universal}, noise: 1.0e-5, noise_true: 0}\n"),
                 robot, platform_home(), problems);
    EXPECT_FALSE(problems.any()) << problems.list.front();
    return made;
  }
  std::vector<Outcome> replies() {
    std::vector<MotionReply> list;
    machine.take(list);
    std::vector<Outcome> out;
    for (const MotionReply& each : list) out.push_back(each.outcome);
    return out;
  }
  Touched ask(MoveKind kind, const std::string& label = "leg 1 universal") {
    return go(machine, kind, platform_home(), label);
  }
  /// Direction of the leg, as its universal joint has it, after a visit of one's choice.
  Eigen::Vector3d visit(int i) {
    Eigen::VectorXd q = platform_home();
    q[i % 6] += 0.03;
    q[(i + 2) % 6] -= 0.02;
    const Touched there = go(machine, MoveKind::visit, q, "v" + std::to_string(i));
    return locate(machine.robot(), machine.truth().xi,
                  reading_of(there.samples.last(), machine.scales()),
                  body_behind(0, PassiveKind::universal))
        .R.col(2);
  }
};

TEST(MachineLock, EngagesAndOpensAndTheTriggerConfirmsBoth) {
  LockCell cell("lock_time: 0.3");
  const Touched engaged = cell.ask(MoveKind::lock);
  ASSERT_EQ(engaged.edges.size(), 1u);
  EXPECT_TRUE(engaged.edges[0].closed);
  EXPECT_EQ(engaged.edges[0].time, 300 * kMillisecond);
  EXPECT_THAT(cell.replies(), testing::ElementsAre(Outcome::accepted, Outcome::done));
  const Touched open = cell.ask(MoveKind::release);
  ASSERT_EQ(open.edges.size(), 1u);
  EXPECT_FALSE(open.edges[0].closed);
  EXPECT_THAT(cell.replies(), testing::ElementsAre(Outcome::accepted, Outcome::done));
}

TEST(MachineLock, KeepsItsLegsDirectionOnEveryVisit) {
  LockCell cell("");
  cell.ask(MoveKind::lock);
  const Eigen::Vector3d first = cell.visit(0);
  for (int i = 1; i < 6; ++i) EXPECT_LT((cell.visit(i) - first).norm(), 1e-7) << i;  // 1e-9 m steps
}

TEST(MachineLock, SlipsOnTheWayToTheVisitThatTheScenarioNames) {
  LockCell cell("lock_slip: 0.002, lock_slips: [3]");
  cell.ask(MoveKind::lock);
  const Eigen::Vector3d first = cell.visit(0), second = cell.visit(1), third = cell.visit(2);
  EXPECT_LT((second - first).norm(), 1e-7);
  EXPECT_NEAR((third - first).norm(), 0.002, 1e-6);  // the chord of the arc
}

TEST(MachineLock, RefusesALockThatItLacksOrThatIsBroken) {
  LockCell cell("");
  cell.ask(MoveKind::lock, "leg 2 spherical");
  EXPECT_THAT(cell.replies(), testing::ElementsAre(Outcome::refused));
  LockCell broken("faults: [{what: lock_refuse, at: 0}]");
  broken.ask(MoveKind::lock);
  EXPECT_THAT(broken.replies(), testing::ElementsAre(Outcome::refused));
}

TEST(MachineLock, NeverConfirmsALockThatIsLate) {
  LockCell cell("faults: [{what: lock_late, at: 0}]");
  EXPECT_TRUE(cell.ask(MoveKind::lock).edges.empty());
  EXPECT_THAT(cell.replies(), testing::ElementsAre(Outcome::accepted));
}

TEST(MachineLock, OpensByItselfWhenToldSo) {
  LockCell cell("faults: [{what: lock_open, at: 2}]");
  cell.ask(MoveKind::lock);
  Touched touched;
  pass(cell.machine, 3 * kSecond, touched);
  ASSERT_EQ(touched.edges.size(), 1u);
  EXPECT_FALSE(touched.edges[0].closed);
}

}  // namespace
}  // namespace selfcal
