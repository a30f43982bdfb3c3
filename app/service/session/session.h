// The session in progress as the store has it: plan, touches, and what is still to be done.
#pragma once

#include <vector>

#include "app/service/transitions/state.h"
#include "constraints/planning/touch_plan.h"
#include "io/store/store.h"

namespace selfcal {

struct Session {
  SessionRecord record;
  std::vector<StepRecord> plan;
  std::vector<TouchRecord> touches;
  SessionKind kind() const { return kind_of(record.kind).value_or(SessionKind::full); }
};

/// Readings as the store and the ports have them, as a vector.
Eigen::VectorXd vector_of(const std::vector<double>& readings);

/// The plan as the store keeps it.
std::vector<StepRecord> steps_of(const TouchPlan& plan, const std::vector<Set>& sets);

/// Good touches of a step so far; those before a touch that differed from them do not count.
std::vector<const TouchRecord*> good_touches(const Session& session, int step);
/// The first step that needs another touch.
int next_step(const Session& session, int repeats, int attempts);
/// Steps that are put aside: no attempt is left and too few touches are good.
int steps_put_aside(const Session& session, int repeats, int attempts);

/// The session up to `step`, of each set the last touches alone: as many as tell where a surface
/// is, however long the session.
Session lately(const Session& session, std::size_t step);

}  // namespace selfcal
