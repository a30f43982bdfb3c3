// The pose of a measuring device in the world: known (the world itself) or six nuisance parameters.
#pragma once

#include "constraints/methods/method.h"

namespace selfcal {

/// Values x y z qw qx qy qz; the six freedoms are a shift and a rotation vector in the world frame.
struct DeviceFrame {
  static constexpr int kValues = 7, kFreedom = 6;

  /// Of freedom `i`, three shifts and three turns.
  static Quantity quantity(int i) {
    return i >= 3 && i < kFreedom ? Quantity::angle : Quantity::length;
  }
  static Eigen::VectorXd world();
  static Location pose(const Eigen::VectorXd& values);
  static void retract(Eigen::Ref<Eigen::VectorXd> values, const Eigen::VectorXd& step);
  /// x y z rx ry rz with their gradients to `freedom` own freedoms, the first six the frame's.
  static std::vector<NuisanceReport> report(const Eigen::VectorXd& values, int freedom);
  /// The pose that brings points of the device onto points of the world best (Kabsch).
  static Eigen::VectorXd register_points(const std::vector<Eigen::Vector3d>& device,
                                         const std::vector<Eigen::Vector3d>& world);
};

/// A location kept as x y z qw qx qy qz, moved by a shift and a rotation vector in the world frame.
Eigen::VectorXd to_values(const Location& X);

}  // namespace selfcal
