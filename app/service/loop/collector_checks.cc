// What the collector looks at in every turn: whether the robot is fit to move, and whether it
// stands.
#include <cmath>

#include "app/service/loop/collector.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kStopAgain = kSecond / 10;  // until the robot stands
constexpr double kBeyond = 0.02;  // of its unit, past its limits, that a joint may stand
constexpr const char* kChatters = "the trigger chatters: a loose wire, or no bias?";

/// `what`, and why if that is known.
std::string because(const std::string& what, const std::string& why) {
  return why.empty() ? what : what + ": " + why;
}

}  // namespace

void Collector::listen() {
  front_end_.listen(c_.now, c_.events);
  if (!may_move(c_.extended_state.state)) return;
  const auto broken = [&](const std::string& why) { c_.put(Event::What::broken, false, why); };
  if (!front_end_.encoders_alive(c_.now))
    broken(because("no encoder reading for " + format_number(c_.config.silence) + " s",
                   c_.ports.encoders->trouble()));
  if (!front_end_.closed()) broken(because("the trigger is gone", front_end_.trigger().trouble));
  if (front_end_.trigger().chatters) broken(kChatters);
  if (!reflex_.alive(c_.now)) broken("the trigger is not watched: its thread hangs");
  if (const std::string strangers = two_senders(); !strangers.empty()) broken(strangers);
}

std::string Collector::two_senders() const {
  const char* of = c_.ports.encoders->senders() > 1   ? "encoder readings"
                   : front_end_.trigger().senders > 1 ? "the trigger"
                   : c_.ports.motion->senders() > 1   ? "motion replies"
                                                      : nullptr;
  if (!of) return {};
  return std::string("two senders of ") + of +
         ": are they of two robots, or does somebody pretend to be this one?";
}

std::string Collector::unfit() const {
  return stands() ? two_senders() : "the robot does not stand still, or is silent";
}

bool Collector::is_shut_in(const Eigen::VectorXd& here) const {
  const Robot& robot = *c_.models.active();
  return !path_is_free(robot, values(robot), here, c_.config.plan.home, c_.config.obstacles, 0, -1,
                       c_.config.plan.fence);
}

std::string Collector::unfit_to_go_on() const {
  const ExtendedState& s = c_.extended_state;
  if (s.state != ServiceState::awaiting_person || s.step >= s.steps) return {};
  if (std::string why = unfit(); !why.empty()) return why;
  if (!front_end_.closed())
    return because("the trigger's level is not known", front_end_.trigger().trouble);
  return is_shut_in(*front_end_.q()) ? kShutIn : "";
}

std::string Collector::rivals() const {
  if (c_.messenger.rivals() == 0) return {};
  return "another service of robot " + c_.config.id +
         " is in this DDS domain: one of the two must end (or has a robot the id of another?)";
}

std::string Collector::missing() const {
  const auto joints = static_cast<int>(c_.config.robot->joints().size());
  if (!front_end_.encoders_alive(c_.now) || !front_end_.at_rest())
    return because("no encoder readings come in", c_.ports.encoders->trouble());
  if (const std::string strangers = two_senders(); !strangers.empty()) return strangers;
  if (std::string others = rivals(); !others.empty()) return others;
  if (c_.extended_state.unfinished && !*front_end_.at_rest()) return "the robot moves";
  if (front_end_.samples().last().joints != joints)
    return "the encoders give " + std::to_string(front_end_.samples().last().joints) +
           " joints, the robot has " + std::to_string(joints);
  if (const std::string beyond = beyond_limits(); !beyond.empty()) return beyond;
  const std::string& trouble = front_end_.trigger().trouble;
  if (!front_end_.closed()) return because("the trigger's level is not known", trouble);
  if (!trouble.empty()) return trouble;
  if (front_end_.trigger().chatters) return kChatters;
  if (*front_end_.closed() && !c_.extended_state.unfinished)
    return "the trigger is closed while the robot stands: in contact, stuck, or inverted (`active` "
           "of a GPIO line)";
  return {};
}

/// A joint that reads what it cannot: its zero or its turns are wrong.
std::string Collector::beyond_limits() const {
  const Eigen::VectorXd q = *front_end_.q();
  const Eigen::ArrayXd units = units_of_readings(*c_.config.robot);
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    const Joint& joint = c_.config.robot->joints()[j];
    if (!joint.allows(q[j], -kBeyond * units[j]))
      return joint.name + " reads " + format_number(std::round(1e3 * q[j]) / 1e3) +
             ", beyond its limits: are its zero, its sign and its turns right?";
  }
  return {};
}

void Collector::check_rest() {
  if (c_.extended_state.state != ServiceState::collecting ||
      c_.extended_state.phase != Phase::settle)
    return;
  if (front_end_.at_rest() != true || !front_end_.closing()) return;
  if (c_.extended_state.engaged) {
    // Readings of the configuration itself, not of the way there.
    if (front_end_.samples().last().time > c_.extended_state.since) c_.put(Event::What::at_rest);
    return;
  }
  const Nanoseconds edge = front_end_.closing()->time - nanoseconds(c_.config.touch.delay);
  if (front_end_.samples().last().time > edge) c_.put(Event::What::at_rest);
}

void Collector::check_stop() {
  if (stopped_ == 0) return;
  if (front_end_.encoders_alive(c_.now) && front_end_.at_rest() == true &&
      c_.now - stopped_ >= kStopAgain) {
    stopped_ = 0;
    return leave_alone();
  }
  // Where the robot may move only the stop of a touch is still wanted; a move takes it back.
  const bool touching = c_.extended_state.state == ServiceState::collecting &&
                        c_.extended_state.phase == Phase::settle;
  if (c_.now - stopped_ < kStopAgain || (may_move(c_.extended_state.state) && !touching)) return;
  stop("until it stands");
}

}  // namespace selfcal
