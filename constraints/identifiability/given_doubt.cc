#include "constraints/identifiability/given_doubt.h"

#include <algorithm>
#include <cmath>

#include "constraints/methods/plane.h"

namespace selfcal {
namespace {

constexpr double kBelieved = 1e-4;
/// Of a gear ratio without a tolerance: tooth counts are exact, a ball screw or a belt less so.
constexpr double kHeldRatio = 2e-5;
/// Of a probe's radius without a tolerance: a micrometre or two where a ball has millimetres.
constexpr double kBall = 1e-3;

bool is_plane(const Set& set) { return set.method->touches() == TouchedSurface::plane; }

/// What a probe that is larger than given does to the distance of a plane (m, 1 sigma): once to
/// one that is known, twice to that from another one that was touched from the other side,
/// nothing to that from one on the same side.
double by_probe(const Set& set, bool opposite) {
  const double radius = probe_radius(*set.method);
  if (radius <= 0) return 0;
  const double doubt = set.given.length >= 0 ? set.given.length : kBall * radius;
  if (set.reference < 0) return doubt;
  return opposite ? 2 * doubt : 0;
}

}  // namespace

double doubt_of_fixed(const Parameter& p) {
  if (!is_own(p) || p.tolerance <= 0) return 0;
  return p.part == Part::gear && !p.free ? std::min(kHeldRatio, p.tolerance) : p.tolerance;
}

double doubt_of_length(const Set& set, const KnownLength& length, bool opposite) {
  const bool plane = is_plane(set);
  const double stated = plane ? set.given.place : set.given.length;
  const double alone = stated >= 0 ? stated : kBelieved * std::abs(length.value);
  return std::hypot(length.by_row ? alone : 0, plane ? by_probe(set, opposite) : 0);
}

double doubt_of_centre(const Set& set, double distance) {
  if (is_plane(set)) return 0;
  return set.given.place >= 0 ? set.given.place : kBelieved * distance;
}

double doubt_of_turn(const Set& set) {
  if (!is_plane(set)) return 0;
  return set.given.turn >= 0 ? set.given.turn : kBelieved;
}

}  // namespace selfcal
