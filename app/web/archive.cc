#include "app/web/archive.h"

#include "app/report/past.h"
#include "app/web/changes.h"
#include "io/files/robot_file.h"

namespace selfcal {

Result<Store*> Archive::store() {
  if (store_ && store_->moved()) {  // the service has set it aside and begun another
    store_.reset();
    planned_session_ = 0;
  }
  if (!store_) {
    auto opened = Store::open_to_read(folder_);
    if (!opened) return tl::unexpected(opened.error());
    store_ = *std::move(opened);
  }
  return store_.get();
}

nlohmann::ordered_json Archive::history() {
  nlohmann::ordered_json json = {{"sessions", nlohmann::ordered_json::array()},
                                 {"events", nlohmann::ordered_json::array()},
                                 {"problem", ""}};
  const auto from = store();
  const auto past = from ? read_past(**from, kSessions) : tl::unexpected(from.error());
  const auto events = from ? (*from)->events(kEvents) : tl::unexpected(from.error());
  if (!past || !events) {
    store_.reset();  // it may be another one by now
    json["problem"] = !past ? past.error().what : events.error().what;
    return json;
  }
  for (const Past& each : *past) json["sessions"].push_back(record_of(each));
  for (const EventRecord& each : *events)
    json["events"].push_back(
        {{"unix_ms", each.unix_ms}, {"level", each.level}, {"text", each.text}});
  return json;
}

std::optional<Archive::Parameters> Archive::parameters(Store& store, Slot slot,
                                                       bool or_factory) const {
  const auto record = store.slot(slot);
  if (!record) return std::nullopt;
  if (!*record || (*record)->session == 0) {
    if (!or_factory) return std::nullopt;
    return Parameters{0, *record ? (*record)->since_ms : 0, factory_};
  }
  auto robot = robot_of((*record)->robot_text, std::string(to_string(slot)));
  if (!robot) return std::nullopt;
  return Parameters{(*record)->session, (*record)->since_ms, *std::move(robot)};
}

nlohmann::ordered_json Archive::slots() {
  nlohmann::ordered_json json = {{"accept", nullptr}, {"rollback", nullptr}};
  const auto from = store();
  if (!from) return json;
  Store& open = **from;
  const auto active = parameters(open, Slot::active, true);
  if (!active) return json;
  if (const auto candidate = parameters(open, Slot::candidate, false)) {
    const auto result = open.result(candidate->session);
    json["accept"] = {{"session", candidate->session},
                      {"from", active->session},
                      {"changes", changes_between(active->robot, candidate->robot,
                                                  result && *result ? (*result)->json : "")}};
  }
  if (active->session == 0) return json;
  if (const auto previous = parameters(open, Slot::previous, true))
    json["rollback"] = {{"from", active->session},
                        {"to", previous->session},
                        {"since_ms", previous->since_ms},
                        {"changes", changes_between(active->robot, previous->robot, "")}};
  return json;
}

std::optional<Eigen::VectorXd> Archive::planned(std::int64_t session, std::uint32_t step) {
  // A further round of a session adds to its plan.
  if (session != planned_session_ || step >= plan_.size()) {
    const auto from = store();
    if (!from) return std::nullopt;
    auto plan = (*from)->plan(session);
    if (!plan || plan->empty()) return std::nullopt;
    plan_ = *std::move(plan);
    planned_session_ = session;
  }
  if (step >= plan_.size()) return std::nullopt;
  const std::vector<double>& q = plan_[step].touch;
  if (q.empty()) return std::nullopt;
  return Eigen::Map<const Eigen::VectorXd>(q.data(), static_cast<Eigen::Index>(q.size()));
}

}  // namespace selfcal
