// Effects in a robot file: there and back, what they say of themselves, what is refused at which
// line.
#include "io/files/robot_file.h"
#include "kinematics/make_robot.h"
#include "tests/effects/effect_case.h"
#include "tests/effects/refused.h"
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

/// Three legs and what weighs on them; the first effect stands on line 9.
const char* const kPrinter =
    "robot: printer\nkind: linear-delta\nmasses: {effector: 0.2}\ntowers:\n"
    "  - {radius: 0.105, angle: 0.5, rod: 0.215, endstop: 0.48}\n"
    "  - {radius: 0.105, angle: 2.6, rod: 0.215, endstop: 0.48}\n"
    "  - {radius: 0.105, angle: 4.7, rod: 0.215, endstop: 0.48}\neffects:\n";

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

}  // namespace
}  // namespace selfcal
