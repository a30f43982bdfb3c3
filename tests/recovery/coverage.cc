// Coverage of the stated sigmas, for every platform and method: the share of identified parameters
// that are within 1.96 of their sigmas of the truth, over many made robots and sessions. A few by
// default, SELFCAL_SEEDS of them on demand, from SELFCAL_FIRST_SEED on; README.md has the table of
// 200.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "sim/data_set_maker.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/recovery/rx90.h"
#include "tests/support/cell.h"

namespace selfcal::recovery {
namespace {

struct Covered {
  const char* title;
  const char* robot;  ///< a kind of kind_examples, or rx90
  const char* sets;
  int few = 3;  ///< robots by default
};

constexpr const char* kPlanes =
    "  a: {method: plane, noise: 2.0e-5, rows: 50}\n"
    "  b: {method: plane, noise: 2.0e-5, rows: 50}\n"
    "  c: {method: plane, noise: 2.0e-5, rows: 50}\n"
    "  d: {method: plane, noise: 2.0e-5, rows: 50}\n";
constexpr const char* kPositions = "  tracker: {method: position, noise: 2.0e-5, rows: 90}\n";
constexpr const char* kLocations =
    "  arm: {method: location, noise: 2.0e-5, noise_angle: 1.0e-4, rows: 60}\n";

/// Markers that are turned by one joint after another.
std::string circle_sets() {
  std::string sets;
  for (int joint = 1; joint <= 6; ++joint) {
    const std::string name = "j" + std::to_string(joint);
    sets +=
        "  " + name + ": {method: circle-point, joint: " + name + ", noise: 5.0e-5, rows: 24}\n";
  }
  return sets;
}

std::unique_ptr<Robot> robot_named(const std::string& name) {
  return robot_of(name == "rx90" ? kRx90 : kind_examples().at(name));
}

/// Every parameter that is free is off by as much as its maker's tolerance says.
std::string drawn_errors_of(const Robot& robot, int seed) {
  Random random(static_cast<unsigned>(seed));
  std::normal_distribution<double> normal;
  std::string text;
  for (const Parameter& p : robot.parameters()) {
    const double off = p.tolerance * normal(random);
    if (p.free && p.part != Part::gear)
      text += (text.empty() ? "" : ", ") + p.name + ": " + format_number(off);
  }
  return "{parameters: {" + text + "}}";
}

struct Tally {
  int robots = 0, unreached = 0, errors = 0, within = 0, within_one = 0;
  double squares = 0;

  void add(const Solution& solution, const Eigen::VectorXd& truth) {
    ++robots;
    for (std::size_t i = 0; i < solution.parameters.size(); ++i) {
      const ParameterResult& p = solution.parameters[i];
      if (p.status != Status::identified) continue;
      const double z = (p.value - truth[static_cast<Eigen::Index>(i)]) / p.sigma;
      ++errors;
      within_one += std::abs(z) <= 1;
      within += std::abs(z) <= 1.96;
      squares += z * z;
    }
  }
};

class Coverage : public testing::TestWithParam<Covered> {};

TEST_P(Coverage, IsWhatIsStated) {
  const Covered& each = GetParam();
  const auto robot = robot_named(each.robot);
  const int first = repetitions("SELFCAL_FIRST_SEED", 1);
  const int end = first + repetitions("SELFCAL_SEEDS", each.few);
  Tally tally;
  const std::string sets = *each.sets == 0 ? circle_sets() : each.sets;
  for (int seed = first; seed < end; ++seed) {
    const auto node = parse_yaml("robot: r\nseed: " + std::to_string(seed) +
                                     "\nerrors: " + drawn_errors_of(*robot, seed) +
                                     "\ncheck: 0.25\nsets:\n" + sets,
                                 "scenario");
    ASSERT_TRUE(node) << node.error().what;
    Problems problems;
    const Scenario scenario = read_scenario(*node, problems);
    const Simulated made = make_data_set(scenario, *robot, problems);
    ASSERT_FALSE(problems.any()) << problems.list.front();
    if (!made.unreached.empty()) {  // this robot does not reach what was drawn for it
      ++tally.unreached;
      continue;
    }
    const Solution solution = identify(*robot, made.data);
    EXPECT_TRUE(solution.converged) << seed << ": " << solution.stop_reason;
    tally.add(solution, made.truth.xi);
  }
  ASSERT_GT(tally.robots, tally.unreached) << "nothing was shown";
  const double n = tally.errors;
  const double share = tally.within / n;
  std::printf("| %s | %d | %d | %.2f | %.2f | %.3f |\n", each.title, tally.robots, tally.errors,
              100 * tally.within_one / n, 100 * share, std::sqrt(tally.squares / n));
  // Parameters of one robot hang together: six independent ones of it, four sigma of a share of
  // 0.95; two in a hundred of 200 robots.
  const double slack = std::max(0.02, 4 * std::sqrt(0.95 * 0.05 / (6.0 * tally.robots)));
  EXPECT_GT(share, 0.95 - slack);
  EXPECT_LT(share, std::max(0.98, 0.95 + slack));
}

TEST(HeldParameter, ThatIsOffMakesTheOthersAsDoubtful) {
  const auto robot = robot_of(kRx90);
  constexpr int kRobots = 10;
  Options options;
  options.fix = {"d5"};
  Tally tally;
  for (int seed = 1; seed <= kRobots; ++seed) {
    const std::string text = "robot: r\nseed: " + std::to_string(seed) +
                             "\nerrors: " + drawn_errors_of(*robot, seed) +
                             "\ncheck: 0.25\nsets:\n" + kPositions;
    Problems problems;
    const Scenario scenario = read_scenario(*parse_yaml(text, "scenario"), problems);
    const Simulated made = make_data_set(scenario, *robot, problems);
    ASSERT_FALSE(problems.any()) << problems.list.front();
    tally.add(identify(*robot, made.data, options), made.truth.xi);
  }
  // A parameter is off by 2 sigma of its tolerance in one robot of twenty, all others with it.
  EXPECT_GT(tally.within, 0.93 * tally.errors);
  EXPECT_GT(tally.errors, 10 * kRobots);
}

TEST(Repeats, ThatShareTheirErrorMakeNothingSurer) {
  const auto robot = robot_of(kRx90);
  constexpr int kRobots = 12;
  Tally tally;
  for (int seed = 1; seed <= kRobots; ++seed) {
    // Encoders of 1 mrad, by which ten touches of one configuration err alike.
    const std::string text = "robot: r\nseed: " + std::to_string(seed) +
                             "\ntarget: 20.0e-3\nerrors: {base_length: 5.0e-3, base_angle: 5.0e-3, "
                             "tool_length: 5.0e-3, tool_angle: 5.0e-3}\nencoder_step: 1.0e-3\n"
                             "check: 0.3\nrepeats: {share: 1, times: 10}\nsets:\n"
                             "  tracker: {method: position, frame: unknown, point: unknown, "
                             "noise: 2.0e-6, rows: 600}\n";
    Problems problems;
    const Scenario scenario = read_scenario(*parse_yaml(text, "scenario"), problems);
    const Simulated made = make_data_set(scenario, *robot, problems);
    ASSERT_FALSE(problems.any()) << problems.list.front();
    tally.add(identify(*robot, made.data), made.truth.xi);
  }
  // Of 1.96 sigma 0.95, as stated; three sigma of six independent parameters a robot.
  EXPECT_GT(tally.within, (0.95 - 3 * std::sqrt(0.95 * 0.05 / (6 * kRobots))) * tally.errors);
  EXPECT_LT(tally.squares, 1.3 * tally.errors);
  EXPECT_GT(tally.errors, 10 * kRobots);
}

// With this seed a touch is beyond the noise of the others without itself, and within it with
// itself: put aside and taken back for ever, it would keep the fit from its end.
TEST(RowAtTheBound, LetsTheFitEnd) {
  const auto robot = robot_of(kRx90);
  constexpr int kSeed = 38;
  std::string text = "robot: r\nseed: " + std::to_string(kSeed) +
                     "\nerrors: " + drawn_errors_of(*robot, kSeed) + "\ncheck: 0\nsets:\n";
  for (const char* name : {"a", "b", "c"})
    text += std::string("  ") + name + ": {method: plane, noise_true: 1.0e-4, rows: 20}\n";
  Problems problems;
  const Scenario scenario = read_scenario(*parse_yaml(text, "scenario"), problems);
  const Simulated made = make_data_set(scenario, *robot, problems);
  ASSERT_FALSE(problems.any()) << problems.list.front();
  const Solution solution = identify(*robot, made.data);
  EXPECT_TRUE(solution.converged) << solution.stop_reason;
  EXPECT_LT(solution.iterations, 100);
}

INSTANTIATE_TEST_SUITE_P(
    Stated, Coverage,
    testing::Values(
        Covered{"StewartLocks", "gough-stewart",
                "  u1: {method: locked-joint, lock: {leg: 1, joint: universal}, noise: 2.0e-5, "
                "rows: 60}\n"
                "  u3: {method: locked-joint, lock: {leg: 3, joint: universal}, noise: 2.0e-5, "
                "rows: 60}\n"
                "  s5: {method: locked-joint, lock: {leg: 5, joint: spherical}, noise: 2.0e-5, "
                "rows: 60}\n"},
        Covered{"StewartPlanes", "gough-stewart", kPlanes},
        Covered{"StewartInclinometers", "gough-stewart",
                "  tilt: {method: inclinometers, noise: 2.0e-5, rows: 120}\n"},
        Covered{"StewartPositions", "gough-stewart", kPositions},
        Covered{"StewartLocations", "gough-stewart", kLocations},
        Covered{"HexaSlideLink", "hexaslide",
                "  link: {method: constraint-link, length: 0.75, noise: 1.0e-6, noise_angle: "
                "2.0e-5, noise_joints: 2.0e-5, rows: 80}\n"},
        Covered{"HexaSlidePlanes", "hexaslide", kPlanes, 1},
        Covered{"HexaSlidePositions", "hexaslide", kPositions},
        Covered{"HexaSlideLocations", "hexaslide", kLocations},
        Covered{"DeltaPlanes", "linear-delta", kPlanes},
        Covered{"DeltaPositions", "linear-delta", kPositions},
        Covered{"ArmCirclePoints", "rx90", ""},
        Covered{"ArmInclinometers", "rx90",
                "  tilt: {method: inclinometers, noise: 2.0e-5, rows: 120}\n"},
        Covered{"ArmTheodolites", "rx90",
                "  one: {method: bearing, frame: unknown, noise: 2.0e-5, rows: 80}\n"
                "  two: {method: bearing, frame: unknown, noise: 2.0e-5, rows: 80}\n"
                "  a: {method: plane, noise: 2.0e-5, rows: 30}\n"
                "  b: {method: plane, noise: 2.0e-5, rows: 30, parallel_to: {set: a, distance: "
                "0.2, noise: 2.0e-6}}\n"},
        Covered{"ArmCables", "rx90",
                "  a: {method: fixed-point-distance, offset: unknown, noise: 1.0e-4, rows: 80}\n"
                "  b: {method: fixed-point-distance, offset: unknown, noise: 1.0e-4, rows: 80}\n"
                "  c: {method: fixed-point-distance, offset: unknown, noise: 1.0e-4, rows: 80}\n"},
        Covered{"ArmLockedJoint", "rx90",
                "  tip: {method: position-constraint, locked: [j4], noise: 2.0e-5, rows: 60, "
                "rows_per_group: 12}\n"
                "  tracker: {method: position, frame: unknown, noise: 2.0e-5, rows: 60}\n"}),
    [](const auto& made) { return std::string(made.param.title); });

}  // namespace
}  // namespace selfcal::recovery
