// How well the service and what it needs are: a line each, once a second and at once when something
// gets worse.
#include <cmath>
#include <cstdio>

#include "app/service/service.h"

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

void Service::report_health(bool in_any_case) {
  if (!in_any_case && now_ - last_health_ < kHealth) return;
  last_health_ = now_;
  tell_damage();
  const std::vector<HealthMessage> lines = health();
  std::string levels;
  for (const HealthMessage& line : lines) levels += std::to_string(static_cast<int>(line.level));
  if (in_any_case || levels != last_levels_) messenger_.publish(lines, config_.serial);
  last_levels_ = levels;
}

std::vector<HealthMessage> Service::health() const {
  return {health_of_service(), health_of_encoders(), health_of_trigger(), health_of_store(),
          health_of_calibration()};
}

HealthMessage Service::health_of_service() const {
  const std::string strangers = two_senders();
  const bool fault = situation_.state == ServiceState::fault;
  const Health level = fault || !strangers.empty() ? Health::error
                       : situation_.unfinished     ? Health::warn
                                                   : Health::ok;
  return {"selfcal: service",
          level,
          with_trouble(std::string(to_string(situation_.state)) + ": " + situation_.why, strangers),
          {{"hardware", std::string(hardware_may(situation_.state, situation_.phase))},
           {"session", std::to_string(situation_.session)},
           {"unsent", std::to_string(messenger_.unsent())},
           {"refused_commands", std::to_string(refused_.total)}}};
}

HealthMessage Service::health_of_encoders() const {
  const bool alive = senses_.encoders_alive(now_);
  const std::string trouble = ports_.encoders->trouble();
  const Health level = !alive ? Health::error : trouble.empty() ? Health::ok : Health::warn;
  HealthMessage message{"selfcal: encoders",
                        level,
                        with_trouble(alive ? "readings come in" : "silent", trouble),
                        {{"rate_hz", text(senses_.rate())},
                         {"dropped", std::to_string(senses_.samples_dropped())},
                         {"out_of_order", std::to_string(senses_.samples().out_of_order())}}};
  for (const Tally& each : ports_.encoders->tallies())
    if (each.count > 0)
      message.values.emplace_back("met_" + std::string(each.name), std::to_string(each.count));
  return message;
}

HealthMessage Service::health_of_trigger() const {
  const auto closed = senses_.closed();
  const bool contact = situation_.state == ServiceState::collecting || situation_.unfinished;
  const TriggerNews& trigger = senses_.trigger();
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
           {"slowest_stop_ms", text(1e3 * seconds(reflex_.slowest()))},
           {"strange_messages", std::to_string(trigger.strange + ports_.encoders->strange() +
                                               ports_.motion->strange())}}};
}

void Service::recall_damage() {
  const auto notes = store_.damage();
  if (!notes || notes->empty()) return;
  damaged_before_ = "found damaged before: " + notes->front().what +
                    (notes->size() == 1 ? "" : " and more (selfcal history)");
  tell("warning", damaged_before_);
  if (ports_.clock->unix_ms() - notes->front().unix_ms > kRecentDamage_ms) damaged_before_.clear();
}

void Service::tell_damage() {
  if (store_.met().size() == damage_told_) return;
  for (; damage_told_ < store_.met().size(); ++damage_told_) {
    const std::string& what = store_.met()[damage_told_];
    damaged_ += (damaged_.empty() ? "" : ", ") + what;
    tell("error", "the store is damaged, and this not used: " + what);
  }
}

HealthMessage Service::health_of_store() const {
  const auto bytes = store_.bytes();
  const bool error = !bytes || !damaged_.empty();
  return {"selfcal: store",
          error                     ? Health::error
          : damaged_before_.empty() ? Health::ok
                                    : Health::warn,
          !bytes                    ? bytes.error().what
          : !damaged_.empty()       ? damaged_
          : damaged_before_.empty() ? "sound"
                                    : damaged_before_,
          {{"size_mb", text(bytes ? static_cast<double>(*bytes) / 1e6 : 0)},
           {"limit_mb", text(static_cast<double>(config_.store_bytes) / 1e6)}}};
}

HealthMessage Service::health_of_calibration() const {
  const bool unexplained = last_check_ && !last_check_->explained;
  const bool wrong = !models_.refused().empty();
  const bool warn = unexplained || situation_.candidate || models_.session() == 0;
  std::string message = wrong ? models_.refused() : models_.name() + " is active";
  if (situation_.candidate) message += "; a result waits: accept or reject";
  if (unexplained) message += "; the last check was not explained";
  const auto age_ms = models_.since_ms() == 0 ? 0 : ports_.clock->unix_ms() - models_.since_ms();
  return {"selfcal: calibration",
          wrong  ? Health::error
          : warn ? Health::warn
                 : Health::ok,
          message,
          {{"age_h", text(static_cast<double>(age_ms) / 3.6e6)},
           {"check_p", last_check_ ? text(last_check_->p_value) : "none yet"},
           {"check_rms_mm", last_check_ ? text(1e3 * last_check_->rms) : "none yet"},
           {"motion_h", text(motion_hours_)},
           {"temperature_c", text(senses_.celsius().value_or(std::nan("")))}}};
}

}  // namespace selfcal
