// One joint's counts from frame to frame: turns are counted on, and a jump is told.
#pragma once

#include "io/can/faults.h"
#include "io/can/map.h"

namespace selfcal {

class JointTrack {
 public:
  /// What a count means against the ones before it.
  enum class Step : std::uint8_t {
    first,    ///< nothing to compare with
    follows,  ///< the joint can have moved so far
    jumped,   ///< it cannot: either this count is wrong, or all from now on are of another zero
    back,     ///< the one before was wrong: this follows the last one that did
    stayed,   ///< the count after a jump went on from there: the joint's zero is not known any more
    guessed,  ///< it was silent so long that it may have passed more than half a turn of its
              ///< counter
  };
  explicit JointTrack(const CanJoint& joint) : joint_(&joint) {}

  /// Tells the count `raw` of time `t`, which must be later than the last one.
  Step add(std::int64_t raw, Nanoseconds t);
  /// Something was lost before the next count, or its time is not comparable: it is believed.
  void break_off() { broke_off_ = true; }
  std::int64_t counts() const { return counts_; }  ///< of the last one, turns counted
  /// Counts the joint can move in `span`.
  double reach(Nanoseconds span) const;

 private:
  /// Whether a joint can have come from `before` to `after` in `span`.
  bool reachable(std::int64_t before, std::int64_t after, Nanoseconds span) const;
  std::int64_t nearest(std::int64_t raw, std::int64_t near) const;
  void trust(std::int64_t counts);

  const CanJoint* joint_;
  bool known_ = false, jumped_ = false, broke_off_ = false;
  std::int64_t counts_ = 0, trusted_ = 0;  ///< trusted: of the last one that followed
  Nanoseconds time_ = 0, trusted_time_ = 0;
};

/// Tells the fault that a step is, if it is one.
void note_step(CanFaults& faults, JointTrack::Step step, const std::string& joint, Nanoseconds t);

}  // namespace selfcal
