// Sets that share another's unknowns.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "io/files/data_set_file.h"
#include "tests/io/scratch.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

/// What is wrong with a gauge parallel to a table, of these rows.
std::string references_error(const std::string& rows) {
  const Scratch scratch;
  scratch.write("a.robot.yaml",
                "robot: a\nkind: serial\nframes:\n"
                "  - {name: j1, joint: revolute}\n"
                "  - {name: tool, joint: fixed, d: 0.5}\n");
  scratch.write(
      "dataset.yaml",
      "robot: a.robot.yaml\nobservations: o.csv\nsets:\n"
      "  table: {method: plane}\n"
      "  gauge: {method: plane, parallel_to: {set: table, distance: 0.2, noise: 2.0e-6}}\n"
      "  tracker: {method: position}\n");
  scratch.write("o.csv", "set,q1,x,y,z,part\n" + rows);
  const auto loaded = load_data_set(scratch.folder());
  return loaded ? "" : loaded.error().what;
}

TEST(References, AreRefusedWhenTheOtherSetHasNoFitRows) {
  EXPECT_THAT(references_error("table,0.1,,,,check\ngauge,0.2,,,,fit\n"),
              HasSubstr("table, which has no `fit` rows"));
}

TEST(References, OfASetThatOnlyJudgesNeedSomeRowsOfTheOther) {
  EXPECT_THAT(references_error("tracker,0.1,0.5,0,0,fit\ngauge,0.2,,,,check\n"),
              HasSubstr("table, which has no `fit` or `check` rows"));
  EXPECT_EQ(references_error("tracker,0.1,0.5,0,0,fit\ngauge,0.2,,,,check\ntable,0.1,,,,check\n"),
            "");
}

}  // namespace
}  // namespace selfcal
