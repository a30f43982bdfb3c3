// A platform carried by six chains between it and its base (Khalil and Dombre 11.7). Chain i joins
// c_i, a centre on the side of the base, to b_i, a centre fixed in the platform, over a length l_i:
//   |p + R b_i - c_i| = l_i, i = 1 … 6
// A kind says c, b and l of its readings and parameters and their derivatives; the rest is here:
// where the platform is (Newton), Psi, the legs' directions, configurations within the limits.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kinematics/robot.h"

namespace selfcal::platform {

inline constexpr int kChains = 6;
using Six = Eigen::Matrix<double, kChains, 1>;
using Centres = Eigen::Matrix<double, 3, kChains>;

/// The six chains at some readings.
struct Chains {
  Centres carrier, joint;  ///< column i: c_i in the base, b_i in the platform (m)
  Six length;              ///< l_i (m)
};

/// d(c_i, b_i, l_i) to the parameters of chain i, which stand together.
struct ChainDerivatives {
  Eigen::MatrixXd carrier, joint;  ///< 3 x parameters of a chain
  Eigen::RowVectorXd length;
};

/// The assembly mode that a machine is in: where its platform stands in the middle of its readings,
/// and on which side of the singular places that is.
struct AssemblyMode {
  Location home;
  double volume = 1;  ///< there; its sign is the side
};

/// Six equations by elimination, rows exchanged for the largest pivot. All sizes are known when it
/// is compiled: a platform is stepped to where its loops close a hundred thousand times in a plan.
class Elimination {
 public:
  using Square = Eigen::Matrix<double, kChains, kChains>;
  void compute(const Square& A);
  Six solve(const Six& b) const;  ///< not finite where A is singular
  Square inverse() const;
  double determinant() const;

 private:
  Square lu_ = Square::Identity();           ///< U, below it L without its ones
  Six per_ = Six::Ones();                    ///< 1 / the pivots
  std::array<int, kChains> exchanged_ = {};  ///< row that came up at each step
};

/// The loops closed.
struct ClosedChains {
  Location X;  ///< of the platform
  Centres n;   ///< unit, along each chain from c_i to the platform, base axes
  /// Of A, row i (n_i, R b_i x n_i), so that A dX = d l_i + …
  Elimination A;
  double volume = 0;  ///< det A with lengths over the platform's size
  std::string open;   ///< why there is no X; empty where it closes
};

/// Mean distance of the platform's joints from their centre (m).
double size_of(const Chains& chains);

/// What closes at X, whether or not the lengths fit.
ClosedChains at_pose(const Chains& chains, const Location& X);
/// Newton's steps from `start`, held short and halved where the loops would close worse or the
/// platform would cross a singular place; where that ends nowhere, along lengths between those at
/// `start` and the wanted ones. `open` says why none led there. Without `mode`, either side will
/// do, and steps go straight.
ClosedChains close(const Chains& chains, const Location& start, const AssemblyMode* mode);

/// Newton's steps from `start` alone, as above.
ClosedChains close_near(const Chains& chains, const Location& start, const AssemblyMode* mode);

/// `start` is on the mode's side of the singular places, and not turned over.
bool belongs(const Chains& chains, const Location& start, const AssemblyMode& mode);

/// A pose to look for the home from: turned so that the chains are short, above the base (below
/// with a negative `side`) by what the mean length leaves.
Location pose_between(const Chains& chains, double side);

/// Frame of a link along the unit vector `n`: z is n, x lies towards the x of what it is seen from.
Eigen::Matrix3d link_frame(const Eigen::Vector3d& n);
/// Rotation vector of link_frame(n) for each column of `dn`.
Eigen::MatrixXd link_turns(const Eigen::Matrix3d& frame, const Eigen::MatrixXd& dn);

/// Where the passive joints of a chain may stand: angle (rad) of the link from its direction at
/// home, as seen from the base and from the platform.
struct Swing {
  double universal = 0, spherical = 0;  ///< 0: no limit
};

/// About where the platform stands in the middle of its readings, as a file gives it.
struct HomePose {
  Eigen::Vector3d xyz, rpy;  ///< m; rad, in URDF's order
  Location pose() const;
};
/// `home: {xyz: [..], rpy: [..]}` of a robot's file; nothing where it is silent.
std::optional<HomePose> read_home(Fields& robot, Problems& problems);
Node write_home(const HomePose& home);
/// `swing: [universal, spherical]` of a chain.
Swing read_swing(Fields& chain);
/// A point [x, y, z] (m) that a chain must have.
Eigen::Vector3d read_centre(Fields& chain, std::string_view key);

/// The six of the 18 coordinates (3 i + axis) of the centres that hold a frame best when they are
/// held: those that a motion of all centres together moves most, one after another.
std::vector<int> frame_coordinates(const Centres& centres);
/// Shifts along and turns about the axes of the frame of points that are parameters: point i's x, y
/// and z at `at[i]` of `xi`.
Eigen::MatrixXd point_motions(const Eigen::VectorXd& xi, const std::vector<int>& at);

/// How a platform would stand at a pose to which its chains reach.
enum class Stand {
  free,
  beyond_swing,  ///< a passive joint beyond its limit
  other_mode,    ///< only assembled in another way
};

/// What a kind of platform leaves to its own file.
class Platform : public Robot {
 public:
  /// Parameters of a chain, which stand together, chain by chain.
  virtual int chain_parameters() const = 0;
  virtual Chains chains(const Eigen::VectorXd& xi, const Six& q, const Six& added) const = 0;
  virtual ChainDerivatives derivatives(const Eigen::VectorXd& xi, int chain, double q,
                                       double added) const = 0;
  /// Readings that bring the platform to X, each chain on its own; nothing where one does not
  /// reach.
  virtual std::optional<Six> readings_at(const Eigen::VectorXd& xi, const Location& X) const = 0;

  /// At X, where the readings are q. Uses no heap.
  Stand stand_at(const Eigen::VectorXd& xi, const Six& q, const Location& X) const;

  bool has_loops() const override { return true; }
  const std::vector<PassiveJoint>& passive_joints() const override { return passive_; }
  std::optional<Location> home() const override { return mode_.home; }
  bool within_passive_limits(const Eigen::VectorXd& q) const override;
  Eigen::VectorXd leg_lengths(const Eigen::VectorXd& xi, const Eigen::VectorXd& q) const override;
  Closure locate(const ConfigurationBlock& block, const Eigen::VectorXd& xi, Body body,
                 Locations& X, PsiBlock* psi) const override;
  Eigen::VectorXd draw(const Eigen::MatrixX2d& span,
                       const std::function<double()>& uniform) const override;

 protected:
  /// To be called when joints and parameters are there: finds the assembly mode, from `home` or a
  /// pose between base and platform. Says why there is none.
  std::string take_mode(const std::optional<Location>& home, double side,
                        const std::array<Swing, kChains>& swing, std::string_view chain_name);

 private:
  ClosedChains closed(const Chains& at, const Location* near, const ClosedChains* before) const;
  void place(const Chains& chains, const ClosedChains& at, Body body, int lane, Locations& X) const;
  void differentiate(const ConfigurationBlock& block, const Eigen::VectorXd& xi,
                     const Chains& chains, const ClosedChains& at, Body body, int lane,
                     PsiBlock& psi) const;
  bool swings(const ClosedChains& at) const;
  friend std::vector<std::string> remarks(const Platform& robot);

  AssemblyMode mode_ = {};
  std::vector<PassiveJoint> passive_;
  Centres rest_universal_, rest_spherical_;  ///< directions at home
};

/// What a person checks by eye: where the platform stands at home, how far the joints swing.
std::vector<std::string> remarks(const Platform& robot);

}  // namespace selfcal::platform
