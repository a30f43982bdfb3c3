// The program as its user runs it: `selfcal monitor --web` beside services that this test plays.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/report/live/message_json.h"
#include "io/dds/messenger.h"
#include "tests/support/domain.h"
#include "tests/support/process.h"
#include "tests/support/text.h"
#include "tests/web/http.h"

namespace selfcal {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class LivePage : public DdsTest {
 protected:
  LivePage()
      : log(std::filesystem::path(testing::TempDir()) /
            (std::string("page_") + testing::UnitTest::GetInstance()->current_test_info()->name() +
             ".log")) {
    std::filesystem::remove(log);
  }

  void serve(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"monitor", "--web", "127.0.0.1:0", "--domain",
                                          std::to_string(domain)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    monitor = std::make_unique<Running>(arguments, log);
    const std::string before = "http://127.0.0.1:";
    ASSERT_TRUE(eventually([&] {
      const std::string text = std::filesystem::exists(log) ? text_of(log) : "";
      const std::size_t at = text.find(before);
      if (at != std::string::npos && text.find('\n', at) != std::string::npos)
        port = std::stoi(text.substr(at + before.size()));
      return port > 0;
    })) << text_of(log);
  }

  json state(const std::string& robot) {
    return json::parse(body_of(ask(port, get("/state?robot=" + robot))));
  }
  /// Until the robot's part is there and equals what was sent.
  bool eventually_shows(const std::string& robot, const std::string& part, const json& value) {
    return eventually([&] {
      const json got = state(robot);
      return got["known"] == true && got["parts"].contains(part) && got["parts"][part] == value;
    });
  }
  std::string command(const std::string& verb, std::int64_t session) {
    const json body = {
        {"robot", "rx90"},
        {"verb", verb},
        {"seen", {{"session", session}, {"active", "factory"}, {"candidate", true}}}};
    return ask(port, post("/command", body.dump(), "X-Selfcal-Command: 1\r\n"));
  }
  std::unique_ptr<DdsMessenger> service(const std::string& robot) {
    return must(DdsMessenger::open(participant, robot, wakeup));
  }

  std::filesystem::path log;
  std::unique_ptr<Running> monitor;
  int port = 0;
};

StatusMessage waiting() {
  StatusMessage status;
  status.unix_ms = 1'790'000'000'123;
  status.robot = "rx90";
  status.state = "awaiting-acceptance";
  status.why = "a result waits: \"accept\" or <reject>";
  status.session = 4;
  status.kind = "full";
  status.active = "factory";
  status.candidate = true;
  status.temperature = 21.5;
  return status;
}

TEST_F(LivePage, ShowsWhatTheServiceTells) {
  const auto told = service("rx90");
  serve();
  told->publish(waiting());
  const std::vector<HealthMessage> health = {
      {.name = "selfcal: store", .level = Health::warn, .message = "nearly full", .values = {}}};
  const auto other = service("irb1600");
  EXPECT_TRUE(eventually_shows("rx90", "status", json::parse(line_of(to_json(waiting())))));

  // Health is for whoever listens at that moment, so a service says it once a second.
  ASSERT_TRUE(eventually([&] {
    told->publish(health, "serial");
    other->publish(
        {{.name = "selfcal: store", .level = Health::error, .message = "full", .values = {}}},
        "serial");
    return state("rx90")["parts"].contains("health");
  }));
  const json lines = state("rx90")["parts"]["health"]["lines"];
  ASSERT_EQ(lines.size(), 1) << "and not the other robot's";
  EXPECT_EQ(lines[0]["level"], "warn");
  EXPECT_EQ(lines[0]["message"], "nearly full");

  for (std::uint32_t i = 0; i < 3; ++i) {
    const ProgressMessage touch{.unix_ms = 5,
                                .robot = "rx90",
                                .session = 5,
                                .kind = "full",
                                .done = i + 1,
                                .planned = 240,
                                .set = "table",
                                .index = i,
                                .residual = 1e-6 * i,
                                .accepted = i != 1,
                                .note = i == 1 ? "too early" : ""};
    told->publish(touch);
    ASSERT_TRUE(eventually_shows("rx90", "progress", json::parse(line_of(to_json(touch)))));
  }
  const json touches = state("rx90")["lists"]["touches"]["items"];
  ASSERT_EQ(touches.size(), 3);
  EXPECT_EQ(touches[1]["accepted"], false);
  EXPECT_EQ(touches[1]["note"], "too early");
  EXPECT_EQ(touches[2]["residual"], 2e-6);

  ResultMessage sent;
  sent.robot = "rx90";
  sent.session = 4;
  sent.kind = "full";
  sent.answer = "improved";
  sent.decision = "candidate";
  sent.check_before = 2e-3;
  sent.check_after = 2e-5;
  sent.json =
      R"({"parameters": [{"name": "d2", "frame": "j2", "unit": "m", "nominal": 0.1, "value": 0.102, "sigma": 1e-5}],
          "residual": {"check": {"by_set": [{"name": "table", "rows": 9, "rms_before": 1e-3, "rms_after": 1e-5}]}}})";
  told->publish(sent);
  ASSERT_TRUE(eventually([&] { return state("rx90")["parts"].contains("result"); }));
  const json result = state("rx90")["parts"]["result"];
  EXPECT_EQ(result["check_after"], 2e-5);
  EXPECT_EQ(result["changes"]["rows"][0]["name"], "d2 j2.d");
  EXPECT_EQ(result["sets"][0]["after"], 1e-5);
  EXPECT_FALSE(result.contains("result")) << "the covariance is for nobody's eyes";
  EXPECT_TRUE(eventually([&] {
    const json fleet = state("rx90")["domain"]["fleet"];
    return fleet.size() == 2 && fleet[1]["robot"] == "rx90" && fleet[1]["off"] == 2e-3;
  }));
}

/// That the loopback interface has received: of all programs of this network namespace.
double loopback_bytes() {
  std::ifstream devices("/proc/net/dev");
  for (std::string name; devices >> name;)
    if (double bytes = 0; name == "lo:" && devices >> bytes) return bytes;
  return 0;
}

TEST_F(LivePage, IsOnePageThatLoadsNothingFromElsewhere) {
  serve();
  const std::string answer = ask(port, get("/"));
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_THAT(answer, HasSubstr("text/html"));
  const std::string page = body_of(answer);
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  for (const char* left : {"{{style}}", "{{script}}", "{{chart}}", "<script src", "@import"})
    EXPECT_EQ(page.find(left), std::string::npos) << left;
}

TEST_F(LivePage, OnlyShowsUnlessToldOtherwise) {
  const auto told = service("rx90");
  serve();
  told->publish(waiting());
  ASSERT_TRUE(eventually_shows("rx90", "status", json::parse(line_of(to_json(waiting())))));
  EXPECT_EQ(status_of(command("accept", 4)), 403);
  std::vector<CommandMessage> heard;
  told->take(heard);
  EXPECT_TRUE(heard.empty());
}

TEST_F(LivePage, CommandsTheServiceThatThePersonHasSeen) {
  const auto told = service("rx90");
  serve({"--allow-commands"});
  told->publish(waiting());
  ASSERT_TRUE(eventually_shows("rx90", "status", json::parse(line_of(to_json(waiting())))));

  EXPECT_EQ(status_of(command("accept", 3)), 409) << "another session's result waits by now";
  EXPECT_EQ(status_of(command("format", 4)), 400);
  EXPECT_EQ(status_of(ask(port, post("/command", "{", "X-Selfcal-Command: 1\r\n"))), 400);
  EXPECT_EQ(status_of(ask(port, post("/command", "{}", ""))), 403);

  std::string answer;
  std::jthread asking([&] { answer = command("accept", 4); });
  std::vector<CommandMessage> heard;
  ASSERT_TRUE(eventually([&] {
    told->take(heard);
    return !heard.empty();
  }));
  EXPECT_EQ(heard[0].verb, "accept");
  EXPECT_THAT(heard[0].from, HasSubstr("page, from 127.0.0.1"));
  told->reply({.id = heard[0].id, .verb = "accept", .accepted = false, .why = "busy"});
  asking.join();
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_EQ(json::parse(body_of(answer)), json({{"accepted", false}, {"why", "busy"}}));
  told->take(heard);
  EXPECT_EQ(heard.size(), 1) << "what was refused before never came here";
}

TEST_F(LivePage, WatchesFiftyRobots) {
  constexpr int kSeconds = 6, kFinding = 3;
  const char* many = std::getenv("SELFCAL_FLEET");
  const int kRobots = many ? std::atoi(many) : 50;
  std::vector<std::unique_ptr<DdsMessenger>> services;
  for (int i = 0; i < kRobots; ++i) services.push_back(service("robot_" + std::to_string(i)));
  serve();
  const std::vector<HealthMessage> health(
      5, {.name = "selfcal: part", .level = Health::ok, .message = "well", .values = {{"a", "1"}}});
  std::size_t asked = 0, bytes = 0;
  json domain_part;
  const auto tell_all = [&](int turn) {
    for (int i = 0; i < kRobots; ++i) {
      StatusMessage status = waiting();
      status.robot = "robot_" + std::to_string(i);
      status.unix_ms += turn;
      status.state = i == 7 ? "fault" : "collecting";
      status.candidate = false;
      services[i]->publish(status);
      services[i]->publish(health, status.robot);
      services[i]->publish(ProgressMessage{.unix_ms = turn,
                                           .robot = status.robot,
                                           .session = 4,
                                           .kind = "full",
                                           .done = static_cast<std::uint32_t>(turn),
                                           .planned = 240,
                                           .set = "table",
                                           .residual = 1e-6,
                                           .accepted = true,
                                           .note = {}});
    }
  };
  // As services do once a second, while a page asks four times.
  const Nanoseconds began = monotonic_now();
  double cpu = cpu_seconds(monitor->pid());
  double heard_before = 0;  // once everyone has found everyone
  std::uint64_t version = 0;
  std::string epoch;
  for (Nanoseconds next = began; next < began + kSeconds * kSecond; next += kSecond / 4) {
    while (monotonic_now() < next) wakeup.wait(next - monotonic_now());
    if (asked == 4 * kFinding) heard_before = loopback_bytes();
    if (asked++ % 4 == 0) tell_all(static_cast<int>(asked));
    const std::string answer = ask(
        port, get("/state?robot=robot_3&epoch=" + epoch + "&version=" + std::to_string(version)));
    bytes += answer.size();
    const json got = json::parse(body_of(answer));
    version = got["version"];
    epoch = got["epoch"];
    if (got["domain"].contains("fleet")) domain_part = got["domain"]["fleet"];
  }
  cpu = cpu_seconds(monitor->pid()) - cpu;
  std::printf(
      "%d robots: %.1f %% of a core, a page is told %.1f kB/s, over the loopback interface in all "
      "%.0f kB/s\n",
      kRobots, 100 * cpu / kSeconds, static_cast<double>(bytes) / 1000 / kSeconds,
      (loopback_bytes() - heard_before) / 1000 / (kSeconds - kFinding));
  ASSERT_EQ(domain_part.size(), kRobots);
  EXPECT_EQ(domain_part[0]["robot"], "robot_7");
  for (const json& line : domain_part) EXPECT_EQ(line["health"], "ok") << line["robot"];
  EXPECT_LT(cpu, 0.5 * kSeconds);
}

TEST_F(LivePage, EndsWhenItIsTold) {
  serve({"--allow-commands"});
  Caller idle(port);
  const Nanoseconds began = monotonic_now();
  EXPECT_EQ(monitor->end(SIGTERM), 0);
  EXPECT_LT(seconds(monotonic_now() - began), 20);  // a fraction of one where nothing else runs
}

TEST_F(LivePage, PrintsATokenWhereOthersReachIt) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  ASSERT_EQ(grantpt(terminal), 0);
  ASSERT_EQ(unlockpt(terminal), 0);
  monitor = std::make_unique<Running>(
      std::vector<std::string>{"monitor", "--web", "0.0.0.0:0", "--domain", std::to_string(domain)},
      ptsname(terminal));
  const std::string before = "#token=";
  std::string token, text;
  ASSERT_TRUE(eventually([&] {
    char some[256];
    if (const ssize_t got = ::read(terminal, some, sizeof some); got > 0) text.append(some, got);
    const std::size_t at = text.find(before), end = text.find('\r', at);
    if (at == std::string::npos || end == std::string::npos) return false;
    token = text.substr(at + before.size(), end - at - before.size());
    port = std::stoi(text.substr(text.find("0.0.0.0:") + 8));
    return true;
  }));
  EXPECT_EQ(token.size(), 32);
  EXPECT_EQ(status_of(ask(port, get("/state"))), 401);
  EXPECT_EQ(status_of(ask(port, get("/state", "Authorization: Bearer " + token + "\r\n"))), 200);
  monitor.reset();
  close(terminal);
}

TEST_F(LivePage, PrintsNoTokenIntoALog) {
  monitor = std::make_unique<Running>(
      std::vector<std::string>{"monitor", "--web", "0.0.0.0:0", "--domain", std::to_string(domain)},
      log);
  EXPECT_EQ(monitor->wait(), kMisused);
  EXPECT_NE(text_of(log).find("give one by --token FILE"), std::string::npos) << text_of(log);
  EXPECT_EQ(text_of(log).find("#token="), std::string::npos);

  const std::string secret = "0123456789abcdef0123456789abcdef", file = log.string() + ".token";
  std::ofstream(file) << secret << "\n";
  std::filesystem::permissions(file, std::filesystem::perms::owner_read);
  monitor = std::make_unique<Running>(
      std::vector<std::string>{"monitor", "--web", "0.0.0.0:0", "--domain", std::to_string(domain),
                               "--token", file},
      log);
  ASSERT_TRUE(
      eventually([&] { return text_of(log).find("asks for the token") != text_of(log).npos; }));
  const std::string all = text_of(log);
  port = std::stoi(all.substr(all.find("0.0.0.0:", all.find("the page is at")) + 8));
  EXPECT_EQ(status_of(ask(port, get("/state"))), 401);
  EXPECT_EQ(status_of(ask(port, get("/state", "Authorization: Bearer " + secret + "\r\n"))), 200);
  EXPECT_EQ(monitor->end(SIGTERM), 0);
  monitor.reset();
  EXPECT_EQ(text_of(log).find(secret), std::string::npos);
}

}  // namespace
}  // namespace selfcal
