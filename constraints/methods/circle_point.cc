// Markers on the tool, seen while one joint turns (Mooring, Roth, Driels: Fundamentals of
// Manipulator Calibration, circle point analysis): marker i is fixed to the last moving link at an
// unknown t_i,
//   r_i = p_L + R_L t_i - m_i,   dr_i = dp_L - [R_L t_i]x dphi_L + R_L dt_i
// in the axes of the device, which are the world's. What lies behind the turning joint goes along
// with t_i; what a set tells is the axis, and constraints/axes finds it without a robot to start
// from.
#include "constraints/methods/maker.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

class CirclePoint final : public Method {
 public:
  CirclePoint(std::string joint, int markers) : joint_(std::move(joint)), markers_(markers) {}

  std::string_view name() const override { return "circle-point"; }
  std::vector<Quantity> equations() const override {
    return std::vector<Quantity>(3 * static_cast<std::size_t>(markers_), Quantity::length);
  }
  std::vector<MeasuredColumn> measures() const override {
    std::vector<MeasuredColumn> columns;
    for (int i = 0; i < 3 * markers_; ++i) columns.push_back({column(i), Quantity::length});
    return columns;
  }
  bool constrains() const override { return false; }
  bool point_unknown() const override { return true; }
  std::string turning_joint() const override { return joint_; }
  int tangent_dimension() const override { return 3 * markers_; }

  Eigen::VectorXd start(const std::vector<Location>& X, const std::vector<int>& rows,
                        const Observations& data, const Eigen::VectorXd*,
                        const Location&) const override {
    Eigen::VectorXd nuisance = Eigen::VectorXd::Zero(3 * markers_);
    for (std::size_t k = 0; k < rows.size(); ++k)
      for (int i = 0; i < markers_; ++i)
        nuisance.segment<3>(3 * i) += X[k].R.transpose() * (seen(data, rows[k], i) - X[k].p) /
                                      static_cast<double>(rows.size());
    return nuisance;
  }

  void retract(Eigen::VectorXd& nuisance, const Eigen::VectorXd& step) const override {
    nuisance += step;
  }

  std::vector<NuisanceReport> report(const Eigen::VectorXd& nuisance,
                                     const Eigen::VectorXd*) const override {
    static constexpr const char* kAxes[] = {".x", ".y", ".z"};
    std::vector<NuisanceReport> list;
    for (int i = 0; i < 3 * markers_; ++i)
      list.push_back({"m" + std::to_string(i / 3 + 1) + kAxes[i % 3],
                      nuisance[i],
                      Eigen::VectorXd::Unit(3 * markers_, i),
                      {}});
    return list;
  }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    const int m = tangent_dimension();
    for (int lane = 0; lane < in.count; ++lane) {
      const Location X = in.now->at(lane);
      for (int i = 0; i < markers_; ++i) {
        const Eigen::Vector3d arm = X.R * in.nuisance->segment<3>(3 * i);
        const Eigen::Matrix3d by_angle = -skew(arm);
        const Eigen::Vector3d r = X.p + arm - seen(*in.data, in.rows[lane], i);
        for (int c = 0; c < 3; ++c) {
          const int a = 3 * i + c;
          out.r(lane, a) = r[c];
          set_linear(out.G_now, lane, a, Eigen::Vector3d::Unit(c));
          set_angular(out.G_now, lane, a, by_angle.row(c));
          out.D_own.row(lane).segment<3>(a * m + 3 * i) = X.R.row(c);
        }
      }
    }
  }

  void measure(const Location& X, const Location&, const Eigen::VectorXd& nuisance,
               Observations& data, int row) const override {
    for (int i = 0; i < 3 * markers_; ++i)
      data.column(column(i))[row] = (X.p + X.R * nuisance.segment<3>(i / 3 * 3))[i % 3];
  }

  /// A bracket in depth, as a cube's corners are, before the flange.
  Eigen::VectorXd through(const Location&, const Eigen::VectorXd*, Random&) const override {
    static constexpr double kBracket[kMostMarkers][3] = {{0.1, 0.1, 0.15},  {-0.1, 0.1, 0.05},
                                                         {0.1, -0.1, 0.05}, {-0.1, -0.1, 0.15},
                                                         {0.15, 0, 0.25},   {0, -0.15, 0.2}};
    Eigen::VectorXd nuisance(3 * markers_);
    for (int i = 0; i < 3 * markers_; ++i) nuisance[i] = kBracket[i / 3][i % 3];
    return nuisance;
  }

 private:
  /// The column of coordinate i, counted over all markers.
  static std::string column(int i) { return marker_column(i / 3, i % 3); }
  static Eigen::Vector3d seen(const Observations& data, int row, int marker) {
    Eigen::Vector3d m;
    for (int c = 0; c < 3; ++c) m[c] = data.column(marker_column(marker, c))[row];
    return m;
  }

  std::string joint_;
  int markers_;
};

}  // namespace

std::string marker_column(int marker, int coordinate) {
  return "m" + std::to_string(marker + 1) + "xyz"[coordinate];
}

MethodPtr make_circle_point(SetEntry& entry) {
  const std::string joint = entry.fields.text("joint", "");
  if (joint.empty()) entry.fields.fail("joint", "the joint that turns, by its frame's name");
  return std::make_unique<CirclePoint>(
      joint, entry.fields.integer("markers", kFewestMarkers, kFewestMarkers, kMostMarkers));
}

}  // namespace selfcal
