// What the service tells and is told, as plain structs; io/dds carries them over DDS.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/outcome.h"
#include "io/result.h"

namespace selfcal {

/// What the service is and does. Sent on every change.
struct StatusMessage {
  std::int64_t unix_ms = 0;
  std::string robot, model_hash, version;
  std::string state;                 ///< "collecting"
  std::string phase;                 ///< "touch"; empty outside collecting
  std::string hardware;              ///< what the hardware may do in this state, in words
  std::string why;                   ///< why it is in this state, in words
  std::int64_t session = 0;          ///< running or last one; 0 before the first
  std::string kind;                  ///< "full", "check", "cause" or empty
  std::string active;                ///< "factory" or "session 12"
  std::int64_t active_since_ms = 0;  ///< 0 for factory
  bool candidate = false;            ///< a result waits for acceptance
  std::int64_t next_due_ms = 0;      ///< 0 when nothing is scheduled
  double temperature = 0;            ///< °C; NaN when not known
  bool operator==(const StatusMessage&) const = default;
};

/// How far the running session is; sent after every touch.
struct ProgressMessage {
  std::int64_t unix_ms = 0;
  std::string robot;
  std::int64_t session = 0;
  std::string kind;
  std::uint32_t done = 0, planned = 0, outlier = 0;
  double seconds_left = 0;  ///< NaN when not known
  std::string set;          ///< of the last touch
  std::uint32_t index = 0;  ///< of the last touch in the plan
  double residual = 0;      ///< m, against the active model and the surface as known so far; NaN
  bool accepted = false;    ///< false: put aside
  std::string note;         ///< why it was put aside, or the stage of the computation
  bool operator==(const ProgressMessage&) const = default;
};

/// The outcome of a session.
struct ResultMessage : ResultFigures {
  std::int64_t unix_ms = 0;
  std::string robot, model_hash;
  std::int64_t session = 0;
  std::string kind;      ///< "full", "check" or "cause"
  std::string answer;    ///< of ResultAnswer: "not-improved"
  std::string decision;  ///< of ResultDecision: "applied"
  std::string why;
  std::string json;        ///< result.json's content, or diagnosis.json's; empty for a check
  std::string cause = {};  ///< what is named, "backlash@j2"; empty where nothing is
  double cause_probability = 0;
  double cause_closes = 0;  ///< share of the gap that it closes; NaN where that is not known
  bool operator==(const ResultMessage&) const = default;
};

enum class Health : std::uint8_t { ok = 0, warn = 1, error = 2, stale = 3 };

/// One line of diagnostic_msgs/DiagnosticArray.
struct HealthMessage {
  std::string name;  ///< "selfcal: encoders"
  Health level = Health::ok;
  std::string message;
  std::vector<std::pair<std::string, std::string>> values;  ///< the unit stands in the key
};

/// All lines of health of one moment.
struct HealthReport {
  std::int64_t unix_ms = 0;
  std::string hardware_id;
  std::vector<HealthMessage> lines;
};

struct CommandMessage {
  std::string id;    ///< chosen by the sender, repeated in the reply
  std::string verb;  ///< "start", "abort": one of those that the service takes
  std::string from;  ///< who asks, for the log
};

struct CommandReplyMessage {
  std::string id, verb;
  bool accepted = false;
  std::string why;
};

/// The service's voice and ear.
class Messenger {
 public:
  virtual ~Messenger() = default;
  virtual void publish(const StatusMessage& status) = 0;
  virtual void publish(const ProgressMessage& progress) = 0;
  virtual void publish(const ResultMessage& result) = 0;
  /// All lines of one moment; `hardware_id` is the robot's serial number or name.
  virtual void publish(const std::vector<HealthMessage>& health,
                       const std::string& hardware_id) = 0;
  virtual void reply(const CommandReplyMessage& reply) = 0;
  /// Appends the commands since the last call, oldest first. Of more than a few a second the others
  /// are refused at once and counted.
  virtual void take(std::vector<CommandMessage>& out) = 0;
  virtual std::uint64_t refused() const = 0;
  /// Services of this robot beside us that are heard at the moment.
  virtual int rivals() const { return 0; }
  /// Messages that could not be sent in time since the start.
  virtual std::uint64_t unsent() const = 0;
};

}  // namespace selfcal
