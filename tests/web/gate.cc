// Who may ask what: address, token, and the headers by which a stranger is known.
#include "app/web/gate.h"

#include <gmock/gmock.h>

#include <fstream>

#include "app/web/address.h"
#include "app/web/token.h"

namespace selfcal {
namespace {

const GateRules kOpen{.commands = true, .token = "", .names = {"robot7"}};
const GateRules kGuarded{.commands = true, .token = "0123456789abcdef", .names = {}};

RequestHead state_asked() {
  return {.method = "GET", .path = "/state", .target_bytes = 6, .host = "127.0.0.1:8080"};
}

RequestHead command_asked() {
  return {.method = "POST",
          .path = "/command",
          .target_bytes = 8,
          .host = "127.0.0.1:8080",
          .origin = "http://127.0.0.1:8080",
          .site = "same-origin",
          .command = "1"};
}

int status_for(const RequestHead& asked, const GateRules& rules) {
  const auto refusal = refused(asked, rules);
  return refusal ? refusal->status : 200;
}

TEST(Gate, LetsOurOwnPageAskAndCommand) {
  EXPECT_EQ(status_for(state_asked(), kOpen), 200);
  EXPECT_EQ(status_for(command_asked(), kOpen), 200);
}

TEST(Gate, KnowsThisComputerByNumberLocalhostOrName) {
  for (const char* host : {"127.0.0.1", "localhost:8080", "LOCALHOST", "[::1]:8080", "192.168.1.7",
                           "robot7:8080", "Robot7"}) {
    RequestHead asked = state_asked();
    asked.host = host;
    EXPECT_EQ(status_for(asked, kOpen), 200) << host;
  }
  for (const char* host : {"", "evil.example", "evil.example:8080", "127.0.0.1.evil.example",
                           "localhost.evil.example", "robot7.evil.example", "[::1", "1.2.3"}) {
    RequestHead asked = state_asked();
    asked.host = host;
    EXPECT_EQ(status_for(asked, kOpen), 421) << host;
  }
}

TEST(Gate, RefusesPagesOfOtherSites) {
  for (const char* origin : {"http://evil.example", "null", "http://127.0.0.1:8081",
                             "http://127.0.0.1:8080.evil.example", "ftp://127.0.0.1:8080"}) {
    RequestHead asked = command_asked();
    asked.origin = origin;
    EXPECT_EQ(status_for(asked, kOpen), 403) << origin;
  }
  for (const char* site : {"cross-site", "same-site"}) {
    RequestHead asked = state_asked();
    asked.site = site;
    EXPECT_EQ(status_for(asked, kOpen), 403) << site;
    asked.path = "/";  // a link to the page
    EXPECT_EQ(status_for(asked, kOpen), 200) << site;
  }
}

TEST(Gate, TakesNoCommandUnlessToldAndWithItsHeader) {
  GateRules shows = kOpen;
  shows.commands = false;
  EXPECT_EQ(status_for(command_asked(), shows), 403);
  RequestHead plain = command_asked();  // as a form of another site could send it
  plain.command = "";
  EXPECT_EQ(status_for(plain, kOpen), 403);
}

TEST(Gate, AsksForTheTokenOfAllButThePage) {
  for (const char* wrong : {"", "Bearer ", "Bearer 0123456789abcdeg", "Bearer 0123456789abcdef0",
                            "Basic 0123456789abcdef", "0123456789abcdef"}) {
    for (RequestHead asked : {state_asked(), command_asked()}) {
      asked.authorization = wrong;
      EXPECT_EQ(status_for(asked, kGuarded), 401) << asked.path << " " << wrong;
    }
  }
  RequestHead asked = state_asked();
  asked.authorization = "Bearer 0123456789abcdef";
  EXPECT_EQ(status_for(asked, kGuarded), 200);
  asked.authorization = "";
  asked.path = "/";
  EXPECT_EQ(status_for(asked, kGuarded), 200);
}

TEST(Gate, HasThreePathsEachWithItsMethod) {
  RequestHead asked = state_asked();
  asked.path = "/etc/passwd";
  EXPECT_EQ(status_for(asked, kOpen), 404);
  asked = state_asked();
  asked.method = "POST";
  EXPECT_EQ(status_for(asked, kOpen), 405);
  asked = command_asked();
  asked.method = "GET";
  EXPECT_EQ(status_for(asked, kOpen), 405);
  asked = state_asked();
  asked.target_bytes = kMostTarget + 1;
  EXPECT_EQ(status_for(asked, kOpen), 414);
}

TEST(WebAddress, IsANumberAndAPort) {
  const auto v4 = parse_web_address("127.0.0.1:8080");
  ASSERT_TRUE(v4);
  EXPECT_EQ(v4->url(), "http://127.0.0.1:8080/");
  EXPECT_TRUE(v4->loopback);
  const auto v6 = parse_web_address("[::1]:80");
  ASSERT_TRUE(v6);
  EXPECT_EQ(v6->url(), "http://[::1]:80/");
  EXPECT_TRUE(v6->loopback);
  EXPECT_EQ(parse_web_address("localhost:1")->host, "127.0.0.1");
  EXPECT_FALSE(parse_web_address("0.0.0.0:8080")->loopback);
  EXPECT_FALSE(parse_web_address("192.168.1.7:8080")->loopback);
  EXPECT_FALSE(parse_web_address("[::]:8080")->loopback);
  for (const char* wrong :
       {"", "8080", ":8080", "127.0.0.1", "127.0.0.1:", "127.0.0.1:65536", "127.0.0.1:-1",
        "127.0.0.1:80x", "robot7:80", "::1:80", "[127.0.0.1]:80"})
    EXPECT_FALSE(parse_web_address(wrong)) << wrong;
}

TEST(Token, IsReadOnlyWhereNobodyElseCan) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / ("token_" + std::to_string(getpid()));
  const auto permit = [&](std::filesystem::perms bits) {
    std::filesystem::permissions(file, bits);
  };
  std::ofstream(file) << "0123456789abcdef\n";
  using std::filesystem::perms;
  permit(perms::owner_read | perms::owner_write);
  EXPECT_EQ(read_token(file).value_or(""), "0123456789abcdef");
  permit(perms::owner_read | perms::owner_write | perms::group_read);
  EXPECT_FALSE(read_token(file));
  permit(perms::owner_read | perms::owner_write);
  std::ofstream(file) << "short\n";
  EXPECT_FALSE(read_token(file));
  std::ofstream(file) << "0123456789 abcdef\n";
  EXPECT_FALSE(read_token(file));
  std::filesystem::remove(file);
  EXPECT_FALSE(read_token(file));
}

TEST(Token, IsNewEachTime) {
  const auto one = new_token(), two = new_token();
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->size(), 32);
  EXPECT_NE(*one, *two);
  EXPECT_TRUE(same_token(*one, *one));
  EXPECT_FALSE(same_token(*one, *two));
  EXPECT_FALSE(same_token(*one, one->substr(1)));
}

}  // namespace
}  // namespace selfcal
