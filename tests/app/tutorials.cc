// Every command of the tutorials, as it is typed, in the order of its page.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/app/cell.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

/// The lines of the page's blocks of `kind`.
std::string blocks_of(const std::string& page, const std::string& kind) {
  std::istringstream lines(page);
  std::string text, line;
  bool inside = false;
  while (std::getline(lines, line)) {
    if (line.starts_with("```")) {
      inside = line == "```" + kind;
      continue;
    }
    if (inside) text += line + "\n";
  }
  return text;
}

/// A line of a page as what it finds: any numbers in the place of its own, anything for "…".
std::regex pattern_of(std::string line) {
  line = std::regex_replace(line, std::regex("[.^$|()\\[\\]{}*+?\\\\]"), "\\$&");
  line = std::regex_replace(line, std::regex("(\\\\\\+|-)?[0-9]+(\\\\.[0-9]+)?(e-?[0-9]+)?"),
                            "([-+0-9.e]+)");
  line = std::regex_replace(line, std::regex(" +"), " +");
  return std::regex(std::regex_replace(line, std::regex("…"), ".*"));
}

std::vector<double> numbers_of(const std::string& line, const std::regex& pattern) {
  std::smatch found;
  std::vector<double> numbers;
  if (!std::regex_search(line, found, pattern)) return numbers;
  for (size_t i = 1; i < found.size(); ++i)
    numbers.push_back(std::strtod(found[i].str().c_str(), nullptr));
  return numbers;
}

/// Whether one of the lines that were printed has the words of `shown`, and its numbers too where
/// these count: to a third, since other processors round otherwise.
bool is_printed(const std::string& shown, const std::string& printed, bool numbers_count) {
  const std::regex pattern = pattern_of(shown);
  const std::vector<double> wanted = numbers_of(shown, pattern);
  std::istringstream lines(printed);
  for (std::string line; std::getline(lines, line);) {
    if (!std::regex_search(line, pattern)) continue;
    const std::vector<double> numbers = numbers_of(line, pattern);
    const bool near = std::ranges::equal(numbers, wanted, [](double a, double b) {
      return std::abs(a - b) <= std::max(std::abs(a), std::abs(b)) / 3;
    });
    if (near || !numbers_count) return true;
  }
  return false;
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
    const std::string text = text_of(SELFCAL_SOURCE_DIR "/app/tutorials/" + page);
    const std::string commands = blocks_of(text, "sh");
    EXPECT_FALSE(commands.empty()) << page;
    const std::filesystem::path script = folder_ / "commands.sh";
    std::ofstream(script)
        << "set -euo pipefail\ntrap 'kill $(jobs -p) 2>/dev/null || true' EXIT\ncd '"
        << folder_.string() << "'\n"
        << "PATH='" << std::filesystem::path(SELFCAL_BINARY).parent_path().string() << "':$PATH\n"
        << "export ROS_DOMAIN_ID=" << domain << "\n"
        << commands;
    Ran ran = run_in_bash("bash " + script.string());
    // What a session finds hangs on when its touches come.
    const bool numbers_count = commands.find("--simulate") == std::string::npos;
    std::istringstream shown(blocks_of(text, "text"));
    for (std::string line; std::getline(shown, line);) {
      if (line.find_first_not_of(" …") == std::string::npos || line.starts_with("selfcal "))
        continue;
      EXPECT_TRUE(is_printed(line, ran.out, numbers_count)) << page << ": " << line;
    }
    return ran;
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
