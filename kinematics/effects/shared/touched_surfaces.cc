#include "kinematics/effects/shared/touched_surfaces.h"

namespace selfcal {

const MeasuredSet* TouchedSurfaces::set_of(const RegressorInput& at) const {
  const auto set = static_cast<std::size_t>(at.set);
  if (at.set < 0 || set >= sets_.size() || sets_[set].touch == TouchedSurface::none) return nullptr;
  return &sets_[set];
}

bool TouchedSurfaces::touched(const RegressorInput& at) const {
  return set_of(at) || at.normal.allFinite();
}

bool TouchedSurfaces::on_ball(const RegressorInput& at) const {
  const MeasuredSet* set = set_of(at);
  return set && set->touch == TouchedSurface::curved;
}

Eigen::Vector3d TouchedSurfaces::normal(const RegressorInput& at) const {
  const MeasuredSet* set = set_of(at);
  const bool known = set && set->normal.norm() > 1e-6;
  return at.normal.allFinite() || !known ? at.normal : set->normal.normalized();
}

}  // namespace selfcal
