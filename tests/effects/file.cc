// Effects in a robot file: there and back, what they say of themselves, what is refused at which
// line.
#include "io/files/robot_file.h"
#include "kinematics/make_robot.h"
#include "tests/effects/effect_case.h"
#include "tests/support/arm_of_size.h"

namespace selfcal {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class EffectFile : public testing::TestWithParam<EffectCase> {};

bool same_locations(const Robot& a, const Robot& b, const ConfigurationBlock& block) {
  Locations X, Y;
  a.locate(block, values(a), Body::endpoint, X, nullptr);
  b.locate(block, values(b), Body::endpoint, Y, nullptr);
  // A normal that is made a unit vector once more may differ in its last bit.
  return (X.position - Y.position).abs().maxCoeff() < 1e-15 &&
         (X.rotation - Y.rotation).abs().maxCoeff() < 1e-15;
}

TEST_P(EffectFile, ComesBackWithTheSameParametersAndActsTheSame) {
  std::mt19937_64 random(91);
  for (int i = 0; i < 6; ++i) {
    const EffectInstance at = random_instance(GetParam(), random);
    const std::string text = robot_text(*at.robot, at.xi);
    const auto back = robot_of(parsed(text));
    ASSERT_NE(back, nullptr) << text;
    EXPECT_EQ(values(*back), at.xi) << text;
    EXPECT_EQ(robot_text(*back, at.xi), text);
    const auto once = effects_of(*at.robot), again = effects_of(*back);
    ASSERT_EQ(again.size(), 1u);
    EXPECT_EQ(again[0]->name(), once[0]->name());
    EXPECT_EQ(again[0]->at(), once[0]->at());
    // At the context of its data set it acts there as it did.
    Problems problems;
    const auto there = correct(geometry_of(robot_of(parsed(text))),
                               parsed(text).find("effects")->items, at.context, problems);
    ASSERT_NE(there, nullptr) << problems.list.front();
    Locations X, Y;
    at.robot->locate(at.block, at.xi, Body::endpoint, X, nullptr);
    there->locate(at.block, values(*there), Body::endpoint, Y, nullptr);
    EXPECT_LT((X.position - Y.position).abs().maxCoeff(), 1e-15);
    EXPECT_LT((X.rotation - Y.rotation).abs().maxCoeff(), 1e-15);
    // And the file that was read acts like the file that it writes.
    EXPECT_TRUE(same_locations(*back, *robot_of(parsed(robot_text(*back, at.xi))), at.block));
  }
}

TEST_P(EffectFile, LeavesTheModelsHashAlone) {
  std::mt19937_64 random(92);
  const EffectInstance at = random_instance(GetParam(), random);
  const std::string hash = model_hash(*at.geometry);
  EXPECT_EQ(model_hash(*at.robot), hash);
  EXPECT_EQ(model_hash(*robot_of(parsed(robot_text(*at.robot, at.xi)))), hash);
}

TEST_P(EffectFile, HasParametersWithUnitsThatAreFixedUnlessFreed) {
  std::mt19937_64 random(93);
  const EffectInstance at = random_instance(GetParam(), random);
  const Effect& effect = *effects_of(*at.robot)[0];
  EXPECT_FALSE(effect.needs().empty());
  ASSERT_EQ(effect.parameters().size(), static_cast<size_t>(at.xi.size() - at.own()));
  ASSERT_FALSE(effect.parameters().empty());
  const std::string place = effect.at().empty() ? "robot" : effect.at();
  for (size_t i = 0; i < effect.parameters().size(); ++i) {
    const EffectParameter& own = effect.parameters()[i];
    EXPECT_FALSE(own.unit.empty());
    EXPECT_GT(own.usual_least, 0);
    EXPECT_GT(own.usual_most, own.usual_least);
    const Parameter& p = at.robot->parameters()[static_cast<size_t>(at.own()) + i];
    EXPECT_EQ(p.name, place + "." + own.name);
    EXPECT_EQ(p.unit(), own.unit);
    EXPECT_EQ(p.part, Part::effect);
    EXPECT_EQ(p.nominal, 0);
    EXPECT_DOUBLE_EQ(p.tolerance, 10 * own.usual_most);
    EXPECT_FALSE(p.free);
    EXPECT_EQ(find_parameter(*at.robot, p.name), static_cast<int>(at.own()) + static_cast<int>(i));
  }
}

TEST_P(EffectFile, KeepsWhetherADiagnosisNamedIt) {
  std::mt19937_64 random(94);
  const EffectInstance at = random_instance(GetParam(), random);
  const Node silent = parsed(robot_text(*at.robot, at.xi)).find("effects")->items.front();
  EXPECT_EQ(silent.find("named"), nullptr);
  EXPECT_FALSE(effects_of(*at.robot)[0]->named().has_value());
  for (const bool named : {true, false}) {
    const std::string word = named ? "true" : "false";
    Node entry = silent;
    entry.set("named", Node::of(word));
    Problems problems;
    const auto robot = correct(at.geometry, {entry}, at.context, problems);
    ASSERT_NE(robot, nullptr) << problems.list.front();
    const auto back = robot_of(parsed(robot_text(*robot, at.xi)));
    ASSERT_NE(back, nullptr);
    EXPECT_EQ(effects_of(*back)[0]->named(), named);
    EXPECT_EQ(effect_entries(*back).front().find("named")->text, word);
    EXPECT_EQ(values(*back), at.xi);
  }
}

TEST_P(EffectFile, HasOneEntryOfWhatWasFoundTwice) {
  std::mt19937_64 random(95);
  const EffectInstance at = random_instance(GetParam(), random);
  const Node entry = parsed(robot_text(*at.robot, at.xi)).find("effects")->items.front();
  Problems problems;
  const auto twice = correct(at.geometry, {entry, entry}, at.context, problems);
  ASSERT_NE(twice, nullptr) << problems.list.front();
  const auto own = at.xi.size() - at.own();
  Eigen::VectorXd xi(at.own() + 2 * own);
  xi << at.xi, 0.5 * at.xi.tail(own);
  const auto back = robot_of(parsed(robot_text(*twice, xi)));
  ASSERT_NE(back, nullptr);
  EXPECT_EQ(effect_entries(*back).size(), 1U);
  // An effect is linear in its parameters.
  EXPECT_LT((values(*back).tail(own) - 1.5 * at.xi.tail(own)).norm(), 1e-15);
}

const char* const kArm =
    "robot: arm\nkind: serial\nframes:\n"
    "  - {name: base, joint: fixed, r: 0.5}\n"
    "  - {name: j1, joint: revolute, d: 0.3, mass: 10}\n"
    "  - {name: j2, joint: revolute, alpha: 1.5, d: 0.4, mass: 5}\n"
    "  - {name: j3, joint: prismatic, alpha: 1.5, mass: 2}\n"
    "effects:\n";  // the first effect stands on line 9

/// Three legs and what weighs on them; the first effect stands on line 9.
const char* const kPrinter =
    "robot: printer\nkind: linear-delta\nmasses: {effector: 0.2}\ntowers:\n"
    "  - {radius: 0.105, angle: 0.5, rod: 0.215, endstop: 0.48}\n"
    "  - {radius: 0.105, angle: 2.6, rod: 0.215, endstop: 0.48}\n"
    "  - {radius: 0.105, angle: 4.7, rod: 0.215, endstop: 0.48}\neffects:\n";

/// First problem of the arm with these effects, one a line.
std::string refusal(const std::string& entries, const char* of = kArm) {
  Problems problems;
  const auto robot = make_robot(parsed(of + entries), problems);
  EXPECT_EQ(robot, nullptr);
  return problems.any() ? problems.list.front() : "accepted";
}

TEST_P(EffectFile, IsRefusedForAnUnknownKey) {
  if (std::string(GetParam().kind) != "serial") {
    EXPECT_THAT(refusal("  - {" + entry_text(GetParam(), "tower2", "tower1") + ", colour: red}\n",
                        kPrinter),
                AllOf(StartsWith("arm.yaml:9: "), HasSubstr("'colour'")));
    const std::string on_an_arm = entry_text(GetParam(), "j2", "j1");
    if (on_an_arm.find("leg_") == on_an_arm.npos && on_an_arm.find("clearance") == on_an_arm.npos)
      return;
    EXPECT_THAT(refusal("  - {" + on_an_arm + "}\n"),
                AllOf(StartsWith("arm.yaml:9: "), HasSubstr("no legs carry this kind of robot")));
    return;
  }
  const std::string entry = entry_text(GetParam(), "j2", "j1");
  EXPECT_THAT(refusal("  - {effect: backlash, at: j1}\n  - {" + entry + ", colour: red}\n"),
              AllOf(StartsWith("arm.yaml:10: "), HasSubstr("'colour'")));
}

INSTANTIATE_TEST_SUITE_P(Effects, EffectFile, testing::ValuesIn(effect_cases()), title_of);

TEST(UsualSizes, OfLengthsGrowWithTheMachineAndOfAnglesAndForcesStay) {
  const auto usual = [](double size, const std::string& effect) {
    const std::shared_ptr<const Robot> arm = arm_of_size(size);
    Problems problems;
    const auto corrected =
        correct(arm, {*parsed("effects: {" + effect + "}").find("effects")}, {}, problems);
    EXPECT_NE(corrected, nullptr) << effect;
    return effects_of(*corrected)[0]->parameters()[0].usual_most;
  };
  const auto ratio = [&](const std::string& effect) {
    return usual(10, effect) / usual(1, effect);
  };
  EXPECT_NEAR(ratio("effect: tool_shift, moment: 0"), 10, 1e-9);
  EXPECT_NEAR(ratio("effect: probe_pretravel"), 10, 1e-9);
  EXPECT_NEAR(ratio("effect: plane_form_error, at: t, normal: [0, 0, 1]"), 0.1, 1e-9);
  EXPECT_NEAR(ratio("effect: transmission_error, at: j2"), 1, 1e-9);
  EXPECT_NEAR(ratio("effect: thermal_expansion"), 1, 1e-9);
}

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
