// A point on the robot as an instrument sees it, in the instrument's axes:
//   v = R_F^T (P - p_F),   dv = R_F^T (dP - dp_F + [P - p_F]x dphi_F)
// The instrument's frame F is the world or six nuisance parameters; the point is the endpoint or
// three more, fixed to the last moving link at s: P = p_L + R_L s, dP = dp_L - [R_L s]x dphi_L +
// R_L ds.
#pragma once

#include "constraints/methods/shared/device_frame.h"

namespace selfcal {

class SeenPoint {
 public:
  static constexpr int kValues = DeviceFrame::kValues + 3;  ///< of the frame, then of the point

  SeenPoint(bool frame_unknown, bool point_unknown)
      : frame_(frame_unknown), point_(point_unknown) {}

  bool frame_unknown() const { return frame_; }
  bool point_unknown() const { return point_; }
  int freedom() const { return point_at() + (point_ ? 3 : 0); }
  Quantity quantity(int i) const { return frame_ ? DeviceFrame::quantity(i) : Quantity::length; }

  Eigen::VectorXd start(const Location& tool) const;
  void retract(Eigen::VectorXd& values, const Eigen::VectorXd& step) const;
  std::vector<NuisanceReport> report(const Eigen::VectorXd& values) const;
  /// Of an instrument somewhere, for simulation.
  Eigen::VectorXd random(Random& random) const;

  /// P, of a location of the endpoint, or of the last moving link where the point is unknown.
  Eigen::Vector3d place(const Location& X, const Eigen::VectorXd& values) const {
    return point_ ? Eigen::Vector3d(X.p + X.R * values.tail<3>()) : X.p;
  }

  /// The derivatives of one equation with dr = a . dv, of a row at `lane`; `F` is the instrument's
  /// pose in `values`.
  void chain(const Eigen::Vector3d& a, const Location& F, const Eigen::VectorXd& values,
             const Location& X, int lane, int equation, MethodOutput& out) const;

 private:
  int point_at() const { return frame_ ? DeviceFrame::kFreedom : 0; }

  bool frame_, point_;
};

}  // namespace selfcal
