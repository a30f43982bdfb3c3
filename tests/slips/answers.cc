// Every slip through identify and diagnose, as a user would run them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <cmath>
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
using testing::HasSubstr;

constexpr int kImproved = 0, kBadInput = 3;
constexpr std::size_t kRows = 200;  // of a set: more say the same, later

constexpr std::string_view kProgress[] = {"weighing the causes",
                                          "asking noise the same question",
                                          "practising on simulated sessions",
                                          "closing the gap",
                                          "done",
                                          "judging by folds",
                                          "identifying from another start"};

constexpr std::string_view kTelling[] = {"Look at",   "data sheet's noise", "instrument",
                                         "check the", "times go back",      "in every digit"};

/// A number of a cause, how probable the cause is, and whether it is named.
struct Figure {
  double value = 0, sigma = 0, probability = 0;
  bool named = false;
};

/// The figures of `effect` at one of `places` (or at none, of the whole robot), by their names.
std::map<std::string, Figure> figures_of(const json& diagnosis, const json& effect,
                                         const json& places) {
  std::map<std::string, Figure> figures;
  const bool named =
      std::ranges::any_of(diagnosis.at("verdict").at("named"),
                          [&](const json& each) { return each.at("effect") == effect; });
  for (const json& each : diagnosis.at("candidates")) {
    const bool there = std::ranges::any_of(each.at("where"), [&](const json& place) {
      return std::ranges::find(places, place) != places.end();
    });
    if (each.at("effect") != effect || !there) continue;
    for (const json& number : each.at("parameters"))
      figures[number.at("name")] = {number.at("value"), number.at("sigma"), each.at("probability"),
                                    named};
  }
  return figures;
}

/// Whether a cause that is named is the sound set's as well: named there or as probable as not, or
/// as it is named, at the same place, and of the same size within their sigmas or a half.
bool is_the_same(const Figure& spoiled, const Figure& sound) {
  constexpr double kSigmas = 4, kShare = 0.5, kNearly = 0.05;
  const double off = std::abs(spoiled.value - sound.value);
  return (sound.named || sound.probability >= std::min(0.5, spoiled.probability - kNearly)) &&
         (off < kSigmas * std::hypot(spoiled.sigma, sound.sigma) ||
          off < kShare * std::max(std::abs(spoiled.value), std::abs(sound.value)));
}

/// Whether the sound set's cause has other figures of the same place: another wave of one gear is
/// no other cause.
bool is_there(const std::map<std::string, Figure>& sound, const std::string& name) {
  const std::string place = name.substr(0, name.find('.') + 1);
  return std::ranges::any_of(sound, [&](const auto& each) {
    return each.first.starts_with(place) && (each.second.named || each.second.probability >= 0.5);
  });
}

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

bool gives_way(const std::string& effect) { return effect.ends_with("_compliance"); }

/// A machine that bends does so at several joints and links, between which a slip moves the shares.
bool names_what_gives_way(const json& diagnosis) {
  return std::ranges::any_of(diagnosis.at("verdict").at("named"),
                             [](const json& each) { return gives_way(each.at("effect")); });
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
  if (!std::filesystem::exists(folder_ / "diagnosed/diagnosis.json")) {
    EXPECT_EQ(ran.status, 1) << ran.out;  // too few rows
    return;
  }
  const json diagnosis = json_of(folder_ / "diagnosed/diagnosis.json");
  json sound;  // asked for where something is named
  for (const json& named : diagnosis.at("verdict").at("named")) {
    const std::string effect = named.at("effect");
    if (std::ranges::find(slip.may_name, effect) != slip.may_name.end()) continue;
    if (sound.is_null()) {
      run("diagnose", "sound", "sound_diagnosed");
      sound = json_of(folder_ / "sound_diagnosed/diagnosis.json");
    }
    if (gives_way(effect) && names_what_gives_way(sound)) continue;
    const auto truly = figures_of(sound, effect, named.at("where"));
    for (const auto& [name, figure] : figures_of(diagnosis, effect, named.at("where"))) {
      if (!truly.contains(name) && is_there(truly, name)) continue;
      ASSERT_TRUE(truly.contains(name)) << effect << ": " << name << "\n" << ran.out;
      EXPECT_TRUE(is_the_same(figure, truly.at(name)))
          << effect << ": " << name << " of " << figure.value << " (" << figure.sigma << "), p "
          << figure.probability << "; of the sound rows " << truly.at(name).value << " ("
          << truly.at(name).sigma << "), p " << truly.at(name).probability;
    }
  }
}

TEST(Pipes, InThePlaceOfFilesAreRefusedAtOnce) {
  SELFCAL_NEED_SHARED();
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "slips_pipes";
  for (const char* file : {"dataset.yaml", "robot.yaml", "observations.csv"}) {
    std::filesystem::remove_all(folder);
    Files(shared_dir() / "data/motoman-tracker").write(folder);
    std::filesystem::remove(folder / file);
    ASSERT_EQ(mkfifo((folder / file).c_str(), 0600), 0);
    for (const char* command : {"identify ", "diagnose ", "data check "}) {
      const Ran ran = run_selfcal(command + folder.string());
      EXPECT_EQ(ran.status, kBadInput) << command << file;
      EXPECT_THAT(ran.out, HasSubstr(std::string(file) + ": expected a file, got a named pipe"));
    }
  }
  std::filesystem::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(All, Slips, testing::ValuesIn(slips()), [](const auto& each) {
  return plain(each.param.set) + "_" + plain(each.param.name);
});

}  // namespace
}  // namespace selfcal::slips
