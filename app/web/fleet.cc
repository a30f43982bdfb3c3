#include "app/web/fleet.h"

#include <algorithm>
#include <array>

#include "app/report/format.h"
#include "app/report/message_json.h"
#include "io/files/json_parts.h"
#include "io/outcome.h"

namespace selfcal {
namespace {

constexpr std::array<std::string_view, 5> kConcerns = {"none", "warning", "waits", "error",
                                                       "silent"};

const HealthMessage* worst_of(const std::vector<HealthMessage>& health) {
  const auto worst = std::ranges::max_element(health, {}, &HealthMessage::level);
  return worst == health.end() ? nullptr : &*worst;
}

bool is_silent(const Watched& watched) { return !watched.status || watched.silent >= kSilence; }

/// The result that was applied has replaced what missed the touches by so much.
nlohmann::ordered_json off_by(const Watched& watched) {
  if (!watched.result || parse_answer(watched.result->answer) == ResultAnswer::failed)
    return nullptr;
  const ResultMessage& r = *watched.result;
  const bool check = r.kind == "check";
  const bool applied = parse_decision(r.decision) == ResultDecision::applied;
  return finite(check || applied ? r.check_after : r.check_before);
}

std::string why_of(const Watched& watched, Concern concern) {
  const HealthMessage* worst = worst_of(watched.health);
  switch (concern) {
    case Concern::silent:
      return watched.status ? "nothing heard for " + duration(watched.silent)
                            : "no status heard yet";
    case Concern::error:
      if (watched.status->state == "fault") return watched.status->why;
      return worst->message;
    case Concern::waits:
      return "a result waits: accept or reject";
    case Concern::warning:
      return worst->message;
    case Concern::none:
      break;
  }
  return "";
}

}  // namespace

Concern concern_of(const Watched& watched) {
  if (is_silent(watched)) return Concern::silent;
  const HealthMessage* worst = worst_of(watched.health);
  const Health level = worst ? worst->level : Health::ok;
  if (watched.status->state == "fault" || level >= Health::error) return Concern::error;
  if (watched.status->candidate) return Concern::waits;
  return level == Health::warn ? Concern::warning : Concern::none;
}

std::string_view to_string(Concern concern) { return kConcerns[static_cast<std::size_t>(concern)]; }

nlohmann::ordered_json fleet_line(const Watched& watched) {
  const Concern concern = concern_of(watched);
  nlohmann::ordered_json line = {
      {"robot", watched.robot}, {"concern", to_string(concern)}, {"why", why_of(watched, concern)}};
  const StatusMessage status = watched.status.value_or(StatusMessage{});
  const bool progress = watched.progress && watched.progress->session == status.session &&
                        status.state != "idle" && status.state != "awaiting-acceptance";
  const HealthMessage* worst = worst_of(watched.health);
  line["state"] = status.state;
  line["session"] = status.session;
  line["done"] = progress ? watched.progress->done : 0;
  line["planned"] = progress ? watched.progress->planned : 0;
  line["health"] = worst ? to_string(worst->level) : "";
  line["candidate"] = status.candidate;
  line["active"] = status.active;
  line["result"] = nullptr;
  if (const auto& r = watched.result)
    line["result"] = {{"unix_ms", r->unix_ms},
                      {"kind", r->kind},
                      {"answer", r->answer},
                      {"decision", r->decision}};
  line["off"] = off_by(watched);
  line["next_due_ms"] = status.next_due_ms;
  line["silent"] = concern == Concern::silent;
  return line;
}

nlohmann::ordered_json fleet_json(std::vector<nlohmann::ordered_json> lines) {
  const auto rank = [](const nlohmann::ordered_json& line) {
    const auto at = std::ranges::find(kConcerns, line["concern"].get_ref<const std::string&>());
    return std::pair(kConcerns.end() - at, line["robot"].get<std::string>());
  };
  std::ranges::sort(lines, {}, rank);
  return lines;
}

}  // namespace selfcal
