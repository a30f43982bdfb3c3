// Every command of the tutorials, as it is typed, in the order of its page.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/app/cell.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

/// The lines of the page's blocks of commands.
std::string commands_of(const std::string& page) {
  std::istringstream lines(page);
  std::string commands, line;
  bool inside = false;
  while (std::getline(lines, line)) {
    if (line.starts_with("```")) {
      inside = line == "```sh";
      continue;
    }
    if (inside) commands += line + "\n";
  }
  return commands;
}

class Tutorials : public CellTest {
 protected:
  void SetUp() override {
    folder_ = folder / "tutorial";
    std::filesystem::create_directories(folder_);
    std::filesystem::create_directory_symlink(SELFCAL_SOURCE_DIR "/app", folder_ / "app");
  }

  /// Runs the commands of a page one after another in a folder that has the sources' `app`; what
  /// is still running at the end is ended.
  Ran follow(const std::string& page) {
    const std::string commands = commands_of(text_of(SELFCAL_SOURCE_DIR "/app/tutorials/" + page));
    EXPECT_FALSE(commands.empty()) << page;
    const std::filesystem::path script = folder_ / "commands.sh";
    std::ofstream(script)
        << "set -euo pipefail\ntrap 'kill $(jobs -p) 2>/dev/null || true' EXIT\ncd '"
        << folder_.string() << "'\n"
        << "PATH='" << std::filesystem::path(SELFCAL_BINARY).parent_path().string() << "':$PATH\n"
        << "export ROS_DOMAIN_ID=" << domain << "\n"
        << commands;
    return run_in_bash("bash " + script.string());
  }

  std::filesystem::path folder_;
};

TEST_F(Tutorials, LeadFromABareRobotToACalibration) {
  const Ran ran = follow("nightly.md");
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_NE(ran.out.find("improved"), std::string::npos) << ran.out;
  const std::string page = text_of(folder_ / "cell/session-1.html");
  EXPECT_NE(page.find("It waits for a person"), std::string::npos);
  EXPECT_EQ(page.find("then use calibrated.robot.yaml"), std::string::npos);
  EXPECT_NE(page.find("\"in_use\":{\"before\":0.00"), std::string::npos) << "what the history has";
}

TEST_F(Tutorials, FindTheCauseOfAGap) {
  const Ran ran = follow("gap.md");
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_NE(ran.out.find("joint_compliance@j2"), std::string::npos) << ran.out;
  EXPECT_NE(text_of(folder_ / "joints.csv").find("reached"), std::string::npos);
}

TEST_F(Tutorials, CalibrateADeltaPrinter) {
  const Ran ran = follow("delta_printer.md");
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_NE(ran.out.find("delta_radius:"), std::string::npos) << ran.out;
}

TEST_F(Tutorials, MendASimulator) {
  const Ran ran = follow("simulator.md");
  if (ran.out.find("built without libmujoco") != std::string::npos)
    GTEST_SKIP() << "selfcal was built without libmujoco";
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_NE(ran.out.find("Against mended.xml: these rows show no difference"), std::string::npos)
      << ran.out;
}

TEST_F(Tutorials, LeadFromAUrdfToACalibratedOne) {
  const Ran ran = follow("urdf.md");
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_NE(ran.out.find("Improved"), std::string::npos) << ran.out;
  EXPECT_NE(text_of(folder_ / "calibrated.urdf").find("Calibrated by selfcal"), std::string::npos);
}

TEST_F(Tutorials, WatchManyRobots) {
  const Ran ran = follow("fleet.md");
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_NE(ran.out.find("3 robots, 1 waits, 2 warning"), std::string::npos) << ran.out;
}

TEST_F(Tutorials, SayWhatToExpectOfACell) {
  const Ran ran = follow("accuracy.md");
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_NE(ran.out.find("target 1 mm: yes"), std::string::npos) << ran.out;
}

}  // namespace
}  // namespace selfcal
