// Robots for controllers that take little, read back.
#include "io/models/controller_text.h"

#include <gmock/gmock.h>

#include <cstdio>
#include <numbers>
#include <sstream>

#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "io/models/dh_table.h"
#include "tests/io/scratch.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

constexpr double kTableSame = 1e-9;  // m, rad: digits of a table are 1e-9 mm and degrees

constexpr const char* kTableArm = R"(robot: arm
kind: serial
frames:
  - {name: j1, joint: revolute, theta: 0.302, r: 0.4003, nominal: {theta: 0.3, r: 0.4}}
  - {name: j2, joint: revolute, alpha: -1.5718, d: 0.1504, nominal: {alpha: -pi/2, d: 0.15}}
  - {name: slide, joint: prismatic, alpha: 0.7, d: 0.5, theta: 1.0005, r: 0.199, nominal: {theta: 1, r: 0.2}}
  - {name: j4, joint: revolute, alpha: 1.2, r: 0.1}
)";

serial::Model model_of(const std::string& text) {
  Problems problems;
  serial::Model model = serial::read(*parse_yaml(text, "arm.yaml"), problems);
  EXPECT_FALSE(problems.any()) << problems.list.front();
  return model;
}

serial::Model makers_model_of(const std::string& text) {
  Problems problems;
  const auto robot = robot_of(text, "arm.yaml");
  serial::Model model = serial::read((*robot)->text().describe(nominal_values(**robot)), problems);
  EXPECT_FALSE(problems.any()) << problems.list.front();
  return model;
}

/// The text of the table's arm with a fixed base before its joints and a fixed tool after them.
std::string arm_between(const std::string& base, const std::string& tool) {
  std::string text = kTableArm;
  text += "  - {name: tool, joint: fixed, " + tool + "}\n";
  text.insert(text.find("  - {name: j1"), "  - {name: base, joint: fixed, " + base + "}\n");
  return text;
}

Result<std::string> table_of(const std::string& text, const std::string& convention) {
  return dh_table_text(model_of(text), makers_model_of(text), convention, "Of arm.\n", "arm.yaml");
}

class ControllerText : public testing::TestWithParam<const char*> {
 protected:
  /// The robot that the table comes to.
  std::unique_ptr<Robot> read_back(const std::string& table) const {
    const auto node = read_dh_table(scratch_.write("arm.csv", table), GetParam());
    EXPECT_TRUE(node) << (node ? "" : node.error().what);
    auto robot = robot_of(write_yaml(*node), "arm");
    EXPECT_TRUE(robot) << (robot ? "" : robot.error().what);
    return robot ? *std::move(robot) : nullptr;
  }

  /// `back` is the robot of `text`.
  static void expect_same(const std::string& text, const Robot* back) {
    ASSERT_NE(back, nullptr);
    const auto robot = robot_of(text, "arm.yaml");
    ASSERT_TRUE(robot) << robot.error().what;
    for (const Eigen::Vector4d& q :
         {Eigen::Vector4d(0, 0, 0, 0), Eigen::Vector4d(0.3, -1.2, 0.1, 2),
          Eigen::Vector4d(-2, 1, -0.3, 1)}) {
      const Location is = locate(*back, values(*back), q),
                     wanted = locate(**robot, values(**robot), q);
      EXPECT_LT((is.p - wanted.p).norm(), kTableSame);
      EXPECT_LT((is.R - wanted.R).norm(), kTableSame);
    }
  }

  Scratch scratch_;
};

TEST_P(ControllerText, OfATableIsReadBackAsTheRobot) {
  const auto table = table_of(kTableArm, GetParam());
  ASSERT_TRUE(table) << table.error().what;
  expect_same(kTableArm, read_back(*table).get());
}

TEST_P(ControllerText, OfATableHasBaseAndToolInRows) {
  std::string text = kTableArm;
  text +=
      "  - {name: tool, joint: fixed, xyz: [0.01, -0.02, 0.1], rpy: [0.1, -0.7, 2]}\n"
      "  - {name: tip, joint: fixed, alpha: 0.3, d: 0.01, beta: 1.0e-3}\n";
  text.insert(text.find("  - {name: j1"),
              "  - {name: base, joint: fixed, alpha: 0.2, d: 0.3, theta: -1, r: 0.5}\n"
              "  - {name: plate, joint: fixed, xyz: [1, 0, 3], rpy: [0, 0, pi/2]}\n");
  const auto table = table_of(text, GetParam());
  ASSERT_TRUE(table) << table.error().what;
  expect_same(text, read_back(*table).get());
}

TEST_P(ControllerText, OfATableHasTheMakersToUndoIt) {
  const auto table = table_of(kTableArm, GetParam());
  const auto at = table->find("# To undo it, the maker's:\n");
  ASSERT_NE(at, std::string::npos);
  std::string undo;
  std::istringstream lines(table->substr(table->find('\n', at) + 1));
  for (std::string line; std::getline(lines, line) && !line.starts_with("# the first joint");)
    undo += line.substr(2) + "\n";
  const auto back = read_back(undo);
  ASSERT_TRUE(back);
  const auto robot = robot_of(kTableArm, "arm.yaml");
  const Eigen::Vector4d q(0.3, -1.2, 0.1, 2);
  EXPECT_LT(
      (locate(*back, values(*back), q).p - locate(**robot, nominal_values(**robot), q).p).norm(),
      kTableSame);
}

/// The pose that a comment of the table says after `what`.
Eigen::Isometry3d pose_said(const std::string& table, const std::string& what) {
  const std::string text = table.substr(table.find(what) + what.size());
  double x = 0, y = 0, z = 0, roll = 0, pitch = 0, yaw = 0;
  EXPECT_EQ(std::sscanf(text.c_str(), " x y z %lf %lf %lf mm, roll pitch yaw %lf %lf %lf", &x, &y,
                        &z, &roll, &pitch, &yaw),
            6);
  const double degree = std::numbers::pi / 180;
  return Eigen::Translation3d(1e-3 * x, 1e-3 * y, 1e-3 * z) *
         Eigen::AngleAxisd(degree * yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(degree * pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(degree * roll, Eigen::Vector3d::UnitX());
}

// A controller takes the rows of the joints alone, its base and its tool from the head.
TEST_P(ControllerText, OfATablePutsTheToolThereByItsHead) {
  const std::string text = arm_between("alpha: 0.2, d: 0.3, theta: -1, r: 0.5",
                                       "alpha: 0.3, d: 0.05, theta: 0.4, r: 0.1");
  const auto table = table_of(text, GetParam());
  ASSERT_TRUE(table);
  const bool standard = std::string(GetParam()) == "standard";
  const Eigen::Vector4d q(0.3, -1.2, 0.1, 2);
  Eigen::Isometry3d X = pose_said(*table, "the first joint's row stands in the world at");
  std::istringstream lines(table->substr(table->find("\njoint,alpha") + 1));
  std::string line;
  int joint = 0;
  for (std::getline(lines, line); std::getline(lines, line);) {
    char name[20], type[20];
    double alpha = 0, a = 0, d = 0, theta = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%19[^,],%lf,%lf,%lf,%lf,%19s", name, &alpha, &a, &d,
                          &theta, type),
              6)
        << line;
    if (std::string(type) == "fixed") continue;
    const bool slides = std::string(type) == "prismatic";
    const double degree = std::numbers::pi / 180;
    const Eigen::Isometry3d along_z =
        Eigen::AngleAxisd(degree * theta + (slides ? 0 : q[joint]), Eigen::Vector3d::UnitZ()) *
        Eigen::Translation3d(0, 0, 1e-3 * d + (slides ? q[joint] : 0));
    const Eigen::Isometry3d along_x = Eigen::Translation3d(1e-3 * a, 0, 0) *
                                      Eigen::AngleAxisd(degree * alpha, Eigen::Vector3d::UnitX());
    // The base's pose is that of the first joint's row: behind its a and alpha, of the modified
    // one.
    X = standard ? X * along_z * along_x : X * along_x * along_z;
    ++joint;
  }
  ASSERT_EQ(joint, 4);
  X = X * pose_said(*table, "the tool stands in the frame of the last joint's row at");
  const auto robot = robot_of(text, "arm.yaml");
  const Location wanted = locate(**robot, values(**robot), q);
  EXPECT_LT((X.translation() - wanted.p).norm(), 1e-8);
  EXPECT_LT((X.linear() - wanted.R).norm(), 1e-8);
}

TEST_P(ControllerText, OfATableQuotesWhatWouldEndACell) {
  std::string text = kTableArm;
  text.replace(text.find("name: j2"), 8, "name: 'j,2'");
  const auto table = table_of(text, GetParam());
  ASSERT_TRUE(table) << table.error().what;
  expect_same(text, read_back(*table).get());
}

INSTANTIATE_TEST_SUITE_P(Conventions, ControllerText, testing::Values("standard", "modified"),
                         [](const auto& each) { return std::string(each.param); });

TEST(ControllerText, OfATableNamesBaseAndTool) {
  std::string text =
      arm_between("xyz: [1, 2, 3], rpy: [0, 0, 0]", "xyz: [0.01, 0, 0.1], rpy: [0, 0, pi/2]");
  const auto table = table_of(text, "modified");
  ASSERT_TRUE(table);
  EXPECT_THAT(*table,
              HasSubstr("# the first joint's row stands in the world at x y z 1000 2000 3000 "
                        "mm, roll pitch yaw 0 0 0 degrees"));
  EXPECT_THAT(*table,
              HasSubstr("# the tool stands in the frame of the last joint's row at x y z 10 "
                        "0 100 mm, roll pitch yaw 0 0 90 degrees"));
  text.insert(text.find("  - {name: slide"),
              "  - {name: bracket, joint: fixed, xyz: [0, 0, 0.1], rpy: [0, 0, 0]}\n");
  const auto refused = table_of(text, "modified");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("arm.yaml: frame bracket between the joints"));
}

TEST(ControllerText, OfOffsetsQuotesNamesThatAreNoWords) {
  std::string text = kTableArm;
  text.replace(text.find("name: j2"), 8, "name: '[j2'");
  const auto file = parse_yaml(controller_offsets_text(model_of(text), ""), "offsets.yaml");
  ASSERT_TRUE(file) << file.error().what;
  EXPECT_NE(file->find("offsets")->find("[j2"), nullptr);
}

// A person adds offsets to the maker's figures, in the maker's kinematics, and sets the tool.
TEST(ControllerText, OfOffsetsPutsTheMakersRobotThere) {
  const std::string text =
      std::string(kTableArm) +
      "  - {name: tool, joint: fixed, xyz: [0.01, 0.002, 0.1], rpy: [0, 0, 0.5], "
      "nominal: {xyz: [0.01, 0, 0.1], rpy: [0, 0, 0.49]}}\n";
  const serial::Model model = model_of(text);
  const auto file = parse_yaml(controller_offsets_text(model, "Of arm.\n"), "offsets.yaml");
  ASSERT_TRUE(file) << file.error().what;
  const auto number = [&](const Node& node) { return *parse_number(node.text); };
  const Node& offsets = *file->find("offsets");
  EXPECT_NEAR(number(*offsets.find("j1")), 0.002, 1e-9);
  EXPECT_NEAR(number(*offsets.find("slide")), -0.001, 1e-9);
  EXPECT_EQ(number(*offsets.find("j4")), 0);
  EXPECT_EQ(number(*file->find("undo")->find("offsets")->find("j1")), 0);
  const Node& tool = *file->find("tool");
  EXPECT_NEAR(number(tool.find("xyz")->items[1]), 0.002, 1e-9);
  EXPECT_NEAR(number(tool.find("rpy")->items[2]), 0.5, 1e-9);
  EXPECT_EQ(number(file->find("undo")->find("tool")->find("xyz")->items[1]), 0);
  // The correction stands in the tool's own axes, which are turned by 0.49 rad.
  const Node& correction = *file->find("tool_correction");
  EXPECT_NEAR(number(correction.find("xyz")->items[0]), 0.002 * std::sin(0.49), 1e-9);
  EXPECT_NEAR(number(correction.find("rpy")->items[2]), 0.01, 1e-9);
}

TEST(ControllerText, CommentsEveryLine) {
  EXPECT_EQ(commented("a\n\nb"), "# a\n#\n# b\n");
  EXPECT_EQ(commented("", ';'), "");
}

}  // namespace
}  // namespace selfcal
