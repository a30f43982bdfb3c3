// URDF chains as robot files: the same locations as urdfdom's poses give, for every kind of joint
// and of neighbouring axes; what is refused, and where.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "io/files/file.h"
#include "tests/io/urdf_case.h"

namespace selfcal {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr double kSame = 1e-9;  // m, rad: what is asked of a conversion

std::string urdf_link(const std::string& name, const std::string& inside = "") {
  return "<link name='" + name + "'>" + inside + "</link>\n";
}

struct UrdfJoint {
  std::string name, type, parent, child, origin, axis = "0 0 1", more = "";
};

std::string urdf_joint(const UrdfJoint& j) {
  return "<joint name='" + j.name + "' type='" + j.type + "'><parent link='" + j.parent +
         "'/><child link='" + j.child + "'/><origin " + j.origin + "/><axis xyz='" + j.axis +
         "'/><limit lower='-2' upper='2' effort='1' velocity='1'/>" + j.more + "</joint>\n";
}

/// Links l0 … ln, joints j1 … jn between them.
std::string urdf_of(const std::vector<UrdfJoint>& joints) {
  std::string text = "<robot name='r'>\n" + urdf_link("l0");
  for (size_t i = 0; i < joints.size(); ++i) {
    UrdfJoint joint = joints[i];
    joint.name = "j" + std::to_string(i + 1);
    joint.parent = "l" + std::to_string(i);
    joint.child = "l" + std::to_string(i + 1);
    text += urdf_link(joint.child) + urdf_joint(joint);
  }
  return text + "</robot>\n";
}

UrdfJoint step(std::string type, std::string origin, std::string axis = "0 0 1",
               std::string more = "") {
  return {"", std::move(type), "", "", std::move(origin), std::move(axis), std::move(more)};
}

/// Every case by hand: crossing, skew, parallel, opposed, coincident and nearly parallel axes, a
/// slide, a fixed joint between, an axis of another length, mimicry of a joint that mimics.
std::string every_case() {
  return urdf_of({
      step("fixed", "xyz='0.1 -0.2 0.3' rpy='0.3 -0.2 0.1'"),
      step("revolute", "xyz='0 0 0.3'", "0 0 -1"),
      step("continuous", "xyz='0.05 0.1 0.2' rpy='0 1.57079632679 0'", "0 1 0"),
      step("revolute", "xyz='0.6 0 0.1'", "0 1 0"),
      step("revolute", "xyz='0.5 0.02 0' rpy='0 0 0.003'", "0 -3 0"),
      step("fixed", "xyz='0.01 0.02 0.03' rpy='0.4 0.5 0.6'"),
      step("prismatic", "xyz='0 0.1 0.2' rpy='0.1 0.2 0.3'", "0.3 0.4 1.2"),
      step("revolute", "xyz='0.1 0 0'", "1 0 0",
           "<mimic joint='j4' multiplier='-0.5' offset='0.2'/>"),
      step("revolute", "xyz='0.3 0 0'", "1 0 0"),
      step("revolute", "xyz='0 0.1 0' rpy='1 2 3'", "0.5 -0.5 0.7",
           "<mimic joint='j8' multiplier='2' offset='-0.1'/>"),
      step("fixed", "xyz='0.1 0.2 0.3' rpy='-1 0.5 2'"),
  });
}

TEST(Urdf, HasTheLocationsOfUrdfdomInEveryCase) {
  std::mt19937_64 random(1);
  const PoseGap gap = gap_of_urdf(every_case(), {}, 50, random);
  EXPECT_LT(gap.length, kSame);
  EXPECT_LT(gap.angle, kSame);
}

TEST(Urdf, HasTheSameLocationsFromAnyLinkToAnyOther) {
  std::mt19937_64 random(2);
  for (const UrdfEnds& ends :
       {UrdfEnds{"l11", "l0"}, UrdfEnds{"l3", "l11"}, UrdfEnds{"l6", "l2"}}) {
    const PoseGap gap = gap_of_urdf(every_case(), ends, 20, random);
    EXPECT_LT(gap.length, kSame) << ends.base;
    EXPECT_LT(gap.angle, kSame) << ends.base;
  }
}

TEST(Urdf, HasTheLocationsOfUrdfdomOnRandomChains) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const char* const kAxes[] = {"1 0 0", "0 1 0", "0 0 1", "-1 0 0", "0 0 -1", "0.2 0.3 -0.9"};
  const char* const kTypes[] = {"revolute", "revolute", "continuous", "prismatic", "fixed"};
  const double kTurns[] = {0, 0, M_PI / 2, -M_PI / 2, M_PI, 1.5708, 1e-3, 1e-7, 0.7};
  const double kLengths[] = {0, 0, 0.4, -0.3, 1e-5, 1e-8, 0.123456};
  const auto any = [&](const auto& list) { return list[random() % std::size(list)]; };
  PoseGap worst;
  for (int i = 0; i < 300; ++i) {
    std::vector<UrdfJoint> joints;
    for (int j = 0; j < 7; ++j) {
      std::string origin = "xyz='";
      for (int k = 0; k < 3; ++k) origin += format_number(any(kLengths)) + " ";
      origin += "' rpy='";
      for (int k = 0; k < 3; ++k) origin += format_number(any(kTurns)) + " ";
      joints.push_back(step(j == 3 ? "revolute" : any(kTypes), origin + "'", any(kAxes)));
    }
    const PoseGap gap = gap_of_urdf(urdf_of(joints), {}, 5, random);
    EXPECT_LT(gap.length, kSame) << urdf_of(joints);
    EXPECT_LT(gap.angle, kSame) << urdf_of(joints);
    worst.length = std::max(worst.length, gap.length);
    worst.angle = std::max(worst.angle, gap.angle);
  }
  std::printf("300 random chains: %.1e m, %.1e rad at most\n", worst.length, worst.angle);
}

/// Every URDF under a folder that the environment names, from its root to each of its ends.
TEST(Urdf, HasTheLocationsOfUrdfdomOnWhatOthersWrote) {
  const char* const root = std::getenv("SELFCAL_URDF");
  if (!root) GTEST_SKIP() << "SELFCAL_URDF names no folder of URDFs";
  std::mt19937_64 random(4);
  int files = 0, chains = 0;
  PoseGap worst;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(
           root, std::filesystem::directory_options::skip_permission_denied)) {
    if (entry.path().extension() != ".urdf") continue;
    const std::string text = *read_file(entry.path(), std::size_t{16} << 20);
    const auto model = urdf::parseURDF(text);
    if (!model) continue;
    ++files;
    for (const auto& [name, link] : model->links_) {
      const UrdfEnds ends{model->getRoot()->name, name};
      if (!link->child_links.empty() || !read_urdf(text, entry.path(), ends)) continue;
      const PoseGap gap = gap_of_urdf(text, ends, 5, random);
      EXPECT_LT(gap.length, kSame) << entry.path() << " " << name;
      EXPECT_LT(gap.angle, kSame) << entry.path() << " " << name;
      worst.length = std::max(worst.length, gap.length);
      worst.angle = std::max(worst.angle, gap.angle);
      ++chains;
    }
  }
  EXPECT_GT(files, 0) << "no URDF under " << root;
  std::printf("%d files, %d chains: %.1e m, %.1e rad at most\n", files, chains, worst.length,
              worst.angle);
}

TEST(Urdf, KeepsFixedJointsAsWholePosesUnderTheirNames) {
  const auto read = read_urdf(every_case(), "robot.urdf", {});
  ASSERT_TRUE(read);
  const serial::Model model = frames_of(read->chain, FixedJoints::kept);
  std::vector<std::string> names;
  for (const serial::Frame& frame : model.frames) {
    names.push_back(frame.name);
    EXPECT_EQ(frame.whole, frame.motion == serial::Motion::fixed) << frame.name;
  }
  EXPECT_THAT(names, testing::ElementsAre("j1", "j2", "j3", "j4", "j5", "j6", "j7", "j8", "j9",
                                          "j10", "j11"));
  // Where a joint follows, the link's frame turned about its z and shifted along it.
  const auto theirs = urdf::parseURDF(every_case());
  const auto at = serial::frame_poses(model, Eigen::VectorXd::Zero(8));
  for (const int frame : {0, 5, 10}) {
    const Eigen::Isometry3d link = urdf_pose(*theirs, "l" + std::to_string(frame + 1), {});
    const Eigen::Isometry3d apart = link.inverse() * at[static_cast<size_t>(frame)];
    EXPECT_LT((apart.linear().col(2) - Eigen::Vector3d::UnitZ()).norm(), kSame) << frame;
    EXPECT_LT(apart.translation().head<2>().norm(), kSame) << frame;
  }
}

TEST(Urdf, NamesAFixedJointLikeNoOther) {
  std::string text = every_case();
  const auto renamed = [&](const std::string& from, const std::string& to) {
    text.replace(text.find("<joint name='" + from + "'"), 13 + from.size() + 1,
                 "<joint name='" + to + "'");
  };
  renamed("j1", "a b");
  renamed("j6", "a_b");
  const auto read = read_urdf(text, "robot.urdf", {});
  ASSERT_TRUE(read);
  ASSERT_EQ(read->chain.fixed.size(), 3u);
  EXPECT_EQ(read->chain.fixed[0].name, "a_b");
  EXPECT_EQ(read->chain.fixed[1].name, "a_b_");
}

TEST(Urdf, NamesItsOwnBaseLikeNoFixedJointThatIsKept) {
  std::string text = every_case();
  text.replace(text.find("<joint name='j6'"), 16, "<joint name='base'");
  const auto read = read_urdf(text, "robot.urdf", {"l1", ""});
  ASSERT_TRUE(read) << read.error().what;
  std::set<std::string> names;
  const serial::Model model = frames_of(read->chain, FixedJoints::kept);
  for (const serial::Frame& frame : model.frames)
    EXPECT_TRUE(names.insert(frame.name).second) << frame.name;
  EXPECT_TRUE(names.contains("base") && names.contains("base_"));
}

TEST(Urdf, OfAUr10eIsItsMakersDhTable) {
  // ur_description's default_kinematics of the UR10e; the maker's table has alpha pi/2, 0, 0, pi/2,
  // -pi/2, 0, a 0, -0.6127, -0.57155, 0, 0, 0 and d 0.1807, 0, 0, 0.17415, 0.11985, 0.11655.
  const auto chain = read_urdf(
      urdf_of({step("revolute", "xyz='0 0 0.1807'"), step("revolute", "rpy='1.57079632679489 0 0'"),
               step("revolute", "xyz='-0.6127 0 0'"), step("revolute", "xyz='-0.57155 0 0.17415'"),
               step("revolute", "xyz='0 -0.11985 0' rpy='1.57079632679489 0 0'"),
               step("revolute", "xyz='0 0.11655 0' rpy='-1.57079632679489 0 0'")}),
      "robot.urdf", {});
  ASSERT_TRUE(chain);
  const serial::Model model = frames_of(chain->chain);
  const double q = M_PI / 2;
  const double table[6][3] = {{0, 0, 0},               // alpha, d, r: r of the first is in the base
                              {q, 0, 0},               //
                              {0, -0.6127, 0},         //
                              {0, -0.57155, 0.17415},  //
                              {q, 0, 0.11985},         //
                              {-q, 0, 0.11655}};
  for (int j = 0; j < 6; ++j) {
    const serial::Frame& frame = model.frames[j + 1];
    EXPECT_EQ(frame.value[serial::kAlpha], table[j][0]) << frame.name;
    EXPECT_EQ(frame.value[serial::kD], table[j][1]) << frame.name;
    EXPECT_EQ(frame.value[serial::kR], table[j][2]) << frame.name;
    EXPECT_EQ(frame.value[serial::kTheta], 0) << frame.name;
    EXPECT_EQ(frame.value[serial::kBeta], 0) << frame.name;
  }
  EXPECT_EQ(model.frames[0].value[serial::kZ], 0.1807);
}

TEST(Urdf, GivesEachJointTheMassesThatItCarries) {
  const auto mass = [](double kg, const char* at) {
    return "<inertial><mass value='" + format_number(kg) + "'/><origin xyz='" + at +
           "'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>";
  };
  const std::string text = "<robot name='r'>\n" + urdf_link("w", mass(50, "0 0 0")) +
                           urdf_link("a", mass(2, "1 0 0")) + urdf_link("b", mass(6, "0 0 1")) +
                           urdf_link("finger", mass(4, "0 0 0")) + urdf_link("tip") +
                           urdf_joint({"j1", "revolute", "w", "a", "xyz='0 0 1'"}) +
                           urdf_joint({"weld", "fixed", "a", "b", "xyz='1 0 0'"}) +
                           urdf_joint({"grip", "prismatic", "b", "finger", "xyz='0 2 0'"}) +
                           urdf_joint({"end", "fixed", "b", "tip", "xyz='0 0 0'"}) + "</robot>";
  const auto chain = read_urdf(text, "robot.urdf", {"w", "tip"});
  ASSERT_TRUE(chain) << chain.error().what;
  // 2 kg at (1, 0, 0), 6 kg at (1, 0, 1), 4 kg at (1, 2, 0): 12 kg at (1, 2/3, 1/2).
  const ChainJoint& joint = chain->chain.joints.at(0);
  EXPECT_DOUBLE_EQ(*joint.mass, 12);
  EXPECT_LT((joint.com - Eigen::Vector3d(1, 2.0 / 3, 0.5)).norm(), 1e-12);
  EXPECT_THAT(chain->notices, Contains(HasSubstr("joints off the chain")));
}

TEST(Urdf, SaysWhatARobotFileCannotHold) {
  const auto chain =
      read_urdf(urdf_of({step("revolute", "xyz='0 0 1'"),
                         step("revolute", "xyz='1 0 0'", "0 1 0", "<mimic joint='j1'/>")}),
                "robot.urdf", {});
  ASSERT_TRUE(chain);
  EXPECT_THAT(chain->notices, Contains(HasSubstr("joint j2 mimics j1")));
  const serial::Model model = frames_of(chain->chain);
  EXPECT_EQ(model.coupling, (Eigen::Matrix2d() << 1, 0, 1, 1).finished());
  EXPECT_EQ(model.frames[2].upper, kStill);
}

TEST(Urdf, IsRefusedWithTheLine) {
  const auto why = [](const std::string& text, const UrdfEnds& ends = {}) {
    const auto read = read_urdf(text, "f.urdf", ends);
    return read ? std::string("accepted") : read.error().what;
  };
  const auto joint = [](const UrdfJoint& j) { return urdf_of({j}); };
  EXPECT_THAT(why("<robot name='r'>\n<link name='a'>\n</robot>"),
              HasSubstr("f.urdf:3: is not valid"));
  EXPECT_THAT(why("<sdf/>"), HasSubstr("f.urdf:1: expected a URDF"));
  EXPECT_THAT(why("<robot name='r'>\n<xacro:arm/>\n</robot>"), HasSubstr("f.urdf:2: is xacro"));
  EXPECT_THAT(why("<robot name='r'>\n\n<link name='${p}a'/>\n</robot>"),
              HasSubstr("f.urdf:3: is xacro"));
  EXPECT_THAT(why("<robot name='r'>\n<!-- J\xF6rg -->\n<link name='B\xFChne'/>\n</robot>"),
              HasSubstr("f.urdf:3: expected a name in UTF-8"));
  EXPECT_THAT(why("<robot name='r'>\n<joint name='j'>\n<origin rpy='0 -90 0'/></joint></robot>"),
              HasSubstr("f.urdf:3: rpy -90 is more than four turns, radians expected (degrees?)"));
  EXPECT_THAT(why(joint(step("planar", ""))), HasSubstr("f.urdf:4: joint 'j1' is neither"));
  EXPECT_THAT(why(joint(step("revolute", "", "0 0 0"))),
              HasSubstr("f.urdf:4: joint 'j1' has an axis"));
  EXPECT_THAT(why(joint(step("revolute", "xyz='0 0 x'"))), HasSubstr("f.urdf:4: urdfdom"));
  EXPECT_THAT(why(joint(step("fixed", ""))), HasSubstr("no joint moves"));
  EXPECT_THAT(why(joint(step("revolute", "")), {"", "hand"}), HasSubstr("no link 'hand'"));
  EXPECT_THAT(why(joint(step("revolute", "", "0 0 1", "<mimic joint='other'/>"))),
              HasSubstr("f.urdf:4: joint 'j1' mimics 'other', which does not move"));
  EXPECT_THAT(why(urdf_of({step("revolute", "", "0 0 1", "<mimic joint='j2'/>"),
                           step("revolute", "", "0 0 1", "<mimic joint='j1'/>")})),
              HasSubstr("mimics itself in a circle"));
  const std::string two = "<robot name='r'>" + urdf_link("a") + urdf_link("b") + urdf_link("c") +
                          urdf_joint({"x", "revolute", "a", "b", ""}) +
                          urdf_joint({"y", "revolute", "a", "c", ""}) + "</robot>";
  EXPECT_THAT(why(two), HasSubstr("has 2 ends: b, c; choose one with --tip"));
  EXPECT_EQ(why(two, {"b", "c"}), "accepted");
}

// Whoever reads the tree calls a function for each level.
TEST(Urdf, IsRefusedWhereItNestsWithoutEnd) {
  const auto nested = [](int levels) {
    std::string text = "<robot name='r'>\n<!-- <a> --><b c='/>'/>\n";
    for (int i = 0; i < levels; ++i) text += "<d e='/>'>";
    for (int i = 0; i < levels; ++i) text += "</d>";
    return text + "</robot>";
  };
  EXPECT_THAT(read_urdf(nested(100'000), "f.urdf", {}).error().what,
              HasSubstr("f.urdf:3: elements nest deeper than 200 levels"));
  EXPECT_THAT(read_urdf(nested(199), "f.urdf", {}).error().what, Not(HasSubstr("nest")));
}

TEST(RobotFile, RefusesAUrdfAndNamesTheCommandThatTurnsItIntoOne) {
  const auto robot = robot_of("\n <?xml version='1.0'?><robot/>", "arm.urdf");
  ASSERT_FALSE(robot);
  EXPECT_THAT(robot.error().what, HasSubstr("selfcal robot convert arm.urdf"));
}

}  // namespace
}  // namespace selfcal
