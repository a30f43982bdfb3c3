// What the touches of a session say as rows of a data set.
#pragma once

#include <optional>
#include <vector>

#include "app/service/session/decoding.h"
#include "app/service/session/session.h"

namespace selfcal {

/// The rows that the good touches make, in the order of the plan, with speed, time and temperature.
/// With `all_check` every row only judges, with `all_fit` every row identifies. A row's noise is
/// that of its set and, on top, what the reading leaves open (Reading::sigma_time) at the speed at
/// which `robot`, nearly the true one, came in. Each engagement of a lock has constants of its own:
/// the first is the set, a later one a set NAME-2, NAME-3 … (a free name) beside it; one of fewer
/// than kFewestOfLock rows, two of them to fit, is left out beside one that has more.
inline constexpr int kFewestOfLock = 4;
enum class Parts { as_planned, all_check, all_fit };
DataSet rows_of(const Robot& robot, const Session& session, const Decoding& decoding,
                Parts parts = Parts::as_planned);

/// The step of the plan that each of these rows comes from.
std::vector<int> steps_of_rows(const Session& session, const Decoding& decoding);

/// The fit rows of `base` and the rows of `check` as rows that judge; both have the same sets.
DataSet joined(const DataSet& base, const DataSet& check);

/// Distance of the last row from its surface (socket) as the rows so far have it, with the robot's
/// own values; nothing while they are too few to tell (m).
std::optional<double> running_residual(const Robot& robot, const DataSet& data);

}  // namespace selfcal
