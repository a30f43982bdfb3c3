// What the service asks of a machine: thin seams without any vendor's types.
//
// The real robot (io/dds, SocketCAN, GPIO) and the simulated one (sim/machine.h) stand behind the
// same ports. Every call returns at once; only Clock::wait may block, and never longer than asked.
// What a port could not take in time it drops oldest first and counts.
//
// One time base: every stamp is CLOCK_MONOTONIC, or what the simulated robot has in its place.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/result.h"

namespace selfcal {

/// A moment on the time base, or a length of time (ns).
using Nanoseconds = std::int64_t;
inline constexpr Nanoseconds kMillisecond = 1'000'000;
inline constexpr Nanoseconds kSecond = 1'000'000'000;
constexpr Nanoseconds nanoseconds(double seconds) {
  return static_cast<Nanoseconds>(seconds * 1e9);
}
constexpr double seconds(Nanoseconds t) { return static_cast<double>(t) * 1e-9; }

class Wakeup;

inline constexpr int kMostJoints = 16;

/// Raw counts of all joints at one moment; complete or not there at all.
struct EncoderSample {
  Nanoseconds time = 0;
  int joints = 0;
  std::array<std::int64_t, kMostJoints> counts{};
  bool follows = true;  ///< false: something broke off before it, and nothing lies between the two
};

/// What a count of one joint means (rad or m); step < 0 turns it.
struct EncoderScale {
  double step = 1e-9;
  std::int64_t zero = 0;
  double reading(std::int64_t counts) const { return static_cast<double>(counts - zero) * step; }
};

/// What a port has met, and how often.
struct Tally {
  std::string_view name;
  std::uint64_t count = 0;
};

class EncoderSource {
 public:
  virtual ~EncoderSource() = default;
  virtual const std::vector<EncoderScale>& scales() const = 0;  ///< by joint
  /// Appends the samples since the last call, oldest first, at most `kMostSamples`. Fails when the
  /// source is broken for good; silence is no failure, the service notices it.
  virtual Result<void> take(std::vector<EncoderSample>& out) = 0;
  virtual std::uint64_t dropped() const = 0;  ///< samples lost since the start
  virtual std::vector<Tally> tallies() const {
    return {};
  }  ///< of what went wrong, since the start
  /// Senders heard at the moment, where the transport can tell: more than one are two robots, or
  /// somebody who pretends to be one.
  virtual int senders() const { return 1; }
  /// Messages of senders other than the first, none of which was believed, since the start.
  virtual std::uint64_t strange() const { return 0; }
  /// What is wrong at the moment, in a sentence for a person; empty when nothing is.
  virtual std::string trouble() const { return {}; }
  static constexpr std::size_t kMostSamples = 1024;
};

/// The trigger's level changed.
struct Edge {
  Nanoseconds time = 0;
  bool closed = false;
  bool timed = true;  ///< false: the edge was lost, and this is when it was noticed
};

class TouchTrigger {
 public:
  virtual ~TouchTrigger() = default;
  /// Level as last seen; nothing as long as it is not known.
  virtual std::optional<bool> closed() = 0;
  /// Appends the edges since the last call, oldest first, not debounced, at most `kMostEdges`.
  virtual Result<void> take(std::vector<Edge>& out) = 0;
  virtual std::uint64_t dropped() const = 0;
  /// As those of EncoderSource.
  virtual int senders() const { return 1; }
  virtual std::uint64_t strange() const { return 0; }
  /// What is wrong at the moment, in a sentence for a person; empty when nothing is.
  virtual std::string trouble() const { return {}; }
  static constexpr std::size_t kMostEdges = 256;
};

enum class MoveKind : std::uint8_t {
  travel,   ///< through free space
  touch,    ///< towards a surface, until the service says stop; a robot stops by itself when it no
            ///< longer hears the service
  seat,     ///< the tool gives way until it sits in the socket or nest
  retract,  ///< back out of a contact
  lock,     ///< stand, every leg held, and engage the lock that the label names; done when engaged
  visit,    ///< with a lock engaged: the legs give way to what it allows nearest `q`
  release,  ///< stand, every leg held, and open whatever lock is engaged; done when open
};
std::string_view to_string(MoveKind kind);

/// What the label of a move ends with that is made with the payload on the tool.
inline constexpr const char* kWithPayload = ", payload";

/// A straight move in joint space to readings `q` (rad or m).
struct MotionRequest {
  std::uint64_t id = 0;  ///< grows with every request
  MoveKind kind = MoveKind::travel;
  std::string label;      ///< of the touch it serves ("table 17"), for a person; of a lock, which:
                          ///< "leg 1 universal"
  std::vector<double> q;  ///< target, by joint
  double speed = 1;       ///< largest joint speed (rad/s or m/s)
};

/// What a robot is asked: a move, or to stop.
struct RobotRequest {
  bool stop = false;
  std::string why;     ///< of a stop
  MotionRequest move;  ///< of a move
};

struct MotionReply {
  enum class Outcome : std::uint8_t { accepted, done, stopped, refused };
  std::uint64_t id = 0;
  Outcome outcome = Outcome::done;
  std::string why;  ///< of a refusal or a stop that nobody asked for
};
std::string_view to_string(MotionReply::Outcome outcome);

/// `request` and `stop` may be called by a thread other than the one that takes.
class Motion {
 public:
  virtual ~Motion() = default;
  virtual Result<void> request(const MotionRequest& request) = 0;
  /// Stops whatever moves, now. Never refused, and may be said again.
  virtual Result<void> stop(const std::string& why) = 0;
  virtual Result<void> take(std::vector<MotionReply>& out) = 0;
  /// Of replies; as those of EncoderSource.
  virtual int senders() const { return 1; }
  virtual std::uint64_t strange() const { return 0; }
};

class Thermometer {
 public:
  virtual ~Thermometer() = default;
  virtual std::optional<double> celsius() = 0;  ///< nothing when not known
};

class Clock {
 public:
  virtual ~Clock() = default;
  virtual Nanoseconds now() = 0;
  virtual std::int64_t unix_ms() = 0;  ///< wall clock (ms since 1970, UTC); may step
  /// Returns after `longest`, or as soon as a port may have news.
  virtual void wait(Nanoseconds longest) = 0;
};

/// The ports of one machine. What may be null says so.
struct Ports {
  Clock* clock = nullptr;
  EncoderSource* encoders = nullptr;
  TouchTrigger* trigger = nullptr;
  Motion* motion = nullptr;
  Thermometer* thermometer = nullptr;  ///< may be null
  /// With one, the trigger is watched by a thread of its own, whose wait this clock ends as soon as
  /// the trigger has news. A machine whose time passes in the service's turns has none.
  Clock* trigger_clock = nullptr;
  Wakeup* wakeup = nullptr;  ///< ends `clock`'s wait early; may be null
};

}  // namespace selfcal
