// Entries of a robot file's effects: which are refused, and what is made of the others.
#include "io/files/robot_file.h"
#include "kinematics/make_robot.h"
#include "tests/effects/effect_case.h"
#include "tests/effects/refused.h"

namespace selfcal {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(EffectsOfAFile, AreRefusedWithTheLineAndWhatWasExpected) {
  const std::pair<const char*, const char*> cases[] = {
      {"{effect: joint_complience, at: j2}", "joint_compliance, link_compliance"},
      {"{at: j2}", "effect"},
      {"{effect: joint_compliance}", "'at'"},
      {"{effect: joint_compliance, at: j9}", "j1, j2, j3"},
      {"{effect: joint_compliance, at: base}", "j1, j2, j3"},
      {"{effect: joint_compliance, at: j2, c: soft}", "'c'"},
      {"{effect: joint_compliance, at: j2, lumps: maybe}", "lumps"},
      {"{effect: joint_compliance, at: j2, by: cube}", "torque or square"},
      {"{effect: joint_compliance, at: j2, by: square, lumps: true}", "no masses"},
      {"{effect: joint_compliance, at: j2, named: perhaps}", "named"},
      {"{effect: link_compliance, at: j2, bend_z: 1}", "bend_z"},
      {"{effect: transmission_error, at: j1, waves: [1, 0]}", "waves"},
      {"{effect: transmission_error, at: j1, waves: []}", "waves"},
      {"{effect: transmission_error, at: j1, waves: -1}", "waves"},
      {"{effect: transmission_error, at: j1, waves: [1, 2, 1]}", "numbers that differ"},
      {"{effect: base_drift, half_waves: [2, 2]}", "numbers that differ"},
      {"{effect: backlash, at: j1, play: 120}",
       "'play': expected from -0.0015 to 0.15 rad (degrees?)"},
      {"{effect: backlash, at: j1, play: -2.0e-3}", "from -0.0015 to 0.15 rad"},
      {"{effect: backlash, at: j3, play: 2}", "m (millimetres?)"},
      {"{effect: tool_shift, moment: 0, x: 100}", "m (millimetres?)"},
      {"{effect: scale_error, at: tracker, s: 1000}", "(parts per million?)"},
      {"{effect: trigger_latency, delay: 5}", "s (milliseconds?), or `unusual: true`"},
      {"{effect: thermal_expansion, alpha: 11.5}", "1/K (parts per million per kelvin?)"},
      {"{effect: joint_compliance, at: j2, c: 0.1}", "to 0.01 rad/(N m), or"},
      {"{effect: thermal_expansion, reference: 293.15}", "Celsius from -100 to 150 (kelvin?)"},
      {"{effect: scale_error, at: t, by: temperature, reference: -273}",
       "Celsius from -100 to 150,"},
      {"{effect: backlash, at: j1, unusual: maybe}", "unusual"},
      {"{effect: backlash, at: j1, by: luck}", "motion or load"},
      {"{effect: joint_coupling, at: j1}", "from"},
      {"{effect: joint_coupling, at: j1, from: j1}", "another joint"},
      {"{effect: joint_coupling, at: j1, from: base}", "another joint"},
      {"{effect: thermal_expansion, at: j2}", "the whole robot"},
      {"{effect: thermal_expansion, lag: -1}", "lag"},
      {"{effect: base_drift, at: j1}", "base"},
      {"{effect: base_drift, settle: -5}", "settle"},
      {"{effect: base_drift, moment: 5, settle: 5}", "moved at once"},
      {"{effect: base_drift, moment: 5, end: 50}", "moved at once"},
      {"{effect: zero_shift, at: j1}", "moment"},
      {"{effect: probe_pretravel, at: j1}", "probe"},
      {"{effect: trigger_latency, at: base}", "probe"},
      {"{effect: base_drift, begin: 100, end: 50}", "a time after `begin`"},
      {"{effect: plane_form_error, at: table, normal: [0, 0, 0]}", "normal"},
      {"{effect: fixture_shift, at: table, normal: [0, 0, 1]}", "moment"},
      {"{effect: fixture_shift, at: table, moment: 1, normal: [0, 1]}", "normal"},
  };
  for (const auto& [entry, expected] : cases)
    EXPECT_THAT(refusal("  - " + std::string(entry) + "\n"),
                AllOf(StartsWith("arm.yaml:9: "), HasSubstr(expected)))
        << entry;
}

TEST(EffectsOfAFile, LeaveOpenWhatRowsAreToSay) {
  for (const char* entry :
       {"effect: thermal_expansion, alpha: 1.0e-5", "effect: base_drift, x: 1.0e-4",
        "effect: base_drift, begin: 50, x: 1.0e-4", "effect: plane_form_error, at: table, a: 1e-3",
        "effect: scale_error, at: tracker, by: temperature, k: 1.0e-6",
        "effect: fixture_shift, at: table, moment: 1, normal: [0, 0, 1], shift: 1.0e-4"}) {
    const auto robot = robot_of(std::string(kArm) + "  - {" + entry + "}\n", "arm.yaml");
    ASSERT_TRUE(robot) << robot.error().what;
    const std::vector<Node> written = effect_entries(**robot);
    for (const char* key : {"reference", "end", "center"})
      EXPECT_EQ(written.front().find(key), nullptr) << entry << ": " << key;
  }
}

TEST(EffectsOfAFile, AreRefusedWhenOneIsThereTwice) {
  EXPECT_THAT(refusal("  - {effect: backlash, at: j1, play: 1.0e-4}\n"
                      "  - {effect: backlash, at: j1, play: 2.0e-4}\n"),
              AllOf(StartsWith("arm.yaml:"), HasSubstr("one is there twice")));
}

TEST(EffectsOfAFile, AreReadAgainWhateverAFitMadeOfThem) {
  const auto robot = robot_of(std::string(kArm) + "  - {effect: backlash, at: j1}\n", "arm.yaml");
  ASSERT_TRUE(robot) << robot.error().what;
  Eigen::VectorXd xi = values(**robot);
  for (const double play : {-1.0e-3, -2.0e-3, 0.1, 7.0}) {
    xi.tail<1>()[0] = play;
    const std::string text = robot_text(**robot, xi);
    const auto back = robot_of(text, "arm.yaml");
    ASSERT_TRUE(back) << back.error().what;
    EXPECT_EQ(values(**back), xi);
    EXPECT_EQ(text.find("unusual: true") != text.npos, play < -1.5e-3 || play > 0.15) << play;
    EXPECT_EQ(robot_text(**back, xi), text);
  }
}

TEST(EffectsOfAFile, AreRemarkedOnWhereTheirSignIsOneThatNoMachineHas) {
  const auto remarks = [](const std::string& play) {
    const auto robot =
        robot_of(std::string(kArm) + "  - {effect: backlash, at: j1, play: " + play + "}\n", "a");
    return robot ? (*robot)->text().remarks() : std::vector{robot.error().what};
  };
  EXPECT_THAT(
      remarks("-3e-4"),
      Contains("backlash at j1: play is -3.0e-04 rad, below zero, which no machine has (its "
               "sign?)"));
  EXPECT_THAT(remarks("3e-4"), Not(Contains(HasSubstr("below zero"))));
}

TEST(EffectsOfAFile, AreRefusedWhenTheyAreNoList) {
  EXPECT_THAT(refusal("  effect: backlash\n  at: j1\n"),
              AllOf(StartsWith("arm.yaml:"), HasSubstr("list of effects")));
}

TEST(TriggerLatency, IsRefusedWhereOnlySignsOfVelocitiesAreKnown) {
  MeasurementContext context;
  context.velocities = true;
  Problems problems;
  const auto entry = parsed("{effect: trigger_latency}");
  EXPECT_EQ(correct(robot_of(with_frames("  - {name: j1, joint: revolute}\n")), {entry}, context,
                    problems),
            nullptr);
  ASSERT_TRUE(problems.any());
  EXPECT_THAT(problems.list.front(), HasSubstr("velocities"));
}

TEST(JointCompliance, OfARobotWithoutMassesComesBackAsItWasLoadedOrLumped) {
  const auto arm = std::shared_ptr<const Robot>(
      robot_of(with_frames("  - {name: j1, joint: revolute, alpha: 1.5}\n"
                           "  - {name: tool, joint: fixed, d: 1}\n")));
  MeasurementContext loaded, unloaded;
  loaded.loads = true;
  for (const MeasurementContext& context : {loaded, unloaded}) {
    Problems problems;
    const auto robot =
        correct(arm, {parsed("{effect: joint_compliance, at: j1}")}, context, problems);
    ASSERT_NE(robot, nullptr);
    const auto back = robot_of(robot->text().describe(values(*robot)));
    ASSERT_NE(back, nullptr);
    EXPECT_EQ(back->parameters().size(), robot->parameters().size());
    EXPECT_EQ(back->parameters().back().name, context.loads ? "j1.c" : "j1.y_j1");
  }
}

TEST(EffectOfABase, HasItsOwnNamesBesideABaseThatIsAWholePose) {
  const std::string frames =
      "robot: arm\nkind: serial\nframes:\n"
      "  - {name: base, joint: fixed, xyz: [0, 0, 0.5]}\n  - {name: j1, joint: revolute}\n";
  const auto robot = robot_of(
      parsed(frames + "effects:\n  - {effect: base_drift, rx: 1.0e-4, begin: 0, end: 9}\n"));
  ASSERT_NE(robot, nullptr);
  EXPECT_EQ(robot->parameters()[find_parameter(*robot, "base.rx")].part, Part::base);
  const int drift = find_parameter(*robot, "base_drift.rx");
  ASSERT_GE(drift, 0);
  EXPECT_EQ(robot->parameters()[drift].part, Part::effect);
  EXPECT_EQ(values(*robot)[drift], 1e-4);
  const auto back = robot_of(robot->text().describe(values(*robot)));
  ASSERT_NE(back, nullptr);
  EXPECT_EQ(values(*back), values(*robot));
}

TEST(EffectsOfAFile, MayBeAtOnePlaceAgainWhereTheyDifferInMoreThanTheirValues) {
  const std::string arm =
      "robot: arm\nkind: serial\nframes:\n  - {name: j1, joint: revolute}\n"
      "  - {name: tool, joint: fixed, r: 0.1}\neffects:\n";
  const std::string at_10 = "  - {effect: tool_shift, at: probe, moment: 10, x: 1.0e-4}\n",
                    at_20 = "  - {effect: tool_shift, at: probe, moment: 20, x: 2.0e-4}\n";
  const auto robot = robot_of(arm + at_10 + at_20, "arm.yaml");
  ASSERT_TRUE(robot) << robot.error().what;
  const auto value = [&](const std::string& name) {
    for (std::size_t i = 0; i < (*robot)->parameters().size(); ++i)
      if ((*robot)->parameters()[i].name == name)
        return values(**robot)[static_cast<Eigen::Index>(i)];
    return -1.0;
  };
  EXPECT_EQ(value("probe.x"), 1e-4);
  EXPECT_EQ(value("probe.x_2"), 2e-4);
  EXPECT_TRUE(robot_of(robot_text(**robot, values(**robot)), "again.yaml"));
}

}  // namespace
}  // namespace selfcal
