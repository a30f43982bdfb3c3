// The server over real sockets: what it answers, what it refuses, and that nobody can hold it.
#include "app/web/server.h"

#include <gmock/gmock.h>

#include <vector>

#include "io/clock.h"
#include "tests/web/http.h"

namespace selfcal {
namespace {

using ::testing::HasSubstr;

class WebServerTest : public ::testing::Test {
 protected:
  void open(const ServerLimits& limits = {}, const GateRules& rules = {.commands = true}) {
    auto opened = WebServer::open(
        {"127.0.0.1", 0, true}, rules, limits, [](const WebRequest& request) -> WebResponse {
          const auto robot = request.query.find("robot");
          return {.body = request.path + "|" + request.body + "|" +
                          (robot == request.query.end() ? "" : robot->second)};
        });
    ASSERT_TRUE(opened) << opened.error().what;
    server = *std::move(opened);
    port = server->address().port;
  }

  std::unique_ptr<WebServer> server;
  int port = 0;
};

constexpr const char* kCommand = "X-Selfcal-Command: 1\r\n";

TEST_F(WebServerTest, HandsRequestsToItsHandler) {
  open();
  EXPECT_EQ(body_of(ask(port, get("/"))), "/||");
  EXPECT_EQ(body_of(ask(port, get("/state?robot=r%20x"))), "/state||r x");
  EXPECT_EQ(body_of(ask(port, post("/command", "{}", kCommand))), "/command|{}|");
}

TEST_F(WebServerTest, ForbidsToKeepToFrameAndToShare) {
  open();
  const std::string answer = ask(port, get("/state"));
  EXPECT_THAT(answer, HasSubstr("Cache-Control: no-store"));
  EXPECT_THAT(answer, HasSubstr("X-Frame-Options: DENY"));
  EXPECT_THAT(answer, HasSubstr("X-Content-Type-Options: nosniff"));
  EXPECT_EQ(answer.find("Access-Control-"), std::string::npos);
}

TEST_F(WebServerTest, RefusesWhatTheGateRefuses) {
  open({}, {.commands = false, .token = "0123456789abcdef", .names = {}});
  const std::string token = "Authorization: Bearer 0123456789abcdef\r\n";
  EXPECT_EQ(status_of(ask(port, get("/state", token))), 200);
  EXPECT_EQ(status_of(ask(port, get("/state"))), 401);
  EXPECT_EQ(status_of(ask(port, get("/state", token + "Host: evil.example\r\n"))), 421);
  EXPECT_EQ(status_of(ask(port, get("/state", token + "Origin: http://evil.example\r\n"))), 403);
  EXPECT_EQ(status_of(ask(port, post("/command", "{}", token + kCommand))), 403);
  EXPECT_EQ(status_of(ask(port, get("/../etc/passwd"))), 404);
  EXPECT_EQ(status_of(ask(port, get("/" + std::string(1000, 'a')))), 414);
}

TEST_F(WebServerTest, RefusesABodyThatIsTooLarge) {
  open({.body = 1024});
  EXPECT_EQ(status_of(ask(port, post("/command", std::string(1024, 'x'), kCommand))), 200);
  EXPECT_EQ(status_of(ask(port, post("/command", std::string(1025, 'x'), kCommand))), 413);
}

TEST_F(WebServerTest, CutsOffARequestWithoutEnd) {
  open({.request = 16384, .request_seconds = 60});
  // In pieces whose lengths nobody has announced.
  Caller caller(port);
  caller.send("POST /command HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n" +
              std::string(kCommand) + "\r\n");
  const std::string piece = "400\r\n" + std::string(1024, 'x') + "\r\n";
  for (int i = 0; i < 64; ++i)
    if (!caller.send(piece)) break;
  EXPECT_NE(status_of(caller.rest()), 200);
}

TEST_F(WebServerTest, TakesNoRequestOutOfARefusedBody) {
  open({}, {.commands = false});
  Caller caller(port);
  const std::string hidden = "GET /state HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
  caller.send("POST /command HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: " +
              std::to_string(hidden.size()) + "\r\n\r\n" + hidden);
  const std::string answer = caller.rest();
  EXPECT_EQ(status_of(answer), 403);
  EXPECT_EQ(answer.find("/state|"), std::string::npos) << answer;
}

TEST_F(WebServerTest, AnswersManyRequestsOfOneConnection) {
  open();
  Caller caller(port);
  std::string requests;
  for (int i = 0; i < 20; ++i)
    requests += "GET /state?robot=" + std::to_string(i) + " HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
  caller.send(requests + get("/state?robot=end"));
  const std::string answers = caller.rest();
  for (int i = 0; i < 20; ++i) EXPECT_THAT(answers, HasSubstr("/state||" + std::to_string(i)));
  EXPECT_THAT(answers, HasSubstr("/state||end"));
}

TEST_F(WebServerTest, EndsARequestThatDripsInByteByByte) {
  open({.request_seconds = 0.3});
  Caller caller(port);
  const Nanoseconds began = monotonic_now();
  // Each wait for an answer is the pause between two bytes.
  while (caller.send("G") && seconds(monotonic_now() - began) < 10)
    if (!caller.rest(0.02).empty()) break;
  EXPECT_LT(seconds(monotonic_now() - began), 5);
}

TEST_F(WebServerTest, AnswersBesideACrowdOfSlowOnes) {
  open({.connections = 8, .request_seconds = 60, .idle_seconds = 60});
  std::vector<Caller> silent;
  for (int i = 0; i < 60; ++i) {
    silent.emplace_back(port);
    if (i % 2 == 0) silent.back().send("GET /state HTTP/1.1\r\nHo");
  }
  const Nanoseconds began = monotonic_now();
  for (int i = 0; i < 5; ++i) EXPECT_EQ(body_of(ask(port, get("/state"))), "/state||");
  EXPECT_LT(seconds(monotonic_now() - began), 10) << "well below the 60 s of each of the crowd";
}

TEST_F(WebServerTest, EndsAtOnceWhateverIsOpen) {
  open({.request_seconds = 60, .idle_seconds = 60});
  std::vector<Caller> open_ones;
  for (int i = 0; i < 20; ++i) {
    open_ones.emplace_back(port);
    open_ones.back().send("GET /state HTTP/1.1\r\nHost: 127.0.0.1\r\n" +
                          std::string(i % 2 ? "\r\n" : ""));
  }
  ASSERT_EQ(status_of(ask(port, get("/state"))), 200);
  const Nanoseconds began = monotonic_now();
  server.reset();
  EXPECT_LT(seconds(monotonic_now() - began), 1);
}

TEST_F(WebServerTest, SaysWhenItsAddressIsTaken) {
  open();
  const auto second = WebServer::open({"127.0.0.1", port, true}, {}, {},
                                      [](const WebRequest&) { return WebResponse{}; });
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().exit_status, kDeviceFailed);
}

}  // namespace
}  // namespace selfcal
