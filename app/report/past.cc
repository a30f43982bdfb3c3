#include "app/report/past.h"

#include <algorithm>
#include <limits>
#include <map>

#include "io/files/json_parts.h"
#include "io/files/robot_file.h"

namespace selfcal {

namespace {

/// Sigma of each parameter by its name, of result.json; empty where it is gone.
std::map<std::string, double> sigmas_of(const std::string& json) {
  std::map<std::string, double> sigmas;
  const auto result = nlohmann::json::parse(json, nullptr, false);
  if (!result.is_object() || !result.contains("parameters")) return sigmas;
  for (const auto& each : result["parameters"])
    if (each.contains("sigma") && each["sigma"].is_number())
      sigmas[each["name"].get<std::string>()] = each["sigma"].get<double>();
  return sigmas;
}

}  // namespace

bool is_damaged(const Past& past) { return past.session.kind.empty(); }

Result<std::vector<Past>> read_past(Store& store, int newest) {
  auto sessions = store.sessions(newest);
  if (!sessions) return tl::unexpected(sessions.error());
  const auto results = store.results(newest);
  if (!results) return tl::unexpected(results.error());
  std::vector<Past> past;
  for (SessionRecord& session : *sessions) {
    const auto found = std::ranges::find(*results, session.id, &ResultRecord::session);
    past.push_back({std::move(session), std::nullopt});
    if (found != results->end() && !is_damaged(past.back())) past.back().result = *found;
  }
  return past;
}

Result<std::vector<AcceptedParameters>> read_calibrations(Store& store) {
  const auto results = store.results(std::numeric_limits<int>::max());
  if (!results) return tl::unexpected(results.error());
  std::vector<AcceptedParameters> newest_first;
  for (const ResultRecord& each : *results) {
    if (each.decision != ResultDecision::applied) continue;
    const auto result = store.result(each.session);
    if (!result) return tl::unexpected(result.error());
    if (!*result || (*result)->robot_text.empty()) continue;
    auto robot = robot_of((*result)->robot_text, "session " + std::to_string(each.session));
    if (!robot) continue;  // of a robot that this program does not know
    if (!newest_first.empty() &&
        newest_first.front().robot->text().identity() != (*robot)->text().identity())
      continue;
    newest_first.push_back(
        {each.session, each.unix_ms, std::move(*robot), sigmas_of((*result)->json)});
  }
  std::ranges::reverse(newest_first);
  return newest_first;
}

std::string state_of(const Past& past) {
  if (is_damaged(past)) return "damaged";
  switch (past.session.state) {
    case SessionState::collecting:
    case SessionState::collected:
      return "unfinished";
    case SessionState::aborted:
      return "aborted";
    case SessionState::finished:
      return past.result ? "finished" : "damaged result";
  }
  return "";
}

nlohmann::ordered_json record_of(const Past& past) {
  const auto ended = past.session.ended_ms > 0 ? nlohmann::ordered_json(past.session.ended_ms)
                                               : nlohmann::ordered_json(nullptr);
  nlohmann::ordered_json json = {{"session", past.session.id},
                                 {"kind", past.session.kind},
                                 {"state", state_of(past)},
                                 {"reason", past.session.reason},
                                 {"started_ms", past.session.started_ms},
                                 {"ended_ms", ended},
                                 {"model_hash", past.session.model_hash},
                                 {"result", nullptr}};
  if (!past.result) return json;
  const ResultRecord& r = *past.result;
  const ResultFigures figures = known_figures(r, r.answer);
  json["result"] = {{"unix_ms", r.unix_ms},
                    {"answer", to_string(r.answer)},
                    {"decision", to_string(r.decision)},
                    {"why", r.why},
                    {"p_value", finite(figures.p_value)},
                    {"check_before", finite(figures.check_before)},
                    {"check_after", finite(figures.check_after)},
                    {"endpoint_sigma", finite(figures.endpoint_sigma)},
                    {"touches", r.touches},
                    {"rejected", r.outliers},
                    {"identified", r.identified}};
  return json;
}

}  // namespace selfcal
