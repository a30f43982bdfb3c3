// Location and generalized Jacobian of a linear delta, by implicit differentiation of its closure:
//   (p - c_i) . (dp - dc_i) = l_i dl_i, i = 1, 2, 3
// With g_i the columns of the inverse of the matrix that has p - c_i as rows,
//   dp = sum g_i ((p - c_i) . dc_i + l_i dl_i).
#include "kinematics/robots/linear_delta.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/expects.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace linear_delta {
namespace {

Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi) {
  return left_jacobian_inverse(phi).inverse();
}

/// dp to the seven parameters of tower `t`, `toward` its p - c and `g` the column of the inverse.
Eigen::Matrix<double, 3, kFields> tower_columns(const Eigen::VectorXd& xi, const ClosedLoops& at,
                                                int t, const Eigen::Vector3d& g, double q) {
  const double angle = xi[index(t, kAngle)];
  const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0);
  const Eigen::Vector3d along(-out.y(), out.x(), 0), u = at.towers[t].u;
  const Eigen::Vector3d toward = at.p - at.carriage.col(t);
  const Eigen::Matrix3d turn = left_jacobian(tilt_of(xi, index(t, kTiltX)));
  Eigen::Matrix<double, 1, kFields> b;
  b[kRadius] = toward.dot(out);
  b[kAngle] = xi[index(t, kRadius)] * toward.dot(along);
  b[kRod] = xi[index(t, kRod)];
  b[kEndstop] = toward.dot(u);
  b[kTiltX] = at.height[t] * toward.dot(turn.col(0).cross(u));
  b[kTiltY] = at.height[t] * toward.dot(turn.col(1).cross(u));
  b[kScale] = q * toward.dot(u);
  return g * b;
}

/// Half of a tower's rods weighs on its carriage, half on the effector.
std::optional<PointMasses> weights(const Delta& model) {
  std::optional<PointMasses> all = point_masses(model.masses);
  const double half = model.masses.rod / 2;
  for (int t = 0; all && t < kTowers; ++t) {
    const double carried = model.masses.carriage + half;
    if (carried > 0)
      all->points.push_back({tower_name(t), link_body(t), Eigen::Vector3d::Zero(), carried});
    if (half > 0)
      all->points.push_back({tower_name(t), Body::last_link, Eigen::Vector3d::Zero(), half});
  }
  return all;
}

class LinearDelta final : public Robot, public RobotText {
 public:
  explicit LinearDelta(Delta model)
      : model_(std::move(model)),
        parameters_(linear_delta::parameters(model_)),
        preference_(linear_delta::preference(model_)),
        weights_(weights(model_)) {
    for (int t = 0; t < kTowers; ++t) {
      joints_.push_back({tower_name(t), Quantity::length, model_.lower[t], model_.upper[t]});
      carriages_.push_back(tower_name(t));
    }
    limited_ = std::ranges::any_of(model_.swing, [](double most) { return most > 0; });
    Eigen::Vector3d middle;
    for (int t = 0; t < kTowers; ++t) middle[t] = (joints_[t].lower + joints_[t].upper) / 2;
    rest_ = rods_at(middle);
  }

  std::string_view kind() const override { return "linear-delta"; }
  const std::string& name() const override { return model_.name; }
  const std::vector<Joint>& joints() const override { return joints_; }
  const std::vector<Parameter>& parameters() const override { return parameters_; }
  const std::vector<int>& preference() const override { return preference_; }
  const RobotText& text() const override { return *this; }
  std::vector<std::string> remarks() const override { return linear_delta::remarks(model_); }
  bool has_loops() const override { return true; }
  const std::vector<std::string>& links() const override { return carriages_; }
  const PointMasses* masses() const override { return weights_ ? &*weights_ : nullptr; }
  int variable_parameter(int joint) const override { return index(joint, kEndstop); }
  Eigen::MatrixXd variables_per_reading(const Eigen::VectorXd& xi) const override {
    return Eigen::Vector3d(xi[index(0, kScale)], xi[index(1, kScale)], xi[index(2, kScale)])
        .asDiagonal();
  }
  int leg_parameter(int joint) const override { return index(joint, kRod); }
  Eigen::VectorXd leg_lengths(const Eigen::VectorXd& xi, const Eigen::VectorXd&) const override {
    return Eigen::Vector3d(xi[index(0, kRod)], xi[index(1, kRod)], xi[index(2, kRod)]);
  }
  bool within_passive_limits(const Eigen::VectorXd& q) const override {
    if (!limited_) return true;
    const std::optional<Eigen::Matrix3d> rods = rods_at(q);
    if (!rods || !rest_) return false;
    for (int t = 0; t < kTowers; ++t) {
      const double most = model_.swing[static_cast<std::size_t>(t)];
      if (most > 0 && rods->col(t).dot(rest_->col(t)) < std::cos(most)) return false;
    }
    return true;
  }
  /// The nozzle or probe points down.
  Eigen::Vector3d tool_axis() const override { return -Eigen::Vector3d::UnitZ(); }

  Closure locate(const ConfigurationBlock& block, const Eigen::VectorXd& xi, Body body,
                 Locations& X, PsiBlock* psi) const override {
    expects(has_body(*this, body), "a body of the robot");
    Closure closure;
    std::array<Tower, kTowers> towers;
    for (int t = 0; t < kTowers; ++t) towers[t] = tower(xi, t);
    const Eigen::Vector3d tilt = tilt_of(xi, kEffector);
    const Eigen::Matrix3d R = exp_rotation(tilt);
    const Eigen::Vector3d tool = body == Body::endpoint ? Eigen::Vector3d(R * xi.segment<3>(kTool))
                                                        : Eigen::Vector3d::Zero();
    const Eigen::Matrix3d turn = left_jacobian(tilt);
    X.resize(block.lanes());
    bool astray = false;
    if (psi) psi->setZero(6 * block.lanes(), kParameters);
    for (int lane = 0; lane < block.lanes(); ++lane) {
      X.rotation.row(lane) = Eigen::Matrix3d::Identity().reshaped().transpose().array();
      X.position.row(lane).setZero();
      if (body == Body::first_link) continue;
      const Eigen::Vector3d q = block.q.row(lane).matrix().transpose();
      Eigen::Vector3d added = Eigen::Vector3d::Zero();
      if (block.added.rows() > 0) added = block.added.row(lane).matrix().transpose();
      const ClosedLoops at = close(xi, towers, q, added);
      if (!at.open.empty()) {
        closure.leave_open(lane, at.open);
        continue;
      }
      if (lane == 0 && block.start)
        astray = !((block.start->p - at.carriage.col(0)).dot(at.down) > 0);
      if (astray) {
        closure.leave_open(lane,
                           "no position of the effector: the start is of another assembly mode, "
                           "above the carriages");
        continue;
      }
      if (body >= Body::first_named) {
        place_carriage(xi, at, q, static_cast<int>(body) - static_cast<int>(Body::first_named),
                       lane, X, psi);
        continue;
      }
      X.rotation.row(lane) = R.reshaped().transpose().array();
      X.position.row(lane) = (at.p + tool).transpose().array();
      if (psi) fill(xi, at, q, R, turn, body == Body::endpoint ? &tool : nullptr, lane, *psi);
    }
    return closure;
  }

  void joint_jacobian(const ConfigurationBlock&, const Eigen::VectorXd& xi, Body,
                      const PsiBlock& psi, Eigen::MatrixXd& J) const override {
    J.resize(psi.rows(), kTowers);
    for (int t = 0; t < kTowers; ++t) J.col(t) = xi[index(t, kScale)] * psi.col(index(t, kEndstop));
  }

  Eigen::VectorXd draw(const Eigen::MatrixX2d& span,
                       const std::function<double()>& uniform) const override;

  Node describe(const Eigen::VectorXd& xi) const override {
    Delta model = model_;
    model.value = xi;
    return linear_delta::write(model);
  }

  std::string identity() const override {
    std::string text = "linear-delta " + model_.name;
    for (const double v : model_.nominal) text += " " + format_number(v);
    return text;
  }

 private:
  /// Where the rods of the file's robot point at readings `q`: unit vectors, column t that of tower
  /// t; nothing where its loops do not close.
  std::optional<Eigen::Matrix3d> rods_at(const Eigen::Vector3d& q) const {
    const Eigen::VectorXd& xi = model_.nominal;
    std::array<Tower, kTowers> towers;
    for (int t = 0; t < kTowers; ++t) towers[t] = tower(xi, t);
    const ClosedLoops at = close(xi, towers, q, Eigen::Vector3d::Zero());
    if (!at.open.empty()) return std::nullopt;
    return (at.p.replicate<1, kTowers>() - at.carriage).colwise().normalized();
  }

  /// The carriage of tower `t`, which stands as its tower does.
  static void place_carriage(const Eigen::VectorXd& xi, const ClosedLoops& at,
                             const Eigen::Vector3d& q, int t, int lane, Locations& X,
                             PsiBlock* psi) {
    const Eigen::Vector3d tilt = tilt_of(xi, index(t, kTiltX)), u = at.towers[t].u;
    X.rotation.row(lane) = exp_rotation(tilt).reshaped().transpose().array();
    X.position.row(lane) = at.carriage.col(t).transpose().array();
    if (!psi) return;
    const double radius = xi[index(t, kRadius)], angle = xi[index(t, kAngle)];
    const Eigen::Matrix3d turn = left_jacobian(tilt);
    Eigen::Matrix<double, 6, kFields> by = Eigen::Matrix<double, 6, kFields>::Zero();
    by.col(kRadius).head<3>() << std::cos(angle), std::sin(angle), 0;
    by.col(kAngle).head<3>() << -radius * std::sin(angle), radius * std::cos(angle), 0;
    by.col(kEndstop).head<3>() = u;
    by.col(kScale).head<3>() = q[t] * u;
    for (int k = 0; k < 2; ++k)
      by.col(kTiltX + k) << at.height[t] * turn.col(k).cross(u), turn.col(k);
    for (int c = 0; c < 6; ++c)
      psi->row(c * (psi->rows() / 6) + lane).segment<kFields>(index(t, 0)) = by.row(c);
  }

  /// `tool`: from the effector's joints to the body, world; null where the body is the effector.
  static void fill(const Eigen::VectorXd& xi, const ClosedLoops& at, const Eigen::Vector3d& q,
                   const Eigen::Matrix3d& R, const Eigen::Matrix3d& turn,
                   const Eigen::Vector3d* tool, int lane, PsiBlock& psi) {
    Eigen::Matrix<double, 6, kParameters> all = Eigen::Matrix<double, 6, kParameters>::Zero();
    Eigen::Matrix3d toward;
    for (int t = 0; t < kTowers; ++t) toward.row(t) = (at.p - at.carriage.col(t)).transpose();
    const Eigen::Matrix3d g = toward.inverse();
    for (int t = 0; t < kTowers; ++t)
      all.block<3, kFields>(0, index(t, 0)) = tower_columns(xi, at, t, g.col(t), q[t]);
    for (int k = 0; k < 2; ++k) {
      all.col(kEffector + k).tail<3>() = turn.col(k);
      if (tool) all.col(kEffector + k).head<3>() = turn.col(k).cross(*tool);
    }
    if (tool) all.block<3, 3>(0, kTool) = R;
    for (int c = 0; c < 6; ++c) psi.row(c * (psi.rows() / 6) + lane) = all.row(c);
  }

  Delta model_;
  std::vector<Parameter> parameters_;
  std::vector<int> preference_;
  std::optional<PointMasses> weights_;
  std::vector<Joint> joints_;
  std::vector<std::string> carriages_;
  std::optional<Eigen::Matrix3d> rest_;  ///< rods_at() the middle of the readings
  bool limited_ = false;                 ///< some rod's swing is
};

/// Evenly over the disc in which the rods stand steeply enough, then over the heights that the
/// carriages' limits leave there.
Eigen::VectorXd LinearDelta::draw(const Eigen::MatrixX2d& span,
                                  const std::function<double()>& uniform) const {
  constexpr int kTries = 200;
  const Eigen::VectorXd xi = model_.nominal;
  double most = working_radius(xi);
  for (int t = 0; t < kTowers; ++t)
    if (const double swing = model_.swing[static_cast<std::size_t>(t)]; swing > 0)
      most = std::min(most, xi[index(t, kRod)] * std::sin(swing));
  Eigen::Vector3d best = span.rowwise().mean();
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const double r = most * std::sqrt(uniform()), a = 2 * std::numbers::pi * uniform(),
                 share = uniform();
    Eigen::Vector3d p(r * std::cos(a), r * std::sin(a), 0);
    const auto below = readings_at(xi, p);
    if (!below) continue;
    double low = -HUGE_VAL, high = HUGE_VAL;
    for (int t = 0; t < kTowers; ++t) {
      const double K = xi[index(t, kScale)];
      const double one = K * (span(t, 0) - (*below)[t]), other = K * (span(t, 1) - (*below)[t]);
      low = std::max(low, std::min(one, other));
      high = std::min(high, std::max(one, other));
    }
    if (low > high) continue;
    p.z() = low + (high - low) * share;
    const auto q = readings_at(xi, p);
    if (!q) continue;
    if (!within_passive_limits(*q)) continue;
    best = *q;
    if ((best.array() >= span.col(0).array() && best.array() <= span.col(1).array()).all()) break;
  }
  return best;
}

}  // namespace
}  // namespace linear_delta

std::unique_ptr<Robot> make_linear_delta(const Node& node, Problems& problems) {
  linear_delta::Delta model = linear_delta::read(node, problems);
  if (problems.any()) return nullptr;
  return std::make_unique<linear_delta::LinearDelta>(std::move(model));
}

}  // namespace selfcal
