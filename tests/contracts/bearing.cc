// Bearings of a theodolite, worked by hand: rows, their derivatives and where the station starts.
#include <gtest/gtest.h>

#include "constraints/methods/shared/device_frame.h"
#include "kinematics/rotation.h"
#include "tests/contracts/method_case.h"

namespace selfcal {
namespace {

constexpr double kRounded = 1e-15;
constexpr double kResected = 1e-9;  // m, rad: a small eigenvector

TEST(Bearing, IsTheAzimuthFromXAndTheElevationAboveThePlaneOfXAndY) {
  const auto sets = make_sets("s: {method: bearing}");
  const Method& method = *sets[0].method;
  Observations data;
  data.measured["azimuth"] = Eigen::VectorXd::Constant(1, 0.5);
  data.measured["elevation"] = Eigen::VectorXd::Constant(1, 0.25);
  Locations now;
  // 5 m away over the ground, along (3, 4), and 12 m up: 13 m in all.
  for (int lane = 0; lane < kLanes; ++lane)
    place(now, lane, {Eigen::Matrix3d::Identity(), {3, 4, 12}});
  Random random(1);
  const Eigen::VectorXd station = method.through({}, nullptr, random);
  const int row = 0;
  MethodOutput out;
  out.resize(2, method.tangent_dimension(), 0, 0);
  method.evaluate({1, &data, &row, &now, nullptr, &station, nullptr, nullptr}, out);
  EXPECT_NEAR(out.r(0, 0), std::atan2(4, 3) - 0.5, kRounded);
  EXPECT_NEAR(out.r(0, 1), std::atan2(12, 5) - 0.25, kRounded);
  const double by_place[] = {-4. / 25,       3. / 25,        0,        0, 0, 0,
                             -36. / 5 / 169, -48. / 5 / 169, 5. / 169, 0, 0, 0};
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(out.G_now(0, i), by_place[i], kRounded) << i;
}

/// Where the station is found from exact bearings of `places`, beside where it is: m and rad.
std::pair<double, double> resected(const std::vector<Eigen::Vector3d>& places) {
  const auto sets = make_sets("s: {method: bearing, frame: unknown}");
  const Method& method = *sets[0].method;
  Location station;
  station.R = exp_rotation({0.3, -0.2, 2.5});
  station.p = {3, -2, 0.5};
  Eigen::VectorXd truth(DeviceFrame::kValues + 3);
  truth << to_values(station), 0, 0, 0;
  Observations data;
  for (const char* column : {"azimuth", "elevation"})
    data.measured[column].resize(static_cast<Eigen::Index>(places.size()));
  std::vector<Location> X;
  std::vector<int> rows;
  for (const Eigen::Vector3d& each : places) {
    X.push_back({Eigen::Matrix3d::Identity(), each});
    rows.push_back(static_cast<int>(rows.size()));
    method.measure(X.back(), {}, truth, data, rows.back());
  }
  const Location found = DeviceFrame::pose(method.start(X, rows, data, nullptr, {}));
  return {(found.p - station.p).norm(),
          log_rotation(Eigen::Matrix3d(found.R.transpose() * station.R)).norm()};
}

TEST(Bearing, FindsItsStationFromPlacesInSpaceAndInAPlane) {
  const std::vector<Eigen::Vector3d> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                                {1, 1, 0}, {1, 1, 1}, {1, 0, 1}, {0.3, 0.6, 0.2}};
  const auto [shift, turn] = resected(corners);
  EXPECT_LT(shift, kResected);
  EXPECT_LT(turn, kResected);
  std::vector<Eigen::Vector3d> flat = corners;
  for (Eigen::Vector3d& each : flat) each.z() = 0.2 + 0.3 * each.x();
  const auto [flat_shift, flat_turn] = resected(flat);
  EXPECT_LT(flat_shift, kResected);
  EXPECT_LT(flat_turn, kResected);
}

}  // namespace
}  // namespace selfcal
