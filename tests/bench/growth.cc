// How the time grows: with the joints of an arm, with the planes that it touches. What a session
// waits for after its last touch.
#include <numbers>
#include <random>

#include "constraints/estimation/engagements.h"
#include "constraints/estimation/identification.h"
#include "constraints/sampling/configurations.h"
#include "io/files/robot_file.h"
#include "io/files/solution_json.h"
#include "kinematics/expects.h"
#include "kinematics/make_robot.h"
#include "tests/bench/tasks.h"

namespace selfcal::bench {
namespace {

constexpr int kRowsOfGrowth = 2000;

/// An arm of `joints` that turn, each a quarter turn from the one before or parallel to it.
std::unique_ptr<Robot> arm_of(int joints) {
  Node frames = Node::list();
  const auto add = [&](const std::string& name, const char* joint, double alpha, double d,
                       double r) {
    Node frame = Node::map();
    frame.set("name", Node::of(name)).set("joint", Node::of(std::string(joint)));
    frame.set("alpha", Node::of(alpha)).set("d", Node::of(d)).set("r", Node::of(r));
    frames.items.push_back(std::move(frame));
  };
  add("base", "fixed", 0, 0, 0.3);
  for (int j = 1; j <= joints; ++j)
    add("j" + std::to_string(j), "revolute",
        j % 3 == 0 ? 0 : std::numbers::pi / 2 * (j % 2 ? 1 : -1), 0.05 + 0.25 / j,
        j % 2 ? 0.3 : 0.02);
  add("tool", "fixed", 0.7, 0.1, 0.15);
  Node node = Node::map();
  node.set("robot", Node::of(std::string("arm"))).set("kind", Node::of(std::string("serial")));
  node.set("frames", std::move(frames));
  Problems problems;
  auto robot = make_robot(node, problems);
  expects(!problems.any(), "the arm is well formed");
  return robot;
}

/// Rows shared among sets that `entry` describes, with 20 um of noise.
DataSet rows_of(const Robot& robot, const Node& entry, int sets, int rows = kRowsOfGrowth) {
  DataSet data;
  Node all = Node::map();
  for (int s = 0; s < sets; ++s) all.set("s" + std::to_string(s), entry);
  Problems problems;
  data.sets = read_sets(all, problems);
  expects(!problems.any(), "the sets are well formed");
  Random random(3);
  std::normal_distribution<double> normal(0, kMeasured);
  std::vector<SampleRequest> requests;
  for (int s = 0; s < sets; ++s) {
    SampleRequest request;
    request.set = s;
    request.rows = rows / sets;
    request.together = true;
    const auto equations = static_cast<Eigen::Index>(
        data.sets[static_cast<std::size_t>(s)].method->equations().size());
    request.residual = [&, equations](int) {
      return Eigen::VectorXd(
          Eigen::VectorXd::NullaryExpr(equations, [&] { return normal(random); }));
    };
    requests.push_back(request);
  }
  sample_rows(robot, values(robot), requests, random, data);
  for (double& each : data.rows.position.reshaped()) each += normal(random);
  return data;
}

Node method_of(const char* name) {
  Node node = Node::map();
  node.set("method", Node::of(std::string(name)));
  node.set("noise", Node::of(kMeasured));
  return node;
}

void joints(benchmark::State& state) {
  const auto robot = arm_of(static_cast<int>(state.range(0)));
  const DataSet data = rows_of(*robot, method_of("position"), 1);
  for (auto _ : state) benchmark::DoNotOptimize(identify(*robot, data).verdict);
}

void planes(benchmark::State& state) {
  const DataSet data =
      rows_of(example_robot(), method_of("plane"), static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(identify(example_robot(), data).verdict);
}

/// From the rows of a session to what is judged, stored and published of it.
void result(benchmark::State& state) {
  const Robot& robot = example_robot();
  DataSet data = rows_of(robot, method_of("plane"), 6, static_cast<int>(state.range(0)));
  for (Eigen::Index row = 0; row < data.rows.rows(); row += 3)
    data.rows.check[static_cast<std::size_t>(row)] = 1;
  for (auto _ : state) {
    const Engagements found = identify_engagements(robot, data, {});
    benchmark::DoNotOptimize(judge_as_it_is(robot, data).verdict);
    benchmark::DoNotOptimize(to_json(found.solution, robot.name(), {}).dump());
    benchmark::DoNotOptimize(robot_text(robot, found.solution.values));
  }
}

}  // namespace

void add_growth() {
  for (const int count : {3, 4, 5, 6, 7, 8, 9})
    add_task("joints/selfcal", joints)->Arg(count)->Unit(benchmark::kMillisecond);
  for (const int count : {1, 4, 10, 40, 100})
    add_task("planes/selfcal", planes)->Arg(count)->Unit(benchmark::kMillisecond);
  add_task("result/selfcal", result)->Arg(400)->Unit(benchmark::kMillisecond);
}

}  // namespace selfcal::bench
