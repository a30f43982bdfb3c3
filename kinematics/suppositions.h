// Where an effect may act, and in which shapes: what each effect says of itself when a diagnosis
// asks (effects/NAME.cc, suppose_NAME), or why rows like these cannot tell.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinematics/effect.h"
#include "kinematics/effect_shape.h"

namespace selfcal {

/// What is asked about: the robot, the rows as far as effects ask, and how finely shapes are tried.
struct Supposed {
  const Robot& robot;
  const MeasurementContext& context;
  bool warms = false;    ///< temperatures change
  bool normals = false;  ///< rows carry the touched surface's normal
  int most_waves = 0;    ///< a turn that are asked for one by one
  int profile = 0;       ///< waves a turn of a whole profile
  /// By joint, more of them that the rows hint at, and how likely each is beside the others.
  std::vector<std::vector<double>> hinted_waves = {};
  double hinted_share = 1;
  double assumed = 0;  ///< doubt of masses that are usual ones, over what they exert
  /// Moments at which a step may have happened, of the rows of a set (-1: of all).
  std::function<std::vector<double>(int set)> moments = {};
  /// A set has rows enough to show a form.
  std::function<bool(int set)> shows = {};
};

/// One place: a joint, a set, or (both -1) the robot as a whole with its base and its probe.
struct EffectPlace {
  int joint = -1, set = -1;
  std::string name = {};  ///< of the joint or the set
  bool whole() const { return joint < 0 && set < 0; }
};

/// A shape that takes up what another has wrong.
struct Slack {
  EffectShape shape = {};
  double doubt = 0.25;  ///< its size over the other's
};

/// An effect in one shape, with what is wrong with it.
struct Supposition {
  std::string effect, at;
  EffectShape shape = {};
  std::vector<Slack> slack = {};
  int together = 0;      ///< not 0: the first so many of the same effect and place as one
  bool profile = false;  ///< asked for only once it is known to be there
  double share = 1;      ///< how likely beside the effect's other shapes at its place
  double odds = 1;       ///< of its effect, over those of another one: as machines have them
  bool drifts = false;   ///< in time, as all does that goes with the places in their order
};

/// A cause that these rows cannot test at all.
struct Untestable {
  std::string effect, at, why;
};

/// What the effects suppose, in the order of effects.def.
class Suppositions {
 public:
  void add(std::string at, EffectShape shape = {}, std::vector<Slack> slack = {}) {
    list_.push_back({std::string(effect_), std::move(at), std::move(shape), std::move(slack)});
  }
  void cannot(std::string at, std::string why) {
    untestable_.push_back({std::string(effect_), std::move(at), std::move(why)});
  }
  Supposition& last() { return list_.back(); }

  const std::vector<Supposition>& list() const { return list_; }
  const std::vector<Untestable>& untestable() const { return untestable_; }

 private:
  friend Suppositions suppose(const Supposed& rows, const EffectPlace& place);

  std::string_view effect_;
  std::vector<Supposition> list_;
  std::vector<Untestable> untestable_;
};

/// Of every effect that may act at `place`.
Suppositions suppose(const Supposed& rows, const EffectPlace& place);

}  // namespace selfcal
