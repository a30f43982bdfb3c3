// selfcal trial from sealing to the score.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "diagnosis/diagnosis.h"
#include "io/files/data_set_file.h"
#include "io/files/file.h"
#include "tests/io/scratch.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class TrialCommand : public testing::Test {
 protected:
  /// Exit status of `selfcal trial ARGUMENTS`; what it says is kept.
  int trial(const std::string& arguments) {
    const std::string said = path("said").string();
    const std::string command =
        std::string(SELFCAL_BINARY) + " trial " + arguments + " >" + said + " 2>&1";
    const int status = std::system(command.c_str());
    said_ = *read_file(said, 1 << 20);
    return WEXITSTATUS(status);
  }
  fs::path path(const std::string& name) const { return scratch_.folder() / name; }
  int make(const std::string& name) {
    return trial("seal --make 2 --seed 3 --rows 120-130 --out " + path(name).string());
  }
  std::string text(const std::string& name) const { return *read_file(path(name), 1 << 24); }

  Scratch scratch_;
  std::string said_;
};

TEST_F(TrialCommand, SealsDataSetsThatReadAndTheSameForOneSeed) {
  ASSERT_EQ(make("a"), 0) << said_;
  EXPECT_THAT(said_, HasSubstr(sha256_hex(text("a/truth.json"))));
  ASSERT_EQ(make("b"), 0) << said_;
  EXPECT_EQ(text("a/truth.json"), text("b/truth.json"));
  for (const char* name : {"t000", "t001"}) {
    const auto loaded = load_data_set(path("a") / name);
    ASSERT_TRUE(loaded) << loaded.error().what;
    EXPECT_GE(loaded->data.rows.rows(), 120);
    EXPECT_EQ(text(std::string("a/") + name + "/observations.csv"),
              text(std::string("b/") + name + "/observations.csv"));
  }
  EXPECT_EQ(make("a"), kBadInput) << "a sealed folder is not sealed again";
}

TEST_F(TrialCommand, SealsTrialsOfPlatformsAndADelta) {
  for (const std::string robot : {"stewart", "hexaslide", "delta"}) {
    const std::string made = "seal --make 3 --seed 2 --rows 120-130 --robot " SELFCAL_SOURCE_DIR
                             "/app/examples/" +
                             robot + ".robot.yaml --out " + path(robot).string();
    ASSERT_EQ(trial(made), 0) << robot << said_;
    for (const char* name : {"t000", "t001", "t002"}) {
      const auto loaded = load_data_set(path(robot) / name);
      ASSERT_TRUE(loaded) << loaded.error().what;
      EXPECT_EQ(why_not_diagnosable(std::move(loaded->robot), loaded->data), "");
    }
  }
}

TEST_F(TrialCommand, AnswersWithoutTheTruthAndScoresWithIt) {
  ASSERT_EQ(make("a"), 0) << said_;
  fs::rename(path("a/truth.json"), path("kept"));
  const std::string answers = path("answers.json").string();
  ASSERT_EQ(trial("run " + path("a").string() + " --baseline compliance --out " + answers), 0)
      << said_;
  fs::rename(path("kept"), path("a/truth.json"));
  EXPECT_LE(trial("score " + path("a").string() + " " + answers + " --json"), 1);
  const auto table = nlohmann::json::parse(said_);
  EXPECT_TRUE(table.contains("right_cause_r_1")) << said_;
}

TEST_F(TrialCommand, PutsBaselinesBesideTheAnswersThatAreJudged) {
  ASSERT_EQ(make("a"), 0) << said_;
  const std::string folder = path("a").string();
  const std::string one = path("one.json").string(), other = path("other.json").string();
  ASSERT_EQ(trial("run " + folder + " --baseline compliance --out " + one), 0) << said_;
  ASSERT_EQ(trial("run " + folder + " --baseline bic --out " + other), 0) << said_;
  EXPECT_LE(trial("score " + folder + " " + one + " " + other), 1);
  EXPECT_THAT(said_, HasSubstr("compliance         bic")) << "a column each";
  ASSERT_LE(trial("score " + folder + " " + one + " " + other + " --json"), 1);
  const auto both = nlohmann::json::parse(said_);
  ASSERT_LE(trial("score " + folder + " " + other + " --json"), 1);
  const auto alone = nlohmann::json::parse(said_);
  for (const auto& [line, figures] : alone.items())
    EXPECT_EQ(both[line]["beside"]["bic"], figures["value"]) << line;
}

TEST_F(TrialCommand, AnswersTheOthersWhereADataSetIsBad) {
  ASSERT_EQ(make("a"), 0) << said_;
  std::ofstream(path("a/t000/dataset.yaml"), std::ios::app) << "tarket: 1\n";
  const std::string answers = path("answers.json").string();

  EXPECT_EQ(trial("run " + path("a").string() + " --baseline compliance --out " + answers),
            kBadInput);
  EXPECT_THAT(said_, HasSubstr("1 of 2 trials were not answered"));
  const auto written = nlohmann::json::parse(text("answers.json"));
  EXPECT_TRUE(written["answers"].contains("t001"));
  EXPECT_THAT(written["unanswered"]["t000"].get<std::string>(), HasSubstr("tarket"));
  EXPECT_LE(trial("score " + path("a").string() + " " + answers), 1) << said_;
}

TEST_F(TrialCommand, AnswersTheSameHoweverManyAtOnce) {
  ASSERT_EQ(trial("seal --make 6 --seed 3 --rows 120-130 --out " + path("a").string()), 0) << said_;
  const auto answers = [&](const std::string& jobs) {
    const std::string name = "answers" + jobs + ".json";
    EXPECT_EQ(
        trial("run " + path("a").string() + " --jobs " + jobs + " --out " + path(name).string()), 0)
        << said_;
    auto list = nlohmann::json::parse(text(name))["answers"];
    for (auto& each : list) each.erase("seconds");
    return list;
  };
  EXPECT_EQ(answers("1"), answers("3"));
}

TEST_F(TrialCommand, EndsAtOnceWhereItsAnswersCannotBeWritten) {
  ASSERT_EQ(make("a"), 0) << said_;
  EXPECT_EQ(trial("run " + path("a").string() + " --jobs 1 --baseline compliance --out " +
                  path("nowhere/answers.json").string()),
            kDeviceFailed);
  EXPECT_THAT(said_, testing::Not(HasSubstr("2/2")));
}

TEST_F(TrialCommand, NoticesATruthThatWasChangedAfterSealing) {
  ASSERT_EQ(make("a"), 0) << said_;
  const std::string answers = path("answers.json").string();
  ASSERT_EQ(trial("run " + path("a").string() + " --baseline compliance --out " + answers), 0);
  std::ofstream(path("a/truth.json"), std::ios::app) << " ";
  EXPECT_EQ(trial("score " + path("a").string() + " " + answers), kBadInput);
  EXPECT_THAT(said_, HasSubstr("is not the truth that was sealed"));
}

TEST_F(TrialCommand, RefusesAnswersToOtherTrials) {
  ASSERT_EQ(make("a"), 0) << said_;
  const std::string answers = path("answers.json").string(), folder = path("a").string();
  ASSERT_EQ(trial("run " + folder + " --baseline compliance --out " + answers), 0);
  const std::string other = text("a/truth.json") + " ";
  std::ofstream(path("a/truth.json")) << other;  // and sealed anew
  std::ofstream(path("a/TRUTH.sha256")) << sha256_hex(other);
  EXPECT_EQ(trial("score " + folder + " " + answers), kBadInput);
  EXPECT_THAT(said_, HasSubstr("answers trials that were sealed as"));
}

TEST_F(TrialCommand, TakesGivenDataSetsWithTheirTruth) {
  ASSERT_EQ(make("a"), 0) << said_;
  const std::string both = path("a/t000").string() + " " + path("a/t001").string();
  ASSERT_EQ(trial("seal " + both + " --truth " + path("a/truth.json").string() + " --out " +
                  path("b").string()),
            0)
      << said_;
  EXPECT_EQ(text("a/truth.json"), text("b/truth.json"));
  EXPECT_EQ(text("a/TRUTH.sha256"), text("b/TRUTH.sha256"));
  EXPECT_TRUE(load_data_set(path("b/t001")));
}

TEST_F(TrialCommand, LeavesNothingBehindWhenItRefusesGivenDataSets) {
  ASSERT_EQ(make("a"), 0) << said_;
  const std::string first = path("a/t000").string(), both = first + " " + path("a/t001").string();
  const std::string sealed = " --truth " + path("a/truth.json").string(),
                    other = " --truth " +
                            scratch_.write("o.json", R"({"t000": {"effect": "none"}})").string(),
                    out = " --out " + path("b").string();

  EXPECT_EQ(trial("seal " + both + other + out), 2);    // says nothing of t001
  EXPECT_EQ(trial("seal " + first + sealed + out), 2);  // names t001 besides
  EXPECT_EQ(trial("seal " + both + " " + first + sealed + out), 2);
  EXPECT_FALSE(fs::exists(path("b")));

  // What cannot be diagnosed cannot be answered: a dozen rows of t001.
  fs::copy(path("a"), path("few"), fs::copy_options::recursive);
  std::istringstream rows(text("a/t001/observations.csv"));
  std::string some, line;
  for (int i = 0; i < 13 && std::getline(rows, line); ++i) some += line + "\n";
  scratch_.write("few/t001/observations.csv", some);
  EXPECT_EQ(
      trial("seal " + path("few/t000").string() + " " + path("few/t001").string() + sealed + out),
      kBadInput);
  EXPECT_THAT(said_, HasSubstr("t001/observations.csv: too few rows for a diagnosis"));
  EXPECT_FALSE(fs::exists(path("b")));

  EXPECT_EQ(trial("seal " + both + sealed + out), 0) << said_;
}

TEST_F(TrialCommand, TakesTheFilesThatADataSetIsMadeOfAndNoOther) {
  ASSERT_EQ(make("a"), 0) << said_;
  fs::create_directory(path("a/t000/robots"));
  fs::rename(path("a/t000/arm.robot.yaml"), path("a/t000/robots/arm.robot.yaml"));
  std::string description = text("a/t000/dataset.yaml");
  replace(description, "arm.robot.yaml", "robots/arm.robot.yaml");
  scratch_.write("a/t000/dataset.yaml", description);
  scratch_.write("a/t000/truth.txt", "elbow");
  const std::string given = path("a/t000").string() + " " + path("a/t001").string() + " --truth " +
                            path("a/truth.json").string() + " --out ";

  ASSERT_EQ(trial("seal " + given + path("b").string()), 0) << said_;
  EXPECT_TRUE(load_data_set(path("b/t000")));
  EXPECT_FALSE(fs::exists(path("b/t000/truth.txt")));

  replace(description, "robots/arm.robot.yaml", "../t001/arm.robot.yaml");
  scratch_.write("a/t000/dataset.yaml", description);
  EXPECT_EQ(trial("seal " + given + path("c").string()), kBadInput);
  EXPECT_THAT(said_, HasSubstr("outside the data set's folder"));
}

}  // namespace
}  // namespace selfcal
