// Effects of a robot's file on the rows of a data set: what the file leaves to the rows, and what
// these rows cannot have.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/files/robot_file.h"
#include "kinematics/corrected_robot.h"
#include "tests/io/data_set_folder.h"

namespace selfcal {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const char* const kAnHour =
    "set,q1,q2,x,y,z,time,temperature\n"
    "tracker,0.1,0.2,1,2,3,1000,30\ntracker,0.2,0.3,1,2,3,2000,31\n"
    "tracker,0.3,0.4,1,2,3,4600,35\n";

class EffectsOfRows : public DataSetFolder {
 protected:
  /// `entry` stands on line 9 of the robot's file.
  void have(const std::string& entry) { robot += "effects:\n  - " + entry + "\n"; }
  void have_more(const std::string& entry) { robot += "  - " + entry + "\n"; }
};

TEST_F(EffectsOfRows, AreRefusedWithFileAndKeyWhereTheRowsCannotHaveThem) {
  have("{effect: trigger_latency, delay: 5.0e-3}");
  head += "dq: sign\n";
  sets = only("table: {method: plane}");
  EXPECT_THAT(error("set,q1,q2,dq1,dq2\ntable,0.1,0.2,1,-1\n"),
              AllOf(StartsWith("arm.robot.yaml:9: effect: key 'effect'"), HasSubstr("signs")));
}

TEST_F(EffectsOfRows, HaveTheRowsTimesAndMeanTemperatureWhereTheFileSaysNone) {
  have("{effect: base_drift, x: 1.0e-4}");
  have_more("{effect: thermal_expansion, alpha: 1.2e-5}");
  have_more("{effect: scale_error, at: tracker, by: temperature, k: 1.0e-6}");
  have_more("{effect: base_drift, begin: 1500, settle: 100, y: 1.0e-4}");
  sets = only("tracker: {method: position}");
  const auto loaded = load(kAnHour);
  ASSERT_TRUE(loaded) << loaded.error().what;
  const std::vector<Node> entries = effect_entries(*loaded->robot);
  ASSERT_EQ(entries.size(), 4U);
  EXPECT_EQ(entries[0].find("begin")->text, "1000");
  EXPECT_EQ(entries[0].find("end")->text, "4600");
  EXPECT_EQ(entries[1].find("reference")->text, "32");
  EXPECT_EQ(entries[2].find("reference")->text, "32");
  EXPECT_EQ(entries[3].find("begin")->text, "1500");
  EXPECT_EQ(entries[3].find("end")->text, "4600");
}

TEST_F(EffectsOfRows, KeepWhatTheFileSays) {
  have("{effect: base_drift, begin: 0, end: 50, x: 1.0e-4}");
  have_more("{effect: thermal_expansion, reference: 20, alpha: 1.2e-5}");
  have_more("{effect: base_drift, begin: 9000, settle: 100, y: 1.0e-4}");
  sets = only("tracker: {method: position}");
  const auto loaded = load(kAnHour);
  ASSERT_TRUE(loaded) << loaded.error().what;
  const std::vector<Node> entries = effect_entries(*loaded->robot);
  EXPECT_EQ(entries[0].find("end")->text, "50");
  EXPECT_EQ(entries[1].find("reference")->text, "20");
  // It begins after the rows: it has no end among them.
  EXPECT_EQ(entries[2].find("end"), nullptr);
}

TEST_F(EffectsOfRows, HaveTheMiddleAndTheNormalOfTheRowsOfTheirSet) {
  have("{effect: plane_form_error, at: table, a: 1.0e-3}");
  sets = only("table: {method: plane}");
  const auto loaded = load("set,q1,q2,nx,ny,nz\ntable,0.5,0.2,0,0,1\ntable,-0.5,0.2,0,0,1\n");
  ASSERT_TRUE(loaded) << loaded.error().what;
  const Node entry = effect_entries(*loaded->robot).front();
  ASSERT_NE(entry.find("normal"), nullptr);
  EXPECT_EQ(entry.find("normal")->items[2].text, "1");
  ASSERT_NE(entry.find("center"), nullptr);
  EXPECT_NE(entry.find("center")->items[0].text, "0");
}

TEST_F(EffectsOfRows, OfASurfaceThatTheDataSetLacksAreKeptAsTheyAre) {
  have("{effect: plane_form_error, at: floor, a: 1.0e-3}");
  sets = only("tracker: {method: position}");
  const auto loaded = load(kAnHour);
  ASSERT_TRUE(loaded) << loaded.error().what;
  const Node entry = effect_entries(*loaded->robot).front();
  EXPECT_EQ(entry.find("normal"), nullptr);
  EXPECT_EQ(entry.find("center"), nullptr);
}

TEST_F(EffectsOfRows, OfASurfaceNeedANormalWhereTheRowsTouchNone) {
  have("{effect: plane_form_error, at: tracker, a: 1.0e-3}");
  sets = only("tracker: {method: position}");
  EXPECT_THAT(error(kAnHour), AllOf(StartsWith("arm.robot.yaml:9: effect: key 'normal'")));
}

TEST_F(EffectsOfRows, HaveTheDeviceWhereTheirRowsHaveIt) {
  const auto arm = robot_of(robot, "arm.yaml");
  ASSERT_TRUE(arm) << arm.error().what;
  std::string tracked = "set,q1,q2,x,y,z\n", wired = "set,q1,q2,distance\n";
  const Eigen::Vector3d device(3, -2, 0.5);
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector2d q(-1.5 + 0.25 * i, 0.1 * (i % 4));
    const Eigen::Vector3d p = locate(**arm, values(**arm), q).p - device;
    const std::string readings = format_number(q[0]) + "," + format_number(q[1]) + ",";
    tracked += "device," + readings + format_number(p.x()) + "," + format_number(p.y()) + "," +
               format_number(p.z()) + "\n";
    wired += "device," + readings + format_number(p.norm()) + "\n";
  }
  have("{effect: scale_error, at: device, s: 1.0e-5}");
  for (const auto& [method, rows] :
       {std::pair("{method: position, frame: unknown}", &tracked),
        std::pair("{method: fixed-point-distance, center: [3, -2, 0.5]}", &wired)}) {
    sets = only("device: " + std::string(method));
    const auto loaded = load(*rows);
    ASSERT_TRUE(loaded) << loaded.error().what;
    const Node entry = effect_entries(*loaded->robot).front();
    const Node* origin = entry.find("origin");
    ASSERT_NE(origin, nullptr) << method;
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(std::stod(origin->items[static_cast<size_t>(axis)].text), device[axis], 1e-9)
          << method;
  }
}

}  // namespace
}  // namespace selfcal
