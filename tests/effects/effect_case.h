// Every effect in the shapes that its entry may have, on random robots with masses, at a place and
// a time where something of everything holds.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "constraints/sampling/random_poses.h"
#include "kinematics/corrected_robot.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"
#include "tests/kinematics/random_robot.h"

namespace selfcal {

/// JOINT and OTHER in the entry stand for two joints of the robot: a serial one, or the example of
/// its kind that has legs.
struct EffectCase {
  const char* title;
  const char* entry;
  const char* kind = "serial";
  bool heavy = false;       ///< of a machine with loops: its file says what it weighs
  bool light_tool = false;  ///< of a serial robot: no frame behind the last joint has a mass
};

inline std::vector<EffectCase> effect_cases() {
  return {
      {"JointCompliance", "effect: joint_compliance, at: JOINT"},
      {"JointComplianceByLumps", "effect: joint_compliance, at: JOINT, lumps: true"},
      {"JointComplianceOfASpringThatStiffens", "effect: joint_compliance, at: JOINT, by: square"},
      {"LinkCompliance", "effect: link_compliance, at: JOINT"},
      {"TransmissionError", "effect: transmission_error, at: JOINT"},
      {"TransmissionErrorOfManyWaves",
       "effect: transmission_error, at: JOINT, waves: [1, 2, 12.5]"},
      {"Backlash", "effect: backlash, at: JOINT"},
      {"BacklashByLoad", "effect: backlash, at: JOINT, by: load"},
      {"JointCoupling", "effect: joint_coupling, at: JOINT, from: OTHER"},
      {"ThermalExpansion", "effect: thermal_expansion"},
      {"ThermalExpansionThatLags", "effect: thermal_expansion, lag: 600, reference: 21"},
      {"ThermalExpansionOfTheTool", "effect: thermal_expansion, tool: true, reference: 21"},
      {"ThermalExpansionOfTheBase", "effect: thermal_expansion, base: true, reference: 21"},
      {"BaseDrift", "effect: base_drift, at: base"},
      {"BaseDriftThatSettles", "effect: base_drift, settle: 500"},
      {"BaseDriftThatWanders", "effect: base_drift, half_waves: [1, 2.5]"},
      {"BaseMovedAtOnce", "effect: base_drift, moment: 1000"},
      {"ZeroShift", "effect: zero_shift, at: JOINT, moment: 1000"},
      {"ZeroShiftByTemperature", "effect: zero_shift, at: JOINT, by: temperature, reference: 21"},
      {"ProbePretravel", "effect: probe_pretravel, at: probe"},
      {"TriggerLatency", "effect: trigger_latency"},
      {"PlaneFormError", "effect: plane_form_error, at: table"},
      {"FixtureShift", "effect: fixture_shift, at: table, moment: 1000"},
      {"FixtureShiftOfABall", "effect: fixture_shift, at: ball, moment: 1000"},
      {"ToolShift", "effect: tool_shift, at: probe, moment: 1000"},
      {"ToolCompliance", "effect: tool_compliance, at: probe"},
      {"ToolComplianceOfALightTool", "effect: tool_compliance, at: probe", "serial", false, true},
      {"ToolComplianceOfTheToolItself", "effect: tool_compliance, at: probe, by: tool"},
      {"ToolComplianceOfALightToolItself", "effect: tool_compliance, by: tool, mass: 3", "serial",
       false, true},
      {"ToolComplianceByTheWrenchAlone", "effect: tool_compliance, at: probe, mass: 0", "serial",
       false, true},
      {"ScaleError", "effect: scale_error, at: tracker"},
      {"ScaleErrorByTemperature", "effect: scale_error, at: tracker, by: temperature"},
      {"ScaleErrorThatLags", "effect: scale_error, at: tracker, by: temperature, lag: 600"},
      {"LegCompliance", "effect: leg_compliance, at: JOINT", "gough-stewart"},
      {"LegComplianceOfADelta", "effect: leg_compliance, at: JOINT, mass: 0", "linear-delta"},
      {"LegComplianceOfAHexaSlide", "effect: leg_compliance, at: JOINT, mass: 9", "hexaslide"},
      {"LegThermalGrowth", "effect: leg_thermal_growth, at: JOINT", "gough-stewart"},
      {"LegThermalGrowthOfAllLegs", "effect: leg_thermal_growth", "gough-stewart"},
      {"LegThermalGrowthOfADelta", "effect: leg_thermal_growth, at: JOINT, reference: 21",
       "linear-delta"},
      {"JointClearance", "effect: joint_clearance, at: JOINT", "gough-stewart"},
      {"JointClearanceUnderAWeight", "effect: joint_clearance, at: JOINT, mass: 4", "hexaslide"},
      {"LegComplianceOfAHeavyPlatform", "effect: leg_compliance, at: JOINT", "gough-stewart", true},
      {"JointComplianceOfADelta", "effect: joint_compliance, at: JOINT", "linear-delta", true},
      {"JointComplianceOfAHexaSlide", "effect: joint_compliance, at: JOINT", "hexaslide", true},
      {"BacklashByLoadOfADelta", "effect: backlash, at: JOINT, by: load", "linear-delta", true},
  };
}

inline std::string title_of(const testing::TestParamInfo<EffectCase>& info) {
  return info.param.title;
}

/// The entry as a line of flow style, with the joints put in.
inline std::string entry_text(const EffectCase& each, const std::string& joint,
                              const std::string& other) {
  std::string text = each.entry;
  if (const size_t at = text.find("OTHER"); at != text.npos) text.replace(at, 5, other);
  if (const size_t at = text.find("JOINT"); at != text.npos) text.replace(at, 5, joint);
  return text;
}

/// Sets "table" and "ball" (touched) and "tracker"; an hour in which it grows warm.
inline MeasurementContext random_context(std::mt19937_64& random) {
  MeasurementContext context;
  context.sets = {
      {"table", TouchedSurface::plane, {0.4, 0.2, uniform(random, -0.2, 0.2)}, {0.1, -0.3, 0.9}},
      {"tracker", TouchedSurface::none, {}, {}, true},
      {"ball", TouchedSurface::curved, {0.5, -0.1, 0.3}}};
  for (double t = 0; t <= 3600; t += 60) {
    context.times.push_back(t);
    context.temperatures.push_back(20 + t / 900 + uniform(random, -0.1, 0.1));
  }
  context.end = 3600;
  context.reference = 22;
  context.loads = context.velocities = context.speeds = true;
  return context;
}

inline Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, double most,
                                     std::mt19937_64& random) {
  Eigen::MatrixXd M(rows, columns);
  for (double& m : M.reshaped()) m = uniform(random, -most, most);
  return M;
}

inline ConfigurationBlock with_conditions(ConfigurationBlock block, std::mt19937_64& random) {
  MeasurementConditions& at = block.conditions;
  at.wrench = random_matrix(kLanes, 6, 100, random);
  at.velocity = random_matrix(kLanes, block.q.cols(), 0.5, random);
  at.normal = random_matrix(kLanes, 3, 1, random).rowwise().normalized();
  at.temperature = random_matrix(kLanes, 1, 5, random).array() + 20;
  at.time = random_matrix(kLanes, 1, 1700, random).array() + 1800;
  for (int lane = 0; lane < kLanes; ++lane) at.set.push_back(lane % 3);
  return block;
}

/// A random robot of weight with one effect, whose parameters are not zero.
struct EffectInstance {
  std::shared_ptr<const Robot> geometry;
  MeasurementContext context;
  std::unique_ptr<Robot> robot;
  Eigen::VectorXd xi;
  ConfigurationBlock block;

  Eigen::Index own() const { return static_cast<Eigen::Index>(geometry->parameters().size()); }
};

inline std::shared_ptr<const Robot> heavy_robot(bool light_tool, std::mt19937_64& random) {
  const RandomRobot made = random_robot(random);
  Node node = robot_node(made.frames, made.coupling);
  std::size_t heavy = made.frames.size();
  while (light_tool && !made.frames[heavy - 1].moves()) --heavy;
  for (size_t k = 0; k < node.keys.size(); ++k)
    for (size_t f = 0; f < heavy && node.keys[k] == "frames"; ++f) {
      Node& frame = node.items[k].items[f];
      frame.set("mass", Node::of(uniform(random, 1, 20)));
      frame.set("com", Node::of(Eigen::VectorXd(random_matrix(3, 1, 0.3, random))));
    }
  return robot_of(node);
}

/// Configurations that the robot can take.
inline ConfigurationBlock closing_block(const Robot& robot, std::mt19937_64& random) {
  ConfigurationBlock block;
  block.q = random_poses(robot, nullptr, kLanes, random()).array();
  block.count = kLanes;
  return block;
}

inline EffectInstance random_instance(const EffectCase& each, std::mt19937_64& random) {
  const bool legs = std::string(each.kind) != "serial";
  const std::string weight = each.heavy ? kind_masses().at(each.kind) : "";
  EffectInstance made{legs ? robot_of(kind_examples().at(each.kind) + weight)
                           : heavy_robot(each.light_tool, random),
                      random_context(random),
                      {},
                      {},
                      {}};
  const std::vector<Joint>& joints = made.geometry->joints();
  const auto pick = static_cast<size_t>(uniform(random, 0, static_cast<double>(joints.size() - 1)));
  const std::string text = entry_text(each, joints[pick].name, joints[pick + 1].name);
  Problems problems;
  made.robot = correct(made.geometry, {parsed("{" + text + "}")}, made.context, problems);
  for (const std::string& problem : problems.list) ADD_FAILURE() << problem;
  made.xi = values(*made.robot);
  for (Eigen::Index i = made.own(); i < made.xi.size(); ++i)
    made.xi[i] = made.robot->parameters()[i].tolerance / 10 * uniform(random, -1, 1);
  made.block = with_conditions(
      legs ? closing_block(*made.geometry, random) : random_block(*made.geometry, random), random);
  return made;
}

}  // namespace selfcal
