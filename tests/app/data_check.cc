// A first look at data sets: a sound one, and the same with one slip in it.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/app/data_check_case.h"
#include "tests/shared_data.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST_F(DataCheck, FindsNothingInASoundSet) {
  const Ran ran = run_selfcal("data check " + (folder_ / "data").string());
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("nothing is likely wrong"));
}

TEST_F(DataCheck, SaysThatATableIsStandard) {
  change_robot("convention: standard\n", "");
  expect_likely_wrong("the table is standard DH");
}

TEST_F(DataCheck, SaysWhichJointHasTheOtherSign) {
  change_rows({"q3"}, [](auto& q) { q[0] *= -1; });
  expect_likely_wrong("j3 is read with the other sign");
}

TEST_F(DataCheck, SaysWhichJointsZeroIsElsewhere) {
  change_rows({"q3"}, [](auto& q) { q[0] += 10 * std::numbers::pi / 180; });
  free_of_limits();
  expect_likely_wrong("the zero of j3 is 10.1 degrees from where the robot's file has it");
}

TEST_F(DataCheck, SaysWhatIsWrongOfRowsThatTheJointsLimitsRefuse) {
  change_rows({"q4"}, [](auto& q) { q[0] *= 2; });
  for (const char* command : {"data check ", "identify ", "diagnose "}) {
    const Ran ran = run_selfcal(command + (folder_ / "data").string());
    EXPECT_EQ(ran.status, 3) << command;
    EXPECT_THAT(ran.out, testing::AllOf(testing::HasSubstr("is far outside the limits"),
                                        testing::HasSubstr("; likely wrong: the readings of j4 are "
                                                           "twice what it moves")))
        << command;
  }
}

TEST_F(DataCheck, SaysThatAllLegsAreReadWithTheOtherSignThoughNoRowIsThenPossible) {
  std::ofstream(folder_ / "s.yaml") << R"(robot: arm.robot.yaml
seed: 1
errors: {length: 1.0e-3}
sets:
  tracker: {method: position, noise: 2.0e-5, rows: 60}
)";
  simulate(text_of(std::filesystem::path(SELFCAL_SOURCE_DIR) / "app/examples/stewart.robot.yaml"));
  const auto turned = [](std::vector<double>& legs) {
    for (double& each : legs) each *= -1;
  };
  for (const auto& [legs, said] : {std::pair{kReadings, "all joints are read with the other sign"},
                                   std::pair{Cells{"q2"}, "leg2 is read with the other sign"}}) {
    change_rows(legs, turned);
    const Ran ran = run_selfcal("data check " + (folder_ / "data").string());
    EXPECT_EQ(ran.status, 3);
    EXPECT_THAT(ran.out, HasSubstr(std::string("; likely wrong: ") + said));
    change_rows(legs, turned);
  }
}

TEST_F(DataCheck, SaysThatTooFewRowsTellNothing) {
  simulate_sets(kErrors + "  tracker: {method: position, noise: 2.0e-5, rows: 4}\n");
  const Ran ran = run_selfcal("data check " + (folder_ / "data").string());
  EXPECT_EQ(ran.status, 1) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("too few rows to tell whether anything is wrong"));
  EXPECT_THAT(ran.out, Not(HasSubstr("nothing is likely wrong")));
}

TEST_F(DataCheck, SaysWhichReadingsAreTwiceWhatTheJointMoves) {
  change_rows({"q4"}, [](auto& q) { q[0] *= 2; });
  free_of_limits();
  expect_likely_wrong("the readings of j4 are twice what it moves (its gear ratio)");
}

TEST_F(DataCheck, SaysWhichJointReadsTheSameInEveryRow) {
  change_rows({"q3"}, [](auto& q) { q[0] = 0.5; });
  expect_likely_wrong("the rows do not fit, and what is read of j3 is the same in all of them");
}

TEST_F(DataCheck, SaysWhichJointsAreExchanged) {
  change_rows({"q2", "q3"}, [](auto& q) { std::swap(q[0], q[1]); });
  expect_likely_wrong("the columns of j2 and j3 are exchanged");
}

TEST_F(DataCheck, SaysThatReadingsOfAMimicAreInTheCouplingAlready) {
  std::string coupled = std::string(kTable) + R"(coupling:
  - [1, 0, 0, 0, 0, 0]
  - [0, 1, 0, 0, 0, 0]
  - [0, -1, 1, 0, 0, 0]
  - [0, 0, 0, 1, 0, 0]
  - [0, 0, 0, 0, 1, 0]
  - [0, 0, 0, 0, 0, 1]
)";
  const std::string free = "{name: j3, joint: revolute, d: -0.57155, limits: [-1.0, 1.0]}";
  const std::string still = "{name: j3, joint: revolute, d: -0.57155, limits: [-1.0e-9, 1.0e-9]}";
  coupled.replace(coupled.find(free), free.size(), still);
  simulate(coupled);
  free_of_limits();
  ASSERT_EQ(run_selfcal("data check " + (folder_ / "data").string()).status, 0);
  change_rows({"q2", "q3"}, [](std::vector<double>& q) { q[1] = -q[0]; });
  expect_likely_wrong("the readings of j3 follow those of j2, as its coupling does already");
}

TEST_F(DataCheck, SaysThatReadingsAreDegreesBelowTheFourTurnsThatNoFilePasses) {
  // Joints that move through little: 1 rad here, 17 degrees for 0.3 rad there.
  ASSERT_NO_FATAL_FAILURE(simulate_again("1.0]", "0.3]", "-1.0,", "-0.3,"));
  free_of_limits();
  change_rows(kReadings, [](auto& q) {
    for (double& each : q) each *= 180 / std::numbers::pi;
  });
  expect_likely_wrong("the joint readings are degrees");
}

TEST_F(DataCheck, SaysThatTheRowsAreOfAnotherRobot) {
  change_robot("-0.6127", "-0.425");
  change_robot("-0.57155", "-0.39225");
  expect_likely_wrong("none of the usual slips explains the rows");
}

struct MadeSlip {
  const char* name;
  std::function<void()> make;
  const char* said;
};

TEST_F(DataCheck, IsTheFirstAdviceOfAnIdentification) {
  const auto scaled = [this](const Cells& columns, double factor) {
    change_rows(columns, [factor](auto& cells) {
      for (double& each : cells) each *= factor;
    });
  };
  const MadeSlip slips[] = {
      {"sign", [&] { scaled({"q3"}, -1); }, "j3 is read with the other sign"},
      {"gear", [&] { change_robot("r: 0.17415", "gear: -1, r: 0.17415"); },
       "j4 is read with the other sign (or its gear turns the other way)"},
      {"joints",
       [&] {
         change_rows({"q2", "q3"}, [](auto& q) { std::swap(q[0], q[1]); });
       },
       "the columns of j2 and j3 are exchanged"},
      {"places",
       [&] {
         change_rows({"x", "y"}, [](auto& p) { std::swap(p[0], p[1]); });
       },
       "the columns x and y are exchanged"},
      {"inches",
       [&] {
         scaled({"x", "y", "z"}, 1 / 0.0254);
       },
       "the measured positions are inches"},
      {"convention", [&] { change_robot("convention: standard\n", ""); },
       "the table is standard DH"},
      {"tool", [&] { change_robot("xyz: [0.03, 0.02, 0.15]", "xyz: [0, 0, 0]"); },
       "the tool's frame is missing"},
      {"robot", [&] { change_robot("-0.6127", "-0.425"); },
       "none of the usual slips explains the rows"},
  };
  for (const MadeSlip& slip : slips) {
    ASSERT_NO_FATAL_FAILURE(simulate(kTable));
    slip.make();
    const Ran ran = run_selfcal("identify " + (folder_ / "data").string());
    EXPECT_THAT(ran.out, HasSubstr(std::string("\nNext\n  Look at the files first: ") + slip.said))
        << slip.name;
  }
}

TEST_F(DataCheck, TakesNoToolForAnotherOneThatIsAsFarOffAsItsFileLetsIt) {
  for (const char* tolerance : {"0.05", "0.2"}) {
    ASSERT_NO_FATAL_FAILURE(simulate(kTable));
    change_robot("xyz: [0.03, 0.02, 0.15]",
                 std::string("xyz: [0, 0, 0], tolerance: {z: ") + tolerance + "}");
    const Ran ran = run_selfcal("data check " + (folder_ / "data").string());
    EXPECT_EQ(ran.out.find("the tool's frame is missing") != std::string::npos,
              std::string(tolerance) == "0.05")
        << ran.out;
  }
}

TEST_F(DataCheck, LeavesTheDiagnosisNoCauseOfWhatASlipExplains) {
  constexpr const char* kBare = R"(robot: irb1600
kind: serial
frames:
  - {name: base, joint: fixed}
  - {name: j1, joint: revolute, r: 0.4865, limits: [-3.14, 3.14]}
  - {name: j2, joint: revolute, alpha: -pi/2, d: 0.15, limits: [-1.1, 1.91]}
  - {name: j3, joint: revolute, d: 0.7, theta: -pi/2, limits: [-4.1, 0.96]}
  - {name: j4, joint: revolute, alpha: -pi/2, r: 0.6, limits: [-3.49, 3.49]}
  - {name: j5, joint: revolute, alpha: pi/2, limits: [-2.01, 2.01]}
  - {name: j6, joint: revolute, alpha: -pi/2, theta: pi, r: 0.065, limits: [-6.98, 6.98]}
)";
  std::ofstream(folder_ / "s.yaml") << R"(robot: arm.robot.yaml
seed: 4
errors: {length: 0.5e-3, angle: 0.5e-3, tool_length: 2.0e-3, base_length: 2.0e-3}
check: 0.3
sets:
  tracker: {method: position, noise: 2.0e-5, rows: 80}
)";
  simulate(std::string(kBare) + "  - {name: tool, joint: fixed, theta: 1.1562, r: 0.036}\n");
  std::ofstream(folder_ / "data/arm.robot.yaml") << kBare;
  const Ran ran = run_selfcal("diagnose --json " + (folder_ / "data").string(), true);
  const auto answer = nlohmann::json::parse(ran.out);
  EXPECT_EQ(answer["verdict"]["effect"], "unknown");
  EXPECT_GT(answer["verdict"]["probability"], 0.9);
  for (const auto& each : answer["candidates"])
    EXPECT_TRUE(each["effect"] == "unknown" || each["probability"] < 0.1) << each["effect"];
  EXPECT_THAT(answer["next"][0]["what"].get<std::string>(), HasSubstr("lacks a tool frame"));
}

TEST_F(DataCheck, IsNoAdviceWhereNothingIsWrong) {
  const Ran ran = run_selfcal("identify " + (folder_ / "data").string());
  EXPECT_THAT(ran.out, Not(HasSubstr("Look at the files")));
}

// So small a part of the range was measured that any rows on one point fit nearly as well.
TEST_F(DataCheck, SaysOfPositionsAloneThatAColumnHasTheOtherSign) {
  SELFCAL_NEED_SHARED();
  for (const Cells& column : {Cells{"x"}, Cells{"y"}, Cells{"z"}}) {
    std::filesystem::remove_all(folder_ / "data");
    std::filesystem::copy(shared_dir() / "data/ur10-mocap", folder_ / "data");
    change_rows(column, [](auto& p) { p[0] *= -1; });
    expect_likely_wrong("two of the columns x, y and z are exchanged, or one has the other sign");
  }
}

TEST(DataCheckOfRealRobots, AccusesNoSoundSet) {
  SELFCAL_NEED_SHARED();
  for (const char* name :
       {"delta-bed", "ipa-ur10-joint", "motoman-planes", "motoman-selfcontact", "motoman-tracker",
        "mukca-kuka-14", "mukca-panda-3", "talos-contact", "ur10-mocap"}) {
    const Ran ran = run_selfcal("data check " + (shared_dir() / "data" / name).string());
    EXPECT_EQ(ran.status, 0) << name << ": " << ran.out;
  }
}

}  // namespace
}  // namespace selfcal
