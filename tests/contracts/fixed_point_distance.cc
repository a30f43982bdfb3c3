// Distances from a fixed point, worked by hand: rows, their derivatives and where the point starts.
#include <gtest/gtest.h>

#include "tests/contracts/method_case.h"

namespace selfcal {
namespace {

constexpr double kByHand = 1e-15;  // rounding
constexpr double kSolved = 1e-12;  // rounding of a small linear system

/// One row of the method at X, which reads `reading`, and its own values.
MethodOutput row_of(const Method& method, const Location& X, double reading,
                    const Eigen::VectorXd& nuisance) {
  Observations data;
  data.measured["distance"] = Eigen::VectorXd::Constant(1, reading);
  Locations now;
  for (int lane = 0; lane < kLanes; ++lane) place(now, lane, X);
  const int row = 0;
  MethodOutput out;
  out.resize(1, method.tangent_dimension(), 0, 0);
  method.evaluate({1, &data, &row, &now, nullptr, &nuisance, nullptr, nullptr}, out);
  return out;
}

Eigen::VectorXd first_row(const MethodOutput::Block& D) { return D.row(0).matrix().transpose(); }

/// Own values at the start from readings `measured` of endpoints `at`.
Eigen::VectorXd started(const std::string& sets, const std::vector<Eigen::Vector3d>& at,
                        const Eigen::Vector3d& centre, double offset) {
  std::vector<Location> X;
  std::vector<int> rows;
  Observations data;
  data.measured["distance"].resize(static_cast<Eigen::Index>(at.size()));
  for (size_t i = 0; i < at.size(); ++i) {
    X.push_back({Eigen::Matrix3d::Identity(), at[i]});
    rows.push_back(static_cast<int>(i));
    data.column("distance")[rows.back()] = (at[i] - centre).norm() + offset;
  }
  return make_sets(sets)[0].method->start(X, rows, data, nullptr, {});
}

const std::vector<Eigen::Vector3d> kCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                               {0, 0, 1}, {1, 1, 0}, {1, 1, 1}};

TEST(FixedPointDistance, IsTheWayToThePointAndTheOffsetLessTheReading) {
  const auto sets = make_sets("s: {method: fixed-point-distance, offset: unknown}");
  Eigen::VectorXd nuisance(8);
  nuisance << 1, 0, 0, 0.5, 0, 0, 0, 0;
  // From (1, 0, 0) to (2, 2, 2): length 3 along (1, 2, 2) / 3.
  const Location X{Eigen::Matrix3d::Identity(), {2, 2, 2}};
  const MethodOutput out = row_of(*sets[0].method, X, 3.25, nuisance);
  EXPECT_NEAR(out.r(0, 0), 0.25, kByHand);
  Eigen::VectorXd by_location(6), by_own(4);
  by_location << 1. / 3, 2. / 3, 2. / 3, 0, 0, 0;
  by_own << -1. / 3, -2. / 3, -2. / 3, 1;
  EXPECT_LT((first_row(out.G_now) - by_location).norm(), kByHand);
  EXPECT_LT((first_row(out.D_own) - by_own).norm(), kByHand);
}

TEST(FixedPointDistance, TakesADrumsShareIntoEveryReading) {
  const auto sets = make_sets("s: {method: fixed-point-distance, scale: unknown}");
  Eigen::VectorXd nuisance(8);
  nuisance << 1, 0, 0, 0, 0.02, 0, 0, 0;
  // 3 m, of which the drum shows 2.95: 3 - 1.02 x 2.95 = -0.009.
  const MethodOutput out =
      row_of(*sets[0].method, {Eigen::Matrix3d::Identity(), {2, 2, 2}}, 2.95, nuisance);
  EXPECT_NEAR(out.r(0, 0), -0.009, kByHand);
  Eigen::VectorXd by_own(4);
  by_own << -1. / 3, -2. / 3, -2. / 3, -2.95;
  EXPECT_LT((first_row(out.D_own) - by_own).norm(), kByHand);
}

TEST(FixedPointDistance, IsTakenFromATargetOnTheLastLinkThatTurnsWithIt) {
  const auto sets = make_sets("s: {method: fixed-point-distance, point: unknown}");
  Eigen::VectorXd nuisance(8);
  nuisance << 0, 0, 0, 0, 0, 2, 0, 2;
  Location X;  // a quarter turn about z: the target is at (1, 0, 0) + (0, 2, 2)
  X.R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  X.p << 1, 0, 0;
  const MethodOutput out = row_of(*sets[0].method, X, 3, nuisance);
  EXPECT_NEAR(out.r(0, 0), 0, kByHand);
  Eigen::VectorXd by_location(6), by_own(6);
  by_location << 1. / 3, 2. / 3, 2. / 3, 0, 2. / 3, -2. / 3;  // (0, 2, 2) x (1, 2, 2) / 3
  by_own << -1. / 3, -2. / 3, -2. / 3, 2. / 3, -1. / 3, 2. / 3;
  EXPECT_LT((first_row(out.G_now) - by_location).norm(), kByHand);
  EXPECT_LT((first_row(out.D_own) - by_own).norm(), kByHand);
}

TEST(FixedPointDistance, HasNoDirectionAtThePointItself) {
  const auto sets = make_sets("s: {method: fixed-point-distance}");
  const MethodOutput out = row_of(*sets[0].method, {}, 0.25, Eigen::VectorXd::Zero(7));
  EXPECT_EQ(out.r(0, 0), -0.25);
  EXPECT_EQ(first_row(out.G_now).norm() + first_row(out.D_own).norm(), 0);
}

TEST(FixedPointDistance, StartsAtThePointThatExactRowsAreMeasuredFrom) {
  const Eigen::Vector3d centre(1, 2, -2);
  const Eigen::VectorXd alone = started("s: {method: fixed-point-distance}", kCorners, centre, 0);
  EXPECT_LT((alone.head<3>() - centre).norm(), kSolved);
  EXPECT_EQ(alone[3], 0);
  const Eigen::VectorXd both =
      started("s: {method: fixed-point-distance, offset: unknown}", kCorners, centre, 0.5);
  EXPECT_LT((both.head<3>() - centre).norm(), kSolved);
  EXPECT_NEAR(both[3], 0.5, kSolved);
  const Eigen::VectorXd known =
      started("s: {method: fixed-point-distance, center: [1, 2, -2], offset: unknown}", kCorners,
              centre, 0.5);
  EXPECT_EQ(known.head<3>(), centre);
  EXPECT_NEAR(known[3], 0.5, kByHand);
}

TEST(FixedPointDistance, StartsBelowThePlaneOfRowsThatLieInOne) {
  std::vector<Eigen::Vector3d> flat = kCorners;
  for (Eigen::Vector3d& p : flat) p = {p.x() + 0.3 * p.z(), p.y() - 0.6 * p.z(), 0.5};
  const Eigen::Vector3d centre(1, 2, -2);
  const Eigen::VectorXd alone = started("s: {method: fixed-point-distance}", flat, centre, 0);
  EXPECT_LT((alone.head<3>() - centre).norm(), kSolved);
  const Eigen::VectorXd both =
      started("s: {method: fixed-point-distance, offset: unknown}", flat, centre, 0.5);
  EXPECT_LT((both.head<3>() - centre).norm(), kSolved);
  EXPECT_NEAR(both[3], 0.5, kSolved);
}

TEST(FixedPointDistance, StartsFiniteFromOneRow) {
  const Eigen::VectorXd nuisance =
      started("s: {method: fixed-point-distance, offset: unknown}", {{1, 1, 1}}, {1, 2, -2}, 0.5);
  EXPECT_TRUE(nuisance.allFinite());
}

}  // namespace
}  // namespace selfcal
