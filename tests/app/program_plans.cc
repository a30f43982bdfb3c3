// `selfcal plan` as its user runs it: what it says no to, what it is given and what it writes.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/program.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

TEST_F(Program, PlansWithWhatAResultKnowsAlready) {
  const std::string data = simulated(), out = (folder_ / "result").string();
  ASSERT_EQ(run_selfcal("identify " + data + " --out " + out).status, 0);
  const std::string plan = "plan " + data + "/rx90.robot.yaml --method position --count 6 --json";
  const Ran alone = run_selfcal(plan, true);
  const Ran with = run_selfcal(plan + " --prior " + out + "/result.json", true);
  ASSERT_EQ(with.status, 0) << with.out;
  const auto sigma = [](const Ran& ran) {
    return nlohmann::json::parse(ran.out)["planned"]["sigma"].get<double>();
  };
  EXPECT_LT(sigma(with), sigma(alone));
}

TEST_F(Program, PlansACellAsTheServiceChecksIt) {
  const std::string config = SELFCAL_SOURCE_DIR "/app/examples/delta_cell.config.yaml";
  const std::string rows = (folder_ / "rows.csv").string();
  const Ran plan = run_selfcal("plan " + config + " --out " + rows, true);
  EXPECT_EQ(plan.status, 0) << plan.out;
  const Ran check = run_selfcal("serve " + config + " --check", true);
  EXPECT_NE(check.out.find(plan.out.substr(plan.out.find("\n  bed"))), std::string::npos)
      << plan.out << check.out;
  const Ran told = run_selfcal("plan " + config + " --json", true);
  const auto json = nlohmann::json::parse(told.out);
  EXPECT_EQ(json["reached"], true);
  ASSERT_EQ(json["configurations"].size(), 72u);
  EXPECT_EQ(json["configurations"][0]["q"].size(), 3u);
  const std::string text = text_of(rows);
  EXPECT_EQ(std::ranges::count(text, '\n'), 73);
  EXPECT_EQ(text.substr(0, text.find('\n')), "set,part,q1,q2,q3");
}

TEST_F(Program, SaysNoToACellWhosePlanMissesItsTarget) {
  const std::filesystem::path examples = SELFCAL_SOURCE_DIR "/app/examples";
  for (const char* file : {"delta.robot.yaml", "delta_cell.scenario.yaml"})
    std::filesystem::copy_file(examples / file, folder_ / file);
  std::string text = text_of((examples / "delta_cell.config.yaml").string());
  const std::string target = "target: 0.5e-3";
  ASSERT_NE(text.find(target), std::string::npos);
  text.replace(text.find(target), target.size(), "target: 2.0e-6");
  const std::string config = (folder_ / "strict.config.yaml").string();
  std::ofstream(config) << text;
  const Ran check = run_selfcal("serve " + config + " --check", true);
  EXPECT_EQ(check.status, 1) << check.out;
  EXPECT_NE(check.out.find("target 0.002 mm: no; plan more touches or surfaces"), std::string::npos)
      << check.out;
  const Ran plan = run_selfcal("plan " + config + " --json", true);
  EXPECT_EQ(plan.status, 1);
  EXPECT_EQ(nlohmann::json::parse(plan.out)["reached"], false);
}

TEST_F(Program, SaysNoToAPlanThatMissesTheTargetItIsGiven) {
  const std::string plan =
      "plan " SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml --method position --candidates 60";
  EXPECT_EQ(run_selfcal(plan + " --target 1e-9").status, 1);
  EXPECT_EQ(run_selfcal(plan + " --target 0.01").status, 0);
  EXPECT_EQ(run_selfcal(plan + " --count 2").status, 0) << "the best two, as asked for";
}

TEST_F(Program, NamesNobodyWhoCarriesAMillionthOfAParameter) {
  const Ran ran = run_selfcal("identifiable " SELFCAL_SOURCE_DIR
                              "/app/examples/delta.robot.yaml --method plane --unknown",
                              true);
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_NE(ran.out.find("grouped with +0.0606 radius1"), std::string::npos) << ran.out;
  EXPECT_EQ(ran.out.find("e-07"), std::string::npos) << ran.out;
}

TEST_F(Program, SaysWhyAPlanHasNoObservability) {
  const std::string plan = "plan " SELFCAL_SOURCE_DIR
                           "/app/examples/irb1600.robot.yaml --method position --candidates 200";
  const std::string told = "do not tell all of them";
  EXPECT_NE(run_selfcal(plan + " --count 4", true).out.find(told), std::string::npos);
  EXPECT_EQ(run_selfcal(plan + " --count 20", true).out.find(told), std::string::npos);
}

TEST_F(Program, WritesTheRowsThatTellLookAlikesApart) {
  const std::string file = (folder_ / "diagnosis.json").string();
  const std::string step =
      R"({"what": "repeat 2 rows twice at once", "separates": ["backlash@j1", "none"],
    "probability_after": 0.97, "rows": [{"set": "t", "q": [0, 1], "repeat": "n1"}, {"set": "t", "q": [0, 1], "repeat": "n1"},
    {"set": "t", "q": [3, 1], "repeat": "n2"}, {"set": "t", "q": [0.5, null], "dq": [1, -1]}]})";
  std::ofstream(file) << R"({"next": [)" << step << R"(], "next_why": ""})";
  const std::string rows = (folder_ / "rows.csv").string();
  const Ran ran = run_selfcal("plan --separate " + file + " --out " + rows, true);
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_EQ(
      ran.out,
      "1  repeat 2 rows twice at once: tells backlash@j1 from none, which is then 97 % sure\n");
  const std::string text = text_of(rows);
  EXPECT_EQ(text.substr(0, text.find('\n')), "set,repeat,q1,q2,dq1,dq2");
  EXPECT_NE(text.find("t,0,0,1,,\nt,0,0,1,,\n"), std::string::npos) << text;
  EXPECT_NE(text.find("t,,0.5,,1,-1\n"), std::string::npos) << text;
  EXPECT_EQ(run_selfcal("plan --separate " + file + " --step 2").status, 2);
  std::ofstream(file) << R"({"next": [{"what": "repeat 2 rows twice at once", "rows": [],
    "separates": ["unknown", "how much is noise"], "probability_after": null}], "next_why": ""})";
  EXPECT_EQ(run_selfcal("plan --separate " + file, true).out,
            "1  repeat 2 rows twice at once: tells how much is noise\n");
  std::ofstream(file) << R"({"next": [{"what": "repeat 2 rows with a payload of 2 kg", "rows": [],
    "separates": ["backlash@j1", "zero_shift@j1"], "probability_after": 0.61}], "next_why": ""})";
  const Ran open = run_selfcal("plan --separate " + file, true);
  EXPECT_EQ(open.status, 1);
  EXPECT_EQ(
      open.out,
      "1  repeat 2 rows with a payload of 2 kg: tells backlash@j1 from zero_shift@j1, which is "
      "then 61 % sure: not enough to name it\n");
  std::ofstream(file) << R"({"next": [], "next_why": "nothing looks like what is named"})";
  const Ran nothing = run_selfcal("plan --separate " + file, true);
  EXPECT_EQ(nothing.status, 1);
  EXPECT_EQ(nothing.out, "nothing to measure: nothing looks like what is named\n");
  for (const char* other : {"null", "[0.5]", "[0, 1, 2]"}) {
    std::ofstream(file) << R"({"next": [{"what": "a", "separates": ["b"], "probability_after": 0.9,
      "rows": [{"set": "t", "q": )"
                        << (other == std::string("null") ? "null" : "[0, 1]")
                        << R"(}, {"set": "t", "q": )" << other << R"(}]}], "next_why": ""})";
    const Ran refused = run_selfcal("plan --separate " + file);
    EXPECT_EQ(refused.status, 3) << other << refused.out;
  }
  std::ofstream(file) << "{}";
  EXPECT_EQ(run_selfcal("plan --separate " + file).status, 3);
  EXPECT_EQ(run_selfcal("plan --separate " + (folder_ / "not_there.json").string()).status, 3);
  EXPECT_EQ(run_selfcal("plan").status, 2);
  EXPECT_EQ(run_selfcal("plan --separate " + file + " --count 3").status, 2);
}

}  // namespace
}  // namespace selfcal
