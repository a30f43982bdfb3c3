// The names of rows: part, repeat, group; their times; which of them are copies or repeats.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io/files/observations_text.h"
#include "tests/io/observations_case.h"

namespace selfcal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

TEST_F(ObservationsCsv, RefusesAWrongPart) {
  EXPECT_EQ(error("set,q1,q2,part\ntable,0,0,test\n"),
            "observations.csv: row 1: column part: expected fit, check or nothing, got 'test'");
}

TEST_F(ObservationsCsv, RefusesRepeatsOfBothParts) {
  EXPECT_EQ(error("set,q1,q2,part,repeat\ntable,0,0,,a\ntable,0,0,check,b\ntable,0,0,check,a\n"),
            "observations.csv: row 3: column repeat: repeats of 'a' must be of one part, and row 1 "
            "is of the other");
}

TEST_F(ObservationsCsv, NumbersGroupsWithinTheirSetAfterTheNamedOnes) {
  sets =
      "sets:\n  socket:\n    method: position-constraint\n"
      "    apart: [{groups: [left, right], distance: 0.05, noise: 5.0e-5}]\n"
      "  other: {method: position-constraint}\n";
  const std::string rows = "set,group,q1,q2\nother,x,0,0\nsocket,new,0,0\nsocket,left,0,0\n";
  const auto loaded = load(rows + "socket,right,0,0\n");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_THAT(loaded->data.sets[0].groups, ElementsAre("left", "right", "new"));
  EXPECT_THAT(loaded->data.sets[1].groups, ElementsAre("x"));
  EXPECT_THAT(loaded->data.rows.group, ElementsAre(0, 2, 0, 1));
  EXPECT_EQ(error(rows), "observations.csv: set 'socket' names group 'right', which has no rows");
}

TEST_F(ObservationsCsv, TakesTheOrderOfTheRowsForTheTimeWhereTheFileHasNone) {
  const std::string rows = "table,2,0\ntable,0,1\ntable,1,1\n";
  const auto without = load("set,q1,q2\n" + rows);
  ASSERT_TRUE(without.has_value()) << without.error().what;
  EXPECT_TRUE(without->data.order_is_time);
  EXPECT_EQ(without->data.rows.time, Eigen::Vector3d(0, 1, 2));
  EXPECT_EQ(observations_text(without->data).find("time"), std::string::npos);
  const auto with = load("set,q1,q2,time\ntable,2,0,5\ntable,0,1,\ntable,1,1,7\n");
  ASSERT_TRUE(with.has_value()) << with.error().what;
  EXPECT_FALSE(with->data.order_is_time);
  EXPECT_EQ(with->data.rows.time, Eigen::Vector3d(5, 6, 7)) << "between its neighbours";
}

/// Twenty rows, of which those from `first` on, `count` of them, lack their time and temperature.
std::string with_gap(int first, int count) {
  std::string csv = "set,q1,q2,time,temperature\n";
  for (int row = 0; row < 20; ++row) {
    const bool lacks = row >= first && row < first + count;
    csv += "table,0,0." + std::to_string(10 + row) + "," +
           (lacks ? "," : std::to_string(30 * row) + "," + std::to_string(20 + row)) + "\n";
  }
  return csv;
}

TEST_F(ObservationsCsv, FillsFewEmptyTimesAndTemperaturesAndUsesNoneWhereManyAreEmpty) {
  const auto few = load(with_gap(3, 2));
  ASSERT_TRUE(few.has_value()) << few.error().what;
  EXPECT_NEAR(few->data.rows.time[4], 120, 1e-9);
  EXPECT_NEAR(few->data.rows.temperature[4], 24, 1e-9);
  EXPECT_THAT(notices(with_gap(3, 2)),
              ElementsAre(HasSubstr("time is empty in 2 of 20 rows, first row 4: it is taken from"),
                          HasSubstr("temperature is empty in 2 of 20 rows, first row 4: it is")));
  const auto last = load(with_gap(18, 2));
  ASSERT_TRUE(last.has_value()) << last.error().what;
  EXPECT_EQ(last->data.rows.temperature[19], 37) << "as the last that has one";
  const auto many = load(with_gap(5, 11));
  ASSERT_TRUE(many.has_value()) << many.error().what;
  EXPECT_TRUE(many->data.order_is_time);
  EXPECT_EQ(many->data.rows.time[19], 19);
  EXPECT_EQ(many->data.rows.temperature.array().isFinite().count(), 9);
  EXPECT_THAT(notices(with_gap(5, 11)), ElementsAre(HasSubstr("the order of the rows is taken"),
                                                    HasSubstr("these are taken to be as warm")));
}

/// Twelve rows as warm as `temperature` says.
std::string as_warm(const std::function<double(int)>& temperature) {
  std::string csv = "set,q1,q2,time,temperature\n";
  for (int row = 0; row < 12; ++row)
    csv += "table,0,0." + std::to_string(10 + row) + "," + std::to_string(30 * row) + "," +
           std::to_string(temperature(row)) + "\n";
  return csv;
}

TEST_F(ObservationsCsv, TakesNoTemperatureOfAThermometerThatIsNotRead) {
  const std::string csv =
      as_warm([](int row) { return row == 3 || (row > 5 && row < 9) ? 85.0 : 20.0 + row; });
  const auto loaded = load(csv);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  for (const int row : {3, 6, 7, 8})
    EXPECT_NEAR(loaded->data.rows.temperature[row], 20 + row, 1e-6);
  EXPECT_THAT(notices(csv), ElementsAre(HasSubstr("85 in 4 of 12 rows, first row 4"),
                                        HasSubstr("empty in 4 of 12 rows, first row 4")));
  // A campaign in a hot room among others; a robot that is nearly as warm as that.
  for (const double warm : {45.0, 85.0}) {
    const auto real = load(as_warm([warm](int row) {
      return row % 3 == 0 ? warm : warm == 85 ? 82.0 : 20.0;
    }));
    ASSERT_TRUE(real.has_value()) << real.error().what;
    EXPECT_EQ(real->data.rows.temperature[0], warm);
  }
}

TEST_F(ObservationsCsv, AsksWhetherTemperaturesAreFahrenheit) {
  EXPECT_THAT(notices(as_warm([](int row) { return 70.0 + 0.1 * row; })),
              ElementsAre(HasSubstr("about 71 are read as degrees Celsius: were they Fahrenheit")));
  EXPECT_THAT(notices(as_warm([](int row) { return 35.0 + row; })), IsEmpty());
}

TEST_F(ObservationsCsv, NotesTimesThatGoBackAgainAndAgain) {
  EXPECT_THAT(notices("set,q1,q2,time\ntable,2,0,5\ntable,0,1,3\ntable,1,1,7\ntable,1,0,4\n"),
              ElementsAre(StartsWith("observations.csv: the times go back 2 times")));
  std::string two_sets = "set,q1,q2,time\n";
  for (int set = 0; set < 2; ++set)
    for (int row = 0; row < 10; ++row)
      two_sets += "table," + std::to_string(set) + ",0." + std::to_string(row) + "," +
                  std::to_string(row) + "\n";
  EXPECT_THAT(notices(two_sets), IsEmpty());
}

TEST_F(ObservationsCsv, RefusesNamesThatATerminalWouldObey) {
  EXPECT_EQ(error("set,group,q1,q2\ntable,le\x1b[31mft,0,0\n"),
            "observations.csv: row 1: column group: a name with a control character");
}

TEST_F(ObservationsCsv, AsksWhetherGroupsOfNearlyOneNameAreOne) {
  EXPECT_THAT(notices("set,group,q1,q2\ntable,Left 1,0,0\ntable,left-1,0,0.1\ntable,b,0,0.2\n"),
              ElementsAre("observations.csv: set 'table': the groups 'Left 1' and 'left-1' differ "
                          "in capitals, blanks or dashes alone: are they one?"));
}

TEST_F(ObservationsCsv, NamesUnknownColumnsInOneNotice) {
  EXPECT_THAT(notices("set,operator,q1,q2,X,m1,q01,time\ntable,Bo,0,0,a,b,c,17\n"),
              ElementsAre("observations.csv: unknown columns are ignored: operator, X, m1, q01"));
}

TEST_F(ObservationsCsv, CountsRowsThatSayTheSameInEveryDigitOnce) {
  const std::string csv =
      "set,group,q1,q2,x,y,z,repeat,part\n"
      "tracker,,0.1,0.2,1,2,3,,fit\n"
      "tracker,,0.1,0.2,1,2,3,,check\n"  // whichever part it is given to
      "tracker,,0.1,0.2,1,2,3.1,,fit\n"  // measured again
      "tracker,,0.1,0.2,1,2,3,a,fit\n"   // said to be repeats
      "tracker,,0.1,0.2,1,2,3,a,fit\n"
      "table,,0.9,1.0,,,,,fit\n"  // a touch, whose readings are the measurement
      "table,,0.9,1.0,,,,,check\n";
  const auto loaded = load(csv);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_THAT(loaded->data.rows.check, ElementsAre(0, kCopy, 0, 0, 0, 0, kCopy));
  EXPECT_THAT(notices(csv), ElementsAre("observations.csv: 2 rows say what another says in every "
                                        "digit, first row 2: each is counted once"));
}

TEST_F(ObservationsCsv, AreNotToldApartByAColumnThatNobodyReads) {
  const auto loaded = load(
      "row,set,q1,q2,x,y,z\n"
      "1,tracker,0.1,0.2,1,2,3\n"
      "2,tracker,0.1,0.2,1,2,3\n"
      "3,tracker,0.1,0.2,1,2,3.1\n");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_THAT(loaded->data.rows.check, ElementsAre(0, kCopy, 0));
}

TEST_F(ObservationsCsv, TakesRowsAtTheReadingsOfTheOneBeforeForItsRepeats) {
  const std::string rows =
      "tracker,0.1,0.2,1,2,3\ntracker,0.1,0.2,1,2,3.1\ntracker,0.1,0.2,1,2,3.2\n"
      "tracker,0.4,0.2,1,2,4\ntracker,0.1,0.2,1,2,3.3\n";
  const std::string csv = "set,q1,q2,x,y,z\n" + rows;
  const auto loaded = load(csv);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_THAT(loaded->data.rows.repeat, ElementsAre(0, 0, 0, -1, -1));
  EXPECT_THAT(notices(csv),
              ElementsAre("observations.csv: 2 rows have the readings of the row before, first "
                          "row 2: taken as its immediate repeats"));
}

TEST_F(ObservationsCsv, LeavesTheRepeatsToAColumnThatNamesThem) {
  const std::string csv =
      "set,q1,q2,x,y,z,repeat\ntracker,0.1,0.2,1,2,3,\ntracker,0.1,0.2,1,2,4,\n";
  const auto loaded = load(csv);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_THAT(loaded->data.rows.repeat, ElementsAre(-1, -1));
  EXPECT_THAT(notices(csv), IsEmpty());
}

}  // namespace
}  // namespace selfcal
