// Location and generalized Jacobian of a serial robot, equations 11.3 and 11.10 to 11.18 of Khalil
// and Dombre, for a block of configurations at once.
//
// For a rotation parameter about axis a through O the column is [a x L; a], L from O to the body;
// for a translation along a it is [a; 0]. beta turns about y of the frame before; alpha and d act
// along x after that turn (the chapter has x before it, equal at its nominal beta of zero); theta
// and r along z of the frame itself.
#include "kinematics/robots/serial.h"

#include <cmath>
#include <functional>

namespace selfcal {
namespace {

using serial::Frame;
using serial::Model;
using serial::Motion;

struct Vector {
  Lanes x, y, z;
};

Vector combine(double a, const Vector& u, double b, const Vector& v) {
  return {a * u.x + b * v.x, a * u.y + b * v.y, a * u.z + b * v.z};
}
Vector combine(const Lanes& a, const Vector& u, const Lanes& b, const Vector& v) {
  return {a * u.x + b * v.x, a * u.y + b * v.y, a * u.z + b * v.z};
}
void advance(Vector& p, const Lanes& length, const Vector& axis) {
  p.x += length * axis.x;
  p.y += length * axis.y;
  p.z += length * axis.z;
}

/// Axes and pivots of one frame's five parameters.
struct Axes {
  Vector beta, alpha, theta;  // unit axes: y of the frame before, x turned by beta, z
  Vector before, at;          // origins of the frame before and of z's foot (after d)
};

struct Pose {
  Vector x, y, z, p;
};

Pose world() {
  const Lanes one = Lanes::Ones(kLanes), zero = Lanes::Zero(kLanes);
  return {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}, {zero, zero, zero}};
}

class SerialRobot final : public Robot {
 public:
  explicit SerialRobot(Model model)
      : model_(std::move(model)),
        moving_(serial::moving_frames(model_)),
        parameters_(serial::parameters(model_)),
        preference_(serial::preference(model_)),
        mechanics_(serial::mechanics(model_)) {
    for (const int f : moving_) {
      const Frame& frame = model_.frames[f];
      joints_.push_back({frame.name,
                         frame.motion == Motion::revolute ? Quantity::angle : Quantity::length,
                         frame.lower, frame.upper});
    }
    coupling_ = model_.coupling.size() > 0
                    ? model_.coupling
                    : Eigen::MatrixXd::Identity(joint_count(), joint_count());
  }

  std::string_view kind() const override { return "serial"; }
  const std::string& name() const override { return model_.name; }
  const std::vector<Joint>& joints() const override { return joints_; }
  const std::vector<Parameter>& parameters() const override { return parameters_; }
  const std::vector<int>& preference() const override { return preference_; }
  std::vector<std::string> remarks() const override { return serial::remarks(model_); }

  void locate(const ConfigurationBlock& block, const Eigen::VectorXd& xi, Body body, Locations& X,
              PsiBlock* psi) const override {
    const int last = last_frame(body);
    std::vector<Axes> axes(psi ? frame_count() : 0);
    Pose pose = world();
    for (int f = 0, joint = 0; f <= last; ++f) {
      const bool moves = model_.frames[f].motion != Motion::fixed;
      const Lanes variable = moves ? joint_variable(block, xi, joint++) : Lanes::Zero(kLanes);
      step(xi.segment<serial::kFields>(serial::kFields * f), variable, model_.frames[f].motion,
           pose, psi ? &axes[f] : nullptr);
    }
    store(pose, X);
    if (psi) fill(axes, pose.p, block, xi, last, *psi);
  }

  void joint_jacobian(const Eigen::VectorXd& xi, const PsiBlock& psi,
                      Eigen::MatrixXd& J) const override {
    J.setZero(psi.rows(), joint_count());
    for (int j = 0; j < joint_count(); ++j)
      for (int k = 0; k < joint_count(); ++k)
        if (coupling_(k, j) != 0)
          J.col(j) += coupling_(k, j) * xi[gear_index(j)] * psi.col(variable_parameter(k));
  }

  const Mechanics& mechanics() const override { return mechanics_; }
  std::vector<Eigen::Isometry3d> link_poses(const Eigen::VectorXd& q) const override {
    return serial::frame_poses(model_, q);
  }
  int variable_parameter(int joint) const override {
    const int f = moving_[joint];
    return serial::kFields * f +
           (model_.frames[f].motion == Motion::revolute ? serial::kTheta : serial::kR);
  }

  Node describe(const Eigen::VectorXd& xi) const override {
    Model model = model_;
    for (int f = 0; f < frame_count(); ++f)
      model.frames[f].value = xi.segment<serial::kFields>(serial::kFields * f);
    for (int j = 0; j < joint_count(); ++j) model.frames[moving_[j]].gear = xi[gear_index(j)];
    return serial::write(model);
  }

  std::string identity() const override {
    std::string text = "serial " + model_.name;
    for (const Frame& frame : model_.frames) {
      text += "\n" + frame.name + " " + std::to_string(static_cast<int>(frame.motion)) + " " +
              format_number(frame.gear_nominal);
      for (const double v : frame.nominal) text += " " + format_number(v);
    }
    for (const double c : coupling_.reshaped()) text += " " + format_number(c);
    return text;
  }

 private:
  int frame_count() const { return static_cast<int>(model_.frames.size()); }
  int joint_count() const { return static_cast<int>(moving_.size()); }
  int last_frame(Body body) const {
    if (body == Body::endpoint) return frame_count() - 1;
    return body == Body::last_link ? moving_.back() : moving_.front();
  }
  int gear_index(int joint) const { return serial::kFields * frame_count() + joint; }
  Lanes joint_variable(const ConfigurationBlock& block, const Eigen::VectorXd& xi, int k) const {
    Lanes sum = Lanes::Zero(kLanes);
    if (block.added.rows() > 0) sum = block.added.col(k);
    for (int j = 0; j < joint_count(); ++j)
      if (coupling_(k, j) != 0) sum += coupling_(k, j) * xi[gear_index(j)] * block.q.col(j);
    return sum;
  }

  static void step(const Eigen::Matrix<double, serial::kFields, 1>& v, const Lanes& variable,
                   Motion motion, Pose& pose, Axes* axes) {
    const double ca = std::cos(v[serial::kAlpha]), sa = std::sin(v[serial::kAlpha]);
    const double cb = std::cos(v[serial::kBeta]), sb = std::sin(v[serial::kBeta]);
    const Vector x = combine(cb, pose.x, -sb, pose.z);
    const Vector z = combine(sb, pose.x, cb, pose.z);
    if (axes) {
      axes->beta = pose.y;
      axes->alpha = x;
      axes->before = pose.p;
    }
    const Vector y = combine(ca, pose.y, sa, z);
    pose.z = combine(-sa, pose.y, ca, z);
    advance(pose.p, Lanes::Constant(kLanes, v[serial::kD]), x);
    if (axes) {
      axes->theta = pose.z;
      axes->at = pose.p;
    }
    Lanes theta = Lanes::Constant(kLanes, v[serial::kTheta]),
          r = Lanes::Constant(kLanes, v[serial::kR]);
    if (motion == Motion::revolute) theta += variable;
    if (motion == Motion::prismatic) r += variable;
    const Lanes c = theta.cos(), s = theta.sin();
    pose.x = combine(c, x, s, y);
    pose.y = combine(c, y, -s, x);
    advance(pose.p, r, pose.z);
  }

  static void store(const Pose& pose, Locations& X) {
    const Vector* columns[] = {&pose.x, &pose.y, &pose.z};
    for (int j = 0; j < 3; ++j) {
      X.rotation.col(3 * j) = columns[j]->x;
      X.rotation.col(3 * j + 1) = columns[j]->y;
      X.rotation.col(3 * j + 2) = columns[j]->z;
    }
    X.position.col(0) = pose.p.x;
    X.position.col(1) = pose.p.y;
    X.position.col(2) = pose.p.z;
  }

  static void turn(const Vector& a, const Vector& o, const Vector& end, double* column) {
    Eigen::Map<LaneArray<6>> out(column, kLanes, 6);
    const Lanes lx = end.x - o.x, ly = end.y - o.y, lz = end.z - o.z;
    out.col(0) = a.y * lz - a.z * ly;
    out.col(1) = a.z * lx - a.x * lz;
    out.col(2) = a.x * ly - a.y * lx;
    out.col(3) = a.x;
    out.col(4) = a.y;
    out.col(5) = a.z;
  }

  static void shift(const Vector& a, double* column) {
    Eigen::Map<LaneArray<6>> out(column, kLanes, 6);
    out.col(0) = a.x;
    out.col(1) = a.y;
    out.col(2) = a.z;
    out.rightCols<3>().setZero();
  }

  void fill(const std::vector<Axes>& axes, const Vector& end, const ConfigurationBlock& block,
            const Eigen::VectorXd& xi, int last, PsiBlock& psi) const {
    psi.resize(6 * kLanes, xi.size());
    for (int f = 0; f < frame_count(); ++f) {
      if (f > last) {
        psi.middleCols<serial::kFields>(serial::kFields * f).setZero();
        continue;
      }
      const auto column = [&](int field) { return psi.col(serial::kFields * f + field).data(); };
      turn(axes[f].beta, axes[f].before, end, column(serial::kBeta));    // 11.11
      turn(axes[f].alpha, axes[f].before, end, column(serial::kAlpha));  // 11.12
      shift(axes[f].alpha, column(serial::kD));                          // 11.13
      turn(axes[f].theta, axes[f].at, end, column(serial::kTheta));      // 11.14
      shift(axes[f].theta, column(serial::kR));                          // 11.15
    }
    for (int j = 0; j < joint_count(); ++j) {
      // 11.17: the column of K_j is the base Jacobian times dq / dK_j.
      auto gear = psi.col(gear_index(j)).reshaped(kLanes, 6).array();
      gear.setZero();
      for (int k = 0; k < joint_count(); ++k)
        if (coupling_(k, j) != 0)
          gear += coupling_(k, j) *
                  (psi.col(variable_parameter(k)).reshaped(kLanes, 6).array().colwise() *
                   block.q.col(j));
    }
  }

  Model model_;
  std::vector<int> moving_;
  std::vector<Parameter> parameters_;
  std::vector<int> preference_;
  Mechanics mechanics_;
  std::vector<Joint> joints_;
  Eigen::MatrixXd coupling_;
};

}  // namespace

std::unique_ptr<Robot> make_serial(const Node& node, Problems& problems) {
  Model model = serial::read(node, problems);
  if (problems.any()) return nullptr;
  return std::make_unique<SerialRobot>(std::move(model));
}

}  // namespace selfcal
