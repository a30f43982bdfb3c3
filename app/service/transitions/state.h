// The service's states and what the hardware may do in each.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace selfcal {

enum class ServiceState : std::uint8_t {
  self_test,
  idle,
  planning,
  collecting,
  analysing,
  identifying,
  judging,
  diagnosing,
  awaiting_person,
  awaiting_acceptance,
  applying,
  publishing,
  fault,
};

/// Where a touch is, while collecting; lock, visit and release are of a joint's lock.
enum class Phase : std::uint8_t { none, approach, touch, settle, retract, lock, visit, release };

/// A full calibration, a quick check, or a look for the cause of what calibration leaves.
enum class SessionKind : std::uint8_t { full, check, cause };

enum class Verb : std::uint8_t { start, check, diagnose, done, abort, accept, reject, rollback };

std::string_view to_string(ServiceState state);
std::string_view to_string(Phase phase);  ///< empty for none
std::string_view to_string(SessionKind kind);
std::string_view to_string(Verb verb);

/// Nothing for a text that is none of them.
std::optional<Verb> verb_of(std::string_view text);
std::optional<SessionKind> kind_of(std::string_view text);
/// All of them: "start, check, …".
std::string verb_names();

/// What the hardware may do, in words; the service asks for nothing else in this state.
std::string_view hardware_may(ServiceState state, Phase phase);
/// True where the service may ask for motion. Into every other state it goes once its last move has
/// ended, or tells the robot to stop.
bool may_move(ServiceState state);

}  // namespace selfcal
