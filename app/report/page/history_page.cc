// A parameter's limit is three of its maker's tolerances; a quick check's is the accuracy that is
// wanted of the end position, with three checks or more.
#include "app/report/page/history_page.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "app/report/format.h"
#include "app/report/trend.h"
#include "constraints/statistics.h"
#include "io/files/json_parts.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

constexpr double kTolerances = 3, kDay = 86400e3;  // kDay in ms
constexpr std::size_t kEveryParameter = 100000;
constexpr double kUpper = 0.975, kLower = 0.025;

double days(std::int64_t unix_ms) { return static_cast<double>(unix_ms) / kDay; }

/// `unit` of the values a day; the date at which the limit is left, if it will be.
Json trend_json(const std::vector<double>& times, const std::vector<double>& values,
                const std::vector<double>& sigmas, double now, double least, double most) {
  const std::optional<Trend> line = trend(times, values, sigmas);
  if (!line) return nullptr;
  const std::optional<double> left = leaves_at(*line, now, least, most);
  return {{"rate", finite(line->rate)},
          {"rate_sigma", finite(line->rate_sigma)},
          {"outside", line->value(now) < least || line->value(now) > most},
          {"leaves_in_days", left ? finite(*left - now) : Json(nullptr)}};
}

Json drift_json(const HistoryFindings& findings, const Drift& drift, const Parameter& parameter) {
  std::vector<double> times;
  for (const AcceptedParameters& each : findings.calibrations) times.push_back(days(each.unix_ms));
  const double limit = kTolerances * parameter.tolerance;
  return {
      {"name", drift.name},
      {"unit", parameter.unit()},
      {"since_factory", array_of(drift.since_factory, finite)},
      {"sigma", array_of(drift.sigma, [](double s) { return s > 0 ? finite(s) : Json(nullptr); })},
      {"limit", finite(limit)},
      {"trend",
       trend_json(times, drift.since_factory, drift.sigma, days(findings.unix_ms), -limit, limit)}};
}

Json drifts_json(const HistoryFindings& findings) {
  Json list = Json::array();
  if (findings.calibrations.empty()) return list;
  const std::vector<Parameter>& parameters = findings.calibrations.front().robot->parameters();
  for (const Drift& drift : drifts(findings.calibrations, kEveryParameter)) {
    const auto found =
        std::ranges::find(parameters, drift.name, [](const Parameter& p) { return full_name(p); });
    list.push_back(drift_json(findings, drift, *found));
  }
  return list;
}

/// Of the quick checks, oldest first: rms, and its 95 % interval by the number of touches.
Json residual_json(const HistoryFindings& findings) {
  Json json = {{"points", Json::array()}};
  std::vector<double> times, values, sigmas;
  for (auto past = findings.sessions.rbegin(); past != findings.sessions.rend(); ++past) {
    if (past->session.kind != "check" || !past->result || past->result->touches < 1) continue;
    if (!std::isfinite(past->result->check_after) || past->result->check_after <= 0) continue;
    const double rms = past->result->check_after, n = past->result->touches;
    const auto bound = [&](double p) {
      return rms * std::sqrt(n) / chi_quantile(past->result->touches, p);
    };
    json["points"].push_back({{"session", past->session.id},
                              {"unix_ms", past->result->unix_ms},
                              {"rms", rms},
                              {"least", finite(bound(kUpper))},
                              {"most", finite(bound(kLower))}});
    times.push_back(days(past->result->unix_ms));
    values.push_back(rms);
    sigmas.push_back(rms / std::sqrt(2 * n));
  }
  if (findings.target > 0) {
    json["limit"] = findings.target;
    json["trend"] = trend_json(times, values, sigmas, days(findings.unix_ms), 0, findings.target);
  }
  return json;
}

/// The page's first sentence: what is beyond its limit, the first limit that will be left, or that
/// none will.
std::string history_sentence(const Json& data, std::size_t calibrations) {
  double soonest = HUGE_VAL;
  std::string what;
  std::vector<std::string> outside;
  const auto look = [&](const Json& trend, const std::string& name) {
    if (!trend.is_object()) return;
    if (trend["outside"] == true) outside.push_back(name);
    if (!trend["leaves_in_days"].is_number()) return;
    if (const double in = trend["leaves_in_days"]; in < soonest) {
      soonest = in;
      what = name;
    }
  };
  for (const Json& drift : data["drifts"]) look(drift["trend"], drift["name"]);
  if (data["residual"].contains("trend")) look(data["residual"]["trend"], "the check residual");
  if (!outside.empty())
    return listed(outside) + (outside.size() == 1 ? " is" : " are") + " beyond the limit now.";
  if (!what.empty())
    return printed("At this rate %s leaves its limit in %.0f days.", what.c_str(), soonest);
  if (data["sessions"].empty()) return "No session yet.";
  if (calibrations < 3)
    return counted(static_cast<std::int64_t>(calibrations), "accepted calibration") +
           " so far; three tell how fast the robot drifts.";
  return "Nothing drifts towards a limit faster than its uncertainty.";
}

}  // namespace

Json history_data(const HistoryFindings& findings) {
  Json json = page_begin("history", findings.robot, findings.unix_ms);
  json["sessions"] = array_of(findings.sessions, record_of);
  json["calibrations"] = array_of(findings.calibrations, [](const AcceptedParameters& each) {
    return Json{{"session", each.session}, {"unix_ms", each.unix_ms}};
  });
  json["drifts"] = drifts_json(findings);
  json["residual"] = residual_json(findings);
  json["events"] = array_of(findings.events, [](const EventRecord& each) {
    return Json{{"when", date_time(each.unix_ms)}, {"level", each.level}, {"text", each.text}};
  });
  std::size_t s = 0;
  for (Json& session : json["sessions"])
    session["when"] = date_time(findings.sessions[s++].session.started_ms);
  json["verdict"] = {{"sentence", history_sentence(json, findings.calibrations.size())}};
  return json;
}

}  // namespace selfcal
