// Blind trials of the diagnosis: what was true, what was answered, and how good that is.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/evidence/hypothesis.h"

namespace selfcal {

/// What a machine really had.
struct TrialTruth {
  std::string effect = kNone, second = {};  ///< second: empty for one cause alone
  std::map<std::string, std::vector<std::string>> where = {};  ///< by effect; naming any is right
  double r = 0;  ///< what calibration leaves of it, rms over the noise
  /// Closed fraction of a fit that is told every cause, cut to 0 ... 1.
  std::optional<double> told_closed = {};
};

struct TrialCauseNamed {
  std::string effect;
  std::vector<std::string> where = {};
  double probability = 0;
  std::vector<std::string> confounded_with = {};  ///< `effect` or `effect@place`
};

struct TrialAnswer {
  TrialCauseNamed verdict;
  std::vector<TrialCauseNamed> candidates = {};
  std::optional<double> closed = {};  ///< fraction of the gap, by everything found
  double seconds = 0;
};

/// A named cause is confident from this probability on, and two causes are both named from it on.
inline constexpr double kConfident = 0.5;
/// An answer that calls its cause confounded is no more certain of it than this.
inline constexpr double kMostWhenConfounded = 0.95;

/// One line of the table: `value` of `of` trials; `count` of them where the value is a share.
struct ScoreLine {
  std::string name;  ///< a key: "right_cause_r_1"
  std::string what;  ///< in words
  int of = 0;
  std::optional<int> count = {};
  std::optional<double> value = {};  ///< nothing when no trial asks for it
  double target = 0;
  bool at_most = false;  ///< the target is an upper bound

  bool met() const { return value && (at_most ? *value <= target : *value >= target); }
};

using TrialTruths = std::map<std::string, TrialTruth>;
using TrialAnswers = std::map<std::string, TrialAnswer>;

/// The verdict names a true cause, or calls its own confounded with it at a fitting probability.
bool right_cause(const TrialTruth& truth, const TrialAnswer& answer);
/// Some place of the verdict is true, and at most one is not; of a cause without a place always.
bool right_place(const TrialTruth& truth, const TrialAnswer& answer);
/// Both causes of a pair are named: by the verdict, or by a candidate that is confident.
bool both_causes(const TrialTruth& truth, const TrialAnswer& answer);

/// Every line in its order; a trial without an answer counts as answered wrongly.
std::vector<ScoreLine> score(const TrialTruths& truths, const TrialAnswers& answers);

}  // namespace selfcal
