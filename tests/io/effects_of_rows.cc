// Effects of a robot's file on the rows of a data set: what the file leaves to the rows, and what
// these rows cannot have.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinematics/corrected_robot.h"
#include "tests/io/data_set_folder.h"

namespace selfcal {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class EffectsOfRows : public DataSetFolder {
 protected:
  /// `entry` stands on line 9 of the robot's file.
  void have(const std::string& entry) { robot += "effects:\n  - " + entry + "\n"; }
};

TEST_F(EffectsOfRows, AreRefusedWithFileAndKeyWhereTheRowsCannotHaveThem) {
  have("{effect: trigger_latency, delay: 5.0e-3}");
  head += "dq: sign\n";
  sets = only("table: {method: plane}");
  EXPECT_THAT(error("set,q1,q2,dq1,dq2\ntable,0.1,0.2,1,-1\n"),
              AllOf(StartsWith("arm.robot.yaml:9: effect: key 'effect'"), HasSubstr("signs")));
}

}  // namespace
}  // namespace selfcal
