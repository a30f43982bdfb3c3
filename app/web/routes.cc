#include "app/web/routes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <mutex>

#include "app/report/live/message_json.h"
#include "app/web/live_page.h"

namespace selfcal {
namespace {

using RouteJson = nlohmann::ordered_json;

constexpr std::array<std::string_view, 8> kVerbs = {"start", "check",  "diagnose", "done",
                                                    "abort", "accept", "reject",   "rollback"};

std::string query_of(const WebRequest& request, const char* name) {
  const auto found = request.query.find(name);
  return found == request.query.end() ? "" : found->second;
}

WebResponse state_of_board(const Board& board, const WebRequest& request) {
  std::uint64_t version = 0;
  const std::string text = query_of(request, "version");
  std::from_chars(text.data(), text.data() + text.size(), version);  // else everything
  return {.body = board.changes(query_of(request, "robot"), query_of(request, "epoch"), version)};
}

WebResponse reply_with(int status, bool accepted, const std::string& why) {
  return {.status = status, .body = line_of(RouteJson{{"accepted", accepted}, {"why", why}})};
}

/// What of the status a decision hangs on.
bool as_seen(const RouteJson& status, const RouteJson& seen) {
  return std::ranges::all_of(std::array{"session", "active", "candidate"}, [&](const char* key) {
    return seen.contains(key) && seen[key] == status[key];
  });
}

WebResponse command_from(const Board& board, const Commanding& command, const WebRequest& request) {
  const RouteJson body = RouteJson::parse(request.body, nullptr, false);
  const auto is_text = [&](const char* key) { return body.contains(key) && body[key].is_string(); };
  if (!body.is_object() || !is_text("robot") || !is_text("verb") || !body.contains("seen") ||
      !body["seen"].is_object())
    return reply_with(400, false, R"(expected {"robot", "verb", "seen"})");
  const std::string robot = body["robot"], verb = body["verb"];
  if (std::ranges::find(kVerbs, verb) == kVerbs.end())
    return reply_with(400, false, "there is no such command");
  const auto status = board.part(robot, "status");
  if (!status) return reply_with(404, false, "no service of this robot is heard");
  if (!as_seen(*status, body["seen"]))
    return reply_with(409, false, "the service has gone on since; look again, and decide anew");
  const auto reply = command(robot, verb, request.peer);
  if (!reply) return reply_with(504, false, reply.error().what);
  return reply_with(200, reply->accepted, reply->why);
}

}  // namespace

WebHandler web_routes(const Board& board, Commanding command) {
  auto one = std::make_shared<std::mutex>();
  return [&board, one, command = std::move(command)](const WebRequest& request) -> WebResponse {
    if (request.path == kPagePath)
      return {.type = "text/html; charset=utf-8", .body = std::string(live_page())};
    if (request.path == kStatePath) return state_of_board(board, request);
    const std::unique_lock lock(*one, std::try_to_lock);
    if (!lock) return reply_with(429, false, "another command is on its way");
    return command_from(board, command, request);
  };
}

}  // namespace selfcal
