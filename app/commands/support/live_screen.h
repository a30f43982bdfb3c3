// A picture on the terminal that follows what is heard, until the person leaves it.
#pragma once

#include <functional>
#include <vector>

#include "app/report/live/monitor_view.h"
#include "io/result.h"
#include "io/wakeup.h"

namespace selfcal {

/// Draws until `q` is pressed, a signal tells to stop, or `take` fails; `p` holds the picture still
/// and lets it go on. `take` takes what has come and says whether anything has; `draw` makes the
/// picture for so many columns and rows. The last line names the keys.
Result<void> show_live(Wakeup& wakeup, const std::function<Result<bool>()>& take,
                       const std::function<std::vector<Line>(int columns, int rows)>& draw);

}  // namespace selfcal
