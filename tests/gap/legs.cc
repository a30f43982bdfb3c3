// Parallel robots with one leg that does what the model lacks: the diagnosis names it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "constraints/sampling/random_poses.h"
#include "diagnosis/diagnosis.h"
#include "kinematics/corrected_robot.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

struct LegCase {
  const char* title;
  const char* kind;
  const char* effect;
  const char* entry;   ///< empty: nothing is the matter
  bool heavy = false;  ///< its file says what it weighs
};

/// Rows of a tracker on the tool, 20 um a coordinate: loads and temperatures of all kinds, on a
/// robot that is off by half a millimetre and has the effect.
DataSet tracked(const std::shared_ptr<const Robot>& nominal, const std::string& entry,
                unsigned seed = 5) {
  constexpr int kRows = 150;
  constexpr double kNoise = 2e-5;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> within(-1, 1);
  Problems problems;
  DataSet data;
  Node tracker = Node::map();
  tracker.set("method", Node::of(std::string("position"))).set("noise", Node::of(kNoise));
  data.sets = {make_set("tracker", tracker, problems)};
  std::shared_ptr<const Robot> robot = nominal;
  if (!entry.empty()) robot = correct(nominal, {parsed("{" + entry + "}")}, {}, problems);
  for (const std::string& problem : problems.list) ADD_FAILURE() << problem;
  Eigen::VectorXd xi = values(*robot);
  for (size_t i = 0; i < nominal->parameters().size(); ++i)
    if (nominal->parameters()[i].quantity == Quantity::length)
      xi[static_cast<Eigen::Index>(i)] += 5e-4 * normal(random);
  Observations& rows = data.rows;
  rows.q = closing_poses(*robot, xi, random_poses(*nominal, nullptr, kRows, seed + 4));
  const auto count = static_cast<Eigen::Index>(rows.q.rows());
  rows.set.assign(static_cast<size_t>(count), 0);
  rows.group.assign(static_cast<size_t>(count), -1);
  rows.position.resize(count, 3);
  rows.wrench.setZero(count, 6);
  rows.temperature.resize(count);
  rows.time.resize(count);
  for (Eigen::Index row = 0; row < count; ++row) {
    rows.check.push_back(row % 3 == 2);
    for (int k = 0; k < 3; ++k) rows.wrench(row, k) = 100 * within(random);
    rows.temperature[row] = 22 + 4 * within(random);
    rows.time[row] = 30.0 * static_cast<double>(row);
    ConfigurationBlock block = block_of(rows.q.row(row).transpose());
    block.conditions = conditions(rows, {static_cast<int>(row)});
    Locations X;
    EXPECT_TRUE(robot->locate(block, xi, Body::endpoint, X, nullptr).closes(0));
    rows.position.row(row) = X.p(0).transpose();
    for (double& coordinate : rows.position.row(row)) coordinate += kNoise * normal(random);
  }
  return data;
}

class LegCauses : public testing::TestWithParam<LegCase> {};

TEST_P(LegCauses, AreNamedWithTheirLeg) {
  const LegCase& each = GetParam();
  const std::shared_ptr<const Robot> robot = robot_of(
      kind_examples().at(each.kind) + (each.heavy ? kind_masses().at(each.kind) : std::string()));
  const Diagnosis diagnosis = diagnose(robot, tracked(robot, each.entry));
  ASSERT_EQ(diagnosis.problem, "");
  std::string words = diagnosis.verdict.effect;
  for (const CauseResult& cause : diagnosis.named) {
    char text[32];
    std::snprintf(text, sizeof text, " %.2f", cause.probability);
    words += "; " + cause.effect;
    for (const std::string& place : cause.where) words += " " + place;
    words += text;
  }
  std::printf("%s: %s\n", each.title, words.c_str());
  EXPECT_EQ(diagnosis.verdict.effect, each.effect);
  if (*each.entry == 0) return;
  ASSERT_FALSE(diagnosis.named.empty());
  ASSERT_EQ(diagnosis.named.front().where.size(), 1u);
  EXPECT_EQ(diagnosis.named.front().where.front(), robot->joints()[1].name);
}

INSTANTIATE_TEST_SUITE_P(
    Made, LegCauses,
    testing::Values(LegCase{"HexapodSoft", "gough-stewart", "leg_compliance",
                            "effect: leg_compliance, at: leg2, mass: 0, c: 1.5e-6"},
                    LegCase{"HexapodWarm", "gough-stewart", "leg_thermal_growth",
                            "effect: leg_thermal_growth, at: leg2, alpha: 2.0e-5"},
                    LegCase{"HexapodLoose", "gough-stewart", "joint_clearance",
                            "effect: joint_clearance, at: leg2, play: 1.0e-4"},
                    LegCase{"HexapodSound", "gough-stewart", "none", ""},
                    LegCase{"SliderSound", "hexaslide", "none", ""},
                    LegCase{"SliderSoft", "hexaslide", "leg_compliance",
                            "effect: leg_compliance, at: chain2, mass: 0, c: 1.5e-6"},
                    LegCase{"SliderWarm", "hexaslide", "leg_thermal_growth",
                            "effect: leg_thermal_growth, at: chain2, alpha: 2.0e-5"},
                    LegCase{"SliderLoose", "hexaslide", "joint_clearance",
                            "effect: joint_clearance, at: chain2, play: 1.0e-4"},
                    LegCase{"DeltaSoft", "linear-delta", "leg_compliance",
                            "effect: leg_compliance, at: tower2, mass: 0, c: 1.5e-6"},
                    LegCase{"DeltaWarm", "linear-delta", "leg_thermal_growth",
                            "effect: leg_thermal_growth, at: tower2, alpha: 3.0e-5"},
                    LegCase{"DeltaLoose", "linear-delta", "joint_clearance",
                            "effect: joint_clearance, at: tower2, play: 1.0e-4"},
                    LegCase{"DeltaSound", "linear-delta", "none", ""},
                    LegCase{"DeltaDriveSoft", "linear-delta", "joint_compliance",
                            "effect: joint_compliance, at: tower2, c: 1.5e-6", true},
                    LegCase{"SliderDriveSoft", "hexaslide", "joint_compliance",
                            "effect: joint_compliance, at: chain2, c: 1.5e-6", true},
                    LegCase{"HeavyDeltaSoft", "linear-delta", "leg_compliance",
                            "effect: leg_compliance, at: tower2, c: 1.5e-6", true}),
    [](const auto& made) { return std::string(made.param.title); });

/// An effect that a leg may have, of a size drawn evenly by its logarithm.
struct LegEffect {
  const char* name;
  const char* field;
  double least, most;
  const char* more;
};
constexpr LegEffect kLegEffects[] = {
    {"leg_compliance", "c", 5e-7, 5e-6, ", mass: 0"},  // m/N: 10 to 100 um of 20 N
    {"leg_thermal_growth", "alpha", 1e-5, 4e-5, ""},   // 1/K, metals and plastics
    {"joint_clearance", "play", 5e-5, 3e-4, ""}};      // m

class LegTrials : public testing::TestWithParam<const char*> {};

/// Trials of any leg, effect and size, a fourth of them of sound robots: few by default,
/// SELFCAL_SEEDS on demand.
TEST_P(LegTrials, NameCauseAndLegAndNothingOnSoundRobots) {
  const std::shared_ptr<const Robot> robot = robot_of(kind_examples().at(GetParam()));
  const char* text = std::getenv("SELFCAL_SEEDS");
  const int trials = text ? std::atoi(text) : 2;
  int affected = 0, named = 0, placed = 0, sound = 0, alarms = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::mt19937_64 random(100 + trial);
    std::uniform_real_distribution<double> share(0, 1);
    const std::size_t leg = random() % robot->joints().size();
    const std::string& place = robot->joints()[leg].name;
    const std::size_t kind = (static_cast<std::size_t>(trial) + 1) % 4;
    std::string entry;
    if (kind < 3) {
      const LegEffect& effect = kLegEffects[kind];
      entry = std::string("effect: ") + effect.name + ", at: " + place + ", " + effect.field +
              ": " +
              format_number(effect.least * std::pow(effect.most / effect.least, share(random))) +
              effect.more;
    }
    const Diagnosis diagnosis =
        diagnose(robot, tracked(robot, entry, 200 + static_cast<unsigned>(trial)));
    ASSERT_EQ(diagnosis.problem, "");
    const std::string& said = diagnosis.verdict.effect;
    std::printf("%s {%s}: %s\n", GetParam(), entry.c_str(), said.c_str());
    if (entry.empty()) {
      ++sound;
      alarms += said != "none";
      continue;
    }
    ++affected;
    const bool right = said == kLegEffects[kind].name;
    named += right;
    placed += right && !diagnosis.named.empty() &&
              diagnosis.named.front().where == std::vector<std::string>{place};
  }
  std::printf("| %s | %d | %d | %d | %d | %d |\n", GetParam(), affected, named, placed, sound,
              alarms);
  // Four of five, less three sigma of few trials; one alarm in twenty and three sigma.
  EXPECT_GE(placed, 0.8 * affected - 3 * std::sqrt(0.16 * affected));
  EXPECT_LE(alarms, 0.05 * sound + 3 * std::sqrt(0.05 * sound));
}

INSTANTIATE_TEST_SUITE_P(Made, LegTrials,
                         testing::Values("gough-stewart", "hexaslide", "linear-delta"),
                         [](const auto& made) {
                           const std::string kind = made.param;
                           return kind == "hexaslide"       ? "HexaSlide"
                                  : kind == "gough-stewart" ? "GoughStewart"
                                                            : "LinearDelta";
                         });

}  // namespace
}  // namespace selfcal
