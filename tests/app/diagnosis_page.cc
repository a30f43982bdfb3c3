// The page of a diagnosis: what it says beside the verdict.
#include "app/report/diagnosis_report.h"

#include <gmock/gmock.h>

namespace selfcal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

NamedValue value(const char* name, double value) { return {name, "rad", value, 1e-5, 0, 1e-3}; }

TEST(DiagnosisReport, TellsWhatChangedSinceTheOtherDataSet) {
  Findings findings;
  findings.since = {
      "spring<1>",
      {0.01, 0, {{"zero_shift", "j3", 0.97, {value("j3.theta", -1.25e-3)}}}, "changed: j3 & so"}};

  const std::string page = html_report(findings);

  EXPECT_THAT(page, HasSubstr("<h2>What changed since spring&lt;1&gt;</h2>"));
  EXPECT_THAT(page, HasSubstr("changed: j3 &amp; so"));
  EXPECT_THAT(page, HasSubstr("<td>zero shift<td>j3<td class=num>0.97"));
  EXPECT_THAT(page, HasSubstr("-0.00125 &plusmn; 1e-05 rad"));
  EXPECT_THAT(page, Not(HasSubstr("Against the simulation")));
}

TEST(DiagnosisReport, TellsInWhatTheSimulationDiffers) {
  Differences of;
  of.robot_only = {{"backlash", "j2", 0.9, {value("j2.gap", 2e-4)}, {}}};
  of.both = {{"joint_compliance",
              "j4",
              {{value("j4.compliance", 1e-5), value("j4.compliance", 3e-5), 4.5}}}};
  of.geometry.changes = {{"geometry_differs", "d4", 0.8, {}}};
  of.sentences = {"the robot has, and its simulation lacks: backlash at j2"};
  Findings findings;
  findings.sim = {"mujoco", of};

  const std::string page = html_report(findings);

  EXPECT_THAT(page, HasSubstr("<h2>Against the simulation mujoco</h2>"));
  EXPECT_THAT(page, HasSubstr("<li>the robot has, and its simulation lacks: backlash at j2"));
  EXPECT_THAT(page, HasSubstr("In the robot alone"));
  EXPECT_THAT(page, Not(HasSubstr("In the simulation alone")));
  EXPECT_THAT(page, HasSubstr("4.5 sigma"));
  EXPECT_THAT(page, HasSubstr("<td>geometry differs<td>d4"));
  EXPECT_THAT(page, Not(HasSubstr("What changed since")));
}

}  // namespace
}  // namespace selfcal
