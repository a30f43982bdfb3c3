// A data set: rows, and for each set of rows the method that says what they mean.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "constraints/methods/method.h"
#include "constraints/methods/observations.h"
#include "constraints/workspace.h"

namespace selfcal {

/// 1 sigma of what the entry of a set gives of a surface; negative where it does not say, 0 where
/// it is exact.
struct GivenTolerance {
  double place = -1;   ///< m, of a plane's distance or a centre
  double turn = -1;    ///< rad, of a normal
  double length = -1;  ///< m, of a radius
};

/// Rows of one method with one set of nuisance parameters.
struct Set {
  std::string name;
  std::shared_ptr<const Method> method;
  double noise = 0;        ///< 1 sigma of one scalar residual as the data sheet says (m); 0 unknown
  double noise_angle = 0;  ///< the same for angles (rad); 0 unknown
  double noise_joints = 0;  ///< 1 sigma of a reading of every joint (rad or m); 0 without
  GivenTolerance given = {};
  Node options;                     ///< its entry, without what is said of noise and tolerances
  int reference = -1;               ///< index of the set whose nuisance parameters it shares
  std::vector<std::string> groups;  ///< names, indexed by Observations::group
};

struct DataSet {
  std::vector<Set> sets;
  Observations rows;
  bool speeds = true;  ///< dq are velocities; false: only their signs mean something
  /// The file has no times: the order of the rows stands for them, a second from one to the next.
  bool order_is_time = false;
  double target = 1.0e-3;  ///< end-position accuracy wanted in the workspace (m, 1 sigma)
  Workspace workspace = {};
};

/// Reads one entry of `sets`: the method, its options and the noise. Known groups are appended to
/// `set.groups` as the options name them. The set is without a method after a problem.
Set make_set(const std::string& name, const Node& node, Problems& problems);

/// Reads the mapping `sets`, NAME: ENTRY, and ties sets together that share unknowns. Sets are
/// without a method or not tied after a problem.
std::vector<Set> read_sets(const Node& node, Problems& problems);

/// Why the robot cannot answer one of the sets, which speaks of a joint that it lacks; empty when
/// it can.
std::string lacking_body(const Robot& robot, const std::vector<Set>& sets);

/// Why a set with rows cannot be solved for: it shares the unknowns of another that has no rows of
/// their use (those that identify need some that do); empty when none is so.
std::string lacking_reference(const DataSet& data);

/// The set among `sets` of the same name, method and options as `set`; -1 without.
int same_set(const std::vector<Set>& sets, const Set& set);

/// Rows of two sessions with one robot, the first ones first. Sets of one name, method and options
/// become one, with the noise that `before` has for it, and of two of one name that differ the
/// second is called NAME'; groups and repeats stay apart, and the second begins when the first
/// ends.
DataSet merged(const DataSet& before, const DataSet& after);

/// The methods that make_set knows.
std::vector<std::string_view> method_names();

}  // namespace selfcal
