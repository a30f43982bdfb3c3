// Standard DH tables (Rot(z, theta) Trans(z, r) Trans(x, d) Rot(x, alpha) a row) against their own
// product, and a table of each convention of one robot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinematics/make_robot.h"
#include "kinematics/rotation.h"
#include "tests/kinematics/parsed_robot.h"
#include "tests/kinematics/random_robot.h"

namespace selfcal {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kRounding = 1e-12;  // a dozen frames, metres and radians

/// theta r d alpha of a row, with the joint's motion and gear, or a whole pose.
struct Row {
  std::string name, joint;
  double theta, r, d, alpha, gear = 1;
  Eigen::Vector3d com = Eigen::Vector3d::Zero();
  bool whole = false;  ///< theta r d alpha are x y z and yaw
};

Eigen::Isometry3d of_row(const Row& row, double variable) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  if (row.whole) {
    T.translate(Eigen::Vector3d(row.theta, row.r, row.d));
    T.rotate(Eigen::AngleAxisd(row.alpha, Eigen::Vector3d::UnitZ()));
    return T;
  }
  const double theta = row.theta + (row.joint == "revolute" ? variable : 0);
  const double r = row.r + (row.joint == "prismatic" ? variable : 0);
  const double ct = std::cos(theta), st = std::sin(theta);
  const double ca = std::cos(row.alpha), sa = std::sin(row.alpha);
  T.matrix() << ct, -st * ca, st * sa, row.d * ct, st, ct * ca, -ct * sa, row.d * st, 0, sa, ca, r,
      0, 0, 0, 1;
  return T;
}

Node node_of(const std::vector<Row>& table) {
  Node frames = Node::list();
  for (const Row& row : table) {
    Node frame = Node::map();
    frame.set("name", text_node(row.name)).set("joint", text_node(row.joint));
    if (row.whole) {
      frame.set("xyz", Node::of(std::vector<double>{row.theta, row.r, row.d}));
      frame.set("rpy", Node::of(std::vector<double>{0, 0, row.alpha}));
    } else {
      frame.set("theta", Node::of(row.theta)).set("r", Node::of(row.r));
      frame.set("d", Node::of(row.d)).set("alpha", Node::of(row.alpha));
    }
    if (row.joint != "fixed") frame.set("gear", Node::of(row.gear));
    frame.set("mass", Node::of(1.5)).set("com", Node::of(Eigen::VectorXd(row.com)));
    frames.items.push_back(std::move(frame));
  }
  Node node = Node::map();
  node.set("robot", text_node("table")).set("kind", text_node("serial"));
  node.set("convention", text_node("standard")).set("frames", std::move(frames));
  return node;
}

std::vector<Row> random_table(std::mt19937_64& random) {
  const auto chance = [&](double p) { return uniform(random, 0, 1) < p; };
  std::vector<Row> table;
  const auto add = [&](const std::string& joint) {
    Row row{"f" + std::to_string(table.size()),
            joint,
            uniform(random, -3, 3),
            uniform(random, -0.5, 0.5),
            uniform(random, -0.5, 0.5),
            uniform(random, -3, 3)};
    row.com = Eigen::Vector3d(uniform(random, -1, 1), uniform(random, -1, 1), 0.2);
    row.whole = joint == "fixed" && chance(0.3);
    if (joint != "fixed") row.gear = uniform(random, 0.95, 1.05);
    table.push_back(row);
  };
  while (chance(0.6)) add("fixed");
  for (int j = 0; j < 6; ++j) {
    add(chance(0.25) ? "prismatic" : "revolute");
    if (chance(0.2)) add("fixed");
  }
  while (chance(0.6)) add("fixed");
  return table;
}

TEST(StandardTable, PutsEveryBodyWhereTheProductOfItsRowsDoes) {
  std::mt19937_64 random(71);
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE("table " + std::to_string(i));
    const std::vector<Row> table = random_table(random);
    const auto robot = robot_of(node_of(table));
    ASSERT_NE(robot, nullptr);
    const Eigen::VectorXd q = random_block(*robot, random).q.row(0).matrix().transpose();
    const auto poses = robot->statics()->link_poses(q);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    Eigen::Index joint = 0;
    size_t link = 0;
    for (const Row& row : table) {
      T = T * of_row(row, row.joint == "fixed" ? 0 : row.gear * q[joint++]);
      while (robot->statics()->mechanics().links[link].frame != row.name) ++link;
      const Eigen::Vector3d com = poses[link] * robot->statics()->mechanics().links[link].com;
      EXPECT_LT((com - T * row.com).norm(), kRounding) << row.name;
    }
    const Location end = locate(*robot, values(*robot), q);
    EXPECT_LT((end.R - T.linear()).norm(), kRounding);
    EXPECT_LT((end.p - T.translation()).norm(), kRounding);
  }
}

// Figures of Universal Robots' page on DH parameters, and the same arm in modified frames.
const char* const kStandardUr10 =
    "robot: ur10\nkind: serial\nconvention: standard\nframes:\n"
    "  - {name: j1, joint: revolute, r: 0.1273, alpha: pi/2, limits: [-2*pi, 2*pi]}\n"
    "  - {name: j2, joint: revolute, d: -0.612, tolerance: {d: 1.0e-3, theta: 4.0e-3}}\n"
    "  - {name: j3, joint: revolute, d: -0.5723, nominal: {d: -0.572}}\n"
    "  - {name: j4, joint: revolute, r: 0.163941, alpha: pi/2}\n"
    "  - {name: j5, joint: revolute, r: 0.1157, alpha: -pi/2}\n"
    "  - {name: j6, joint: revolute, r: 0.0922}\n";
const char* const kModifiedUr10 =
    "robot: ur10\nkind: serial\nframes:\n"
    "  - {name: j1, joint: revolute, r: 0.1273, limits: [-6.283185307179586, 6.283185307179586]}\n"
    "  - {name: j2, joint: revolute, alpha: 1.5707963267948966, tolerance: {theta: 4.0e-3}}\n"
    "  - {name: j3, joint: revolute, d: -0.612, tolerance: {d: 1.0e-3}}\n"
    "  - {name: j4, joint: revolute, d: -0.5723, r: 0.163941, nominal: {d: -0.572}}\n"
    "  - {name: j5, joint: revolute, alpha: 1.5707963267948966, r: 0.1157}\n"
    "  - {name: j6, joint: revolute, alpha: -1.5707963267948966, r: 0.0922}\n";

TEST(StandardTable, OfTheUr10IsItsModifiedOne) {
  const auto standard = robot_of(std::string(kStandardUr10));
  const auto modified = robot_of(std::string(kModifiedUr10));
  ASSERT_TRUE(standard && modified);
  EXPECT_EQ(standard->text().identity(), modified->text().identity());
  EXPECT_EQ(values(*standard), values(*modified));
  ASSERT_EQ(standard->parameters().size(), modified->parameters().size());
  for (size_t i = 0; i < standard->parameters().size(); ++i) {
    EXPECT_EQ(standard->parameters()[i].name, modified->parameters()[i].name);
    EXPECT_EQ(standard->parameters()[i].tolerance, modified->parameters()[i].tolerance) << i;
  }
  EXPECT_EQ(standard->joints()[0].upper, modified->joints()[0].upper);
  // Written, it is in modified frames and says nothing of a table.
  const Node written = standard->text().describe(values(*standard));
  EXPECT_EQ(written.find("convention"), nullptr);
  const auto back = robot_of(written);
  ASSERT_NE(back, nullptr);
  EXPECT_EQ(back->text().identity(), modified->text().identity());
  EXPECT_EQ(values(*back), values(*modified));
}

std::vector<std::string> frames_of(const std::string& frames) {
  const auto robot = robot_of("robot: arm\nkind: serial\nconvention: standard\nframes:\n" + frames);
  std::vector<std::string> names;
  if (robot)
    for (const Link& link : robot->statics()->mechanics().links) names.push_back(link.frame);
  return names;
}

TEST(StandardTable, LeavesWhatIsBehindTheLastJointToAFrameOfItsOwn) {
  const std::string joint = "  - {name: j1, joint: revolute, d: 0.3}\n";
  EXPECT_THAT(frames_of(joint), ElementsAre("j1", "flange"));
  EXPECT_THAT(frames_of("  - {name: j1, joint: revolute, r: 0.3}\n"), ElementsAre("j1"));
  EXPECT_THAT(frames_of(joint + "  - {name: tool, joint: fixed, r: 0.1}\n"),
              ElementsAre("j1", "tool"));  // which takes it
  EXPECT_THAT(frames_of(joint + "  - {name: tool, joint: fixed, xyz: [0, 0, 0.1]}\n"),
              ElementsAre("j1", "flange", "tool"));
  EXPECT_THAT(frames_of(joint + "  - {name: flange, joint: fixed, alpha: 0.1}\n"),
              ElementsAre("j1", "flange", "flange_end"));
  EXPECT_THAT(frames_of("  - {name: base, joint: fixed, r: 0.5, alpha: pi}\n" + joint +
                        "  - {name: bend, joint: fixed, xyz: [0, 0, 0.1]}\n"
                        "  - {name: j2, joint: revolute}\n"),
              ElementsAre("base", "j1", "j1_end", "bend", "j2"));
}

TEST(StandardTable, KeepsThePriorOfWhatPlacesTheRobot) {
  const auto robot = robot_of(
      "robot: arm\nkind: serial\nconvention: standard\nframes:\n"
      "  - {name: base, joint: fixed, r: 0.5, alpha: pi, d: 0.2, tolerance: {d: 1.0e-3}}\n"
      "  - {name: j1, joint: revolute, r: 0.3}\n");
  ASSERT_NE(robot, nullptr);
  const auto tolerance = [&](const char* name) {
    return robot->parameters()[find_parameter(*robot, name)].tolerance;
  };
  EXPECT_EQ(tolerance("j1.d"), 1e-3);
  EXPECT_EQ(tolerance("j1.alpha"), 50e-3);
  EXPECT_EQ(tolerance("j1.r"), 2e-3);
}

std::string table_refusal(const std::string& text) {
  Problems problems;
  EXPECT_EQ(make_robot(parsed(text), problems), nullptr);
  return problems.any() ? problems.list.front() : "accepted";
}

TEST(StandardTable, IsRefusedWithABetaOrTheSheetsLetters) {
  const std::string head = "robot: arm\nkind: serial\nconvention: standard\nframes:\n";
  EXPECT_THAT(table_refusal(head + "  - {name: j1, joint: revolute, beta: 0.1}\n"),
              AllOf(StartsWith("arm.yaml:5: "), HasSubstr("standard DH has no beta")));
  EXPECT_THAT(table_refusal(head + "  - {name: j1, joint: revolute, tolerance: {beta: 0.1}}\n"),
              AllOf(StartsWith("arm.yaml:5: "), HasSubstr("unknown key 'beta'")));
  EXPECT_THAT(table_refusal(head + "  - {name: j1, joint: revolute, a: 0.4, d: 0.1}\n"),
              AllOf(StartsWith("arm.yaml:5: "), HasSubstr("calls d is r here, and its a is d")));
  EXPECT_THAT(table_refusal("robot: arm\nkind: serial\nconvention: craig\nframes:\n"
                            "  - {name: j1, joint: revolute}\n"),
              AllOf(StartsWith("arm.yaml:3: "), HasSubstr("modified or standard")));
}

}  // namespace
}  // namespace selfcal
