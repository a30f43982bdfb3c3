// Measured position of the endpoint (11.5.1, first three equations of 11.39 and 11.45), in the
// device's axes, which are the world's unless `frame: unknown`; with `point: unknown` of a target
// that is fixed to the last moving link. r = v - x (see seen_point.h).
#include "constraints/methods/maker.h"
#include "constraints/methods/shared/seen_point.h"

namespace selfcal {
namespace {

class Position final : public Method {
 public:
  explicit Position(const SeenPoint& seen) : seen_(seen) {}

  std::string_view name() const override { return "position"; }
  std::vector<Quantity> equations() const override { return {3, Quantity::length}; }
  std::vector<std::string> columns() const override { return {"x", "y", "z"}; }
  bool constrains() const override { return false; }
  bool frame_unknown() const override { return seen_.frame_unknown(); }
  bool point_unknown() const override { return seen_.point_unknown(); }
  int tangent_dimension() const override { return seen_.freedom(); }
  Quantity tangent_quantity(int i) const override { return seen_.quantity(i); }

  Eigen::VectorXd start(const std::vector<Location>& X, const std::vector<int>& rows,
                        const Observations& data, const Eigen::VectorXd*,
                        const Location& tool) const override {
    Eigen::VectorXd nuisance = seen_.start(tool);
    if (!seen_.frame_unknown()) return nuisance;
    std::vector<Eigen::Vector3d> device, world;
    for (size_t i = 0; i < rows.size(); ++i) {
      device.emplace_back(data.position.row(rows[i]).transpose());
      world.push_back(seen_.place(X[i], nuisance));
    }
    nuisance.head<DeviceFrame::kValues>() = DeviceFrame::register_points(device, world);
    return nuisance;
  }

  Eigen::Vector3d device(const Eigen::VectorXd& nuisance) const override {
    return DeviceFrame::pose(nuisance).p;
  }

  void retract(Eigen::VectorXd& nuisance, const Eigen::VectorXd& step) const override {
    seen_.retract(nuisance, step);
  }

  std::vector<NuisanceReport> report(const Eigen::VectorXd& nuisance,
                                     const Eigen::VectorXd*) const override {
    return seen_.report(nuisance);
  }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    const Location F = DeviceFrame::pose(*in.nuisance);
    for (int lane = 0; lane < in.count; ++lane) {
      const Location X = in.now->at(lane);
      out.r.row(lane) = (F.R.transpose() * (seen_.place(X, *in.nuisance) - F.p)).transpose() -
                        in.data->position.row(in.rows[lane]);
      for (int a = 0; a < 3; ++a)
        seen_.chain(Eigen::Vector3d::Unit(a), F, *in.nuisance, X, lane, a, out);
    }
  }

  void measure(const Location& X, const Location&, const Eigen::VectorXd& nuisance,
               Observations& data, int row) const override {
    const Location F = DeviceFrame::pose(nuisance);
    data.position.row(row) = (F.R.transpose() * (seen_.place(X, nuisance) - F.p)).transpose();
  }

  Eigen::VectorXd through(const Location&, const Eigen::VectorXd*, Random& random) const override {
    return seen_.random(random);
  }

 private:
  SeenPoint seen_;
};

}  // namespace

MethodPtr make_position(SetEntry& entry) {
  const bool frame = read_unknown(entry.fields, "frame");
  const bool point = read_unknown(entry.fields, "point");
  return std::make_unique<Position>(SeenPoint(frame, point));
}

}  // namespace selfcal
