// The causes that a diagnosis weighs: every effect, at every place where it may act, in the shapes
// that it may take.
//
// A candidate is one hypothesis: an effect at a place in one shape (a moment, a wave number, a time
// lag). A cause is what a person is told: the effect and the place, whatever its shape; a family is
// the effect alone. Priors are spread equally over families, then places, then shapes.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "constraints/methods/data_set.h"
#include "kinematics/effect.h"
#include "kinematics/effect_shape.h"
#include "kinematics/suppositions.h"

namespace selfcal {

/// Parameters that only take up what a candidate's own have wrong.
struct SlackParameters {
  std::vector<int> list = {};  ///< counted over all candidates' effects
  double doubt = 0;            ///< size of these, together, over its own
};

struct Candidate {
  std::string effect, at;  ///< at is empty for the whole robot
  EffectShape shape = {};
  std::vector<int> main = {};  ///< its parameters, counted over all candidates' effects
  std::vector<SlackParameters> slack = {};  ///< a shape of the same effect each
  int joint = -1;                           ///< at which it acts; -1 elsewhere
  std::string needs = {};                   ///< what rows must have so that it can be seen
  double share = 1;                         ///< of its shape among the shapes at its place
  double odds = 1;                          ///< of the family, over those of another one
  double log_prior = 0;                     ///< with the place and the shape within the family
  /// Of a step: the last row before it, the first one behind (s).
  std::optional<std::pair<double, double>> between = {};
  /// Probability that it is meant where it explains; else it is what no candidate has.
  double meant = 1;
};

struct Candidates {
  std::vector<Candidate> list;
  /// Many shapes of one cause at once: too many parameters to ask whether it is there, but once it
  /// is, they close more of the gap. Their parameters are those of candidates in `list`.
  std::vector<Candidate> profiles;
  std::vector<Untestable> untestable;
  std::vector<ShapedEffect> made;  ///< in order: what a robot that has them all is made of
};

/// The same with the profiles at the end of the list.
Candidates with_profiles(Candidates all);

/// What rows hint at, that is not tried else.
struct Hints {
  std::vector<ShapedEffect> steps = {};  ///< at as many more moments up to those next to theirs
  std::vector<std::vector<double>> fine_waves = {};  ///< a turn, by joint (fine_waves.h)
};

/// Every candidate whose measurement context the rows carry. Steps are tried at few moments.
Candidates candidates(const Robot& robot, const DataSet& data, const MeasurementContext& context,
                      const Hints& hints = {});

}  // namespace selfcal
