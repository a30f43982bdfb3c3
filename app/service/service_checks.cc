// What the service looks at in every turn: whether it is fit to work, whether the robot stands,
// whether a session is due.
#include "app/service/service.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kResumeWithin = 120 * kSecond;  // of the start; later only a person resumes
constexpr Nanoseconds kStopAgain = kSecond / 10;      // until the robot stands
constexpr double kBeyond = 0.02;  // rad or m past its limits that a joint may stand
constexpr const char* kChatters = "the trigger chatters: a loose wire, or no bias?";

/// `what`, and why if that is known.
std::string because(const std::string& what, const std::string& why) {
  return why.empty() ? what : what + ": " + why;
}

}  // namespace

/// Two services of one robot would both move it: neither does.
void Service::check_rivals() {
  if (testing_ || situation_.state == ServiceState::fault || messenger_.rivals() == 0) return;
  put(Event::What::broken, false, rivals());
}

std::string Service::rivals() const {
  if (messenger_.rivals() == 0) return {};
  return "another service of robot " + config_.id +
         " is in this DDS domain: one of the two must end (or has a robot the id of another?)";
}

/// What a robot that may move cannot do without.
void Service::check_senses() {
  if (!may_move(situation_.state)) return;
  const auto broken = [&](const std::string& why) { put(Event::What::broken, false, why); };
  if (!senses_.encoders_alive(now_))
    broken(because("no encoder reading for " + format_number(config_.silence) + " s",
                   ports_.encoders->trouble()));
  if (!senses_.closed()) broken(because("the trigger is gone", senses_.trigger().trouble));
  if (senses_.trigger().chatters) broken(kChatters);
  if (!reflex_.alive(now_)) broken("the trigger is not watched: its thread hangs");
  if (const std::string strangers = two_senders(); !strangers.empty()) broken(strangers);
}

/// The topic that somebody beside the robot writes; empty when there is none.
std::string Service::two_senders() const {
  const char* of = ports_.encoders->senders() > 1  ? "encoder readings"
                   : senses_.trigger().senders > 1 ? "the trigger"
                   : ports_.motion->senders() > 1  ? "motion replies"
                                                   : nullptr;
  if (!of) return {};
  return std::string("two senders of ") + of +
         ": are they of two robots, or does somebody pretend to be this one?";
}

/// What is still missing for the self-test to pass; empty when nothing is.
std::string Service::missing() const {
  const auto joints = static_cast<int>(config_.robot->joints().size());
  if (!senses_.encoders_alive(now_) || !senses_.at_rest())
    return because("no encoder readings come in", ports_.encoders->trouble());
  if (const std::string strangers = two_senders(); !strangers.empty()) return strangers;
  if (std::string others = rivals(); !others.empty()) return others;
  if (situation_.unfinished && !*senses_.at_rest()) return "the robot moves";
  if (senses_.samples().last().joints != joints)
    return "the encoders give " + std::to_string(senses_.samples().last().joints) +
           " joints, the robot has " + std::to_string(joints);
  if (const std::string beyond = beyond_limits(); !beyond.empty()) return beyond;
  const std::string& trouble = senses_.trigger().trouble;
  if (!senses_.closed()) return because("the trigger's level is not known", trouble);
  if (!trouble.empty()) return trouble;
  if (senses_.trigger().chatters) return kChatters;
  if (*senses_.closed() && !situation_.unfinished)
    return "the trigger is closed while the robot stands: in contact, stuck, or inverted (`active` "
           "of a GPIO line)";
  return {};
}

/// A joint that reads what it cannot: its zero or its turns are wrong.
std::string Service::beyond_limits() const {
  const Eigen::VectorXd q = *senses_.q();
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    const Joint& joint = config_.robot->joints()[j];
    if (!joint.allows(q[j], -kBeyond))
      return joint.name + " reads " + format_number(std::round(1e3 * q[j]) / 1e3) +
             ", beyond its limits: are its zero, its sign and its turns right?";
  }
  return {};
}

void Service::begin_test() {
  testing_ = true;
  test_began_ = now_;
}

void Service::check_self() {
  if (!testing_) return;
  const std::string why = missing();
  if (!why.empty() && now_ - test_began_ < config_.limits.self_test) return;
  testing_ = false;
  Event event;
  event.what = Event::What::self_tested;
  event.ok = why.empty();
  event.why = why;
  event.resume = config_.resume && !situation_.tested && now_ - began_ < kResumeWithin;
  put(std::move(event));
}

void Service::check_rest() {
  if (situation_.state != ServiceState::collecting || situation_.phase != Phase::settle) return;
  if (senses_.at_rest() != true || !senses_.closing()) return;
  if (situation_.engaged) {
    // Readings of the configuration itself, not of the way there.
    if (senses_.samples().last().time > situation_.since) put(Event::What::at_rest);
    return;
  }
  const Nanoseconds edge = senses_.closing()->time - nanoseconds(config_.touch.delay);
  if (senses_.samples().last().time > edge) put(Event::What::at_rest);
}

/// A stop may be lost on the way, or come before the robot listens: it is said until it stands.
void Service::check_stop() {
  if (stopped_ == 0) return;
  if (senses_.encoders_alive(now_) && senses_.at_rest() == true && now_ - stopped_ > kStopAgain) {
    stopped_ = 0;
    outstanding_ = false;
    return;
  }
  // Where the robot may move only the stop of a touch is still wanted; a move takes it back.
  const bool touching =
      situation_.state == ServiceState::collecting && situation_.phase == Phase::settle;
  if (now_ - stopped_ < kStopAgain || (may_move(situation_.state) && !touching)) return;
  stop("until it stands");
}

void Service::check_schedule() {
  if (situation_.state != ServiceState::idle || !config_.schedule.any()) return;
  if (now_ - last_due_ < kSecond) return;
  last_due_ = now_;
  const std::int64_t unix_ms = ports_.clock->unix_ms();
  // Before the first session, and after the clock was set back, the interval begins now.
  if (since_.unix_ms == 0 || since_.unix_ms > unix_ms + 3'600'000) since_.unix_ms = unix_ms;
  Since since = since_;
  since.motion_hours = motion_hours_ - since_.motion_hours;
  since.calibrated = can_check();
  const auto next = due(config_.schedule, since, unix_ms, senses_.celsius(), utc_offset(unix_ms));
  if (!next) return;
  Event event;
  event.what = Event::What::due;
  event.kind = next->kind;
  event.why = next->why;
  put(std::move(event));
}

}  // namespace selfcal
