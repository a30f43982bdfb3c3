// dataset.yaml: what is read of it and what is refused.
#include "io/files/data_set_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/data_set_folder.h"

namespace selfcal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

const char* const kRow = "set,q1,q2,x,y,z\ntracker,0.1,0.2,1,2,3\n";

class DataSetFile : public DataSetFolder {
 protected:
  DataSetFile() { sets = only("tracker: {method: position, noise: 2.0e-5}"); }
};

TEST_F(DataSetFile, IsReadByItsFolderOrItsName) {
  const auto by_folder = load(kRow);
  ASSERT_TRUE(by_folder.has_value()) << by_folder.error().what;
  const auto by_name = load_data_set(scratch().folder() / "dataset.yaml");
  ASSERT_TRUE(by_name.has_value()) << by_name.error().what;
  for (const LoadedDataSet* loaded : {&*by_folder, &*by_name}) {
    EXPECT_EQ(loaded->name, scratch().folder().filename().string());
    EXPECT_EQ(loaded->robot->name(), "arm");
    EXPECT_EQ(loaded->data.sets.at(0).name, "tracker");
    EXPECT_EQ(loaded->data.sets.at(0).noise, 2.0e-5);
    EXPECT_EQ(loaded->data.target, 1.0e-3);
    EXPECT_EQ(loaded->data.rows.rows(), 1);
    EXPECT_THAT(loaded->notices, IsEmpty());
  }
}

TEST_F(DataSetFile, LooksForItsFilesInItsOwnFolder) {
  std::filesystem::create_directories(scratch().folder() / "inner");
  scratch().write("inner/rows.csv", kRow);
  scratch().write("arm.robot.yaml", robot);
  scratch().write("inner/dataset.yaml",
                  "robot: ../arm.robot.yaml\nobservations: rows.csv\n" + sets);
  const auto loaded = load_data_set(scratch().folder() / "inner/");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_EQ(loaded->name, "inner");
}

TEST_F(DataSetFile, TakesTargetAndTheMeaningOfVelocities) {
  head += "target: 5.0e-5\ndq: sign\n";
  const auto loaded = load(kRow);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_EQ(loaded->data.target, 5.0e-5);
}

TEST_F(DataSetFile, RefusesAnImpossibleTarget) {
  const std::string before = head;
  head = before + "target: 0\n";
  EXPECT_THAT(error(kRow),
              StartsWith("dataset.yaml:3: data set: key 'target': expected a positive"));
  head = before + "target: 1.5\n";
  EXPECT_THAT(error(kRow), HasSubstr("metres below 1 (millimetres?), got '1.5'"));
  head = before + "target: 1mm\n";
  EXPECT_THAT(error(kRow), HasSubstr("expected a number, got '1mm'"));
}

TEST_F(DataSetFile, RefusesImpossibleNoise) {
  for (const char* noise : {"0", "-1.0e-5", "2", "nan"}) {
    sets = only("tracker: {method: position, noise: " + std::string(noise) + "}");
    EXPECT_THAT(error(kRow), HasSubstr("dataset.yaml:4: set tracker: key 'noise'")) << noise;
  }
}

TEST_F(DataSetFile, RefusesUnknownKeysEverywhere) {
  head += "observation: x.csv\n";
  EXPECT_EQ(error(kRow),
            "dataset.yaml:3: data set: unknown key 'observation'; known: columns, dq, header, "
            "observations, orientation, robot, "
            "sets, target, workspace");
  head = "robot: arm.robot.yaml\nobservations: observations.csv\n";
  sets = only("tracker: {method: position, nois: 2.0e-5}");
  EXPECT_THAT(error(kRow), HasSubstr("dataset.yaml:4: set tracker: unknown key 'nois'"));
}

TEST_F(DataSetFile, RefusesMissingKeys) {
  head = "observations: observations.csv\n";
  EXPECT_THAT(error(kRow), HasSubstr("data set: key 'robot' is missing"));
  head = "robot: arm.robot.yaml\n";
  EXPECT_THAT(error(kRow), HasSubstr("data set: key 'observations' is missing"));
  head = "robot: arm.robot.yaml\nobservations: observations.csv\n";
  sets = "";
  EXPECT_THAT(error(kRow), HasSubstr("data set: key 'sets' is missing"));
}

TEST_F(DataSetFile, SaysHowAKnownPlaneIsWritten) {
  sets = only("table: {method: plane, normal: [0, 0, 1]}");
  EXPECT_THAT(error(kRow), HasSubstr("dataset.yaml:4: set table: unknown key 'normal': a known "
                                     "plane has `plane`: [a, b, c] of a x + b y + c z + 1 = 0"));
  sets = only("table: {method: plane, plane: [0, 0, 0]}");
  EXPECT_THAT(error(kRow),
              HasSubstr("n times 1e9 where the plane goes through the world's origin"));
}

TEST_F(DataSetFile, TakesAKnownPlaneThroughTheWorldsOrigin) {
  sets = only("table: {method: plane, plane: [0, 0, 1.0e+9]}");
  const auto loaded = load("set,q1,q2\ntable,0.1,0.2\n");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  const Method& method = *loaded->data.sets[0].method;
  const Eigen::VectorXd own = method.start({}, {}, loaded->data.rows, nullptr, {});
  EXPECT_EQ(method.plane(own, nullptr)->n, Eigen::Vector3d(0, 0, -1));
  EXPECT_NEAR(*method.plane(own, nullptr)->d, 0, 1e-9);  // 1 over the length of [a, b, c]
}

TEST_F(DataSetFile, GuessesMillimetresInItsSets) {
  sets = only("ball: {method: sphere, radius: 127}");
  EXPECT_THAT(error(kRow), HasSubstr("set ball: key 'radius': expected metres"));
  sets = only("ball: {method: sphere, center: [7000, 0, 150]}");
  EXPECT_THAT(error(kRow), HasSubstr("set ball: key 'center': expected metres"));
  sets = only("table: {method: plane, probe_radius: 3}");
  EXPECT_THAT(error(kRow), HasSubstr("set table: key 'probe_radius': expected metres"));
  sets = only(
      "a: {method: plane}\n  b: {method: plane, parallel_to: {set: a, distance: 200, noise: "
      "1.0e-6}}");
  EXPECT_THAT(error(kRow), HasSubstr("key 'distance': expected metres"));
}

TEST_F(DataSetFile, RefusesTwoDistancesBetweenTheSameGroups) {
  sets = only(
      "tip: {method: position-constraint, apart: [{groups: [a, b], distance: 0.05, noise: 1.0e-5}, "
      "{groups: [b, a], distance: 0.06, noise: 1.0e-5}]}");
  EXPECT_THAT(error(kRow), HasSubstr("these two groups are apart already"));
}

TEST_F(DataSetFile, RefusesBrokenSets) {
  sets = "sets: {}\n";
  EXPECT_THAT(error(kRow), HasSubstr("sets: expected one set or more"));
  sets = "sets: [tracker]\n";
  EXPECT_THAT(error(kRow), HasSubstr("sets: expected one set or more"));
  sets = only("tracker: {method: positon}");
  EXPECT_THAT(error(kRow), HasSubstr("dataset.yaml:4: set tracker: key 'method': expected one of"));
  sets = only("tracker:");
  EXPECT_THAT(error(kRow), HasSubstr("set tracker: expected a mapping, got nothing"));
  sets = only("tracker: {method: position}\n  tracker: {method: position}");
  EXPECT_EQ(error(kRow), "dataset.yaml:5: key 'tracker' appears twice");
  sets = only("a: {method: plane, parallel_to: {set: b, distance: 0.2, noise: 1.0e-6}}");
  EXPECT_THAT(error(kRow), HasSubstr("dataset.yaml:4: set a: "));
}

TEST_F(DataSetFile, RefusesAWrongWordForTheVelocities) {
  head += "dq: speed\n";
  EXPECT_EQ(error(kRow),
            "dataset.yaml:3: data set: key 'dq': expected velocity or sign, got 'speed'");
}

TEST_F(DataSetFile, NamesTheFileThatIsMissing) {
  head = "robot: none.yaml\nobservations: observations.csv\n";
  EXPECT_THAT(error(kRow), StartsWith("none.yaml: cannot be read: No such file"));
  head = "robot: arm.robot.yaml\nobservations: none.csv\n";
  EXPECT_THAT(error(kRow), StartsWith("none.csv: cannot be read: No such file"));
  head = "robot: arm.robot.yaml\nobservations: .\n";
  EXPECT_THAT(error(kRow), HasSubstr("expected a file, got a folder"));
  const auto nowhere = load_data_set(scratch().folder() / "nowhere");
  ASSERT_FALSE(nowhere.has_value());
  EXPECT_THAT(nowhere.error().what, HasSubstr("nowhere: cannot be read"));
}

TEST_F(DataSetFile, PassesOnWhatIsWrongWithTheRobot) {
  robot = "robot: arm\nkind: serial\nframes:\n  - {name: j1, joint: revolut}\n";
  EXPECT_THAT(error(kRow), StartsWith("arm.robot.yaml:4: "));
  robot = "robot: arm\nkind: serail\n";
  EXPECT_THAT(error(kRow), StartsWith("arm.robot.yaml:2: "));
}

TEST_F(DataSetFile, SaysWhichSetsHaveNoRows) {
  sets += "  spare: {method: plane}\n";
  const auto loaded = load(kRow);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  ASSERT_EQ(loaded->notices.size(), 1u);
  EXPECT_EQ(without_folder(loaded->notices[0]), "observations.csv: set 'spare' has no rows");
}

}  // namespace
}  // namespace selfcal
