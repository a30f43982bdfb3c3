// What touches that could be made say of the robot's parameters, beside the surfaces and sockets
// whose places are not known.
#pragma once

#include <Eigen/Dense>
#include <map>
#include <utility>
#include <vector>

#include "constraints/methods/data_set.h"
#include "constraints/methods/method.h"
#include "kinematics/robot.h"

namespace selfcal {

/// A touch that could be made.
struct PossibleTouch {
  Eigen::VectorXd q;        ///< readings in the contact
  int set = 0, group = -1;  ///< group: of sockets and nests
  Eigen::Vector3d outward;  ///< of a surface (world, unit)
};

/// 1 sigma² of where a surface or socket lies, or how it is turned, that is not known (squares of
/// the robot's size, rad²).
inline constexpr double kPlaceVariance = 1;

/// Inverse of the covariance `C`, whose directions without variance get a little.
Eigen::MatrixXd inverse_of_covariance(const Eigen::MatrixXd& C);

/// 1 sigma of a touch of the set as its data sheet says (m), 20 um where it says none.
double touch_noise(const Set& set);
/// The same of an angle (rad).
double angle_noise(const Set& set);

/// What is not known exactly of a surface or a socket.
struct PlaceUnknowns {
  int column = 0;          ///< first of three
  Eigen::Vector3d normal;  ///< that the plane's unknowns belong to
};

/// Columns of the surfaces and sockets of touches, after those of the robot, in the order in which
/// they come.
class PlaceColumns {
 public:
  /// After those of `robot`.
  PlaceColumns(const Robot& robot, const std::vector<Set>& sets);

  /// Takes the columns of the touch's surface or socket in.
  void add(const PossibleTouch& touch);
  /// That of the touch's surface or socket; two faces that are a known distance apart are one
  /// place, and have one normal though their ways out are opposite.
  PlaceUnknowns of(const PossibleTouch& touch);
  /// That of the step from the face that the touch's is a known distance from; -1 without.
  int step_of(const PossibleTouch& touch);
  bool is_step(Eigen::Index column) const;
  int end() const { return first_ + static_cast<int>(variances_.size()); }
  /// 1 sigma² of each beforehand.
  const std::vector<double>& variances() const { return variances_; }

 private:
  int first_;
  const std::vector<Set>& sets_;
  double place_variance_;  ///< of a length that is not known (m²)
  std::vector<double> variances_;
  std::map<std::pair<int, int>, PlaceUnknowns> at_;
  std::map<int, int> step_;
};

/// Whitened rows of the touches, one matrix each (1 row for a surface, 3 for a socket, 2 for a
/// lock), in the robot's parameters and `columns`, which take in what they lack.
std::vector<Eigen::MatrixXd> touch_rows(const Robot& robot, const Eigen::VectorXd& xi,
                                        const std::vector<Set>& sets,
                                        const std::vector<PossibleTouch>& touches,
                                        PlaceColumns& columns);

/// Of each column before any touch, `given` of the robot's parameters (without rows: the makers'
/// tolerances); zero of what is known exactly.
Eigen::MatrixXd covariance_before(const Robot& robot, const Eigen::MatrixXd& given,
                                  const PlaceColumns& columns);

/// Orthonormal motions of the world (6 x k, shift then turn) that the touches cannot see, for their
/// places are not given (see gauge.h).
Eigen::MatrixXd unseen_by_touches(const Robot& robot, const Eigen::VectorXd& xi,
                                  const std::vector<Set>& sets,
                                  const std::vector<PossibleTouch>& touches);

/// Covariance of the robot's parameters after the touches, from their priors and each set's noise
/// (20 um where a set says none); surfaces and sockets are unknown where they are not given, and
/// what is given is in doubt (given_doubt.h).
Eigen::MatrixXd covariance_after(const Robot& robot, const Eigen::VectorXd& xi,
                                 const std::vector<Set>& sets,
                                 const std::vector<PossibleTouch>& touches,
                                 const Eigen::MatrixXd& prior = {});

}  // namespace selfcal
