// Watching, commanding and looking back: the real program, with the service in another process.
#include <gtest/gtest.h>
#include <signal.h>

#include <map>
#include <sstream>

#include "io/store/store.h"
#include "tests/app/cell.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

using Json = nlohmann::json;

class ServiceCommands : public CellTest {
 protected:
  static bool ready(const Json& message) {
    return message["topic"] == "status" && message["state"] == "idle";
  }
};

TEST_F(ServiceCommands, MonitorsOnceInJson) {
  const auto service = serve("rx90");
  ASSERT_FALSE(heard(ready).is_null());

  const Ran ran = run_selfcal("monitor --once --json --wait 20" + in_domain());

  ASSERT_EQ(ran.status, 0) << ran.out;
  std::istringstream lines(ran.out);
  std::map<std::string, Json> by_topic;
  for (std::string line; std::getline(lines, line);)
    by_topic[Json::parse(line)["topic"]] = Json::parse(line);
  ASSERT_TRUE(by_topic.contains("status")) << ran.out;
  EXPECT_EQ(by_topic["status"]["robot"], "rx90");
  EXPECT_EQ(by_topic["status"]["active"], "factory");
  ASSERT_TRUE(by_topic.contains("health")) << ran.out;
  EXPECT_EQ(by_topic["health"]["lines"].size(), 5);
  EXPECT_FALSE(by_topic.contains("result"));
}

TEST_F(ServiceCommands, TestThemselvesForAsLongAsTheLimitSays) {
  const auto service = serve("rx90", "limits: {self_test: 1}\n");

  const Json first = heard([](const Json& message) { return message["topic"] == "status"; });

  EXPECT_FALSE(first.is_null());
  EXPECT_FALSE(heard(ready).is_null());
  EXPECT_EQ(text_of(folder / "rx90.log").find("fault"), std::string::npos)
      << text_of(folder / "rx90.log");
}

TEST_F(ServiceCommands, SayWhenNoServiceIsHeard) {
  for (const std::string command : {"monitor --once", "monitor --once --robot rx90", "monitor",
                                    "command start", "command start --robot rx90"}) {
    const Ran ran = run_selfcal(command + " --wait 0.3" + in_domain());
    EXPECT_EQ(ran.status, 4) << command;
    EXPECT_NE(ran.out.find("no service"), std::string::npos) << command << ": " << ran.out;
  }
}

TEST_F(ServiceCommands, RefuseAWrongVerbAndTellTheServicesReason) {
  const auto service = serve("rx90");
  ASSERT_FALSE(heard(ready).is_null());

  const Ran wrong = run_selfcal("command calibrate --wait 20" + in_domain());
  const Ran refused = run_selfcal("command reject --wait 20" + in_domain());
  const Ran in_json = run_selfcal("command reject --robot rx90 --json --wait 20" + in_domain());

  EXPECT_EQ(wrong.status, 2);
  EXPECT_EQ(refused.status, 1);
  EXPECT_EQ(refused.out, "refused: no result waits for acceptance\n");
  EXPECT_EQ(in_json.status, 1);
  EXPECT_EQ(Json::parse(in_json.out)["accepted"], false);
  EXPECT_EQ(Json::parse(in_json.out)["why"], "no result waits for acceptance");
}

TEST_F(ServiceCommands, ShowEveryRobotOfTheDomainAndAskWhichIsMeant) {
  const auto first = serve("left");
  ASSERT_FALSE(heard(ready).is_null());
  const auto second = serve("right");
  ASSERT_EQ(run_selfcal("monitor --once --robot right --wait 20" + in_domain()).status, 0);

  const Ran table = run_selfcal("monitor --once --wait 20" + in_domain());
  const Ran json = run_selfcal("monitor --once --json --wait 20" + in_domain(), true);
  const Ran command = run_selfcal("command start --wait 20" + in_domain());

  EXPECT_EQ(table.status, 0) << table.out;
  EXPECT_EQ(table.out.rfind("2 robots", 0), 0U) << table.out;
  EXPECT_NE(table.out.find("\nleft "), std::string::npos) << table.out;
  EXPECT_NE(table.out.find("\nright "), std::string::npos) << table.out;
  std::map<std::string, int> statuses;
  std::istringstream lines(json.out);
  for (std::string line; std::getline(lines, line);)
    if (const Json message = Json::parse(line); message["topic"] == "status")
      ++statuses[message["robot"]];
  EXPECT_EQ(statuses, (std::map<std::string, int>{{"left", 1}, {"right", 1}})) << json.out;
  EXPECT_EQ(command.status, 2);
  EXPECT_NE(command.out.find("left, right"), std::string::npos) << command.out;
}

TEST_F(ServiceCommands, EndTheMonitorOnInterrupt) {
  const auto service = serve("rx90");
  ASSERT_FALSE(heard(ready).is_null());
  Running monitor({"monitor", "--robot", "rx90", "--domain", std::to_string(domain)},
                  folder / "monitor.log");
  ASSERT_EQ(run_selfcal("monitor --once --wait 20" + in_domain()).status, 0);

  EXPECT_EQ(monitor.end(SIGINT), 0);
}

TEST_F(ServiceCommands, HoldTheMonitorStillAndLeaveItByAKey) {
  const auto service = serve("rx90");
  ASSERT_FALSE(heard(ready).is_null());
  // script(1) gives it a terminal.
  const Ran ran = run_in_bash(
      "(sleep 2; printf p; sleep 1; printf p; sleep 1; printf q; sleep 20) | "
      "timeout 15 script -qec \"" SELFCAL_BINARY " monitor --robot rx90 --wait 20" +
      in_domain() + "\" /dev/null");
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_NE(ran.out.find("p: hold still   q: leave"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("HELD STILL"), std::string::npos) << ran.out;
}

/// Identified parameters and their sigma, by name.
std::map<std::string, std::pair<double, double>> identified(const Json& solution) {
  std::map<std::string, std::pair<double, double>> values;
  for (const Json& p : solution["parameters"])
    if (p["status"] == "identified") values[p["name"]] = {p["value"], p["sigma"]};
  return values;
}

TEST_F(ServiceCommands, TellOfASessionThatSolvesAgainToTheSameResult) {
  const auto service = serve("rx90");
  ASSERT_FALSE(heard(ready).is_null());
  ASSERT_EQ(run_selfcal("command start --wait 20" + in_domain()).out, "accepted\n");
  const Json result = heard([](const Json& m) { return m["topic"] == "result"; });
  ASSERT_EQ(result["decision"], "candidate") << result;
  ASSERT_EQ(run_selfcal("command accept --wait 20" + in_domain()).status, 0);
  ASSERT_FALSE(heard([](const Json& m) {
                 return m["topic"] == "status" && m["active"] == "session 1" &&
                        m["state"] == "idle";
               }).is_null());

  const Ran table = run_selfcal("history " + config("rx90").string());
  const Ran records = run_selfcal("history --json " + (folder / "state_rx90").string());
  const Ran exported = run_selfcal("history " + (folder / "state_rx90").string() + " --export 1 " +
                                   (folder / "again").string());
  const Ran again = run_selfcal("identify --json " + (folder / "again").string());

  EXPECT_EQ(table.status, 0);
  EXPECT_NE(table.out.find("improved"), std::string::npos) << table.out;
  EXPECT_NE(table.out.find("active     session 1"), std::string::npos) << table.out;
  EXPECT_EQ(Json::parse(records.out)[0]["result"]["decision"], "applied");
  EXPECT_EQ(exported.status, 0) << exported.out;
  ASSERT_EQ(again.status, 0) << again.out;
  const auto was = identified(result["result"]),
             is = identified(
                 Json::parse(again.out.substr(again.out.find('{'))));  // after the progress
  ASSERT_GT(was.size(), 15);
  EXPECT_EQ(was.size(), is.size());
  for (const auto& [name, value] : was) {
    ASSERT_TRUE(is.contains(name)) << name;
    // The rows are the same to the bit; what remains is where the iteration stops.
    EXPECT_NEAR(is.at(name).first, value.first, 1e-3 * value.second) << name;
  }
}

}  // namespace
}  // namespace selfcal
