// What the rows leave at a state, without derivatives: each residual, its length, and the shortest
// way to where it would vanish.
#include <cmath>
#include <iterator>

#include "constraints/equations/equations_inner.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {

namespace {

/// Of a lane that `closure` leaves open it is infinite.
RowResidual row_residual(const MethodOutput& out, const std::vector<Quantity>& quantities,
                         const Closure& closure, int lane, int row, int set, double factor) {
  RowResidual r{row, set};
  r.factor = factor;
  for (size_t a = 0; a < quantities.size(); ++a) {
    const double value = out.r(lane, static_cast<Eigen::Index>(a));
    const bool angle = quantities[a] == Quantity::angle;
    r.scalars.set(a, value);
    (angle ? r.angle : r.length) += value * value;
    ++(angle ? r.angles : r.lengths);
  }
  r.length = std::sqrt(r.length);
  r.angle = std::sqrt(r.angle);
  if (!closure.closes(lane)) r.length = HUGE_VAL;
  return r;
}

/// The smallest shift of the method's body, in the world (m), that to first order makes the lengths
/// among the residuals of a lane zero (minimum norm).
Eigen::Vector3d shortest_way(const MethodOutput& out, const std::vector<Quantity>& quantities,
                             int lane) {
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMostEquations, 3> G(quantities.size(), 3);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostEquations, 1> r(quantities.size());
  Eigen::Index count = 0;
  for (size_t a = 0; a < quantities.size(); ++a) {
    if (quantities[a] == Quantity::angle) continue;
    const auto column = static_cast<Eigen::Index>(a);
    G.row(count) = out.G_now.row(lane).segment<3>(6 * column).matrix();
    r[count++] = out.r(lane, column);
  }
  if (count == 0) return Eigen::Vector3d::Zero();
  if (count == 1 && G.row(0).squaredNorm() > 0)
    return -G.row(0).transpose() * (r[0] / G.row(0).squaredNorm());
  if (count == 3) {  // of coordinates in some axes: G turns
    const Eigen::Matrix3d A = G.topRows<3>();
    if ((A * A.transpose()).isIdentity(1e-12)) return -A.transpose() * r.head<3>();
  }
  return -least_squares(G.topRows(count), r.head(count));
}

}  // namespace

double RowResidual::sigmas(const Scale& scale) const {
  return std::hypot(length / scale.length, angle / scale.angle) / factor;
}

template <class Entry, class Of>
std::vector<Entry> Equations::of_every_block(const State& state, const Of& of) const {
  std::vector<Entry> all;
  all.reserve(items_of_all());
  const auto make = [&](int i) {
    const Part& part = parts_[static_cast<size_t>(i)];
    std::vector<Entry> list;
    list.reserve(static_cast<size_t>(part.last - part.first));
    Block block;
    for (int first = part.first; first < part.last; first += kLanes) {
      evaluate(part.set, first, std::min(kLanes, part.last - first), state, block, false);
      of(part.set, block, list);
    }
    return list;
  };
  in_order(static_cast<int>(parts_.size()), parts_at_once(items_of_all()), make,
           [&](int, std::vector<Entry> list) { std::ranges::move(list, std::back_inserter(all)); });
  return all;
}

std::vector<RowResidual> Equations::residuals(const State& state) const {
  return of_every_block<RowResidual>(
      state, [&](int set, const Block& block, std::vector<RowResidual>& list) {
        add_residuals(set, block, list);
      });
}

std::vector<RowNorm> Equations::norms(const State& state) const {
  return of_every_block<RowNorm>(state,
                                 [&](int set, const Block& block, std::vector<RowNorm>& list) {
                                   add_norms(set, block, list);
                                 });
}

std::vector<RowPlace> Equations::places(const State& state, int every) const {
  return of_every_block<RowPlace>(state,
                                  [&](int set, const Block& block, std::vector<RowPlace>& list) {
                                    for (int lane = 0; lane < block.count; ++lane) {
                                      if (block.rows[lane] % every != 0) continue;
                                      RowPlace& place = list.emplace_back();
                                      if (!block.closure.closes(lane)) continue;
                                      place.at = block.X_now.p(lane);
                                      place.way = shortest_way(block.out, quantities_[set], lane);
                                    }
                                  });
}

void Equations::add_residuals(int set, const Block& block, std::vector<RowResidual>& list) const {
  for (int lane = 0; lane < block.count; ++lane)
    list.push_back(row_residual(block.out, quantities_[set], block.closure, lane, block.rows[lane],
                                set, data_.rows.factor(block.rows[lane])));
}

void Equations::add_norms(int set, const Block& block, std::vector<RowNorm>& norms) const {
  Lanes length = Lanes::Zero(kLanes), angle = Lanes::Zero(kLanes);
  for (size_t a = 0; a < quantities_[set].size(); ++a)
    (quantities_[set][a] == Quantity::angle ? angle : length) +=
        block.out.r.col(static_cast<Eigen::Index>(a)).square();
  for (int lane = 0; lane < block.count; ++lane)
    norms.push_back(
        {block.closure.closes(lane) ? std::sqrt(length[lane]) : HUGE_VAL, std::sqrt(angle[lane])});
}

}  // namespace selfcal
