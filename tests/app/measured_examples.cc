// Platforms and measuring devices through the whole program, from the example scenarios to a
// calibrated robot.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/program.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

namespace fs = std::filesystem;

struct MeasuredExample {
  const char* scenario;
  int identified;  ///< parameters; 0: as many as there are
};

class MeasuredByProgram : public testing::TestWithParam<MeasuredExample> {
 protected:
  void SetUp() override {
    folder = fs::path(testing::TempDir()) / (std::string("measured_") + GetParam().scenario);
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  /// Runs the program, which must succeed.
  std::string run(const std::string& arguments) const {
    const Ran ran = run_selfcal(arguments);
    EXPECT_EQ(ran.status, 0) << arguments << "\n" << ran.out;
    return ran.out;
  }
  std::string at(const char* name) const { return (folder / name).string(); }

  fs::path folder;
};

TEST_P(MeasuredByProgram, IsSimulatedCheckedAndIdentifiedToItsTruth) {
  run(std::string("simulate " SELFCAL_SOURCE_DIR "/app/examples/") + GetParam().scenario +
      ".scenario.yaml --out " + at("data") + " --truth " + at("truth.json"));
  run("data check " + at("data"));
  run("identify " + at("data") + " --out " + at("result"));
  run("robot check " + at("result/calibrated.robot.yaml"));
  const nlohmann::json truth = nlohmann::json::parse(text_of(folder / "truth.json"));
  const nlohmann::json result = nlohmann::json::parse(text_of(folder / "result/result.json"));
  EXPECT_EQ(result["verdict"]["answer"], "improved");
  int identified = 0;
  for (const auto& each : result["parameters"]) {
    if (each["status"] != "identified") continue;
    ++identified;
    const double off = each["value"].get<double>() -
                       truth["parameters"][each["name"].get<std::string>()].get<double>();
    EXPECT_LT(std::abs(off), 5 * each["sigma"].get<double>()) << each["name"];  // of fifty
  }
  if (GetParam().identified > 0)
    EXPECT_EQ(identified, GetParam().identified);
  else
    EXPECT_GE(identified, 20);
}

INSTANTIATE_TEST_SUITE_P(Examples, MeasuredByProgram,
                         testing::Values(MeasuredExample{"hexaslide_link", 54},
                                         MeasuredExample{"stewart_locks", 30},
                                         MeasuredExample{"rx90_theodolites", 0},
                                         MeasuredExample{"rx90_cables", 0}),
                         [](const auto& made) { return std::string(made.param.scenario); });

}  // namespace
}  // namespace selfcal
