// What a trial's machine really is, for causes of deviations that the product does not know.
//
// Nothing here or in trial_causes uses kinematics/effects: when the generator and the candidates
// shared a formula, trials of the diagnosis would pass with the formula wrong.
#pragma once

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "constraints/methods/method.h"
#include "kinematics/robot.h"

namespace selfcal {

/// One row at the moment when it is taken.
struct Instant {
  int row = 0;
  int configuration = 0;  ///< equal for immediate repeats
  int set = 0;
  double time = 0;                       ///< s
  Eigen::VectorXd q, velocity;           ///< readings and their rates (rad or m, per s)
  std::vector<Eigen::Isometry3d> poses;  ///< of the links, nominal geometry; on legs of the tool
  Eigen::MatrixXd legs;     ///< 6 x legs: twist of the tip as one grows (1, 1/m), world
  Eigen::VectorXd lengths;  ///< of the legs (m)
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< outward, of the touched surface, world
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< on the tip, world (N)
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< about the tip, world (N m)
};

/// What is added to the joint variables, to the readings, to the lengths of legs and to the place
/// of the tip (world, m).
struct Deviation {
  Eigen::VectorXd joints;
  Eigen::VectorXd readings = Eigen::VectorXd::Zero(joints.size());
  Eigen::VectorXd legs = Eigen::VectorXd::Zero(joints.size());  ///< m, one behind each joint
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
};

/// A touched surface as it really is.
struct TrialSurface {
  std::string name;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< outward
  double distance = 0;                                ///< n . p = distance (m), of either sign
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< of its touches
};

/// The air's temperature at equal steps of time from 0.
struct AirRecord {
  double step = 1;  ///< s
  std::vector<double> celsius;

  double at(double time) const;
  /// The same through a first-order lag (s).
  AirRecord lagged(double lag) const;
};

/// Warms up by 6 to 13 K towards its end, with some weather.
AirRecord draw_air(double duration, Random& random);

/// Every joint has a leg behind it, all of which carry the tip together.
bool runs_on_legs(const Robot& robot);

struct TrialWorld {
  const Robot* robot = nullptr;        ///< nominal
  std::vector<double> mass;            ///< kg, by link, true
  std::vector<Eigen::Vector3d> com;    ///< m, by link, in its frame, true
  std::vector<TrialSurface> surfaces;  ///< by set; none where positions are tracked
  std::vector<Instant> rows;
  AirRecord air;
  double duration = 0;  ///< s

  bool touches() const { return !surfaces.empty(); }
  bool on_legs() const { return runs_on_legs(*robot); }
  const std::vector<Link>& links() const { return robot->statics()->mechanics().links; }
  int joints() const { return static_cast<int>(robot->joints().size()); }
  Eigen::Vector3d gravity() const;  ///< m/s^2, world
  /// Force and moment about `point` (world) of all weights from link `first` on and of the tool's
  /// load.
  void load(const Instant& at, int first, const Eigen::Vector3d& point, Eigen::Vector3d& force,
            Eigen::Vector3d& moment) const;
  /// N m (N of a prismatic joint); on legs the pull along the joint's.
  double torque(const Instant& at, int joint) const;
  /// Largest |torque| over the rows.
  double largest_torque(int joint) const;
};

/// Fills in the poses at `at.q`, or on legs what these do there (true geometry).
void look(const Robot& robot, const Eigen::VectorXd& xi, Instant& at);

/// Geometry `xi` with longer legs (m, by joint).
Eigen::VectorXd with_legs(const Robot& robot, Eigen::VectorXd xi, const Eigen::VectorXd& longer);

/// Place of the tip at readings `q` and true geometry, with `added` to the joint variables (none
/// where it is empty), and its derivative to the readings (3 x joints) unless null.
Eigen::Vector3d tip_of(const Robot& robot, const Eigen::VectorXd& xi, const Eigen::VectorXd& q,
                       Eigen::MatrixXd* J, const Eigen::VectorXd& added = {});

double uniform(Random& random, double least, double most);
double log_uniform(Random& random, double least, double most);
double normal(Random& random);
int pick(Random& random, int count);  ///< 0 to count - 1
bool chance(Random& random, double probability);

}  // namespace selfcal
