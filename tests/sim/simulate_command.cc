// selfcal simulate from its scenario to its folder.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "io/files/data_set_file.h"
#include "io/files/file.h"
#include "tests/io/scratch.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

class SimulateCommand : public testing::Test {
 protected:
  /// Exit status of `selfcal simulate ARGUMENTS`; what it says is kept.
  int simulate(const std::string& arguments) {
    const std::string said = (scratch_.folder() / "said").string();
    const std::string command =
        std::string(SELFCAL_BINARY) + " simulate " + arguments + " >" + said + " 2>&1";
    const int status = std::system(command.c_str());
    said_ = *read_file(said, 1 << 20);
    return WEXITSTATUS(status);
  }

  std::string scenario(const std::string& text) const {
    fs::copy_file(example("rx90.robot.yaml"), scratch_.folder() / "rx90.robot.yaml",
                  fs::copy_options::overwrite_existing);
    return scratch_.write("a.scenario.yaml", "robot: rx90.robot.yaml\n" + text).string();
  }

  fs::path path(const std::string& name) const { return scratch_.folder() / name; }
  std::string out() const { return " --out " + path("data").string(); }

  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path("data")))
      names.push_back(entry.path().filename().string());
    return names;
  }

  const std::string small_ =
      "errors: {length: 1.0e-3}\nsets:\n  table: {method: plane, noise: 2.0e-5, rows: 12}\n"
      "  eye: {method: location, rows: 6}\n  tip: {method: position-constraint, rows: 8}\n";
  Scratch scratch_;
  std::string said_;
};

TEST_F(SimulateCommand, WritesAFolderThatStandsAloneAndHoldsNoTruth) {
  ASSERT_EQ(simulate(scenario(small_) + out()), 0) << said_;
  EXPECT_THAT(files(), UnorderedElementsAre("dataset.yaml", "observations.csv", "rx90.robot.yaml"));
  EXPECT_EQ(*read_file(path("data/rx90.robot.yaml"), 1 << 20),
            *read_file(example("rx90.robot.yaml"), 1 << 20));
  EXPECT_EQ(read_file(path("data/dataset.yaml"), 1 << 20)->find("errors"), std::string::npos);
}

TEST_F(SimulateCommand, WritesRowsThatLoadAsTheyWereMade) {
  ASSERT_EQ(simulate(scenario(small_) + out()), 0) << said_;
  const auto loaded = load_data_set(path("data"));
  ASSERT_TRUE(loaded) << loaded.error().what;
  const Simulated simulated = made("robot: r\n" + small_);
  EXPECT_EQ(loaded->data.rows.q, simulated.data.rows.q);
  EXPECT_EQ(loaded->data.rows.check, simulated.data.rows.check);
  EXPECT_EQ(loaded->data.rows.set, simulated.data.rows.set);
  EXPECT_EQ(loaded->data.rows.group, simulated.data.rows.group);
  for (int row = 0; row < loaded->data.rows.rows(); ++row) {
    if (loaded->data.rows.set[row] != 1) continue;
    EXPECT_EQ(loaded->data.rows.position.row(row), simulated.data.rows.position.row(row));
  }
}

TEST_F(SimulateCommand, WritesTheTruthOnlyWhereItIsAskedFor) {
  ASSERT_EQ(simulate(scenario("false_triggers: {share: 0.1}\n" + small_) + out() + " --truth " +
                     path("truth.json").string()),
            0)
      << said_;
  const auto truth = nlohmann::json::parse(*read_file(path("truth.json"), 1 << 20));
  const Simulated simulated = made("robot: r\nfalse_triggers: {share: 0.1}\n" + small_);
  EXPECT_EQ(truth["parameters"]["d3"], simulated.truth.xi[find_parameter(rx90(), "d3")]);
  ASSERT_EQ(truth["false_rows"].size(), 2U);  // a tenth of 20 touches
  EXPECT_EQ(truth["false_rows"][0], simulated.false_rows[0] + 1);
  EXPECT_TRUE(truth["sets"][0]["own"].contains("table.nx"));
  EXPECT_TRUE(truth["sets"][2]["own"].contains("tip.g1.z"));
  EXPECT_EQ(truth["sets"][0]["noise"], 2.0e-5);
}

TEST_F(SimulateCommand, ReplacesASimulatedDataSetAndNothingElse) {
  ASSERT_EQ(simulate(scenario(small_) + out()), 0) << said_;
  scratch_.write("data/notes", "mine");
  EXPECT_EQ(simulate(scenario(small_) + out()), 0) << said_;
  EXPECT_THAT(files(), testing::Contains("notes"));
  scratch_.write("data/dataset.yaml", "robot: measured\n");
  EXPECT_EQ(simulate(scenario(small_) + out()), 3);
  EXPECT_THAT(said_, HasSubstr("holds no simulated data set"));
}

TEST_F(SimulateCommand, MakesADataSetThatLoadsOfEveryExample) {
  for (const std::string name : {"rx90_planes.scenario.yaml", "rx90_tracker.scenario.yaml"}) {
    ASSERT_EQ(simulate(example(name).string() + out()), 0) << said_;
    const auto loaded = load_data_set(path("data"));
    ASSERT_TRUE(loaded) << loaded.error().what;
    EXPECT_EQ(loaded->notices, std::vector<std::string>()) << name;
  }
}

TEST_F(SimulateCommand, NamesFileAndLineOfABadScenario) {
  EXPECT_EQ(simulate(scenario("sets:\n  a: {method: plain}\n") + out()), 3);
  EXPECT_THAT(said_, HasSubstr("a.scenario.yaml:3: set a: key 'method': expected one of"));
  EXPECT_FALSE(fs::exists(path("data")));
}

TEST_F(SimulateCommand, AnswersNoWhenConfigurationsAreOutOfReach) {
  EXPECT_EQ(simulate(scenario("sets: {sky: {method: plane, plane: [0, 0, -0.1]}}\n") + out()), 1);
  EXPECT_THAT(said_, HasSubstr("set sky: only 0 of 100"));
}

}  // namespace
}  // namespace selfcal
