#include "kinematics/suppositions.h"

namespace selfcal {

#define X(identifier, lasting) \
  void suppose_##identifier(const Supposed& rows, const EffectPlace& place, Suppositions& to);
#include "kinematics/effects.def"
#undef X

Suppositions suppose(const Supposed& rows, const EffectPlace& place) {
  Suppositions all;
#define X(identifier, lasting) \
  all.effect_ = #identifier;   \
  suppose_##identifier(rows, place, all);
#include "kinematics/effects.def"
#undef X
  return all;
}

}  // namespace selfcal
