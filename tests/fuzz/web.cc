// Requests to the live page: what the gate lets pass, and what is answered. Address, headers and
// body are texts after their lengths.
#include <algorithm>
#include <array>

#include "app/web/gate.h"
#include "app/web/routes.h"
#include "tests/fuzz/bytes.h"
#include "tests/fuzz/given.h"

namespace selfcal {
namespace {

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

void try_gate(Bytes& bytes) {
  static constexpr std::array kMethods = {"GET", "POST", "HEAD", "PUT", ""};
  static constexpr std::array kPaths = {kPagePath, kStatePath, kCommandPath, "/other"};
  const GateRules rules{.commands = bytes.byte() % 2 == 1,
                        .token = bytes.byte() % 2 == 1 ? kToken : "",
                        .names = {"cell-7"}};
  RequestHead asked;
  asked.method = kMethods[static_cast<std::size_t>(bytes.below(5))];
  asked.path = kPaths[static_cast<std::size_t>(bytes.below(4))];
  asked.target_bytes = bytes.take<std::uint16_t>();
  asked.host = bytes.text();
  asked.origin = bytes.text();
  asked.site = bytes.text();
  asked.authorization = bytes.text();
  asked.command = bytes.text();
  if (refused(asked, rules)) return;
  promise(asked.target_bytes <= kMostTarget, "an address without end");
  promise(asked.origin.find("evil") == std::string::npos, "a page of another site asks");
  promise(asked.site != "cross-site" || asked.path == kPagePath, "a page of another site asks");
  if (asked.path == kPagePath) return;
  promise(rules.token.empty() || asked.authorization == "Bearer " + rules.token,
          "without the token");
  promise(asked.path != kCommandPath || (rules.commands && !asked.command.empty()),
          "a command that is off");
}

void try_routes(Bytes& bytes) {
  Board board("epoch");
  board.put("rx90", "status", {{"session", 3}, {"active", "factory"}, {"candidate", true}});
  board.append("rx90", "news", "touched", 10);
  board.put(bytes.text(), "status", {{"session", 4}});
  std::string asked_verb;
  const WebHandler handle = web_routes(board,
                                       [&](const std::string&, const std::string& verb,
                                           const std::string&) -> Result<CommandReplyMessage> {
                                         asked_verb = verb;
                                         return CommandReplyMessage{"id", verb, true, "so be it"};
                                       });
  WebRequest request;
  request.path = bytes.byte() % 2 == 0 ? kStatePath : kCommandPath;
  for (const char* key : {"robot", "epoch", "version"}) request.query[key] = bytes.text();
  while (!bytes.empty()) request.body += bytes.text();
  const WebResponse response = handle(request);
  promise(nlohmann::json::accept(response.body), "answers no JSON: " + response.body);
  static constexpr std::array kVerbs = {"start", "check",  "diagnose", "done",
                                        "abort", "accept", "reject",   "rollback"};
  promise(asked_verb.empty() || std::ranges::find(kVerbs, asked_verb) != kVerbs.end(),
          "a verb of its own: " + asked_verb);
}

}  // namespace
}  // namespace selfcal

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace selfcal;
  Bytes bytes(data, size);
  switch (bytes.below(3)) {
    case 0:
      try_gate(bytes);
      break;
    case 1:
      try_routes(bytes);
      break;
    default:
      if (const auto address = parse_web_address(bytes.text())) {
        promise(is_numeric_host(address->host) && address->port >= 0 && address->port < 65536,
                "no address: " + address->url());
        promise(parse_web_address(address->host.find(':') == std::string::npos
                                      ? address->host + ":" + std::to_string(address->port)
                                      : "[" + address->host + "]:" + std::to_string(address->port))
                    .has_value(),
                "an address that is none when written");
      }
  }
  return 0;
}
