// From nothing but the order of the joints to a calibrated robot, by the program: circle points
// give a nominal robot, from which an instrument's rows lead to the truth.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/shared_data.h"
#include "tests/support/program.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class CirclePointsByProgram : public testing::Test {
 protected:
  void SetUp() override {
    folder =
        fs::path(testing::TempDir()) /
        (std::string("circles_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder);
    fs::create_directories(folder);
    fs::copy_file(SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml", folder / "rx90.robot.yaml");
  }
  void TearDown() override { fs::remove_all(folder); }

  /// Data of one and the same robot, whatever the sets.
  std::string simulated(const std::string& name, const std::string& sets) const {
    std::ofstream(folder / (name + ".scenario.yaml"))
        << "robot: rx90.robot.yaml\nseed: 3\nerrors: {length: 1.0e-3, angle: 1.0e-3}\nsets:\n"
        << sets;
    const Ran ran = run_selfcal("simulate " + (folder / (name + ".scenario.yaml")).string() +
                                " --out " + (folder / name).string());
    EXPECT_EQ(ran.status, 0) << ran.out;
    return (folder / name).string();
  }

  std::string circles() const {
    std::string sets;
    for (int joint = 1; joint <= 6; ++joint) {
      const std::string name = "j" + std::to_string(joint);
      sets += "  " + name + ": {method: circle-point, joint: " + name +
              ", markers: 5, noise: 2.0e-5, rows: 24}\n";
    }
    return simulated("circles", sets);
  }

  fs::path folder;
};

/// A robot file that knows the joints' order and nothing of where they are.
const char* const kNothingKnown = R"(robot: nobody-knows
kind: serial
frames:
  - {name: base, joint: fixed}
  - {name: j1, joint: revolute, limits: [-2.79, 2.79]}
  - {name: j2, joint: revolute, limits: [-2.40, 2.40]}
  - {name: j3, joint: revolute, limits: [-2.49, 2.49]}
  - {name: j4, joint: revolute, limits: [-4.71, 4.71]}
  - {name: j5, joint: revolute, limits: [-1.83, 2.09]}
  - {name: j6, joint: revolute, limits: [-4.71, 4.71]}
  - {name: tool, joint: fixed}
)";

TEST_F(CirclePointsByProgram, GiveANominalRobotFromWhichATrackerLeadsToTheTruth) {
  const fs::path by_circles = circles();
  std::ofstream(by_circles / "rx90.robot.yaml") << kNothingKnown;
  const Ran first =
      run_selfcal("identify " + by_circles.string() + " --out " + (folder / "nominal").string());
  ASSERT_TRUE(fs::exists(folder / "nominal/calibrated.robot.yaml")) << first.out;
  const Ran checked =
      run_selfcal("robot check " + (folder / "nominal/calibrated.robot.yaml").string());
  EXPECT_EQ(checked.status, 0) << checked.out;

  const fs::path tracker =
      simulated("tracker",
                "  tracker: {method: position, frame: unknown, point: unknown, noise: 2.0e-5, "
                "rows: 150}\n");
  const Ran blind = [&] {
    std::ofstream(tracker / "rx90.robot.yaml") << kNothingKnown;
    return run_selfcal("identify " + tracker.string() + " --json", true);
  }();
  EXPECT_NE(blind.status, 0) << "the rows need a start";
  fs::copy_file(folder / "nominal/calibrated.robot.yaml", tracker / "rx90.robot.yaml",
                fs::copy_options::overwrite_existing);
  const Ran ran = run_selfcal("identify " + tracker.string() + " --json", true);
  ASSERT_FALSE(ran.out.empty());
  const json solution = json::parse(ran.out);
  EXPECT_EQ(solution["verdict"]["answer"], "improved") << solution["verdict"]["why"];
  // 50 check rows of 20 um a coordinate and what 100 others leave unknown of some thirty
  // parameters: a length of sqrt(3) x 20 um x sqrt(1 + 36 / 300), four sigma of such a mean square.
  const double after = solution["residual"]["check"]["rms_after"];
  EXPECT_LT(after, std::sqrt(3.0) * 20e-6 * 1.06 * (1 + 4 / std::sqrt(300.0)));
}

TEST_F(CirclePointsByProgram, AreOfNoRobotWhoseFileSaysOtherwise) {
  const fs::path by_circles = circles();
  const std::string sound = text_of(by_circles / "rx90.robot.yaml");
  const Ran near = run_selfcal("identify " + by_circles.string());
  EXPECT_EQ(near.out.find("by the robot's file"), std::string::npos) << near.out;
  // A link of 500 mm that would be half as long again.
  std::string other = sound;
  const auto at = other.find("d: 0.5");
  ASSERT_NE(at, std::string::npos);
  other.replace(at, 6, "d: 0.75");
  std::ofstream(by_circles / "rx90.robot.yaml") << other;
  const Ran ran = run_selfcal("identify " + by_circles.string());
  EXPECT_EQ(ran.status, 1) << ran.out;
  EXPECT_EQ(ran.out.find("Not determined"), 0U) << ran.out;
  EXPECT_NE(ran.out.find("by the robot's file: look at the files first"), std::string::npos)
      << ran.out;
}

TEST_F(CirclePointsByProgram, TakeHalfATurnOneWayForHalfATurnTheOther) {
  std::string turned = text_of(folder / "rx90.robot.yaml");
  const auto j3 = turned.find("name: j3,");
  ASSERT_NE(j3, std::string::npos);
  turned.insert(j3 + 9, " theta: pi,");
  std::ofstream(folder / "rx90.robot.yaml") << turned;
  const Ran ran = run_selfcal("identify " + circles());
  EXPECT_EQ(ran.out.find("by the robot's file"), std::string::npos) << ran.out;
}

TEST_F(CirclePointsByProgram, OfARealRobotGiveARobotFileNearItsMakersTable) {
  SELFCAL_NEED_SHARED();
  const Ran ran = run_selfcal("identify " + (shared_dir() / "data/r2000ic-circlepoint").string() +
                              " --out " + (folder / "real").string());
  ASSERT_TRUE(fs::exists(folder / "real/calibrated.robot.yaml")) << ran.out;
  EXPECT_EQ(run_selfcal("robot check " + (folder / "real/calibrated.robot.yaml").string()).status,
            0);
  const json solution = json::parse(text_of(folder / "real/result.json"));
  int compared = 0;
  for (const auto& each : solution["parameters"]) {
    const std::string name = each["name"];
    if (each["status"] != "identified" || (name[0] != 'd' && name.rfind("alpha", 0) != 0)) continue;
    if (name.back() < '2' || name.back() > '6') continue;  // links, of which the table speaks
    ++compared;
    const double off = each["value"].get<double>() - each["nominal"].get<double>();
    std::printf("%s %+.3f\n", name.c_str(), 1e3 * off);
    // What robots of this size differ from their tables: 1 mm and 1 mrad, at 3 sigma.
    EXPECT_LT(std::abs(off), 3e-3) << name;
  }
  EXPECT_GE(compared, 8);
}

}  // namespace
}  // namespace selfcal
