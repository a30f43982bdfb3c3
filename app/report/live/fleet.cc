#include "app/report/live/fleet.h"

#include <algorithm>
#include <array>
#include <map>

#include "app/report/format.h"
#include "app/report/live/message_json.h"
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

/// By how much the parameters that are active miss the touches of the last result; nothing where it
/// speaks of others, which a rollback has given up or an acceptance has replaced.
nlohmann::ordered_json off_by(const Watched& watched) {
  if (!watched.result || !watched.status) return nullptr;
  const ResultMessage& r = *watched.result;
  const StatusMessage& s = *watched.status;
  if (parse_answer(r.answer) == ResultAnswer::failed) return nullptr;
  const auto decision = parse_decision(r.decision);
  if (decision == ResultDecision::applied)
    return s.active == "session " + std::to_string(r.session) ? finite(r.check_after) : nullptr;
  const bool check = r.kind == "check";
  const bool others = decision == ResultDecision::rolled_back || s.active_since_ms > r.unix_ms ||
                      (check && s.active == "factory");  // of which there is no check
  if (others) return nullptr;
  return finite(check ? r.check_after : r.check_before);
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

namespace {

using Cells = std::vector<std::string>;

const Cells kFleetTitles = {"robot", "state", "health", "last result", "off, mm", "next due"};
constexpr int kWidestCell = 40;

Tone tone_of_line(const nlohmann::ordered_json& line) {
  const auto at = std::ranges::find(kConcerns, line["concern"].get_ref<const std::string&>());
  switch (static_cast<Concern>(at - kConcerns.begin())) {
    case Concern::none:
      return Tone::plain;
    case Concern::warning:
    case Concern::waits:
      return Tone::warning;
    case Concern::error:
    case Concern::silent:
      break;
  }
  return Tone::bad;
}

Cells cells_of_line(const nlohmann::ordered_json& line, std::int64_t now_ms) {
  std::string state = line["silent"].get<bool>() ? "SILENT" : line["state"].get<std::string>();
  if (line["planned"] > 0)
    state += printed(" %d of %d", line["done"].get<int>(), line["planned"].get<int>());
  std::string result = "none yet";
  if (const auto& last = line["result"]; last.is_object()) {
    result = day_time(last["unix_ms"], now_ms) + " " + last["answer"].get<std::string>();
    const std::string decision = last["decision"];
    if (!decision.empty() && decision != "none") result += ", " + decision;
  }
  const std::int64_t due = line["next_due_ms"];
  return {line["robot"],
          state,
          line["health"],
          result,
          line["off"].is_number() ? mm(line["off"]) : "-",
          due > 0 ? day_time(due, now_ms) : "when asked"};
}

}  // namespace

std::vector<Line> fleet_picture(const nlohmann::ordered_json& fleet, std::int64_t now_ms,
                                int columns, int rows) {
  std::vector<Cells> table = {kFleetTitles};
  std::map<std::string, int> count;
  for (const auto& line : fleet) {
    table.push_back(cells_of_line(line, now_ms));
    ++count[line["concern"].get<std::string>()];
  }
  std::vector<int> widths(kFleetTitles.size(), 0);
  for (Cells& row : table)
    for (std::size_t c = 0; c < row.size(); ++c) {
      row[c] = fitted(one_line(row[c]), kWidestCell);
      widths[c] = std::max(widths[c], characters(row[c]));
    }
  std::string head = printed("%zu robots", fleet.size());
  for (auto concern = kConcerns.rbegin(); concern != kConcerns.rend(); ++concern)
    if (const int of_it = count[std::string(*concern)]; of_it > 0)
      head += printed(", %d ", of_it) + std::string(*concern == "none" ? "well" : *concern);
  std::vector<Line> lines = {{fitted(head, columns), Tone::strong, 0}};
  for (std::size_t i = 0; i < table.size(); ++i) {
    std::string text;
    for (std::size_t c = 0; c < widths.size(); ++c) text += padded(table[i][c], widths[c]) + "  ";
    if (i > 0) text += one_line(fleet[i - 1]["why"].get<std::string>());
    text.erase(text.find_last_not_of(' ') + 1);
    lines.push_back({fitted(text, columns), i > 0 ? tone_of_line(fleet[i - 1]) : Tone::plain, 0});
  }
  const std::size_t room = static_cast<std::size_t>(std::max(rows, 3));
  if (lines.size() > room) {
    const std::size_t hidden = lines.size() - room + 1;
    lines.resize(room - 1);
    lines.push_back({fitted(printed("and %zu more robots", hidden), columns), Tone::plain, 0});
  }
  return lines;
}

}  // namespace selfcal
