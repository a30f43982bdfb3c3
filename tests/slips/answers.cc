// Every slip through identify and diagnose, as a user would run them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "tests/shared_data.h"
#include "tests/slips/slips.h"
#include "tests/support/program.h"
#include "tests/support/text.h"

namespace selfcal::slips {
namespace {

using nlohmann::json;
using testing::AnyOf;
using testing::Contains;
using testing::HasSubstr;

constexpr int kImproved = 0, kBadInput = 3;
constexpr std::size_t kRows = 200;  // of a set: more say the same, later

/// What is named of the sound sets.
const std::map<std::string, std::vector<std::string>> kSound = {
    {"motoman-tracker", {"link_compliance", "joint_compliance", "base_drift"}},
    {"ipa-ur10-random", {"transmission_error", "joint_coupling", "joint_compliance"}},
    {"motoman-planes", {"base_drift", "plane_form_error"}},
    {"mukca-panda-1", {"link_compliance", "base_drift"}},
    {"rx90-planes", {}},
};

constexpr std::string_view kProgress[] = {"weighing the causes",
                                          "asking noise the same question",
                                          "practising on simulated sessions",
                                          "closing the gap",
                                          "done",
                                          "judging by folds",
                                          "identifying from another start"};

constexpr std::string_view kTelling[] = {"Look at",   "data sheet's noise", "instrument",
                                         "check the", "times go back",      "in every digit"};

json json_of(const std::filesystem::path& path) { return json::parse(text_of(path)); }

std::string plain(std::string text) {
  for (char& each : text)
    if (std::isalnum(static_cast<unsigned char>(each)) == 0) each = '_';
  return text;
}

/// What a person reads first: the answer, and whatever says that the files are to be looked at.
std::string headline(const std::string& out) {
  std::istringstream lines(out);
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const bool first = text.empty() && !line.empty() && !line.starts_with("selfcal: note") &&
                       std::ranges::find(kProgress, line) == std::end(kProgress);
    if (first || std::ranges::any_of(kTelling, [&](std::string_view words) {
          return line.find(words) != std::string::npos;
        }))
      text += (text.empty() ? "" : "<br>") + line.substr(line.find_first_not_of(' '));
  }
  return text;
}

/// A line of the table in README.md, for those who ask for it by SELFCAL_SLIPS_TABLE.
void note(const char* command, const Slip& slip, const Ran& ran) {
  if (const char* file = std::getenv("SELFCAL_SLIPS_TABLE"))
    std::ofstream(file, std::ios::app)
        << "| " << slip.set << " | " << slip.name << " | " << command << " | " << ran.status
        << " | " << headline(ran.out) << " |\n";
}

class Slips : public testing::TestWithParam<Slip> {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              plain(std::string("slips_") +
                    testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    if (GetParam().set == "rx90-planes") {
      const Ran ran = run_selfcal("simulate " SELFCAL_SOURCE_DIR
                                  "/app/examples/rx90_planes.scenario.yaml --out " +
                                  (folder_ / "made").string());
      ASSERT_EQ(ran.status, 0) << ran.out;
      sound_ = folder_ / "made";
    } else {
      SELFCAL_NEED_SHARED();
      sound_ = shared_dir() / "data" / GetParam().set;
    }
    Files files(sound_);
    files.thin(kRows);
    files.write(folder_ / "sound");
    GetParam().make(files);
    ASSERT_NO_FATAL_FAILURE(files.write(folder_ / "spoiled"));
  }

  Ran run(const std::string& command, const std::string& data, const std::string& out,
          const std::string& more = {}) {
    return run_selfcal(command + " " + (folder_ / data).string() + " --out " +
                       (folder_ / out).string() + " " + more);
  }

  /// Of the sound rows kept aside, by the maker's figures or by those of `calibrated` (m).
  double left_of_sound(const std::filesystem::path& calibrated = {}) {
    if (!calibrated.empty())
      std::filesystem::copy_file(calibrated, folder_ / "sound/robot.yaml",
                                 std::filesystem::copy_options::overwrite_existing);
    run("identify", "sound", "judged", "--fix '*'");
    return json_of(folder_ / "judged/result.json").at("residual").at("check").at("rms_after");
  }

  std::filesystem::path folder_, sound_;
};

TEST_P(Slips, NeverGiveAConfidentWrongCalibration) {
  const Slip& slip = GetParam();
  const Ran ran = run("identify", "spoiled", "identified");
  note("identify", slip, ran);
  EXPECT_THAT(ran.status, AnyOf(0, 1, kBadInput)) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr(slip.identify_says));
  if (ran.status == kBadInput) {
    EXPECT_FALSE(std::filesystem::exists(folder_ / "identified"));
  }
  if (ran.status != kImproved || slip.robot_differs) return;
  const double makers = left_of_sound();
  EXPECT_LT(left_of_sound(folder_ / "identified/calibrated.robot.yaml"), makers) << ran.out;
}

TEST_P(Slips, NeverNameACauseThatIsNotThere) {
  const Slip& slip = GetParam();
  const Ran ran = run("diagnose", "spoiled", "diagnosed");
  note("diagnose", slip, ran);
  EXPECT_THAT(ran.status, AnyOf(0, 1, kBadInput)) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr(slip.diagnose_says));
  if (ran.status == kBadInput) {
    EXPECT_FALSE(std::filesystem::exists(folder_ / "diagnosed"));
    return;
  }
  std::vector<std::string> allowed = kSound.at(slip.set);
  std::ranges::copy(slip.may_name, std::back_inserter(allowed));
  if (!std::filesystem::exists(folder_ / "diagnosed/diagnosis.json")) {
    EXPECT_EQ(ran.status, 1) << ran.out;  // too few rows
    return;
  }
  const json diagnosis = json_of(folder_ / "diagnosed/diagnosis.json");
  for (const json& named : diagnosis.at("verdict").at("named"))
    EXPECT_THAT(allowed, Contains(named.at("effect").get<std::string>())) << ran.out;
}

INSTANTIATE_TEST_SUITE_P(All, Slips, testing::ValuesIn(slips()), [](const auto& each) {
  return plain(each.param.set) + "_" + plain(each.param.name);
});

}  // namespace
}  // namespace selfcal::slips
