// Models with a robot's effects, run by MuJoCo, against these effects' own formulas; the user's
// own model mended.
#include <gmock/gmock.h>

#include <random>

#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "io/models/mjcf_like.h"
#include "kinematics/rotation.h"
#include "tests/io/scratch.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// Skew axes, a base, masses, a tool that weighs, a payload of 3 kg at its tip.
constexpr const char* kLoaded = R"(robot: loaded
kind: serial
frames:
  - {name: base, joint: fixed, xyz: [0.1, 0.2, 0.3], rpy: [0.1, -0.2, 0.4]}
  - {name: a, joint: revolute, r: 0.4, mass: 20, com: [0.05, 0, -0.1]}
  - {name: b, joint: revolute, alpha: -1.5, d: 0.15, mass: 10, com: [0.25, 0, 0.02]}
  - {name: c, joint: revolute, alpha: 0.1, d: 0.5, theta: 0.3, r: 0.05, mass: 6, com: [0.1, 0.05, 0]}
  - {name: d, joint: revolute, alpha: 1.5, d: 0.1, r: 0.3, mass: 2, com: [0, 0, 0.05]}
  - {name: tool, joint: fixed, d: 0.05, alpha: 0.2, r: 0.15, mass: 3, com: [0, 0, 0]}
)";

struct Read {
  Node node;
  serial::Model model;
  std::unique_ptr<Robot> robot;
};

Read read_with(const std::string& effects) {
  const std::string text = std::string(kLoaded) + "effects: [" + effects + "]\n";
  Read read{*parse_yaml(text, "loaded.yaml"), {}, {}};
  Problems problems;
  read.model = serial::read(read.node.without({"effects"}), problems);
  auto robot = robot_of(text, "loaded.yaml");
  EXPECT_TRUE(robot) << robot.error().what;
  read.robot = *std::move(robot);
  return read;
}

/// Largest distance (m) from MuJoCo's tool to ours, and largest move of ours by the effects.
struct Apart {
  double most = 0, moved = 0;
};

Apart apart_at_rest(const Read& read, const std::string& text) {
  const Scratch scratch;
  const auto rigid = robot_of(kLoaded, "loaded.yaml");
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.5, 1.5);
  std::vector<MujocoLoad> loads;
  for (int i = 0; i < 40; ++i)
    loads.push_back(
        {Eigen::Vector4d(uniform(random), uniform(random), uniform(random), uniform(random))});
  const auto poses = settled_poses(scratch.write("model.xml", text), "tool", loads);
  EXPECT_TRUE(poses) << poses.error().what;
  Apart apart;
  for (std::size_t i = 0; poses && i < loads.size(); ++i) {
    EXPECT_TRUE(poses->tool[i]);
    if (!poses->tool[i]) continue;
    const Eigen::Vector3d ours = locate(*read.robot, values(*read.robot), loads[i].q).p;
    apart.most = std::max(apart.most, (poses->tool[i]->p - ours).norm());
    apart.moved =
        std::max(apart.moved, (locate(**rigid, values(**rigid), loads[i].q).p - ours).norm());
  }
  return apart;
}

struct EffectCase {
  const char* name;
  const char* entry;
};

class MujocoEffects : public testing::TestWithParam<EffectCase> {};

// The formulas are of first order in the effect: of a move of a few tenths of a millimetre by some
// tenths of a mrad, a second order of a thousandth is left, and the same again where it loads.
TEST_P(MujocoEffects, MoveTheToolAsTheirFormulasSay) {
  const Read read = read_with(GetParam().entry);
  const MjcfEffects effects = mjcf_effects(read.node, read.model);
  EXPECT_THAT(effects.left_out, IsEmpty());
  const Apart apart = apart_at_rest(read, mjcf_of(read.model, effects).text);
  EXPECT_GT(apart.moved, 1e-4);
  EXPECT_LT(apart.most, 3e-3 * apart.moved);
}

INSTANTIATE_TEST_SUITE_P(
    All, MujocoEffects,
    testing::Values(
        EffectCase{"joint_compliance", "{effect: joint_compliance, at: b, c: 3.0e-6}"},
        EffectCase{
            "link_compliance",
            "{effect: link_compliance, at: b, bend_x: 2.0e-6, bend_y: 4.0e-6, twist: 3.0e-6}"},
        EffectCase{
            "tool_compliance",
            "{effect: tool_compliance, at: probe, bend_x: 1.0e-4, bend_y: 1.5e-4, twist: 1.0e-4}"},
        EffectCase{"backlash", "{effect: backlash, at: b, by: load, play: 1.0e-3}"},
        EffectCase{"joint_coupling", "{effect: joint_coupling, at: c, from: b, kappa_b: 1.0e-3}"},
        EffectCase{"several",
                   "{effect: joint_compliance, at: c, c: 2.0e-6}, {effect: link_compliance, at: a, "
                   "bend_x: 1.0e-6, bend_y: 1.0e-6, twist: 1.0e-6}, {effect: backlash, at: c, by: "
                   "load, play: 4.0e-4}"}),
    [](const auto& each) { return std::string(each.param.name); });

TEST(MujocoEffectsLeftOut, AreNamedWithTheReason) {
  const Read read = read_with(
      "{effect: backlash, at: b, play: 1.0e-3}, {effect: transmission_error, at: b, sin1: 1.0e-4, "
      "cos1: 0}");
  const MjcfEffects effects = mjcf_effects(read.node, read.model);
  EXPECT_THAT(effects.left_out,
              Contains("the effect backlash at b: its side is that of the last motion, and a model "
                       "at rest has none"));
  EXPECT_THAT(effects.left_out, Contains("the effect transmission_error at b"));
}

/// The robot's maker's figures as a person wrote them for MuJoCo: degrees, a geom, an actuator, a
/// joint off its body's origin, a bracket between the last link and the tool.
constexpr const char* kOwn = R"(<mujoco model="own">
  <compiler angle="degree"/>
  <worldbody>
    <light pos="0 0 3"/>
    <body name="foot" pos="0.1 0 0.2">
      <geom name="kept" size="0.05" mass="4"/>
      <body name="one" pos="0 0 0.4">
        <joint name="j1" axis="0 0 1"/>
        <geom size="0.05" mass="8"/>
        <body name="two" pos="0.15 0.02 0" euler="-90 0 0">
          <joint name="j2" axis="0 0 1" pos="0.01 0 0" range="-100 100" limited="true"/>
          <geom size="0.05" mass="10" pos="0.25 0 0"/>
          <body name="three" pos="0.5 0 0">
            <joint name="j3" axis="0 0 -1"/>
            <geom size="0.05" mass="6" pos="0.1 0 0"/>
            <body name="bracket" pos="0.3 0 0.05" euler="0 20 0">
              <geom size="0.02" mass="2"/>
              <site name="tcp" pos="0 0 0.1"/>
            </body>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator><position name="holds" joint="j3" kp="1000000"/></actuator>
</mujoco>
)";

struct Mended {
  std::string text;
  std::vector<std::string> left_out;
  std::unique_ptr<Robot> robot;
};

/// kOwn, or another, mended by its robot, every parameter moved by up to 2 mm or mrad, with
/// `effects`.
Mended mended_by(const std::string& effects, const std::string& own = kOwn) {
  const Scratch scratch;
  const auto file = scratch.write("own.xml", own);
  const auto read = read_mujoco(file, "");
  EXPECT_TRUE(read) << read.error().what;
  const auto nominal = robot_of(write_yaml(serial::write(frames_of(read->chain))), "own.yaml");
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> uniform(-2e-3, 2e-3);
  Eigen::VectorXd xi = values(**nominal);
  for (Eigen::Index i = 0; i < xi.size(); ++i)
    if ((*nominal)->parameters()[static_cast<std::size_t>(i)].part != Part::gear)
      xi[i] += uniform(random);
  const std::string robot = robot_text(**nominal, xi) + "effects: [" + effects + "]\n";
  const Node node = *parse_yaml(robot, "own.yaml");
  Problems problems;
  const serial::Model model = serial::read(node.without({"effects"}), problems);
  const CorrectedChain chain = corrected_chain(read->chain, model);
  EXPECT_EQ(chain.problem, "");
  const auto made = mjcf_like(own, "own.xml", *read, chain, model, mjcf_effects(node, model));
  EXPECT_TRUE(made) << made.error().what;
  auto calibrated = robot_of(robot, "own.yaml");
  EXPECT_TRUE(calibrated) << calibrated.error().what;
  return {made->text, made->left_out, *std::move(calibrated)};
}

double most_apart(const Mended& mended) {
  const Scratch scratch;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1.5, 1.5);
  std::vector<MujocoLoad> loads;
  for (int i = 0; i < 30; ++i)
    loads.push_back({Eigen::Vector3d(uniform(random), uniform(random), uniform(random))});
  const auto poses = settled_poses(scratch.write("mended.xml", mended.text), "tcp", loads);
  EXPECT_TRUE(poses) << poses.error().what;
  double most = 0;
  for (std::size_t i = 0; poses && i < loads.size(); ++i)
    most = std::max(
        most,
        (poses->tool[i]->p - locate(*mended.robot, values(*mended.robot), loads[i].q).p).norm());
  return most;
}

TEST(MendedModel, OfTheUsersPutsTheToolWhereTheCalibratedRobotHasIt) {
  const Mended mended = mended_by("{effect: joint_compliance, at: j3, c: 1.0e-12}");
  EXPECT_THAT(mended.left_out, IsEmpty());
  EXPECT_THAT(mended.text, HasSubstr("name=\"kept\""));
  // The spring behind j3 is one of 1e-12 rad/(N m): nothing beside a nanometre.
  EXPECT_LT(most_apart(mended), 1e-9);
}

TEST(MendedModel, OfTheUsersWhoseJointsAreDrawnElsewhereThanAtZeroPutsTheToolThere) {
  std::string own = kOwn;
  replace(own, "name=\"j1\"", "name=\"j1\" ref=\"-40\"");
  replace(own, "name=\"j2\"", "name=\"j2\" ref=\"30\"");
  replace(own, "name=\"j3\"", "name=\"j3\" ref=\"50\"");
  EXPECT_LT(most_apart(mended_by("{effect: joint_compliance, at: j3, c: 1.0e-12}", own)), 1e-9);
  // The third body stands behind two that bend, by what bends in them.
  EXPECT_LT(most_apart(mended_by("{effect: link_compliance, at: j2, bend_x: 1.0e-12, bend_y: "
                                 "1.0e-12, twist: 1.0e-12}",
                                 own)),
            1e-9);
}

TEST(MendedModel, OfTheUsersGivesWayAsTheRobotDoes) {
  const Mended mended = mended_by(
      "{effect: joint_compliance, at: j2, c: 2.0e-6}, {effect: joint_compliance, at: j3, c: "
      "4.0e-6}, {effect: link_compliance, at: j2, bend_x: 1.0e-6, bend_y: 1.0e-6, twist: 1.0e-6}, "
      "{effect: backlash, at: j2, by: load, play: 4.0e-4}");
  EXPECT_THAT(mended.left_out, IsEmpty());
  EXPECT_THAT(mended.text, HasSubstr("stiffness=\"250000\""));
  EXPECT_THAT(mended.text, HasSubstr("joint=\"j3\" kp=\"1000000\""));
  EXPECT_THAT(mended.text, HasSubstr("j2.play"));
  // Effects move the tool by 0.2 mm and more; a hundredth of it is of second order and of masses
  // that the robot file has at the joints' own links.
  EXPECT_LT(most_apart(mended), 5e-6);
}

TEST(MendedModel, OfSeveralFilesIsRefused) {
  const Scratch scratch;
  std::string text = kOwn;
  scratch.write("more.xml", "<mujoco><worldbody><body name='other'/></worldbody></mujoco>");
  replace(text, "<actuator>", "<include file=\"more.xml\"/><actuator>");
  const auto file = scratch.write("own.xml", text);
  const auto read = read_mujoco(file, "");
  ASSERT_TRUE(read) << read.error().what;
  const serial::Model model = frames_of(read->chain);
  const auto made =
      mjcf_like(text, "own.xml", *read, corrected_chain(read->chain, model), model, {});
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().what,
              HasSubstr("MuJoCo makes 6 bodies of it, and the file itself has 5"));
}

}  // namespace
}  // namespace selfcal
