// Files that other programs wrote: their names, units, angles, separators and lines above.
#include "io/files/column_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/io/data_set_folder.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

class ColumnNames : public DataSetFolder {
 protected:
  /// A data set of one set whose dataset.yaml says `keys` in its lines from the third on.
  Result<LoadedDataSet> with(const std::string& keys, const std::string& csv,
                             const std::string& set = "tracker: {method: position}") {
    head = "robot: arm.robot.yaml\nobservations: observations.csv\n" + keys;
    sets = only(set);
    return load(csv);
  }
  std::string why(const std::string& keys, const std::string& csv) {
    const auto loaded = with(keys, csv);
    if (loaded) return "no error";
    std::string text = without_folder(loaded.error().what);
    const std::string folder = scratch().folder().string() + "/";
    for (size_t at = text.find(folder); at != std::string::npos; at = text.find(folder))
      text.erase(at, folder.size());
    return text;
  }
};

constexpr const char* kMap =
    "columns:\n"
    "  q1: \"pan [deg]\"\n"
    "  q2: \"lift [mm]\"\n"
    "  x: X [mm]\n"
    "  y: \"Y [inch]\"\n"
    "  z: Z\n";

TEST_F(ColumnNames, AreTakenByTheirNamesAndUnits) {
  const auto loaded = with(kMap, "pan,lift,X [mm],Y,Z,comment\n90,250,1500,2,0.5,a\n");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  const Observations& rows = loaded->data.rows;
  // 90 deg = pi/2; 250 mm; 1500 mm; 2 inches of 25.4 mm. To a few roundings.
  EXPECT_NEAR(rows.q(0, 0), std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(rows.q(0, 1), 0.25, 1e-15);
  EXPECT_TRUE(rows.position.row(0).isApprox(Eigen::RowVector3d(1.5, 0.0508, 0.5), 1e-15));
  EXPECT_EQ(rows.set[0], 0);
}

TEST_F(ColumnNames, OfJointsMayHaveTheJointsNames) {
  const auto loaded = with("", "set,j2,x,y,z,j1\ntracker,0.25,1,2,3,-0.5\n");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_EQ(loaded->data.rows.q.row(0), Eigen::RowVector2d(-0.5, 0.25));
  EXPECT_TRUE(loaded->notices.empty());
  const auto both = with("", "set,q1,q2,x,y,z,j1\ntracker,0.1,0.2,1,2,3,-0.5\n");
  ASSERT_TRUE(both.has_value()) << both.error().what;
  EXPECT_EQ(both->data.rows.q(0, 0), 0.1);
}

TEST_F(ColumnNames, AreRefusedWithTheLineThatNamesThem) {
  const std::string csv = "pan,q2,x,y,z\n1,0,1,2,3\n";
  EXPECT_THAT(why("columns:\n  q1: \"pan [grad]\"\n", csv),
              HasSubstr("dataset.yaml:4: expected a unit of rad, mrad, deg, °, got [grad]"));
  EXPECT_THAT(why("columns:\n  q1: \"pan [mm]\"\n", csv), HasSubstr("dataset.yaml:4: expected"));
  EXPECT_THAT(why("columns:\n  q1: tilt\n", csv),
              HasSubstr("dataset.yaml:4: no column is called 'tilt'"));
  EXPECT_THAT(why("columns:\n  q1: pan\n  q2: pan\n", csv),
              HasSubstr("dataset.yaml:5: 'pan' is taken twice, first in line 4"));
  EXPECT_THAT(why("columns:\n  angle: pan\n", csv),
              HasSubstr("dataset.yaml:4: data sets have no column 'angle'"));
  EXPECT_THAT(why("columns:\n  x: pan\n", csv),
              HasSubstr("dataset.yaml:4: the file has a column 'x' of its own"));
  EXPECT_THAT(why("columns:\n  set: \"pan [m]\"\n", csv),
              HasSubstr("dataset.yaml:4: 'set' has no unit"));
  EXPECT_THAT(why("columns:\n  q1: pan\n", "pan,pan [deg],q2,x,y,z\n1,1,0,1,2,3\n"), "no error");
  EXPECT_THAT(why("columns:\n  q1: \"pan [deg]\"\n", "pan,pan [deg],q2,x,y,z\n1,1,0,1,2,3\n"),
              HasSubstr("both 'pan [deg]' and 'pan' are columns"));
}

TEST_F(ColumnNames, MayStandBetweenSemicolonsWithDecimalCommas) {
  const auto loaded = with("", "set;q1;q2;x;y;z\ntracker;0,5;1e-1;1,25;-2;3\n");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_EQ(loaded->data.rows.q.row(0), Eigen::RowVector2d(0.5, 0.1));
  EXPECT_EQ(loaded->data.rows.position.row(0), Eigen::RowVector3d(1.25, -2, 3));
  EXPECT_EQ(why("", "set;q1;q2;x;y;z\ntracker;0,5;0;1.250;2;3\n"),
            "observations.csv: row 1: column x: decimal commas and decimal points in one file: "
            "'1.250' may be thousands");
  EXPECT_THAT(why("", "set;q1;q2;x;y;z\ntracker;0,5;0;1,250,000;2;3\n"),
              HasSubstr("expected a number, got '1,250,000'"));
  EXPECT_EQ(why("header: 1\ncolumns: {q1: pan}\n", "pan, left;q2;x;y;z\n1;0;1;2;3\n"),
            "observations.csv: line 1: both commas and semicolons: put names with one of them "
            "between quotes");
}

TEST_F(ColumnNames, MayStandBelowOtherLines) {
  const std::string csv = "Tracker \"7\nunits; mm, deg\n\nq1,q2,x,y,z\n0.1,0.2,1,2,3\n";
  const auto loaded = with("header: 4\n", csv);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_EQ(loaded->data.rows.position.row(0), Eigen::RowVector3d(1, 2, 3));
  EXPECT_THAT(why("header: 9\n", csv), HasSubstr("expected a line with the names"));
}

TEST_F(ColumnNames, SayTheOrientationByAnglesOrAVector) {
  // Turned by 90 degrees about x, then about the fixed y: R = Ry Rx takes x to -z, y to x, z to -y.
  Eigen::Matrix3d R;
  R << 0, 1, 0, 0, 0, -1, -1, 0, 0;
  const auto turned = [&](const std::string& keys, const std::string& cells) {
    const auto loaded = with("orientation: " + keys + "\n", "q1,q2,x,y,z,A,B,C\n0,0,1,2,3," + cells,
                             "arm: {method: location}");
    EXPECT_TRUE(loaded.has_value()) << loaded.error().what;
    if (!loaded) return Eigen::Matrix3d(Eigen::Matrix3d::Zero());
    const auto q = loaded->data.rows.orientation.row(0);
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  };
  EXPECT_TRUE(
      turned("{euler: xyz, columns: [A, B, C], unit: deg}", "90,90,0\n").isApprox(R, 1e-15));
  EXPECT_TRUE(
      turned("{euler: YXY, columns: [A, B, C], unit: deg}", "90,90,0\n").isApprox(R, 1e-15));
  EXPECT_TRUE(
      turned("{euler: ZYX, columns: [A, B, C], unit: deg}", "0,90,90\n").isApprox(R, 1e-15));
  // The same is a third of a turn about (1, 1, -1).
  EXPECT_TRUE(turned("{rotation_vector: [A, B, C]}",
                     "1.2091995761561452,1.2091995761561452,"
                     "-1.2091995761561452\n")
                  .isApprox(R, 1e-15));
}

TEST_F(ColumnNames, OfAnglesAreThoseOfUrdfWhereTheyAreFixedXyz) {
  // URDF: R = Rz(yaw) Ry(pitch) Rx(roll), written out.
  const double r = 0.3, p = -0.7, y = 1.9;
  const double cr = std::cos(r), sr = std::sin(r), cp = std::cos(p), sp = std::sin(p),
               cy = std::cos(y), sy = std::sin(y);
  Eigen::Matrix3d R;
  R << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, sy * cp, sy * sp * sr + cy * cr,
      sy * sp * cr - cy * sr, -sp, cp * sr, cp * cr;
  EXPECT_TRUE(rotation_of("xyz", {r, p, y}).isApprox(R, 1e-15));
  EXPECT_TRUE(rotation_of("ZYX", {y, p, r}).isApprox(R, 1e-15));
}

TEST_F(ColumnNames, RefuseAnglesThatAreNone) {
  const std::string csv = "q1,q2,x,y,z,A,B,C\n0,0,1,2,3,0,0,0\n";
  for (const char* axes : {"zxx", "zYx", "abc", "xy"})
    EXPECT_THAT(why(std::string("orientation: {euler: ") + axes + ", columns: [A, B, C]}\n", csv),
                HasSubstr("dataset.yaml:3: orientation: key 'euler': expected three axes"))
        << axes;
  EXPECT_THAT(why("orientation: {euler: zyx, columns: [A, B]}\n", csv), HasSubstr("three headers"));
  EXPECT_THAT(why("orientation: {euler: zyx, columns: [A, B, C], unit: mm}\n", csv),
              HasSubstr("dataset.yaml:3: expected a unit of rad, mrad, deg"));
}

}  // namespace
}  // namespace selfcal
