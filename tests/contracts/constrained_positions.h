// Random configurations of an arm that hold its endpoint at unknown points.
#pragma once

#include <vector>

#include "constraints/sampling/configurations.h"
#include "tests/contracts/arm.h"
#include "tests/contracts/method_case.h"

namespace selfcal {

struct ConstrainedPositions {
  DataSet data;
  Sampled sampled;
};

/// The joints `held` are locked at readings of their own.
inline ConstrainedPositions at_constrained_positions(const Robot& arm, int rows,
                                                     const std::vector<int>& held = {}) {
  ConstrainedPositions made;
  made.data.sets = make_sets("s: {method: position-constraint}");
  SampleRequest request;
  request.rows = rows;
  request.held = held;
  Random random(4);
  made.sampled = sample_rows(arm, values(arm), {request}, random, made.data);
  return made;
}

}  // namespace selfcal
