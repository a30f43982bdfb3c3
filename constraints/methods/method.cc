// What a method does unless it says otherwise: it has no unknowns of its own.
#include "constraints/methods/method.h"

#include <algorithm>

namespace selfcal {

void MethodOutput::resize(int equations, int nuisance, int reference, int group) {
  r.setZero(kLanes, equations);
  G_now.setZero(kLanes, 6 * equations);
  G_before.setZero(kLanes, 6 * equations);
  D_own.setZero(kLanes, equations * nuisance);
  D_reference.setZero(kLanes, equations * reference);
  D_group.setZero(kLanes, equations * group);
}

void MethodOutput::clear(int lane) {
  for (Block* block : {&r, &G_now, &G_before, &D_own, &D_reference, &D_group})
    block->row(lane).setZero();
}

bool Method::has_lengths() const {
  const std::vector<Quantity> all = equations();
  return std::find(all.begin(), all.end(), Quantity::length) != all.end();
}

bool Method::has_angles() const {
  const std::vector<Quantity> all = equations();
  return std::find(all.begin(), all.end(), Quantity::angle) != all.end();
}

bool Method::every_row_alone() const {
  return tangent_dimension() == 0 && group_freedom() == 0 && reference().empty() && !paired() &&
         !vectors();
}

Eigen::Vector3d Method::device(const Eigen::VectorXd&) const { return Eigen::Vector3d::Zero(); }
std::optional<Plane> Method::plane(const Eigen::VectorXd&, const Eigen::VectorXd*) const {
  return std::nullopt;
}
Eigen::VectorXd Method::nuisance_of(const Plane&) const { return {}; }
bool Method::can_refer_to(const Method&) const { return false; }

Eigen::VectorXd Method::start(const std::vector<Location>&, const std::vector<int>&,
                              const Observations&, const Eigen::VectorXd*, const Location&) const {
  return {};
}
void Method::retract(Eigen::VectorXd&, const Eigen::VectorXd&) const {}
std::vector<NuisanceReport> Method::report(const Eigen::VectorXd&, const Eigen::VectorXd*) const {
  return {};
}
std::vector<OwnEquation> Method::own_equations(const Eigen::VectorXd&,
                                               const Eigen::VectorXd*) const {
  return {};
}
Eigen::VectorXd Method::start_group(const std::vector<Location>&) const { return {}; }
void Method::retract_group(Eigen::Ref<Eigen::VectorXd>, const Eigen::VectorXd&) const {}
double Method::link_residual(const GroupDistance&, const Eigen::VectorXd&, const Eigen::VectorXd&,
                             Eigen::VectorXd&, Eigen::VectorXd&) const {
  return 0;
}
Eigen::VectorXd Method::through(const Location&, const Eigen::VectorXd*, Random&) const {
  return {};
}
void Method::approach(const Eigen::VectorXd&, const Eigen::VectorXd*, Observations&, int) const {}
void Method::measure(const Location&, const Location&, const Eigen::VectorXd&, Observations&,
                     int) const {}

}  // namespace selfcal
