// Errors are drawn for every parameter, wanted or not, so that one sigma does not move the others.
#include "sim/true_robot.h"

#include <random>

#include "sim/streams.h"

namespace selfcal {
namespace {

double sigma_of(const Parameter& parameter, const Errors& errors) {
  if (parameter.part == Part::gear) return errors.gear;
  return parameter.part == Part::effect ? 0 : errors.sigma.of(parameter);
}

double mass(const serial::Model& model) {
  double sum = 0;
  for (const serial::Frame& frame : model.frames) sum += frame.mass.value_or(0);
  return sum;
}

}  // namespace

Eigen::VectorXd true_parameters(const Scenario& scenario, const Robot& robot, Problems& problems) {
  Random random = stream(scenario.seed, Draw::errors);
  std::normal_distribution<double> normal;
  const Eigen::VectorXd nominal = values(robot);
  Eigen::VectorXd xi = nominal;
  for (Eigen::Index i = 0; i < xi.size(); ++i)
    xi[i] += normal(random) * sigma_of(robot.parameters()[i], scenario.errors);
  for (const NamedNumber& given : scenario.errors.parameters) {
    const int i = find_parameter(robot, given.name);
    if (i >= 0)
      xi[i] = nominal[i] + given.value;
    else
      problems.add(given.place, "errors parameters: no parameter of " + robot.name() +
                                    " is called '" + given.name + "'; its names are like " +
                                    name_example(robot));
  }
  return xi;
}

std::optional<Compliance> true_compliance(const Scenario& scenario, const Robot& robot,
                                          const Eigen::VectorXd& xi, Problems& problems) {
  if (scenario.compliance.empty()) return std::nullopt;
  const Place& place = scenario.compliance.front().place;
  if (robot.kind() != "serial") {
    problems.add(place, "compliance: expected a serial robot, " + robot.name() + " is of kind " +
                            std::string(robot.kind()));
    return std::nullopt;
  }
  const auto joints = static_cast<Eigen::Index>(robot.joints().size());
  Compliance compliance{serial::read(robot.text().describe(xi).without({"effects"}), problems),
                        Eigen::VectorXd::Zero(joints)};
  if (mass(compliance.model) <= 0)
    problems.add(place, "compliance: " + robot.name() +
                            " has no masses, so gravity loads no joint; give `mass` and `com` of "
                            "its frames");
  for (const NamedNumber& given : scenario.compliance) {
    const int j = find_joint(robot, given.name);
    if (j >= 0 && given.value >= 0 && given.value <= 1e-2)
      compliance.c[j] = given.value;
    else
      problems.add(given.place,
                   "compliance: expected a joint's name and 0 to 1e-2 rad/(N m), got '" +
                       given.name + ": " + format_number(given.value) + "'");
  }
  return compliance;
}

Eigen::VectorXd reading_of(const Compliance& compliance, const Eigen::VectorXd& q) {
  const serial::Model& model = compliance.model;
  Eigen::VectorXd given = compliance.c.cwiseProduct(serial::gravity_torques(model, q));
  if (model.coupling.size() > 0) given = model.coupling.inverse() * given;
  const std::vector<int> moving = serial::moving_frames(model);
  for (Eigen::Index j = 0; j < q.size(); ++j) given[j] /= model.frames[moving[j]].gear;
  return q - given;
}

}  // namespace selfcal
