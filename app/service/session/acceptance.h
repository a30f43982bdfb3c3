// What becomes of a result: a candidate is applied, shown to a person, or rejected with its reason.
#pragma once

#include <string>

#include "app/service/config/config.h"
#include "constraints/methods/data_set.h"
#include "constraints/solution.h"
#include "io/outcome.h"

namespace selfcal {

/// Its figures are those of the candidate, but for the touches.
struct AcceptanceDecision : ResultFigures {
  bool acceptable = false;
  bool asks = false;  ///< acceptable, but by a person alone: a lock was put aside
  Answer answer = Answer::not_determined;  ///< the verdict's
  std::string why;
};

/// Judges a candidate, identified from rows starting at `active`, against the active parameters;
/// `unchanged` is what the same rows say with every parameter of the robot held at them. It is
/// acceptable when its verdict is improved, it meets the check rows better than the active
/// parameters do (check_comparison.h) and by the margin (rows that either finds beyond the noise
/// left out of both), and no parameter changes by more than its limit.
AcceptanceDecision decide_on_result(const Acceptance& accept, const Robot& active,
                                    const Solution& candidate, const Solution& unchanged);

/// Whether what a calibration leaves is noise.
struct FitDecision {
  bool noise = true;
  double p_value = 1;
  std::string why;
};

/// The squares that are left are compared with those of immediate repeats (F test) or, without
/// repeats, with the data sheets of the sets that have one (chi square).
FitDecision decide_on_fit(const Solution& solution, const std::vector<Set>& sets);

/// Parameters that the rows determine.
std::uint32_t parameters_identified(const Solution& solution);
/// Rows put aside, from which nothing was identified. Outliers among the check rows are named in
/// the result, but count all the same.
std::uint32_t count_outliers(const Solution& solution);

/// Whether the active model explains the touches of a quick check: check_after is their rms,
/// check_before that of the rows that judged the session behind the active parameters (m).
struct CheckDecision : ResultFigures {
  bool explained = false;
  std::string why;
};

/// `then` is the session behind the active parameters, `now` the same fit rows with the new touches
/// as check rows; both with every parameter of the robot held. The mean squares of the new touches
/// and of the session's check rows have the same expectation as long as nothing has changed: their
/// ratio is compared with F, whose freedoms are the configurations, for repeats share more than
/// their noise.
CheckDecision decide_on_check(const Solution& then, const Solution& now, double least_p);

}  // namespace selfcal
