// The plane that most of the rows touch, by the least quantile of distances among planes through
// three of them drawn by chance (Rousseeuw, Least median of squares regression, 1984, with the
// share kOfOne in place of the half); what lies far beyond that quantile touches another one.
#include "constraints/slips/two_planes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kDraws = 300;
constexpr double kOfOne = 0.3;          // of the rows: the smaller of two has less than the larger
constexpr double kFarFromPlane = 10;    // times the quantile
constexpr double kLeastOfPlane = 1e-3;  // of the robot's size: nearer is the same plane
constexpr double kHardlyApart = 1e-6;   // of its square: three points that span no plane
constexpr double kLeastOther = 0.2;     // of the rows

struct TouchedPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double distance = 0;
  double off(const Eigen::Vector3d& p) const { return std::abs(normal.dot(p) - distance); }
};

/// The distance that `share` of the points keep from the plane.
double quantile_off(const TouchedPlane& plane, const std::vector<Eigen::Vector3d>& points,
                    double share) {
  std::vector<double> off;
  for (const Eigen::Vector3d& p : points) off.push_back(plane.off(p));
  const auto at = off.begin() + static_cast<long>(share * static_cast<double>(off.size() - 1));
  std::nth_element(off.begin(), at, off.end());
  return *at;
}

/// The plane near most of the points of a robot of size `size` (m).
TouchedPlane plane_of_most(const std::vector<Eigen::Vector3d>& points, double size) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::size_t> draw(0, points.size() - 1);
  TouchedPlane best;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Vector3d a = points[draw(random)], b = points[draw(random)],
                          c = points[draw(random)];
    const Eigen::Vector3d across = (b - a).cross(c - a);
    if (across.norm() < kHardlyApart * size * size) continue;
    TouchedPlane plane{across.normalized(), 0};
    plane.distance = plane.normal.dot(a);
    const double off = quantile_off(plane, points, kOfOne);
    if (off < least) least = off, best = plane;
  }
  return best;
}

}  // namespace

std::optional<DataSet> parted_planes(const Robot& robot, const DataSet& data, int set) {
  const Set& touched = data.sets[static_cast<std::size_t>(set)];
  if (touched.method->name() != "plane" || touched.given.place >= 0) return std::nullopt;
  std::vector<int> rows;
  std::vector<Eigen::Vector3d> points;
  for (int row = 0; row < data.rows.rows(); ++row) {
    if (data.rows.set[static_cast<std::size_t>(row)] != set) continue;
    rows.push_back(row);
    points.push_back(
        locate(robot, values(robot), data.rows.q.row(row).transpose(), Body::endpoint).p);
  }
  constexpr std::size_t kFewest = 10;
  if (rows.size() < kFewest) return std::nullopt;
  const double size = size_of(robot);
  const TouchedPlane plane = plane_of_most(points, size);
  const double near =
      std::max(kFarFromPlane * quantile_off(plane, points, kOfOne), kLeastOfPlane * size);
  DataSet parted = data;
  std::size_t others = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (plane.off(points[i]) <= near) continue;
    parted.rows.set[static_cast<std::size_t>(rows[i])] = static_cast<int>(data.sets.size());
    ++others;
  }
  if (static_cast<double>(others) < kLeastOther * static_cast<double>(rows.size()))
    return std::nullopt;
  Set other = touched;
  other.name += ", the rest";
  parted.sets.push_back(std::move(other));
  return parted;
}

}  // namespace selfcal
