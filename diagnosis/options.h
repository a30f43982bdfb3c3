// What a diagnosis is asked for; what it takes for granted is in constants.h.
#pragma once

#include <memory>

#include "constraints/estimation/options.h"

namespace selfcal {

struct PossibleRows;

/// Prior odds, and how far the search goes; each with its range and where it comes from, as in
/// constants.h.
struct SearchRule {
  double family_odds = 0.10;  ///< of one family against its absence; 0.03 to 0.2 [habit]
  /// Of structure that no known effect explains; 0.1 to 1 [trials]
  double unknown_odds = 0.4;
  double another = 0.25;  ///< factor on the odds of each cause after the first; 0.1 to 0.5 [habit]
  /// Odds that a cause acts at one more place: the joints of a robot are made alike; 0.2 to 1
  /// [physics]
  double same_family = 0.5;
  double again = 0.3;  ///< the same at one place: another wave, another moment; 0.1 to 0.5 [habit]
  int extended_singles = 14, extended_pairs = 14;  ///< 6 to 30 [cost]
  /// Beside noise alone: singles and pairs by any other, triples and larger sets by what their
  /// families have elsewhere; 0: none, and sets that no machine can have count as any other; 2 to
  /// 8 [cost].
  int extended_further = 4;
  int most_structures = 4;  ///< kept for pairs and triples; 2 to 8 [cost]
  /// True: the rows are whitened by what their best explanation leaves. False: each structure takes
  /// its noise from what its own best cause leaves.
  bool noise_is_known = false;
};

struct DiagnosisOptions {
  SearchRule search;
  /// A cause is named when `none` is less probable than the first of these, and noise looks as much
  /// like a cause less often than the second; 0.05 to 0.2, 0.01 to 0.05 [habit].
  double name_below_none = 0.1, name_below_p = 0.025;
  int resamples = 199;          ///< of the null distribution
  int simulated_sessions = 30;  ///< simulated sessions that calibrate probabilities; 0: none
  double most_outliers = Options{}.most_outliers;  ///< share of the rows that may be put aside
  unsigned long long seed = 1;
  /// Of these the further rows are chosen; null: of what the robot could do on paper.
  std::shared_ptr<const PossibleRows> possible = {};
  int most_further = 20;  ///< of them at most
};

}  // namespace selfcal
