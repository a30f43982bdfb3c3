// The identification of rows with locked joints, some of which may have slipped.
#pragma once

#include "constraints/estimation/identification.h"

namespace selfcal {

/// Slips of one engagement that are believed; beyond them its rows are put aside.
inline constexpr int kMostSlips = 1;

struct Engagements {
  Solution solution;  ///< of the rows kept, with all slips; rows counted as in `data`
  DataSet data;       ///< as given, but the rows after a slip are sets NAME-2, NAME-3 … beside
  std::vector<int> kept;  ///< rows of `data` that were used, ascending
};

/// identify(), as often as it takes: where a lock slipped, the rows after it are an engagement of
/// their own, whose direction is fitted on its own. One that slips more than kMostSlips times is
/// put aside whole: its rows are among the solution's outliers, the lock among its
/// locks_left_out. Without a slip it is identify().
Engagements identify_engagements(const Robot& robot, DataSet data, const Options& options = {},
                                 const Progress& progress = {});

/// A set beside `sets` like `set`, under the first name NAME-2, NAME-3 … that is free; its index.
int add_engagement(std::vector<Set>& sets, int set);

}  // namespace selfcal
