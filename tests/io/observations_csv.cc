// The rows of a data set: what is kept, what is refused, and in which words.
#include "io/files/observations_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io/files/observations_text.h"
#include "tests/io/observations_case.h"

namespace selfcal {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A method with two columns that no other knows.
class Plumb final : public Method {
 public:
  std::string_view name() const override { return "plumb"; }
  std::vector<Quantity> equations() const override { return {Quantity::angle, Quantity::length}; }
  std::vector<MeasuredColumn> measures() const override {
    return {{"tilt", Quantity::angle}, {"height", Quantity::length, true}};
  }
  void evaluate(const MethodInput&, MethodOutput&) const override {}
};

TEST_F(ObservationsCsv, KeepsEveryColumnThatObservationsHave) {
  const auto loaded = load(
      "set,group,q1,q2,x,y,z,qw,qx,qy,qz,distance,nx,ny,nz,repeat,part\n"
      "tracker,,0.1,0.2,1,2,3,,,,,,,,,a,fit\n"
      "arm,,0.3,0.4,4,5,6,0.6,0,0.8,0,,,,,b,check\n"
      "bar,p,0.5,0.6,,,,,,,,,,,,,\n"
      "bar,p,0.7,0.8,,,,,,,,0.25,,,,,\n"
      "table,,0.9,1.0,,,,,,,,,0,0,1,b,check\n");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  const Observations& rows = loaded->data.rows;
  ASSERT_EQ(rows.rows(), 5);
  EXPECT_EQ(rows.q.row(3), Eigen::RowVector2d(0.7, 0.8));
  EXPECT_EQ(rows.position.row(1), Eigen::RowVector3d(4, 5, 6));
  EXPECT_EQ(rows.orientation.row(1), Eigen::RowVector4d(0.6, 0, 0.8, 0));
  EXPECT_EQ(rows.normal.row(4), Eigen::RowVector3d(0, 0, 1));
  EXPECT_TRUE(std::isnan(rows.column("distance")[2]));
  EXPECT_EQ(rows.column("distance")[3], 0.25);
  EXPECT_TRUE(std::isnan(rows.position(2, 0)));
  EXPECT_THAT(rows.set, ElementsAre(0, 1, 2, 2, 4));
  EXPECT_THAT(rows.group, ElementsAre(-1, -1, 0, 0, -1));
  EXPECT_THAT(rows.repeat, ElementsAre(0, 1, -1, -1, 1));
  EXPECT_THAT(rows.check, ElementsAre(0, 1, 0, 0, 1));
  EXPECT_THAT(loaded->data.sets[2].groups, ElementsAre("p"));
}

TEST_F(ObservationsCsv, KeepsTheColumnsThatAMethodBringsAlong) {
  const auto arm = load("set,q1,q2\ntable,0,0\n");
  ASSERT_TRUE(arm.has_value()) << arm.error().what;
  const auto read = [&](const std::string& csv, DataSet& data) {
    scratch().write("plumb.csv", csv);
    data.sets = {Set(), arm->data.sets[4]};
    data.sets[0].name = "plumb";
    data.sets[0].method = std::make_shared<Plumb>();
    std::vector<std::string> told;
    const auto done = read_observations(scratch().folder() / "plumb.csv", *arm->robot, {},
                                        Readings::within_limits, data, told);
    EXPECT_THAT(told, ElementsAre());
    return done ? std::string() : without_folder(done.error().what);
  };
  const std::string csv = "set,q1,q2,height,tilt\nplumb,0,0,0.5,-0.25\ntable,0,0,,\n";
  DataSet data, again;
  ASSERT_EQ(read(csv, data), "");
  EXPECT_EQ(data.rows.column("tilt")[0], -0.25);
  EXPECT_EQ(data.rows.column("height")[0], 0.5);
  EXPECT_TRUE(std::isnan(data.rows.column("tilt")[1]));
  EXPECT_EQ(observations_text(data), csv);
  EXPECT_EQ(read("set,q1,q2,height,tilt\nplumb,0,0,-1,0\n", again),
            "plumb.csv: row 1: column height: a distance is never negative");
  EXPECT_EQ(
      read("set,q1,q2,height,tilt\nplumb,0,0,1,\n", again),
      "plumb.csv: row 1: column tilt: set 'plumb' (plumb) needs column 'tilt', which is empty");
}

TEST_F(ObservationsCsv, LeavesColumnsThatTheFileLacksWithoutRows) {
  const auto loaded = load("set,q2,q1\ntable,0.2,0.1\n");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  const Observations& rows = loaded->data.rows;
  EXPECT_EQ(rows.q.row(0), Eigen::RowVector2d(0.1, 0.2));
  EXPECT_EQ(rows.position.rows() + rows.orientation.rows() + rows.normal.rows(), 0);
  EXPECT_TRUE(rows.measured.empty());
  EXPECT_TRUE(rows.repeat.empty());
  EXPECT_THAT(rows.check, ElementsAre(0));
  EXPECT_THAT(rows.group, ElementsAre(-1));
}

TEST_F(ObservationsCsv, ReadsHowMuchNoisierARowIsThanItsSet) {
  const auto loaded = load("set,q1,q2,noise_factor\ntable,0.1,0.2,\ntable,0.3,0.4,1.5\n");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_EQ(loaded->data.rows.factor(0), 1);
  EXPECT_EQ(loaded->data.rows.factor(1), 1.5);
  const auto refused = load("set,q1,q2,noise_factor\ntable,0.1,0.2,0.5\n");
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().what, HasSubstr("expected a factor of at least 1"));
}

TEST_F(ObservationsCsv, RefusesAHeaderThatDoesNotFitTheRobot) {
  EXPECT_EQ(
      error("Set,q1,q2\ntable,0,0\n"),
      "observations.csv: header: column 'set' is missing, which says of each row what "
      "dataset.yaml's `sets` has of it; the file has Set, q1, q2 (did you mean 'Set'?); where "
      "it has it under another name, dataset.yaml says which: columns: {set: NAME}");
  EXPECT_EQ(error("set,q1\ntable,0\n"),
            "observations.csv: header: column 'q2' is missing: the robot has 2 joints; the file "
            "has set, q1; where it has it under another name, dataset.yaml says which: columns: "
            "{q2: NAME [deg]}");
  EXPECT_EQ(error("set,q1,q2,q3\ntable,0,0,0\n"),
            "observations.csv: header: column q3: the robot has 2 joints");
  EXPECT_EQ(error("set,q0,q1,q2\ntable,0,0,0\n"),
            "observations.csv: header: column q0: the robot has 2 joints");
  EXPECT_EQ(error("set,q1,q2,dq3\ntable,0,0,0\n"),
            "observations.csv: header: column dq3: the robot has 2 joints");
  EXPECT_EQ(error("set,q1,q2,x,z\ntable,0,0,0,0\n"),
            "observations.csv: header: column 'y' is missing: 'x' needs it; the file has set, q1, "
            "q2, x, z");
  EXPECT_EQ(error("set,q1,q2,qx,qy,qz\ntable,0,0,0,0,0\n"),
            "observations.csv: header: column 'qw' is missing: 'qx' needs it; the file has set, "
            "q1, q2, qx, qy, qz");
}

TEST_F(ObservationsCsv, RefusesAFileWithoutRows) {
  EXPECT_EQ(error("set,q1,q2\n"), "observations.csv: no rows below the header");
}

TEST_F(ObservationsCsv, NamesRowAndColumnOfWhatIsNoNumber) {
  EXPECT_EQ(error("set,q1,q2\ntable,0,0\ntable,abc,0\n"),
            "observations.csv: row 2: column q1: expected a number, got 'abc'");
  EXPECT_EQ(error("set,q1,q2\ntable,0,\n"),
            "observations.csv: row 1: column q2: expected a number, got nothing");
  for (const char* column : {"x", "qw", "distance", "alpha", "beta", "phi", "m1x", "m12z", "fx",
                             "tz", "dq2", "nx", "temperature", "time"}) {
    std::string text = "set,q1,q2,x,y,z,qw,qx,qy,qz,nx,ny,nz,fx,fy,fz,tx,ty,tz,dq1,dq2,";
    const bool in_vector = text.find("," + std::string(column) + ",") != std::string::npos;
    if (!in_vector) text += std::string(column) + ",";
    text += "part\ntable,0,0";
    for (const char* each : {"x", "y", "z", "qw", "qx", "qy", "qz", "nx", "ny", "nz", "fx", "fy",
                             "fz", "tx", "ty", "tz", "dq1", "dq2"}) {
      text += each == std::string(column) ? ",inf" : ",";
    }
    text += in_vector ? ",\n" : ",nan,\n";
    EXPECT_THAT(error(text), StartsWith("observations.csv: row 1: column " + std::string(column) +
                                        ": expected a number, got '"));
  }
}

TEST_F(ObservationsCsv, ListsTheKnownSetsForAnUnknownOne) {
  EXPECT_EQ(error("set,q1,q2\ntable,0,0\nwall,0,0\n"),
            "observations.csv: row 2: column set: no set is called 'wall'; known: tracker, arm, "
            "bar, tip, table");
  EXPECT_THAT(error("set,q1,q2\n,0,0\n"), HasSubstr("row 1: column set: no set is called ''"));
}

TEST_F(ObservationsCsv, AsksForTheColumnsThatAMethodNeeds) {
  EXPECT_EQ(
      error("set,q1,q2,x,y,z\ntracker,0,0,1,1,1\ntracker,0,0,,,\n"),
      "observations.csv: row 2: column x: set 'tracker' (position) needs column 'x', which is "
      "empty");
  EXPECT_EQ(
      error("set,q1,q2,x,y,z\narm,0,0,1,1,1\n"),
      "observations.csv: row 1: set 'arm' (location) needs column 'qw', which is missing: the file "
      "has set, q1, q2, x, y, z");
  EXPECT_THAT(error("set,q1,q2,group\ntip,0,0,\n"), HasSubstr("row 1: column group: set 'tip'"));
  EXPECT_THAT(error("set,q1,q2\ntip,0,0\n"), HasSubstr("needs column 'group', which is missing"));
}

TEST_F(ObservationsCsv, AsksForADistanceFromTheSecondRowOfAGroupOn) {
  EXPECT_EQ(error("set,group,q1,q2,distance\nbar,a,0,0,\nbar,b,0,0,\nbar,a,0,0,0.1\n"), "no error");
  EXPECT_THAT(error("set,group,q1,q2,distance\nbar,a,0,0,\nbar,a,0,0,\n"),
              HasSubstr("row 2: column distance: set 'bar' (distance) needs column 'distance'"));
}

TEST_F(ObservationsCsv, RefusesAVectorThatIsFilledInPart) {
  EXPECT_EQ(error("set,q1,q2,x,y,z\ntable,0,0,1,,1\n"),
            "observations.csv: row 1: column y: is empty, while others of its vector are not");
}

TEST_F(ObservationsCsv, RefusesMillimetresForMetres) {
  EXPECT_EQ(error("set,q1,q2,x,y,z\ntracker,0,0,1,1,1\ntracker,0,0,1,-1200.5,1\n"),
            "observations.csv: row 2: column y: -1200.5 is too large, metres expected "
            "(millimetres?)");
  EXPECT_THAT(error("set,q1,q2,distance\nbar,0,0,1500\n"), HasSubstr("(millimetres?)"));
  EXPECT_THAT(error("set,q1,q2,distance\nbar,0,0,-0.5\n"),
              HasSubstr("a distance is never negative"));
}

TEST_F(ObservationsCsv, RefusesKelvinForDegreesCelsius) {
  EXPECT_EQ(error("set,q1,q2,temperature\ntable,0,0,22.5\ntable,0,0,295.65\n"),
            "observations.csv: row 2: column temperature: 295.65 is no temperature of a robot at "
            "work, degrees Celsius expected (kelvin?)");
  EXPECT_THAT(error("set,q1,q2,temperature\ntable,0,0,-1000\n"),
              EndsWith("degrees Celsius expected"));
}

TEST_F(ObservationsCsv, RefusesDegreesAndReadingsFarOutsideTheLimits) {
  EXPECT_EQ(error("set,q1,q2\ntable,1.9,0\ntable,90,0\n"),
            "observations.csv: row 2: column q1: 90 is more than four turns (degrees instead of "
            "radians?)");
  EXPECT_EQ(error("set,q1,q2\ntable,20,0\n"),
            "observations.csv: row 1: column q1: 20 is far outside the limits [-2, 2] of joint j1 "
            "(degrees instead of radians?)");
  EXPECT_EQ(
      error("set,q1,q2\ntable,2.5,0\n"),
      "observations.csv: row 1: column q1: 2.5 is far outside the limits [-2, 2] of joint j1");
  EXPECT_THAT(error("set,q1,q2\ntable,0,500\n"), EndsWith("(millimetres instead of metres?)"));
}

TEST_F(ObservationsCsv, NotesReadingsALittleOutsideTheLimits) {
  EXPECT_THAT(notices("set,q1,q2\ntable,2.003,0\ntable,2.3,0\ntable,0,1.05\n"),
              ElementsAre("observations.csv: 2 joint readings are outside their limits, the first: "
                          "j1 at 2.3 rad in row 2"));
  EXPECT_THAT(notices("set,q1,q2\ntable,0,1.0512345678\n"),
              ElementsAre("observations.csv: 1 joint reading is outside its limits: j2 at 1.051 m "
                          "in row 1"));
}

TEST_F(ObservationsCsv, NotesALastNumberThatSeemsCutOff) {
  EXPECT_THAT(notices("set,q1,q2\ntable,0.25,0.3125\ntable,0.5,0.43"),
              ElementsAre(HasSubstr("was the file cut off there?")));
  EXPECT_THAT(notices("set,q1,q2\ntable,0.25,0.3125\ntable,0.5,0.43\n"), IsEmpty());
  EXPECT_THAT(notices("set,q1,q2\ntable,0.25,0.3125\ntable,0.5,0.431"), IsEmpty());
}

TEST_F(ObservationsCsv, RefusesDegreesOfAJointWithoutLimits) {
  robot =
      "robot: arm\nkind: serial\nframes:\n  - {name: j1, joint: revolute, d: 0.3}\n"
      "  - {name: j2, joint: revolute, d: 0.3}\n";
  EXPECT_EQ(error("set,q1,q2\ntable,6.5,-12\n"), "no error");
  EXPECT_THAT(error("set,q1,q2\ntable,0,-26\n"), HasSubstr("row 1: column q2: -26 is more than"));
}

TEST_F(ObservationsCsv, ScalesVectorsThatAreNearlyUnitAndRefusesOthers) {
  const auto loaded = load(
      "set,q1,q2,x,y,z,qw,qx,qy,qz,nx,ny,nz\n"
      "arm,0,0,1,1,1,0.7071,0.7071,0,0,0,0.9963,0\n");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_NEAR(loaded->data.rows.orientation.row(0).norm(), 1, 1e-15);  // a few roundings
  EXPECT_NEAR(loaded->data.rows.normal.row(0).norm(), 1, 1e-15);
  EXPECT_EQ(error("set,q1,q2,x,y,z,qw,qx,qy,qz\narm,0,0,1,1,1,1,0,0,0\narm,0,0,1,1,1,2,0,0,0\n"),
            "observations.csv: row 2: the quaternion qw qx qy qz has length 2, expected 1");
  EXPECT_THAT(error("set,q1,q2,x,y,z,qw,qx,qy,qz\narm,0,0,1,1,1,0.998,0,0,0\n"),
              HasSubstr("row 1: the quaternion qw qx qy qz has length 0.998"));
  EXPECT_EQ(error("set,q1,q2,nx,ny,nz\ntable,0,0,0,0,0\n"),
            "observations.csv: row 1: the normal nx ny nz has length 0, expected 1");
}

TEST_F(ObservationsCsv, ReadsManyRows) {
  constexpr int kRows = 50000;
  std::string csv = "set,q1,q2,x,y,z\n";
  for (int i = 0; i < kRows; ++i) {
    csv += "tracker,0." + std::to_string(i) + ",0.5,1.25,2.5," + std::to_string(i % 7) + "\n";
  }
  const auto loaded = load(csv);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  ASSERT_EQ(loaded->data.rows.rows(), kRows);
  EXPECT_EQ(loaded->data.rows.q(kRows - 1, 0), 0.49999);
  EXPECT_EQ(loaded->data.rows.position(kRows - 1, 2), (kRows - 1) % 7);
}

}  // namespace
}  // namespace selfcal
