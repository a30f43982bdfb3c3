// What moves, what it weighs and where it is: what non-geometric effects need of a machine.
#pragma once

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace selfcal {

/// One link with its frame.
struct Link {
  std::string frame;           ///< name
  int joint = -1;              ///< of the joint that moves it; -1: fixed to the link before
  bool turns = false;          ///< by a revolute joint, about z of its frame
  std::optional<double> mass;  ///< kg; nothing where the maker is silent
  Eigen::Vector3d com = Eigen::Vector3d::Zero();  ///< m, in this frame
};

struct Mechanics {
  Eigen::Vector3d gravity{0, 0, -9.81};  ///< m/s^2, world frame
  std::vector<Link> links;               ///< from the world to the tool
  /// The masses are a usual distribution of the whole robot's, no maker's figures.
  bool masses_assumed = false;
  double payload = 0;  ///< kg, that the machine may carry by its file; 0: not told

  bool masses_known() const;
  /// Index of the link that joint `j` moves.
  int link_of(int j) const;
};

/// A tool or a payload heavier than all that carries it, in words. Empty of others, and where the
/// maker's masses are not all told.
std::string strange_masses(const Mechanics& mechanics);

/// The capability of a robot to say what loads it: masses and links.
class Statics {
 public:
  virtual ~Statics() = default;
  /// As the maker gives them.
  virtual const Mechanics& mechanics() const = 0;
  /// Poses of mechanics().links in the world at readings `q`, with the file's own values.
  virtual std::vector<Eigen::Isometry3d> link_poses(const Eigen::VectorXd& q) const = 0;
};

/// Force and moment (N, N m; world axes) that gravity on every link from `first` on and a wrench at
/// the tip exert about `point`. `poses` are those of the links.
struct Load {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
};
Load load_about(const Mechanics& mechanics, const std::vector<Eigen::Isometry3d>& poses,
                const Load& wrench, int first, const Eigen::Vector3d& point);

/// Torque (N m; N of a prismatic joint) on joint `j` along its axis.
double joint_torque(const Mechanics& mechanics, const std::vector<Eigen::Isometry3d>& poses,
                    const Load& wrench, int j);

}  // namespace selfcal
