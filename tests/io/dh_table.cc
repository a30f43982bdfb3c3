// Tables as data sheets print them against published positions, and what is wrong in others.
#include "io/models/dh_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "tests/io/scratch.h"

namespace selfcal {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class DhTable : public testing::Test {
 protected:
  Result<Node> read(const std::string& text, const std::string& convention = "standard") const {
    return read_dh_table(scratch_.write("arm.csv", text), convention);
  }
  std::shared_ptr<const Robot> robot(const std::string& text,
                                     const std::string& convention = "standard") const {
    const auto node = read(text, convention);
    EXPECT_TRUE(node) << (node ? "" : node.error().what);
    if (!node) return nullptr;
    auto robot = robot_of(write_yaml(*node), "arm");
    EXPECT_TRUE(robot) << (robot ? "" : robot.error().what);
    return robot ? std::shared_ptr<const Robot>(std::move(*robot)) : nullptr;
  }
  std::string fault(const std::string& text) const {
    const auto node = read(text);
    return node ? "read" : node.error().what;
  }

  Scratch scratch_;
};

Eigen::Vector3d end_of(const Robot& robot, const Eigen::VectorXd& q) {
  return locate(robot, values(robot), q).p;
}

// Universal Robots' published table of the UR5, in the units of its page.
constexpr const char* kUr5 =
    "Joint,theta [rad],a [m],d [mm],alpha (deg)\n"
    "1,0,0,89.159,90\n"
    "2,0,-0.425,0,0\n"
    "3,0,-0.39225,0,0\n"
    "4,0,0,109.15,90\n"
    "5,0,0,94.65,-90\n"
    "6,0,0,82.3,0\n";

TEST_F(DhTable, PutsTheUr5WhereItsTableDoes) {
  const auto ur5 = robot(kUr5);
  ASSERT_TRUE(ur5);
  // With all joints at zero: a2 + a3, -(d4 + d6), d1 - d5.
  const Eigen::Vector3d zero = end_of(*ur5, Eigen::VectorXd::Zero(6));
  EXPECT_LT((zero - Eigen::Vector3d(-0.81725, -0.19145, -0.005491)).norm(), 1e-12);
  EXPECT_EQ(ur5->joints()[2].name, "j3");
}

TEST_F(DhTable, TakesLimitsTypesAndOffsets) {
  const auto arm = robot(
      "name;alpha [deg];a [mm];d [mm];theta [deg];type;min [deg];max [deg]\n"
      "base;0;0;200;0;fixed;;\n"
      "turn;0;300;0;90;R;-170;170\n"
      "\"lift 2\";0;0;50;0;prismatic;;\n");
  ASSERT_TRUE(arm);
  ASSERT_EQ(arm->joints().size(), 2u);
  EXPECT_EQ(arm->joints()[1].name, "lift_2");
  EXPECT_NEAR(arm->joints()[0].lower, -170 * std::numbers::pi / 180, 1e-12);
  // theta's 90 degrees turn a to y; the slide adds to its d.
  const Eigen::Vector3d end = end_of(*arm, Eigen::Vector2d(0, 0.1));
  EXPECT_LT((end - Eigen::Vector3d(0, 0.3, 0.35)).norm(), 1e-12);
}

TEST_F(DhTable, PutsTheOffsetOfASlideAlongItAndThatOfATurnAroundIt) {
  const auto arm = robot(
      "alpha;a [mm];d [mm];offset;type\n"
      "0;0;100;1.5707963267948966;revolute\n"
      "0;300;0;0.25;prismatic\n");
  ASSERT_TRUE(arm);
  EXPECT_LT((end_of(*arm, Eigen::Vector2d(0, 0)) - Eigen::Vector3d(0, 0.3, 0.35)).norm(), 1e-12);
  EXPECT_THAT(fault("alpha;a [mm];d [mm];offset [mm];type\n0;0;100;90;revolute\n"),
              HasSubstr("the unit mm"));
}

TEST_F(DhTable, TakesDecimalCommasBetweenSemicolons) {
  const auto arm = robot("alpha [deg];a [mm];d [mm];theta [deg]\n0;300,5;0,25;0\n");
  ASSERT_TRUE(arm);
  const Eigen::Vector3d end = end_of(*arm, Eigen::VectorXd::Zero(1));
  EXPECT_LT((end - Eigen::Vector3d(0.3005, 0, 0.00025)).norm(), 1e-12);
  EXPECT_THAT(fault("alpha;a;d\n0;1,000,5;0\n"), HasSubstr("expected a number, got '1,000,5'"));
}

TEST_F(DhTable, KnowsKhalilsLetters) {
  const auto arm = robot("alpha,d,theta,r\n0,0,0,0.3\npi/2,0.4,0,0.1\n", "modified");
  ASSERT_TRUE(arm);
  // Modified: along x by d first, then about the turned z.
  EXPECT_LT((end_of(*arm, Eigen::Vector2d::Zero()) - Eigen::Vector3d(0.4, -0.1, 0.3)).norm(),
            1e-12);
}

TEST_F(DhTable, NamesWhatItCannotRead) {
  EXPECT_THAT(fault("alpha,a,theta\n0,0,0\n"), HasSubstr("no column d"));
  EXPECT_THAT(fault("alpha,a,d,r\n0,0,0,0\n"), HasSubstr("columns a and r"));
  EXPECT_THAT(fault("alpha,a,d,colour\n0,0,0,0\n"), HasSubstr("is none of joint"));
  EXPECT_THAT(fault("alpha [mm],a,d\n1,0,0\n"), HasSubstr("the unit mm is none of"));
  EXPECT_THAT(fault("alpha,a,d,theta\n0,0,0,q1\n"), HasSubstr("row 1: column theta"));
  EXPECT_THAT(fault("alpha,a,d,theta\n0,0,0,0\n0,400,0,0\n"),
              AllOf(HasSubstr("row 2: column a"), HasSubstr("millimetres?")));
  EXPECT_THAT(fault("alpha,a,d,theta\n90,0,0,0\n"),
              AllOf(HasSubstr("row 1: column alpha"), HasSubstr("degrees?")));
  EXPECT_THAT(fault("alpha,a,d,min,max\n0,0,0,1,-1\n"), HasSubstr("a min that is not below"));
  EXPECT_THAT(fault("alpha,a,d,min [deg]\n0,0,0,-170\n"),
              HasSubstr("row 1: has one of min and max, where limits are both"));
  EXPECT_THAT(fault("alpha;a [mm];d [mm]\n0;1,000;0.5\n"),
              HasSubstr("decimal commas and decimal points in one file"));
  EXPECT_THAT(fault("alpha,a,d,type\n0,0,0,ball\n"), HasSubstr("revolute, prismatic or fixed"));
}

}  // namespace
}  // namespace selfcal
