// The program as its user runs it: exit statuses, files written.
#include "tests/app/program.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/text.h"

namespace selfcal {
namespace {

TEST_F(Program, CalibratesTheSimulatedExampleAndWritesTheCandidate) {
  const std::string data = simulated();
  const Ran ran = run_selfcal("identify " + data + " --out " + (folder_ / "result").string());
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_TRUE(ran.out.find("Improved: the tool is met to ") != std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find(" parameters identified from 243 touches"), std::string::npos) << ran.out;
  const auto json = nlohmann::json::parse(text_of(folder_ / "result/result.json"));
  EXPECT_EQ(json["verdict"]["answer"], "improved");
  const Ran again =
      run_selfcal("robot check " + (folder_ / "result/calibrated.robot.yaml").string());
  EXPECT_EQ(again.status, 0) << again.out;
  // One machine keeps one hash whatever its calibration.
  EXPECT_NE(again.out.find(json["model_hash"].get<std::string>()), std::string::npos) << again.out;
}

TEST_F(Program, PrintsJsonAloneOnStandardOutput) {
  const Ran ran = run_selfcal("identify " + simulated() + " --json", true);
  EXPECT_EQ(nlohmann::json::parse(ran.out)["robot"], "staubli-rx90");
}

TEST_F(Program, FailsWhereItCannotWrite) {
  const std::string data = simulated();
  EXPECT_EQ(run_selfcal("identify " + data + " --json > /dev/full").status, 4);
  std::ofstream(folder_ / "file") << "no folder";
  const Ran ran = run_selfcal("identify " + data + " --out " + (folder_ / "file").string());
  EXPECT_EQ(ran.status, 4);
  EXPECT_EQ(ran.out.find("identifying"), std::string::npos) << "told before the work: " << ran.out;
}

TEST_F(Program, WritesNothingOnBadInputAndNamesTheLine) {
  const std::string data = simulated();
  std::ofstream(data + "/dataset.yaml", std::ios::app) << "tarket: 1\n";
  const Ran ran = run_selfcal("identify " + data + " --out " + (folder_ / "result").string());
  EXPECT_EQ(ran.status, 3);
  EXPECT_NE(ran.out.find("dataset.yaml:"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("tarket"), std::string::npos) << ran.out;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "result"));
}

TEST_F(Program, RefusesUnknownNamesAndMethodsAsWrongUsage) {
  const std::string data = simulated();
  const Ran name = run_selfcal("identify " + data + " --fix thetta2");
  EXPECT_EQ(name.status, 2);
  EXPECT_NE(name.out.find("thetta2"), std::string::npos);
  EXPECT_EQ(
      run_selfcal("identifiable " SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml --method plain")
          .status,
      2);
  EXPECT_EQ(run_selfcal("identify").status, 2);
  EXPECT_EQ(run_selfcal("calibrate").status, 2);
}

TEST_F(Program, AsksTheEnvironmentForADomainOnlyWhereItNeedsOne) {
  setenv("ROS_DOMAIN_ID", "many", 1);
  const Ran file = run_selfcal("robot check " SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml");
  const Ran asked = run_selfcal("monitor --wait 0.1");
  const Ran named = run_selfcal("monitor --wait 0.1 --domain 231");
  unsetenv("ROS_DOMAIN_ID");
  EXPECT_EQ(file.status, 0) << file.out;
  EXPECT_EQ(asked.status, 2) << asked.out;
  EXPECT_NE(asked.out.find("ROS_DOMAIN_ID is 'many', and must be 0 to 232"), std::string::npos)
      << asked.out;
  EXPECT_NE(named.out.find("domain 231"), std::string::npos) << named.out;
}

TEST_F(Program, AsksWhetherANearWordWasMeant) {
  for (const auto& [typed, said] : std::map<std::string, std::string>{
           {"identfy x", "selfcal has no command 'identfy'; did you mean 'identify'?"},
           {"robot covnert x", "robot has no command 'covnert'; did you mean 'convert'?"},
           {"monitor --wbe x", "monitor has no option '--wbe'; did you mean '--web'?"},
           {"identify x --fxi=theta2", "identify has no option '--fxi'; did you mean '--fix'?"},
           {"frobnicate", "selfcal has no command 'frobnicate'\n"}}) {
    const Ran ran = run_selfcal(typed);
    EXPECT_EQ(ran.status, 2) << typed;
    EXPECT_NE(ran.out.find(said), std::string::npos) << ran.out;
  }
  EXPECT_NE(run_selfcal("identify").out.find("DATASET is required"), std::string::npos);
}

TEST_F(Program, HoldsWhatTheUserFixes) {
  const Ran ran = run_selfcal("identify " + simulated() + " --fix 'd*' --json", true);
  const auto json = nlohmann::json::parse(ran.out);
  for (const auto& p : json["parameters"])
    if (p["name"].get<std::string>()[0] == 'd') {
      EXPECT_EQ(p["status"], "fixed");
      EXPECT_EQ(p["value"], p["nominal"]);
    }
}

TEST_F(Program, KeepsTheEffectsOfTheRobotsFileBesideThoseAskedFor) {
  const std::string data = simulated();
  std::ofstream(data + "/rx90.robot.yaml", std::ios::app)
      << "effects:\n"
         "  - {effect: joint_coupling, at: j5, from: j4, kappa_j4: 1.0e-4}\n"
         "  - {effect: transmission_error, at: j2, waves: [3], sin3: 1.0e-4, cos3: 0}\n";
  const Ran ran = run_selfcal(
      "identify " + data + " --effects transmission_error@j2 --effects joint_coupling@j3 --json",
      true);
  const auto json = nlohmann::json::parse(ran.out);
  std::set<std::string> effects;
  for (const auto& p : json["parameters"])
    EXPECT_TRUE(effects.insert(p["name"]).second) << p["name"] << " is there twice";
  EXPECT_TRUE(effects.contains("j5.kappa_j4"));
  EXPECT_TRUE(std::ranges::any_of(
      effects, [](const std::string& name) { return name.starts_with("j3.kappa_"); }));
  EXPECT_TRUE(std::ranges::any_of(
      effects, [](const std::string& name) { return name.starts_with("j2.sin"); }));
}

TEST_F(Program, LetsASurfacesFormOfTheRobotsFileActOnItsRows) {
  const std::string data = simulated();
  const auto before = [&] {
    const Ran ran = run_selfcal("identify " + data + " --fix '*' --json", true);
    const auto json = nlohmann::json::parse(ran.out);
    std::map<std::string, double> rms;
    for (const auto& set : json["residual"]["check"]["by_set"])
      rms[set["name"]] = set["rms_before"];
    return rms;
  };
  const auto flat = before();
  const std::string file = data + "/rx90.robot.yaml", robot = text_of(file);
  const std::string form =
      "effects:\n  - {effect: plane_form_error, a: 0.1, b: 0, c: 0, "
      "center: [1, 0, 0.5], normal: [0, 0, 1], at: ";
  std::ofstream(file) << robot << form << flat.begin()->first << "}\n";
  const auto bent = before();
  EXPECT_GT(bent.begin()->second, 2 * flat.begin()->second) << flat.begin()->first;
  std::ofstream(file) << robot << form << "another}\n";
  for (const auto& [set, rms] : before())
    EXPECT_NEAR(rms, flat.at(set), 1e-9) << "of a surface that is not among the sets";
}

TEST_F(Program, JudgesRowsThatTheNominalRobotMeetsExactly) {
  std::filesystem::copy(SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml", folder_);
  std::ofstream(folder_ / "exact.scenario.yaml")
      << "robot: rx90.robot.yaml\nseed: 1\ncheck: 0.33\nsets: {s: {method: position, rows: 100}}\n";
  const std::string data = (folder_ / "data").string();
  ASSERT_EQ(run_selfcal("simulate " + (folder_ / "exact.scenario.yaml").string() + " --out " + data)
                .status,
            0);
  const Ran ran = run_selfcal("identify " + data);
  EXPECT_EQ(ran.status, 1) << ran.out;
  EXPECT_NE(ran.out.find("Not improved: "), std::string::npos) << ran.out;
}

TEST_F(Program, ClaimsNothingWhereEverythingIsFixed) {
  const std::string data = simulated();
  const Ran told = run_selfcal("identify " + data + " --fix '*'");
  EXPECT_EQ(told.status, 1);
  EXPECT_NE(told.out.find("\nnothing was identified"), std::string::npos) << told.out;
  EXPECT_EQ(told.out.find("end position"), std::string::npos) << told.out;
  EXPECT_EQ(told.out.find("candidate"), std::string::npos) << told.out;
  const Ran ran = run_selfcal("identify " + data + " --fix '*' --json", true);
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_TRUE(json["endpoint_sigma"]["rms"].is_null());
  EXPECT_GT(json["residual"]["check"]["rows"], 0);  // the fixed robot is judged all the same
  EXPECT_EQ(json["converged"], true) << json["stop_reason"];
}

TEST_F(Program, ListsEveryParameterAsFixedWhereAllRowsAreKeptAside) {
  const std::string data = simulated();
  std::string rows = text_of(data + "/observations.csv");
  for (size_t at = rows.find(",fit"); at != std::string::npos; at = rows.find(",fit", at))
    rows.replace(at, 4, ",check");
  std::ofstream(data + "/observations.csv") << rows;
  const Ran ran = run_selfcal("identify " + data + " --json", true);
  EXPECT_EQ(ran.status, 1);
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["verdict"]["answer"], "not-determined");
  EXPECT_GT(json["parameters"].size(), 40u);
  for (const auto& p : json["parameters"]) {
    EXPECT_EQ(p["status"], "fixed") << p["name"];
    EXPECT_TRUE(p["sigma"].is_null()) << p["name"];
  }
  EXPECT_EQ(run_selfcal("identify " + data, true).out,
            "Not determined: these rows do not say how the robot really is.\n"
            "no rows to identify from\n"
            "\nNext\n"
            "  Leave `check` (column part) to about a third of the rows: the others are to "
            "identify.\n");
  const Ran look = run_selfcal("data check " + data, true);
  EXPECT_EQ(look.status, 1);
  EXPECT_EQ(look.out, "every row is `part: check`: none is left to look at\n");
  EXPECT_EQ(run_selfcal("identifiable " + data).status, 1);
}

TEST_F(Program, SaysWhatRowsOfADataSetCanTell) {
  const Ran ran = run_selfcal("identifiable " + simulated() + " --json", true);
  EXPECT_EQ(ran.status, 0);
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["own"], 16);  // five planes of three freedoms, one of the parallel plane
  EXPECT_GT(json["total"], 20);
}

TEST_F(Program, TellsOfAColumnThatItIgnoresWhateverItIsAsked) {
  const std::string data = simulated();
  std::string rows = text_of(data + "/observations.csv");
  for (size_t at = 0, line = 0; (at = rows.find('\n', at)) != std::string::npos; at += 4, ++line)
    rows.insert(at, line == 0 ? ",zz" : ",00");
  std::ofstream(data + "/observations.csv") << rows;
  for (const std::string command : {"identify ", "identifiable "}) {
    const Ran ran = run_selfcal(command + data);
    EXPECT_NE(ran.out.find("unknown columns are ignored: zz"), std::string::npos) << ran.out;
  }
}

TEST_F(Program, RefusesHowToDrawConfigurationsForADataSetsOwnRows) {
  const std::string data = simulated();
  for (const std::string option : {"--count 50", "--seed 2", "--unknown", "--method plane"}) {
    const Ran ran = run_selfcal("identifiable " + data + " " + option);
    EXPECT_EQ(ran.status, 2) << option << ": " << ran.out;
    EXPECT_NE(ran.out.find(option.substr(0, option.find(' '))), std::string::npos) << ran.out;
  }
}

TEST_F(Program, RefusesOptionsThatWouldChangeNothing) {
  const std::string robot = SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml";
  const std::string config = SELFCAL_SOURCE_DIR "/app/examples/rx90_cell.config.yaml";
  const std::string out = " --out " + (folder_ / "out").string();
  for (const std::string& arguments :
       {"identifiable " + robot + " --method position --unknown",
        "trial seal a --truth t --seed 2" + out, "trial seal a --truth t --rows 80-90" + out,
        "trial seal a --truth t --measure planes" + out,
        "trial seal a --truth t --robot " + robot + out, "trial seal a" + out,
        "trial seal --make 1 --truth t" + out, "trial seal --make 1 a --truth t" + out,
        "trial seal --truth t" + out, "trial seal" + out,
        "history " + folder_.string() + " --export 1 x --events",
        "history " + folder_.string() + " --export 1 x --newest 3",
        "serve " + config + " --check --sessions 1", "serve " + config + " --check --log debug",
        "serve " + config + " --check --simulate --truth t", "serve " + config + " --truth t",
        "serve " + config + " --sessions -1"}) {
    const Ran ran = run_selfcal(arguments);
    EXPECT_EQ(ran.status, 2) << arguments << ": " << ran.out;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(Program, AsksForANameWhereAFileHasNoneAndForOneOfFixedAndFreed) {
  const std::string data = simulated();
  for (const std::string& arguments :
       {"identify " + data + " --out ''", "diagnose " + data + " --next ''",
        "identify " + data + " --fix theta2 --free theta2"}) {
    const Ran ran = run_selfcal(arguments);
    EXPECT_EQ(ran.status, 2) << arguments << ": " << ran.out;
  }
}

TEST_F(Program, RefusesWhatItCannotCompareWithBeforeItDiagnoses) {
  const std::string data = simulated();
  const std::filesystem::path other = folder_ / "other";
  std::filesystem::copy(data, other, std::filesystem::copy_options::recursive);
  std::string robot = text_of(other / "rx90.robot.yaml");
  const size_t name = robot.find("staubli-rx90");
  ASSERT_NE(name, std::string::npos);
  std::ofstream(other / "rx90.robot.yaml") << robot.replace(name, 12, "another-rx90");
  for (const std::string option : {"--since ", "--sim "}) {
    const Ran nowhere = run_selfcal("diagnose " + data + " " + option + "/nowhere");
    EXPECT_EQ(nowhere.status, 3) << nowhere.out;
    EXPECT_EQ(nowhere.out.find("weighing"), std::string::npos) << nowhere.out;
    const Ran foreign = run_selfcal("diagnose " + data + " " + option + other.string());
    EXPECT_EQ(foreign.status, 3) << foreign.out;
    EXPECT_NE(foreign.out.find("only data sets of one robot can be compared"), std::string::npos)
        << foreign.out;
    EXPECT_EQ(foreign.out.find("weighing"), std::string::npos) << foreign.out;
  }
}

}  // namespace
}  // namespace selfcal
