// Location and generalized Jacobian of a serial robot, equations 11.3 and 11.10 to 11.18 of Khalil
// and Dombre, for a block of configurations at once: frame after frame (serial_chain.h), then the
// gear ratios.
#include "kinematics/robots/serial.h"

#include <cmath>
#include <span>

#include "kinematics/expects.h"
#include "kinematics/kernels/kernels.h"
#include "kinematics/robots/serial_chain.h"
#include "kinematics/statics.h"

namespace selfcal {
namespace {

using serial::Frame;
using serial::Model;
using serial::Motion;

/// The maker's numbers of a frame.
Eigen::VectorXd figures(const Frame& frame) {
  if (!frame.whole) return frame.nominal;
  return (Eigen::VectorXd(6) << frame.nominal.head<3>(), frame.rpy_nominal).finished();
}

/// Centres of mass of a chain's links.
PointMasses weights(const Mechanics& mechanics) {
  PointMasses all{mechanics.gravity, {}};
  for (size_t k = 0; k < mechanics.links.size(); ++k)
    if (const Link& link = mechanics.links[k]; link.mass > 0.0)
      all.points.push_back({link.frame, link_body(static_cast<int>(k)), link.com, *link.mass});
  return all;
}

class SerialRobot final : public Robot, public Statics, public RobotText {
 public:
  explicit SerialRobot(Model model)
      : model_(std::move(model)),
        moving_(serial::moving_frames(model_)),
        first_(serial::first_parameters(model_)),
        parameters_(serial::parameters(model_)),
        preference_(serial::preference(model_)),
        mechanics_(serial::mechanics(model_)),
        weights_(weights(mechanics_)) {
    for (const Frame& frame : model_.frames) links_.push_back(frame.name);
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
  const RobotText& text() const override { return *this; }
  std::vector<std::string> remarks() const override { return serial::remarks(model_); }

  Closure locate(const ConfigurationBlock& block, const Eigen::VectorXd& xi, Body body,
                 Locations& X, PsiBlock* psi) const override {
    expects(has_body(*this, body), "a body of the robot");
    const int frames = last_frame(body) + 1;
    X.resize(block.lanes());
    if (psi) psi->resize(6 * block.lanes(), xi.size());
    serial::follow({std::span(model_.frames).first(static_cast<size_t>(frames)), first_, coupling_},
                   block, xi, X, psi);
    if (psi) {
      psi->middleCols(first_[frames], first_.back() - first_[frames]).setZero();
      fill_gears(block, *psi);
    }
    return {};
  }

  void joint_jacobian(const ConfigurationBlock&, const Eigen::VectorXd& xi, Body,
                      const PsiBlock& psi, Eigen::MatrixXd& J) const override {
    J.setZero(psi.rows(), joint_count());
    for (int j = 0; j < joint_count(); ++j)
      for (int k = 0; k < joint_count(); ++k)
        if (coupling_(k, j) != 0)
          J.col(j) += coupling_(k, j) * xi[gear_index(j)] * psi.col(variable_parameter(k));
  }

  const std::vector<std::string>& links() const override { return links_; }
  const Statics* statics() const override { return this; }
  const PointMasses* masses() const override { return &weights_; }
  const Mechanics& mechanics() const override { return mechanics_; }
  std::vector<Eigen::Isometry3d> link_poses(const Eigen::VectorXd& q) const override {
    return serial::frame_poses(model_, q);
  }
  int variable_parameter(int joint) const override {
    const int f = moving_[joint];
    return first_[f] + (model_.frames[f].motion == Motion::revolute ? serial::kTheta : serial::kR);
  }

  Eigen::MatrixXd variables_per_reading(const Eigen::VectorXd& xi) const override {
    return coupling_ * xi.tail(joint_count()).asDiagonal();
  }

  Node describe(const Eigen::VectorXd& xi) const override {
    Model model = model_;
    for (int f = 0; f < frame_count(); ++f) serial::set_values(model.frames[f], of_frame(xi, f));
    for (int j = 0; j < joint_count(); ++j) model.frames[moving_[j]].gear = xi[gear_index(j)];
    return serial::write(model);
  }

  std::string identity() const override {
    std::string text = "serial " + model_.name;
    for (const Frame& frame : model_.frames) {
      text += "\n" + frame.name + " " + std::to_string(static_cast<int>(frame.motion)) + " " +
              format_number(frame.gear_nominal);
      for (const double v : figures(frame)) text += " " + format_number(v);
    }
    for (const double c : coupling_.reshaped()) text += " " + format_number(c);
    return text;
  }

 private:
  int frame_count() const { return static_cast<int>(model_.frames.size()); }
  int joint_count() const { return static_cast<int>(moving_.size()); }
  int last_frame(Body body) const {
    if (body == Body::endpoint) return frame_count() - 1;
    if (body >= Body::first_named)
      return static_cast<int>(body) - static_cast<int>(Body::first_named);
    return body == Body::last_link ? moving_.back() : moving_.front();
  }
  int gear_index(int joint) const { return first_.back() + joint; }
  Eigen::Ref<const Eigen::VectorXd> of_frame(const Eigen::VectorXd& xi, int f) const {
    return xi.segment(first_[f], model_.frames[f].fields());
  }
  /// 11.17: the column of K_j is the base Jacobian times dq / dK_j.
  void fill_gears(const ConfigurationBlock& block, PsiBlock& psi) const {
    const auto lanes = static_cast<size_t>(block.lanes());
    for (int j = 0; j < joint_count(); ++j) {
      psi.col(gear_index(j)).setZero();
      for (int k = 0; k < joint_count(); ++k) {
        if (coupling_(k, j) == 0) continue;
        const Lanes factor = coupling_(k, j) * block.q.col(j);
        const kernels::LaneProduct product{factor.data(), psi.col(variable_parameter(k)).data()};
        kernels::add_products(&product, 1, lanes, 6, lanes, psi.col(gear_index(j)).data(), lanes);
      }
    }
  }

  Model model_;
  std::vector<int> moving_, first_;
  std::vector<Parameter> parameters_;
  std::vector<int> preference_;
  Mechanics mechanics_;
  PointMasses weights_;
  std::vector<std::string> links_;
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
