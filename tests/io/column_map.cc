// Files that other programs wrote: their names, units, angles, separators and lines above.
#include "io/files/column_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/files/utf8.h"
#include "io/files/yaml.h"
#include "kinematics/rotation.h"
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
  EXPECT_EQ(
      why("header: 1\ncolumns: {q1: pan}\n", "pan, left;q2;x;y;z\n1;0;1;2;3\n"),
      "observations.csv: header: more than one of comma, semicolon and tab: put names with one "
      "of them between quotes");
}

// As trackers' programs and spreadsheets export: tabs, with decimal points or commas.
TEST_F(ColumnNames, MayStandBetweenTabs) {
  const auto loaded = with("columns: {x: X, y: Y, z: Z}\n",
                           "Point\tX [mm]\tY\tZ\tj1\tj2\nP 1\t1250,5\t-2\t3\t0,5\t0,1\n");
  ASSERT_FALSE(loaded.has_value());
  const auto read = with("columns: {x: \"X [mm]\", y: Y, z: Z}\n",
                         "Point\tX [mm]\tY\tZ\tj1\tj2\nP 1\t1250,5\t-2\t3\t0,5\t0,1\n");
  ASSERT_TRUE(read.has_value()) << read.error().what;
  EXPECT_EQ(read->data.rows.q.row(0), Eigen::RowVector2d(0.5, 0.1));
  EXPECT_TRUE(read->data.rows.position.row(0).isApprox(Eigen::RowVector3d(1.2505, -2, 3), 1e-15));
  const auto points = with("", "set\tq1\tq2\tx\ty\tz\ntracker\t0.5\t0.1\t1.25\t-2\t3\n");
  ASSERT_TRUE(points.has_value()) << points.error().what;
  EXPECT_EQ(points->data.rows.position.row(0), Eigen::RowVector3d(1.25, -2, 3));
  // Commas that are lined up with tabs part the cells still.
  const auto both = with("", "set,\tq1,\tq2,\tx,\ty,\tz\ntracker,\t0.5,\t0.1,\t1.25,\t-2,\t3\n");
  ASSERT_TRUE(both.has_value()) << both.error().what;
  EXPECT_EQ(both->data.rows.q.row(0), Eigen::RowVector2d(0.5, 0.1));
}

/// ASCII as UTF-16 behind its mark.
std::string utf16(const std::string& ascii, bool little) {
  std::string text = little ? "\xFF\xFE" : "\xFE\xFF";
  for (const char c : ascii) text += little ? std::string{c, '\0'} : std::string{'\0', c};
  return text;
}

TEST_F(ColumnNames, MayBeInUtf16) {
  const std::string csv = "Tracker\r\nj1\tj2\tx\ty\tz\r\n0,5\t0,1\t1,25\t-2\t3\r\n";
  for (const bool little : {true, false}) {
    const auto loaded = with("header: 2\n", utf16(csv, little));
    ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
    EXPECT_EQ(loaded->data.rows.q.row(0), Eigen::RowVector2d(0.5, 0.1));
    EXPECT_EQ(loaded->data.rows.position.row(0), Eigen::RowVector3d(1.25, -2, 3));
  }
  EXPECT_THAT(why("header: 2\n", utf16(csv, true) + "1"), HasSubstr("ends inside a character"));
  EXPECT_THAT(why("header: 2\n", utf16(csv, true).substr(2)), HasSubstr("UTF-16 behind its mark"));
}

TEST(Utf8Pieces, AreTheSameWhereverTheFileIsCut) {
  // U+00B0, U+20AC and U+1F916 in UTF-16, high byte first, and in UTF-8.
  const std::string wide("\xFE\xFF\x00\xB0\x20\xAC\xD8\x3E\xDD\x16", 10);
  for (std::size_t step = 1; step <= wide.size(); ++step) {
    Utf8Pieces pieces;
    std::string text;
    for (std::size_t at = 0; at < wide.size(); at += step)
      text += pieces.take(std::string_view(wide).substr(at, step));
    EXPECT_EQ(text, "\xC2\xB0\xE2\x82\xAC\xF0\x9F\xA4\x96") << step;
    EXPECT_TRUE(pieces.whole());
  }
  // Half a pair is no text.
  for (const auto& half :
       {std::string("\xFE\xFF\xD8\x3E\x00\x41", 6), std::string("\xFE\xFF\xDD\x16\x00\x41", 6)}) {
    Utf8Pieces pieces;
    EXPECT_FALSE(is_text(pieces.take(half)));
  }
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

TEST_F(ColumnNames, NeedNoQuotationMarksAboutAUnitBetweenBraces) {
  const auto node = parse_yaml("columns: {q1: shoulder pan [deg], q2: b, x: X [mm] }\n", "d.yaml");
  ASSERT_TRUE(node) << node.error().what;
  const Node* columns = node->find("columns");
  EXPECT_EQ(columns->find("q1")->text, "shoulder pan [deg]");
  EXPECT_EQ(columns->find("x")->text, "X [mm]");
  EXPECT_EQ(columns->find("q2")->text, "b");
  const auto twice = parse_yaml("columns: {q1: a: b [deg], q2: c [deg]}\n", "d.yaml");
  ASSERT_TRUE(twice) << twice.error().what;
  EXPECT_EQ(twice->find("columns")->find("q1")->text, "a: b [deg]");
  EXPECT_EQ(twice->find("columns")->find("q2")->text, "c [deg]");
  EXPECT_THAT(parse_yaml("a: 1\ncolumns: {q1: x [deg], q2: [b}\n", "d.yaml").error().what,
              HasSubstr("d.yaml:2: "));
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
