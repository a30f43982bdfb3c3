// The chains of a Hexa Slide: the carriage c = s + q a moves along its rail, the link's length is a
// parameter, d c = d s + q d a, d a_z = -(a_x d a_x + a_y d a_y) / a_z. The inverse is closed
// (Rauf, equation 3), with e = p + R b - s:
//   q = a . e - sqrt(l^2 - |e|^2 + (a . e)^2)
#include "kinematics/robots/hexaslide.h"

#include <cmath>

namespace selfcal {
namespace hexaslide {
namespace {

using platform::Six;

/// Half of a link weighs on its carriage, half on the platform's joint.
std::optional<PointMasses> weights(const Hexaslide& model) {
  std::optional<PointMasses> all = point_masses(model.masses);
  const double half = model.masses.rod / 2;
  for (int i = 0; all && i < kChains; ++i) {
    const double carried = model.masses.carriage + half;
    if (carried > 0)
      all->points.push_back({chain_name(i), body_behind(i, PassiveKind::universal),
                             Eigen::Vector3d::Zero(), carried});
    if (half > 0)
      all->points.push_back(
          {chain_name(i), Body::last_link, model.nominal.segment<3>(index(i, kJoint)), half});
  }
  return all;
}

class HexaslideRobot final : public platform::Platform, public RobotText {
 public:
  HexaslideRobot(Hexaslide model, std::string& problem)
      : model_(std::move(model)),
        parameters_(hexaslide::parameters(model_)),
        preference_(hexaslide::preference(model_)),
        weights_(weights(model_)) {
    for (size_t i = 0; i < kChains; ++i) {
      // Where the file is silent, a rail is as long as its link.
      const bool silent = !(model_.lower[i] < model_.upper[i]);
      const int chain = static_cast<int>(i);
      joints_.push_back({chain_name(chain), Quantity::length, silent ? 0 : model_.lower[i],
                         silent ? model_.nominal[index(chain, kLink)] : model_.upper[i]});
    }
    std::optional<Location> home;
    if (model_.home) home = model_.home->pose();
    problem = take_mode(home, -1, model_.swing, "chain");
  }

  std::string_view kind() const override { return "hexaslide"; }
  const std::string& name() const override { return model_.name; }
  const std::vector<Joint>& joints() const override { return joints_; }
  const std::vector<Parameter>& parameters() const override { return parameters_; }
  const std::vector<int>& preference() const override { return preference_; }
  const RobotText& text() const override { return *this; }
  const PointMasses* masses() const override { return weights_ ? &*weights_ : nullptr; }
  /// A carriage's zero is the start of its rail, along it.
  int variable_parameter(int joint) const override {
    Eigen::Index most = 0;
    direction(model_.nominal, joint).cwiseAbs().maxCoeff(&most);
    return index(joint, kStart) + static_cast<int>(most);
  }
  Eigen::VectorXd variable_change(const Eigen::VectorXd& xi, int joint) const override {
    Eigen::VectorXd change = Eigen::VectorXd::Zero(xi.size());
    change.segment<3>(index(joint, kStart)) = direction(xi, joint);
    return change;
  }
  int leg_parameter(int joint) const override { return index(joint, kLink); }
  int chain_parameters() const override { return kFields; }
  /// The tool points down from its platform.
  Eigen::Vector3d tool_axis() const override { return -Eigen::Vector3d::UnitZ(); }

  platform::Chains chains(const Eigen::VectorXd& xi, const Six& q,
                          const Six& added) const override {
    platform::Chains at;
    for (int i = 0; i < kChains; ++i) {
      at.carrier.col(i) = xi.segment<3>(index(i, kStart)) + (q[i] + added[i]) * direction(xi, i);
      at.joint.col(i) = xi.segment<3>(index(i, kJoint));
      at.length[i] = xi[index(i, kLink)];
    }
    return at;
  }

  platform::ChainDerivatives derivatives(const Eigen::VectorXd& xi, int chain, double q,
                                         double added) const override {
    platform::ChainDerivatives by{Eigen::MatrixXd::Zero(3, kFields),
                                  Eigen::MatrixXd::Zero(3, kFields),
                                  Eigen::RowVectorXd::Zero(kFields)};
    const Eigen::Vector3d a = direction(xi, chain);
    by.carrier.middleCols<3>(kStart).setIdentity();
    by.carrier.col(kDirection) = (q + added) * Eigen::Vector3d(1, 0, -a.x() / a.z());
    by.carrier.col(kDirection + 1) = (q + added) * Eigen::Vector3d(0, 1, -a.y() / a.z());
    by.joint.middleCols<3>(kJoint).setIdentity();
    by.length[kLink] = 1;
    return by;
  }

  std::optional<Six> readings_at(const Eigen::VectorXd& xi, const Location& X) const override {
    Six q;
    for (int i = 0; i < kChains; ++i) {
      const Eigen::Vector3d e =
          X.p + X.R * xi.segment<3>(index(i, kJoint)) - xi.segment<3>(index(i, kStart));
      const double along = direction(xi, i).dot(e), l = xi[index(i, kLink)];
      const double root = l * l - e.squaredNorm() + along * along;
      if (!(root > 0)) return std::nullopt;
      q[i] = along - std::sqrt(root);
    }
    return q;
  }

  void joint_jacobian(const ConfigurationBlock&, const Eigen::VectorXd& xi, Body,
                      const PsiBlock& psi, Eigen::MatrixXd& J) const override {
    J.resize(psi.rows(), kChains);
    for (int i = 0; i < kChains; ++i)
      J.col(i) = psi.middleCols<3>(index(i, kStart)) * direction(xi, i);
  }

  std::vector<FrameMotions> frame_motions(const Eigen::VectorXd& xi) const override {
    std::vector<int> rails, joints;
    for (int i = 0; i < kChains; ++i) {
      rails.push_back(index(i, kStart));
      joints.push_back(index(i, kJoint));
    }
    Eigen::MatrixXd base = platform::point_motions(xi, rails);
    for (int i = 0; i < kChains; ++i)
      for (int k = 0; k < 3; ++k)
        base.block<2, 1>(index(i, kDirection), 3 + k) =
            Eigen::Vector3d::Unit(k).cross(direction(xi, i)).head<2>();
    return {{"the base's frame", base},
            {"the platform's frame", platform::point_motions(xi, joints)}};
  }

  Node describe(const Eigen::VectorXd& xi) const override {
    Hexaslide model = model_;
    model.value = xi;
    return hexaslide::write(model);
  }

  std::string identity() const override {
    std::string text = "hexaslide " + model_.name;
    for (const double v : model_.nominal) text += " " + format_number(v);
    return text;
  }

  std::vector<std::string> remarks() const override { return platform::remarks(*this); }

 private:
  Hexaslide model_;
  std::vector<Parameter> parameters_;
  std::vector<int> preference_;
  std::optional<PointMasses> weights_;
  std::vector<Joint> joints_;
};

}  // namespace

Eigen::Vector3d direction(const Eigen::VectorXd& xi, int chain) {
  const Eigen::Vector2d a = xi.segment<2>(index(chain, kDirection));
  return {a.x(), a.y(), -std::sqrt(std::max(1 - a.squaredNorm(), 1e-12))};
}

}  // namespace hexaslide

std::unique_ptr<Robot> make_hexaslide(const Node& node, Problems& problems) {
  hexaslide::Hexaslide model = hexaslide::read(node, problems);
  if (problems.any()) return nullptr;
  std::string problem;
  auto robot = std::make_unique<hexaslide::HexaslideRobot>(std::move(model), problem);
  if (problem.empty()) return robot;
  problems.add(node.place, "robot: with all readings in the middle of their limits: " + problem);
  return nullptr;
}

}  // namespace selfcal
