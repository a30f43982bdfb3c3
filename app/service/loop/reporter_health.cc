// How well the service and what it needs are: a line each, once a second and at once when something
// gets worse.
#include <cstdio>

#include "app/service/loop/reporter.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kHealth = kSecond / 5;  // between two looks at what may have degraded
constexpr std::int64_t kRecentDamage_ms = std::int64_t{30} * 86'400'000;  // warned of so long

std::string text(double value) {
  char out[32];
  std::snprintf(out, sizeof out, "%.4g", value);
  return out;
}

std::string with_trouble(const std::string& state, const std::string& trouble) {
  return trouble.empty() ? state : state + ": " + trouble;
}

}  // namespace

void Reporter::report_health(bool in_any_case) {
  if (!in_any_case && c_.now - last_health_ < kHealth) return;
  last_health_ = c_.now;
  tell_damage();
  const std::vector<HealthMessage> lines = health();
  std::string levels;
  for (const HealthMessage& line : lines) levels += std::to_string(static_cast<int>(line.level));
  if (in_any_case || levels != last_levels_) c_.messenger.publish(lines, c_.config.serial);
  last_levels_ = levels;
}

std::vector<HealthMessage> Reporter::health() const {
  return {health_of_service(), health_of_encoders(), health_of_trigger(), health_of_store(),
          health_of_calibration()};
}

HealthMessage Reporter::health_of_service() const {
  const std::string strangers = collector_.two_senders();
  const std::string clock = c_.config.schedule.by_clock() ? c_.use.calendar.doubt() : std::string();
  const bool fault = c_.extended_state.state == ServiceState::fault;
  const Health level = fault || !strangers.empty()                      ? Health::error
                       : c_.extended_state.unfinished || !clock.empty() ? Health::warn
                                                                        : Health::ok;
  return {
      "selfcal: service",
      level,
      with_trouble(std::string(to_string(c_.extended_state.state)) + ": " + c_.extended_state.why,
                   strangers.empty() ? clock : strangers),
      {{"hardware", std::string(hardware_may(c_.extended_state.state, c_.extended_state.phase))},
       {"session", std::to_string(c_.extended_state.session)},
       {"unsent", std::to_string(c_.messenger.unsent())},
       {"refused_commands", std::to_string(refused_commands_)},
       {"lost_events", std::to_string(c_.lost_events)}}};
}

HealthMessage Reporter::health_of_encoders() const {
  const bool alive = collector_.front_end().encoders_alive(c_.now);
  const std::string trouble = c_.ports.encoders->trouble();
  const Health level = !alive ? Health::error : trouble.empty() ? Health::ok : Health::warn;
  HealthMessage message{
      "selfcal: encoders",
      level,
      with_trouble(alive ? "readings come in" : "silent", trouble),
      {{"rate_hz", text(collector_.front_end().rate())},
       {"dropped", std::to_string(collector_.front_end().samples_dropped())},
       {"out_of_order", std::to_string(collector_.front_end().samples().out_of_order())}}};
  for (const Tally& each : c_.ports.encoders->tallies())
    if (each.count > 0)
      message.values.emplace_back("met_" + std::string(each.name), std::to_string(each.count));
  return message;
}

HealthMessage Reporter::health_of_trigger() const {
  const auto closed = collector_.front_end().closed();
  const bool contact =
      c_.extended_state.state == ServiceState::collecting || c_.extended_state.unfinished;
  const TriggerNews& trigger = collector_.front_end().trigger();
  const std::string& trouble = trigger.trouble;
  const Health level = !closed                                     ? Health::error
                       : (*closed && !contact) || !trouble.empty() ? Health::warn
                                                                   : Health::ok;
  const char* state = !closed ? "level unknown" : *closed ? "closed" : "open";
  return {"selfcal: trigger",
          level,
          with_trouble(state, trouble),
          {{"glitches", std::to_string(trigger.glitches)},
           {"dropped", std::to_string(trigger.dropped)},
           {"slowest_stop_ms", text(1e3 * seconds(collector_.reflex().slowest()))},
           {"strange_messages", std::to_string(trigger.strange + c_.ports.encoders->strange() +
                                               c_.ports.motion->strange())}}};
}

void Reporter::recall_damage() {
  const auto notes = c_.store.damage();
  if (!notes || notes->empty()) return;
  damaged_before_ = "found damaged before: " + notes->front().what +
                    (notes->size() == 1 ? "" : " and more (selfcal history)");
  c_.tell("warning", damaged_before_);
  if (c_.unix_ms() - notes->front().unix_ms > kRecentDamage_ms) damaged_before_.clear();
}

void Reporter::tell_damage() {
  if (c_.store.met().size() == damage_told_) return;
  for (; damage_told_ < c_.store.met().size(); ++damage_told_) {
    const std::string& what = c_.store.met()[damage_told_];
    damaged_ += (damaged_.empty() ? "" : ", ") + what;
    c_.tell("error", "the store is damaged, and this not used: " + what);
  }
}

HealthMessage Reporter::health_of_store() const {
  const auto bytes = c_.store.bytes();
  const std::string& why = c_.extended_state.why;
  const bool failing =
      c_.extended_state.state == ServiceState::fault && why.starts_with(kStoreFailed);
  const bool error = !bytes || failing || !damaged_.empty();
  return {"selfcal: store",
          error                     ? Health::error
          : damaged_before_.empty() ? Health::ok
                                    : Health::warn,
          !bytes                    ? bytes.error().what
          : failing                 ? why.substr(kStoreFailed.size())
          : !damaged_.empty()       ? damaged_
          : damaged_before_.empty() ? "sound"
                                    : damaged_before_,
          {{"size_mb", text(bytes ? static_cast<double>(*bytes) / 1e6 : 0)},
           {"limit_mb", text(static_cast<double>(c_.config.store_bytes) / 1e6)}}};
}

HealthMessage Reporter::health_of_calibration() const {
  const bool unexplained = analyst_.last_check() && !analyst_.last_check()->explained;
  const bool wrong = !c_.models.refused().empty();
  const bool warn = unexplained || c_.extended_state.candidate || c_.models.session() == 0;
  std::string message = wrong ? c_.models.refused() : c_.models.name() + " is active";
  if (c_.extended_state.candidate) message += "; a result waits: accept or reject";
  if (unexplained) message += "; the last check was not explained";
  const auto celsius = collector_.front_end().celsius();
  const auto age_ms = c_.models.since_ms() == 0 ? 0 : c_.unix_ms() - c_.models.since_ms();
  return {"selfcal: calibration",
          wrong  ? Health::error
          : warn ? Health::warn
                 : Health::ok,
          message,
          {{"age_h", text(static_cast<double>(age_ms) / 3.6e6)},
           {"check_p", analyst_.last_check() ? text(analyst_.last_check()->p_value) : "none yet"},
           {"check_rms_mm",
            analyst_.last_check() ? text(1e3 * analyst_.last_check()->check_after) : "none yet"},
           {"motion_h", text(c_.use.motion_hours)},
           {"temperature_c", celsius ? text(*celsius) : "none yet"}}};
}

}  // namespace selfcal
