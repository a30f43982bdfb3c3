// `selfcal robot convert` as its user runs it, with a URDF: there and back, and what is refused.
#include <gmock/gmock.h>

#include "tests/io/scratch.h"
#include "tests/support/program.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

/// Two joints, a fixed one between them, a tool and a camera.
constexpr const char* kArmUrdf = R"(<robot name="arm">
  <link name="world"/> <link name="one"/> <link name="plate"/> <link name="two"/>
  <link name="tool0"/> <link name="camera"/>
  <joint name="turn" type="revolute"><parent link="world"/><child link="one"/>
    <origin xyz="0 0 0.3"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="weld" type="fixed"><parent link="one"/><child link="plate"/>
    <origin xyz="0.1 0 0" rpy="-1.5707963267948966 0 0"/></joint>
  <joint name="lift" type="revolute"><parent link="plate"/><child link="two"/>
    <origin xyz="0.05 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="flange" type="fixed"><parent link="two"/><child link="tool0"/>
    <origin xyz="0.4 0 0"/></joint>
  <joint name="mount" type="fixed"><parent link="one"/><child link="camera"/></joint>
</robot>
)";

class RobotConvert : public testing::Test {
 protected:
  Ran convert(const std::string& name, const std::string& text,
              const std::string& options = "") const {
    return run_selfcal("robot convert " + scratch_.write(name, text).string() + " " + options);
  }
  std::string in_folder(const std::string& name) const {
    return (scratch_.folder() / name).string();
  }
  Scratch scratch_;
};

TEST_F(RobotConvert, TakesAUrdfThereAndBack) {
  const Ran there =
      convert("arm.urdf", kArmUrdf, "--tip tool0 --out " + in_folder("arm.robot.yaml"));
  ASSERT_EQ(there.status, 0) << there.out;
  std::string robot = text_of(in_folder("arm.robot.yaml"));
  EXPECT_THAT(robot, HasSubstr("# From the URDF arm, world to tool0"));
  replace(robot, "d: 0.15, ", "d: 0.151, nominal: {d: 0.15}, ");
  const Ran back = convert("calibrated.robot.yaml", robot,
                           "--to urdf --like " + in_folder("arm.urdf") + " --tip tool0 --out " +
                               in_folder("calibrated.urdf"));
  ASSERT_EQ(back.status, 0) << back.out;
  EXPECT_THAT(back.out, HasSubstr("give it to the driver as robot_description"));
  // The weld stays, and the joint behind it takes the millimetre.
  const std::string urdf = text_of(in_folder("calibrated.urdf"));
  EXPECT_THAT(urdf, HasSubstr("xyz=\"0.1 0 0\""));
  EXPECT_THAT(urdf, HasSubstr("xyz=\"0.051 0 0\""));
  const Ran again = convert("calibrated.urdf", urdf, "--tip tool0");
  EXPECT_THAT(again.out, HasSubstr("d: 0.151, "));
}

TEST_F(RobotConvert, KeepsAFixedJointAndWritesWhatMovedItIntoItsOwnOrigin) {
  const Ran there = convert("arm.urdf", kArmUrdf,
                            "--tip tool0 --fixed keep --out " + in_folder("arm.robot.yaml"));
  ASSERT_EQ(there.status, 0) << there.out;
  std::string robot = text_of(in_folder("arm.robot.yaml"));
  EXPECT_THAT(robot, HasSubstr("{name: flange, joint: fixed, xyz: [0.4, 0, 0]"));
  replace(robot, "{name: weld, joint: fixed, xyz: [0.1, 0, 0], ",
          "{name: weld, joint: fixed, xyz: [0.1, 0, 0.002], nominal: {xyz: [0.1, 0, 0]}, ");
  const Ran back = convert("calibrated.robot.yaml", robot,
                           "--to urdf --like " + in_folder("arm.urdf") + " --tip tool0");
  ASSERT_EQ(back.status, 0) << back.out;
  EXPECT_THAT(back.out, HasSubstr("xyz=\"0.1 0 0.002\""));
  EXPECT_THAT(back.out, HasSubstr("xyz=\"0.05 0 0\""));
  const Ran none = convert("calibrated.robot.yaml", robot, "--fixed keep");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.out, HasSubstr("--fixed is of the fixed joints of a URDF"));
}

TEST_F(RobotConvert, SaysWhatIsWrong) {
  EXPECT_THAT(convert("arm.urdf", kArmUrdf).out,
              HasSubstr("arm.urdf: has 2 ends: camera, tool0; choose one with --tip"));
  const Ran nowhere = convert("arm.urdf", kArmUrdf, "--tip tcp");
  EXPECT_EQ(nowhere.status, 3);
  EXPECT_THAT(nowhere.out, HasSubstr("has no link 'tcp'; it ends at camera, tool0"));
  EXPECT_THAT(convert("arm.urdf", "This is no URDF.\n").out,
              HasSubstr("arm.urdf:1: no XML, which a URDF and a model for MuJoCo are"));
  EXPECT_THAT(convert("arm.urdf", "<robot name='a' xmlns:xacro='x'><xacro:macro/></robot>").out,
              HasSubstr("xacro"));
  EXPECT_EQ(convert("arm.urdf", kArmUrdf, "--to ur").status, 2);
  EXPECT_EQ(convert("arm.urdf", kArmUrdf, "--to offsets --like arm.urdf").status, 2);
  const Ran other =
      convert("other.robot.yaml",
              "robot: other\nkind: serial\nframes:\n  - {name: turn, joint: revolute}\n",
              "--to urdf --like " + scratch_.write("arm.urdf", kArmUrdf).string() + " --tip tool0");
  EXPECT_EQ(other.status, 3);
  EXPECT_THAT(other.out, HasSubstr("is no calibration of"));
}

}  // namespace
}  // namespace selfcal
