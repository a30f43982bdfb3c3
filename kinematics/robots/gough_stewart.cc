// The legs of a Gough-Stewart platform as chains: a and b are parameters, the length is the reading
// and its offset; so d l = d offset, d c = d a, d b = d b (11.63).
#include "kinematics/robots/gough_stewart.h"

#include <cstdio>

namespace selfcal {
namespace gough_stewart {
namespace {

using platform::Six;

/// A cylinder turns with the leg's universal joint; a piston hangs on the platform, less its way
/// back along the leg.
std::optional<PointMasses> weights(const GoughStewart& model) {
  std::optional<PointMasses> all = point_masses(model.masses);
  const LoopMasses& m = model.masses;
  for (int leg = 0; all && leg < kLegs; ++leg) {
    const Body along = body_behind(leg, PassiveKind::universal);
    const Eigen::Vector3d joint = model.nominal.segment<3>(index(leg, kPlatform));
    const std::string cylinder = leg_name(leg) + ".cylinder", piston = leg_name(leg) + ".piston";
    if (m.cylinder > 0)
      all->points.push_back({cylinder, along, {0, 0, m.cylinder_com}, m.cylinder});
    if (!(m.piston > 0)) continue;
    all->points.push_back({piston, Body::last_link, joint, m.piston});
    all->points.push_back({piston, along, {0, 0, m.piston_com}, -m.piston});
    all->points.push_back({piston, along, Eigen::Vector3d::Zero(), m.piston});
  }
  return all;
}

class GoughStewartRobot final : public platform::Platform, public RobotText {
 public:
  GoughStewartRobot(GoughStewart model, std::string& problem)
      : model_(std::move(model)),
        parameters_(gough_stewart::parameters(model_)),
        preference_(gough_stewart::preference(model_)),
        weights_(weights(model_)) {
    for (size_t leg = 0; leg < kLegs; ++leg)
      joints_.push_back({leg_name(static_cast<int>(leg)), Quantity::length, model_.lower[leg],
                         model_.upper[leg]});
    std::optional<Location> home;
    if (model_.home) home = model_.home->pose();
    problem = take_mode(home, 1, model_.swing, "leg");
  }

  std::string_view kind() const override { return "gough-stewart"; }
  const std::string& name() const override { return model_.name; }
  const std::vector<Joint>& joints() const override { return joints_; }
  const std::vector<Parameter>& parameters() const override { return parameters_; }
  const std::vector<int>& preference() const override { return preference_; }
  const RobotText& text() const override { return *this; }
  const PointMasses* masses() const override { return weights_ ? &*weights_ : nullptr; }
  int variable_parameter(int joint) const override { return index(joint, kOffset); }
  int leg_parameter(int joint) const override { return variable_parameter(joint); }
  int chain_parameters() const override { return kFields; }

  platform::Chains chains(const Eigen::VectorXd& xi, const Six& q,
                          const Six& added) const override {
    platform::Chains at;
    for (int leg = 0; leg < kLegs; ++leg) {
      at.carrier.col(leg) = xi.segment<3>(index(leg, kBase));
      at.joint.col(leg) = xi.segment<3>(index(leg, kPlatform));
      at.length[leg] = q[leg] + added[leg] + xi[index(leg, kOffset)];
    }
    return at;
  }

  platform::ChainDerivatives derivatives(const Eigen::VectorXd&, int, double,
                                         double) const override {
    platform::ChainDerivatives by{Eigen::MatrixXd::Zero(3, kFields),
                                  Eigen::MatrixXd::Zero(3, kFields),
                                  Eigen::RowVectorXd::Zero(kFields)};
    by.carrier.middleCols<3>(kBase).setIdentity();
    by.joint.middleCols<3>(kPlatform).setIdentity();
    by.length[kOffset] = 1;
    return by;
  }

  std::optional<Six> readings_at(const Eigen::VectorXd& xi, const Location& X) const override {
    Six q;
    for (int leg = 0; leg < kLegs; ++leg)
      q[leg] = (X.p + X.R * xi.segment<3>(index(leg, kPlatform)) - xi.segment<3>(index(leg, kBase)))
                   .norm() -
               xi[index(leg, kOffset)];
    return q;
  }

  std::vector<FrameMotions> frame_motions(const Eigen::VectorXd& xi) const override {
    std::vector<int> base, platform;
    for (int leg = 0; leg < kLegs; ++leg) {
      base.push_back(index(leg, kBase));
      platform.push_back(index(leg, kPlatform));
    }
    return {{"the base's frame", platform::point_motions(xi, base)},
            {"the platform's frame", platform::point_motions(xi, platform)}};
  }

  void joint_jacobian(const ConfigurationBlock&, const Eigen::VectorXd&, Body, const PsiBlock& psi,
                      Eigen::MatrixXd& J) const override {
    J.resize(psi.rows(), kLegs);
    for (int leg = 0; leg < kLegs; ++leg) J.col(leg) = psi.col(index(leg, kOffset));
  }

  Node describe(const Eigen::VectorXd& xi) const override {
    GoughStewart model = model_;
    model.value = xi;
    return gough_stewart::write(model);
  }

  std::string identity() const override {
    std::string text = "gough-stewart " + model_.name;
    for (const double v : model_.nominal) text += " " + format_number(v);
    return text;
  }

  std::vector<std::string> remarks() const override { return platform::remarks(*this); }

 private:
  GoughStewart model_;
  std::vector<Parameter> parameters_;
  std::vector<int> preference_;
  std::optional<PointMasses> weights_;
  std::vector<Joint> joints_;
};

}  // namespace
}  // namespace gough_stewart

std::unique_ptr<Robot> make_gough_stewart(const Node& node, Problems& problems) {
  gough_stewart::GoughStewart model = gough_stewart::read(node, problems);
  if (problems.any()) return nullptr;
  std::string problem;
  auto robot = std::make_unique<gough_stewart::GoughStewartRobot>(std::move(model), problem);
  if (problem.empty()) return robot;
  problems.add(node.place, "robot: with all readings in the middle of their limits: " + problem);
  return nullptr;
}

}  // namespace selfcal
