#include "app/report/live/message_json.h"

#include "io/files/json_parts.h"

namespace selfcal {

std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string_view to_string(Health level) {
  switch (level) {
    case Health::ok:
      return "ok";
    case Health::warn:
      return "warn";
    case Health::error:
      return "error";
    case Health::stale:
      return "stale";
  }
  return "";
}

Json to_json(const StatusMessage& status) {
  return Json::object({{"topic", "status"},
                       {"unix_ms", status.unix_ms},
                       {"robot", status.robot},
                       {"model_hash", status.model_hash},
                       {"version", status.version},
                       {"state", status.state},
                       {"phase", status.phase},
                       {"hardware", status.hardware},
                       {"why", status.why},
                       {"session", status.session},
                       {"kind", status.kind},
                       {"active", status.active},
                       {"active_since_ms", status.active_since_ms},
                       {"candidate", status.candidate},
                       {"next_due_ms", status.next_due_ms},
                       {"temperature", finite(status.temperature)}});
}

Json to_json(const ProgressMessage& progress) {
  return Json::object({{"topic", "progress"},
                       {"unix_ms", progress.unix_ms},
                       {"robot", progress.robot},
                       {"session", progress.session},
                       {"kind", progress.kind},
                       {"done", progress.done},
                       {"planned", progress.planned},
                       {"put_aside", progress.outlier},
                       {"seconds_left", finite(progress.seconds_left)},
                       {"set", progress.set},
                       {"index", progress.index},
                       {"residual", finite(progress.residual)},
                       {"accepted", progress.accepted},
                       {"note", progress.note}});
}

Json to_json(const ResultMessage& result) {
  Json nuisance = foreign_json(result.json);
  if (nuisance.is_discarded()) nuisance = nullptr;
  return Json::object({{"topic", "result"},
                       {"unix_ms", result.unix_ms},
                       {"robot", result.robot},
                       {"model_hash", result.model_hash},
                       {"session", result.session},
                       {"kind", result.kind},
                       {"answer", result.answer},
                       {"decision", result.decision},
                       {"why", result.why},
                       {"p_value", finite(result.p_value)},
                       {"check_before", finite(result.check_before)},
                       {"check_after", finite(result.check_after)},
                       {"endpoint_sigma", finite(result.endpoint_sigma)},
                       {"touches", result.touches},
                       {"rejected", result.outliers},
                       {"identified", result.identified},
                       {"cause", result.cause},
                       {"cause_probability", finite(result.cause_probability)},
                       {"cause_closes", finite(result.cause_closes)},
                       {"result", std::move(nuisance)}});
}

Json to_json(const std::string& robot, std::int64_t unix_ms,
             const std::vector<HealthMessage>& health) {
  Json lines = Json::array();
  for (const HealthMessage& line : health) {
    Json values = Json::object();
    for (const auto& [key, value] : line.values) values[key] = value;
    lines.push_back(Json::object({{"name", line.name},
                                  {"level", to_string(line.level)},
                                  {"message", line.message},
                                  {"values", std::move(values)}}));
  }
  return Json::object(
      {{"topic", "health"}, {"unix_ms", unix_ms}, {"robot", robot}, {"lines", std::move(lines)}});
}

}  // namespace selfcal
