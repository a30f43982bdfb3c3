#include "constraints/planning/next_place.h"

#include <algorithm>
#include <cmath>

#include "constraints/planning/detmax.h"

namespace selfcal {
namespace {

/// A pool with what there is and, perhaps, one more set.
struct Tried {
  PoolRequest request;
  Pool pool;
};

/// As many units, those of the last set first: one touch of an unknown surface tells nothing, so
/// that none would be begun one by one.
std::vector<int> beginning(const Tried& tried, int count) {
  const auto last = static_cast<int>(tried.pool.data.sets.size()) - 1;
  std::vector<int> of_last, others;
  for (int i = 0; i < static_cast<int>(tried.pool.units.size()); ++i) {
    const int row = tried.pool.units[static_cast<std::size_t>(i)].front();
    (tried.pool.data.rows.set[row] == last ? of_last : others).push_back(i);
  }
  of_last.insert(of_last.end(), others.begin(), others.end());
  of_last.resize(static_cast<std::size_t>(count));
  return of_last;
}

/// The end position's sigma after the best of the pool besides what is taken; which these are.
double sigma_after(const Robot& robot, const NextRequest& request, Tried& tried,
                   std::vector<int>& chosen) {
  const PlanSystem system(robot, tried.request, request.workspace, request.count, tried.pool);
  if (!system.lacking().empty() || tried.pool.units.empty()) return HUGE_VAL;
  Design design(system.rows(tried.pool.data, tried.pool.units, Criterion::sigma),
                system.objective(Criterion::sigma));
  design.choose(beginning(tried, std::min(request.count, design.candidates())));
  add_and_drop(design);
  chosen = design.chosen();
  return std::sqrt(-design.merit());
}

NextPlace place_of(const Robot& robot, const Tried& tried, const std::vector<int>& chosen,
                   double sigma) {
  NextPlace place;
  place.sigma = sigma;
  const auto last = static_cast<int>(tried.pool.data.sets.size()) - 1;
  std::vector<Eigen::Vector3d> points;
  for (const int i : chosen)
    for (const int row : tried.pool.units[static_cast<std::size_t>(i)])
      if (tried.pool.data.rows.set[row] == last)
        points.push_back(
            locate(robot, tried.pool.state.xi, tried.pool.data.rows.q.row(row).transpose()).p);
  // No more than say where it lies itself tell nothing of the robot.
  const Method& method = *tried.pool.data.sets.back().method;
  if (points.size() * method.equations().size() <=
      static_cast<std::size_t>(method.tangent_dimension() + method.group_freedom()))
    return place;
  place.radius = 0;
  for (const Eigen::Vector3d& p : points) place.centre += p / static_cast<double>(points.size());
  for (const Eigen::Vector3d& p : points)
    place.radius = std::max(place.radius, (p - place.centre).norm());
  const auto plane =
      tried.pool.data.sets.back().method->plane(tried.pool.state.nuisance.back(), nullptr);
  if (plane) place.normal = plane->n;
  return place;
}

}  // namespace

NextPlaces next_places(const Robot& robot, const Eigen::VectorXd& xi, const NextRequest& request,
                       const Progress& progress) {
  NextPlaces next;
  std::vector<int> chosen;
  Tried same{request.pool, draw_pool(robot, xi, request.pool)};
  next.sigma_same = sigma_after(robot, request, same, chosen);
  if (!std::isfinite(next.sigma_same)) {
    next.problem = "these methods tell nothing of this robot there";
    return next;
  }
  {
    const PlanSystem system(robot, same.request, request.workspace, request.count, same.pool);
    next.sigma_now = system.figures(same.pool.data, {}).sigma;
  }
  for (int i = 0; i < request.tries; ++i) {
    if (progress) progress("looking for further places", i / static_cast<double>(request.tries));
    Tried tried{request.pool, {}};
    tried.request.sets.push_back(request.further);
    tried.request.taken.sets = tried.request.sets;
    tried.request.seed = request.pool.seed + static_cast<unsigned long long>(i) + 1;
    tried.pool = draw_pool(robot, xi, tried.request);
    const double sigma = sigma_after(robot, request, tried, chosen);
    const NextPlace place = place_of(robot, tried, chosen, sigma);
    // One that gets no configuration, or of which none was found, is no place.
    if (std::isfinite(sigma) && place.radius >= 0) next.places.push_back(place);
  }
  std::ranges::sort(next.places, {}, &NextPlace::sigma);
  if (next.places.empty()) next.problem = "nowhere that was tried can the robot measure it";
  return next;
}

}  // namespace selfcal
