// Measured distance that the endpoint travelled since the previous row of the group (11.46, 11.47,
// here as lengths rather than squares, so that the residual is in metres):
//   r = |P_j - P_i| - D,   dr = u . (Psi_j - Psi_i) dxi,   u = (P_j - P_i) / |P_j - P_i|
#include "constraints/methods/maker.h"

namespace selfcal {
namespace {

class Distance final : public Method {
 public:
  std::string_view name() const override { return "distance"; }
  std::vector<Quantity> equations() const override { return {Quantity::length}; }
  std::vector<MeasuredColumn> measures() const override {
    return {{"distance", Quantity::length, true}};
  }
  bool paired() const override { return true; }
  bool constrains() const override { return false; }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    const Eigen::VectorXd& measured = in.data->column("distance");
    for (int lane = 0; lane < in.count; ++lane) {
      const Eigen::Vector3d step = in.now->p(lane) - in.before->p(lane);
      const double length = step.norm();
      const Eigen::Vector3d u =
          length > 0 ? Eigen::Vector3d(step / length) : Eigen::Vector3d::Zero();
      out.r(lane, 0) = length - measured[in.rows[lane]];
      set_linear(out.G_now, lane, 0, u);
      set_linear(out.G_before, lane, 0, -u);
    }
  }

  void measure(const Location& X, const Location& before, const Eigen::VectorXd&,
               Observations& data, int row) const override {
    data.column("distance")[row] = (X.p - before.p).norm();
  }
};

}  // namespace

MethodPtr make_distance(SetEntry&) { return std::make_unique<Distance>(); }

}  // namespace selfcal
