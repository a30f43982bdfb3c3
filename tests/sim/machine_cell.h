// A simulated robot over a table, and one touch of it.
#pragma once

#include "app/service/front_end/reading.h"
#include "constraints/planning/touch_plan.h"
#include "sim/machine.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal {

inline const Eigen::VectorXd& home() {
  static const Eigen::VectorXd q = (Eigen::VectorXd(6) << 0.0, -0.6, 0.9, 0.0, 1.2, 0.0).finished();
  return q;
}

/// A scenario of one table; `machine` and `more` are put in as they are.
inline Scenario table(const std::string& machine = "", const std::string& more = "",
                      const std::string& noise = "0") {
  return scenario_of("robot: r\nseed: 3\nerrors: {length: 1.0e-3, angle: 1.0e-3}\n" + more +
                     "machine: {" + machine +
                     "}\nsets:\n  table: {method: plane, noise: 2.0e-5, noise_true: " + noise +
                     ",\n    surface: {point: [0.75, 0, 0.147], normal: [0.004, 0, 1]},\n"
                     "    within: {center: [0.75, 0, 0.147], radius: 0.35}}\n");
}

inline Machine machine_of(const Scenario& scenario) {
  Problems problems;
  Machine machine(scenario, {std::shared_ptr<void>(), &rx90()}, home(), problems);
  EXPECT_FALSE(problems.any()) << problems.list.front();
  return machine;
}

/// Touches of the table as the service plans them: from 50 mm before to 30 mm behind it.
inline const std::vector<PlannedTouch>& planned_touches() {
  static const TouchPlan plan = [] {
    Problems none;
    Node entry = Node::map();
    entry.set("method", Node::of(std::string("plane")));
    TouchTarget target;
    target.touches = 20;
    target.outward = Eigen::Vector3d::UnitZ();
    target.plane = Plane{Eigen::Vector3d::UnitZ(), 0.15};
    target.within = {{0.75, 0, 0.15}, 0.25};
    target.obstacle = 0;
    TouchPlanOptions options;
    options.clearance = 0.05;
    options.search = 0.03;
    options.home = home();
    return plan_touches(rx90(), values(rx90()), {make_set("table", entry, none)}, {target},
                        {{{0.75, 0, 0.15}, Eigen::Vector3d::UnitZ(), target.within}}, {}, options);
  }();
  EXPECT_EQ(plan.unreached, "");
  return plan.touches;
}

inline MotionRequest request_of(MoveKind kind, const Eigen::VectorXd& q, const std::string& label,
                                double speed = 0.2) {
  static std::uint64_t id = 0;
  return {++id, kind, label, {q.begin(), q.end()}, speed};
}

struct Touched {
  std::vector<Edge> edges;
  SampleHistory samples;
  std::optional<Nanoseconds> closing;  // first edge
};

/// Lets time pass and keeps what comes.
inline void pass(Machine& machine, Nanoseconds time, Touched& touched) {
  machine.advance(machine.now() + time);
  std::vector<EncoderSample> samples;
  machine.take(samples);
  for (const EncoderSample& sample : samples) touched.samples.add(sample);
  machine.take(touched.edges);
  if (!touched.closing && !touched.edges.empty() && touched.edges.front().closed)
    touched.closing = touched.edges.front().time;
}

/// Moves to the end.
inline Touched go(Machine& machine, MoveKind kind, const Eigen::VectorXd& q,
                  const std::string& label = "") {
  Touched touched;
  machine.request(request_of(kind, q, label, kind == MoveKind::travel ? 2 : 0.2));
  for (int i = 0; i < 100 && (i == 0 || machine.busy()); ++i) pass(machine, kSecond / 10, touched);
  return touched;
}

/// One touch as the service makes it: from its start until the trigger closes, then a stop.
inline Touched touch(Machine& machine, const PlannedTouch& planned, const std::string& label) {
  if (planned.via_home) go(machine, MoveKind::travel, home(), label);
  for (const Eigen::VectorXd& place : planned.way) go(machine, MoveKind::travel, place, label);
  go(machine, MoveKind::travel, planned.start, label);
  Touched touched;
  machine.request(request_of(MoveKind::touch, planned.end, label));
  while (machine.busy() && !touched.closing) pass(machine, 4 * kMillisecond, touched);
  machine.stop("touched");
  pass(machine, kSecond / 10, touched);
  return touched;
}

/// Distance of the true endpoint from the true table at a moment (m).
inline double height(const Machine& machine, const Touched& touched, Nanoseconds at) {
  const auto around = touched.samples.around(at);
  EXPECT_TRUE(around);
  if (!around) return 0;
  const Reading reading = reading_between(around->first, around->second, at, machine.scales());
  const Eigen::Vector3d p = locate(machine.robot(), machine.truth().xi, reading.q).p;
  const Eigen::Vector3d n = Eigen::Vector3d(0.004, 0, 1).normalized();
  return n.dot(p - Eigen::Vector3d(0.75, 0, 0.147));
}

}  // namespace selfcal
