// A first look at what was measured: units, columns, the tool, the conventions of orientations.
#include <gmock/gmock.h>

#include <algorithm>
#include <numbers>

#include "kinematics/rotation.h"
#include "tests/app/data_check_case.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST_F(DataCheck, SaysThatPositionsAreMillimetresBelowTheKilometreThatNoFilePasses) {
  ASSERT_NO_FATAL_FAILURE(simulate_again("-0.6127", "-0.3", "-0.57155", "-0.2"));
  change_rows({"x", "y", "z"}, [](auto& p) {
    for (double& each : p) each *= 1000;
  });
  expect_likely_wrong("the measured positions are millimetres");
}

TEST_F(DataCheck, SaysThatDistancesAreInAnotherUnit) {
  for (const auto& [unit, metres] : {std::pair{"centimetres", 1e-2}, std::pair{"inches", 0.0254}}) {
    simulate_sets(kBar);
    change_rows({"distance"}, [scale = metres](std::vector<double>& d) { d[0] /= scale; });
    expect_likely_wrong(std::string("the measured distances are ") + unit);
  }
}

TEST_F(DataCheck, SaysThatInclinationsAreDegrees) {
  simulate_sets(kLevels);
  change_rows({"alpha", "beta"}, [](std::vector<double>& angles) {
    for (double& each : angles) each *= 180 / std::numbers::pi;
  });
  expect_likely_wrong("the measured angles are degrees");
}

TEST_F(DataCheck, SaysWhatIsWrongWithTheAnglesOfTheodolitesBesideSoundLengths) {
  using Slip = std::function<void(std::vector<double>&)>;
  const auto times = [](double factor) -> Slip {
    return [=](std::vector<double>& angles) {
      for (double& each : angles) each *= factor;
    };
  };
  const std::pair<Slip, const char*> slips[] = {
      {times(180 / std::numbers::pi), "the measured angles are degrees"},
      {times(200 / std::numbers::pi), "the measured angles are gons"},
      {[](auto& angles) { angles[0] *= -1; }, "the column azimuth has the other sign"},
      {[](auto& angles) { angles[1] = std::numbers::pi / 2 - angles[1]; },
       "the column elevation counts from a right angle away"},
      {[](auto& angles) { std::swap(angles[0], angles[1]); },
       "the columns azimuth and elevation are exchanged"}};
  for (const auto& [slip, said] : slips) {
    simulate_sets(kTheodolites);
    change_rows({"azimuth", "elevation"}, slip);
    expect_likely_wrong(said);
    EXPECT_THAT(run_selfcal("identify " + (folder_ / "data").string()).out, HasSubstr(said));
  }
}

TEST_F(DataCheck, FindsNothingInSoundDistancesAnglesAndInclinations) {
  for (const std::string& sets : {kBar, kLevels, kTheodolites}) {
    simulate_sets(sets);
    const Ran ran = run_selfcal("data check " + (folder_ / "data").string());
    EXPECT_EQ(ran.status, 0) << ran.out;
  }
}

TEST_F(DataCheck, SaysThatColumnsOfThePositionAreExchanged) {
  change_rows({"x", "y"}, [](auto& p) { std::swap(p[0], p[1]); });
  expect_likely_wrong("the columns x and y are exchanged");
}

TEST_F(DataCheck, SaysThatTheToolIsMissing) {
  change_robot("xyz: [0.03, 0.02, 0.15]", "xyz: [0, 0, 0]");
  expect_likely_wrong("the tool's frame is missing");
}

TEST_F(DataCheck, SaysThatTheQuaternionsAreInAnotherOrder) {
  change_rows({"qw", "qx", "qy", "qz"},
              [](auto& q) { std::rotate(q.begin(), q.begin() + 1, q.end()); });
  const Ran ran = run_selfcal("data check " + (folder_ / "data").string());
  EXPECT_EQ(ran.status, 1) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("the quaternions are read in another order"));
}

TEST_F(DataCheck, SaysByWhichConventionTheAnglesAre) {
  change_rows({"qw", "qx", "qy", "qz"}, [](std::vector<double>& q) {
    const Eigen::Vector3d rpy =
        rpy_of(Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix());
    q = {rpy[2], rpy[1], rpy[0], 0};  // turns about z, the new y, the new x
  });
  change_text("data/observations.csv", "qw,qx,qy,qz", "A,B,C,D");
  const auto read_as = [&](const std::string& axes, const std::string& unit) {
    std::string text = text_of(folder_ / "data/dataset.yaml");
    text = text.substr(0, text.find("orientation:"));
    std::ofstream(folder_ / "data/dataset.yaml") << text << "orientation: {euler: " << axes
                                                 << ", columns: [A, B, C], unit: " << unit << "}\n";
  };
  read_as("ZYX", "rad");
  EXPECT_EQ(run_selfcal("data check " + (folder_ / "data").string()).status, 0);
  for (const char* axes : {"zyx", "xyz", "ZYZ"}) {
    read_as(axes, "rad");
    expect_likely_wrong("the angles of set tracker");
    EXPECT_THAT(run_selfcal("data check " + (folder_ / "data").string()).out,
                HasSubstr("they fit where the three columns are angles of euler: ZYX"));
    EXPECT_THAT(run_selfcal("identify " + (folder_ / "data").string()).out,
                HasSubstr("they fit where the three columns are angles of euler: ZYX"));
  }
  change_rows({"A", "B", "C"}, [](std::vector<double>& angles) {
    for (double& each : angles) each *= 180 / std::numbers::pi;
  });
  read_as("ZYX", "rad");
  EXPECT_THAT(run_selfcal("data check " + (folder_ / "data").string()).out,
              HasSubstr("the three columns are angles of euler: ZYX in degrees"));
}

}  // namespace
}  // namespace selfcal
