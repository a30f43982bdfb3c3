// What is measured, as options of a command say it: methods, unknown planes, locks.
#pragma once

#include <string>
#include <vector>

#include "app/commands/subcommand.h"
#include "constraints/methods/data_set.h"
#include "kinematics/robot.h"

namespace selfcal {

struct MethodOptions {
  std::vector<std::string> methods;
  /// Of locked-joint "leg=1,joint=universal"; of others "joint=j2", held while the others move.
  std::vector<std::string> locks;
  bool unknown = false;               ///< planes and normals are
  double noise = 0, noise_angle = 0;  ///< m, rad, 1 sigma; 0: not said
};

/// What --method accepts.
CLI::IsMember is_method();
/// Adds --lock and --unknown.
std::vector<CLI::Option*> add_lock_and_unknown(CLI::App& command, MethodOptions& options);

/// What is wrong with the options among themselves; empty where nothing is.
std::string mistake(const MethodOptions& options);

/// A set of each method (of each lock, of locked-joint; of each joint that turns, of circle-point),
/// named after it. Planes and normals are
/// known unless the options say otherwise, a plane through the endpoint at a random configuration;
/// a link is as long as such a one asks for.
Result<std::vector<Set>> method_sets(const Robot& robot, const MethodOptions& options,
                                     unsigned long long seed);

/// The joints, read ones, that the locks of a method other than locked-joint hold.
Result<std::vector<int>> held_joints(const Robot& robot, const MethodOptions& options);

}  // namespace selfcal
