// One joint's counts from frame to frame: turns are counted on, and a jump is told.
#pragma once

#include "io/can/faults.h"
#include "io/can/map.h"

namespace selfcal {

class JointTrack {
 public:
  /// What a count means against the one before it.
  enum class Step : std::uint8_t {
    first,    ///< nothing to compare with
    follows,  ///< the joint can have moved so far
    jumped,   ///< it cannot; the next count is compared with this one
    guessed,  ///< it was silent so long that it may have passed more than half a turn of its
              ///< counter
  };
  explicit JointTrack(const CanJoint& joint) : joint_(&joint) {}

  /// Tells the count `raw` of time `t`, which must be later than the last one.
  Step add(std::int64_t raw, Nanoseconds t);
  std::int64_t counts() const { return counts_; }  ///< of the last one, turns counted
  /// Counts the joint can move in `span`.
  double reach(Nanoseconds span) const;

 private:
  const CanJoint* joint_;
  bool known_ = false;
  std::int64_t counts_ = 0;
  Nanoseconds time_ = 0;
};

/// Tells the fault that a step is, if it is one.
void note_step(CanFaults& faults, JointTrack::Step step, const std::string& joint, Nanoseconds t);

}  // namespace selfcal
