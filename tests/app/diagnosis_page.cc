// The page of a diagnosis: what its object holds beside diagnosis.json.
#include "app/report/page/diagnosis_page.h"

#include <gmock/gmock.h>

#include "io/files/robot_file.h"

namespace selfcal {
namespace {

NamedValue value(const char* name, double value) { return {name, "rad", value, 1e-5, 0, 1e-3}; }

/// The object of findings about the delta of the examples, without rows.
nlohmann::ordered_json data_of(const Findings& findings) {
  const auto robot = load_robot(SELFCAL_SOURCE_DIR "/app/examples/delta.robot.yaml");
  const DataSet data;
  return diagnosis_data({**robot, data, "summer", 0}, findings);
}

TEST(DiagnosisPage, TellsWhatChangedSinceTheOtherDataSet) {
  Findings findings;
  findings.since = {"spring",
                    {0.01, 0, {{"zero_shift", "j3", 0.97, {value("j3.theta", -1.25e-3)}}}, "j3"}};

  const nlohmann::ordered_json data = data_of(findings);

  EXPECT_EQ(data["since_name"], "spring");
  EXPECT_EQ(data["result"]["since"]["changes"][0]["values"][0]["value"], -1.25e-3);
  EXPECT_FALSE(data.contains("sim_name"));
  EXPECT_FALSE(data["result"].contains("sim"));
}

TEST(DiagnosisPage, TellsInWhatTheSimulationDiffers) {
  Differences of;
  of.robot_only = {{"backlash", "j2", 0.9, {value("j2.gap", 2e-4)}, {}}};
  of.sentences = {"the robot has, and its simulation lacks: backlash at j2"};
  Findings findings;
  findings.sim = {"mujoco", of};

  const nlohmann::ordered_json data = data_of(findings);

  EXPECT_EQ(data["sim_name"], "mujoco");
  EXPECT_EQ(data["result"]["sim"]["why"][0], of.sentences[0]);
  EXPECT_EQ(data["result"]["sim"]["robot_only"][0]["parameters"][0]["value"], 2e-4);
  EXPECT_FALSE(data.contains("since_name"));
}

TEST(DiagnosisPage, HasTheRowsBehindTheGapWithoutFalseReadings) {
  Findings findings;
  findings.diagnosis.validation_rows = {{9e-6, 4e-6, 1e-6, 1e-6, 1e-6, 0, false},
                                        {1, 1, 1, 1, 1e-6, 1, true}};

  const nlohmann::ordered_json judged = data_of(findings)["judged"];

  EXPECT_EQ(judged["of"], 2);
  ASSERT_EQ(judged["nominal"].size(), 1);
  EXPECT_NEAR(judged["nominal"][0].get<double>(), 3e-3, 1e-15);  // square roots, rounded
  EXPECT_NEAR(judged["before"][0].get<double>(), 2e-3, 1e-15);
  EXPECT_FALSE(data_of({}).contains("judged"));
}

}  // namespace
}  // namespace selfcal
