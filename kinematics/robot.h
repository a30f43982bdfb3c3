// The machine as the identification sees it: named parameters, the location of a body and its
// generalized Jacobian Psi (Khalil and Dombre, equations 11.10 to 11.18).
//
// Everything is evaluated for a block of configurations at once, kLanes of them or one alone. In
// every array the lanes are contiguous, so that the same operation runs over all of them.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinematics/description.h"
#include "kinematics/mechanics.h"
#include "kinematics/parameter.h"
#include "kinematics/robot_text.h"

namespace selfcal {

struct PointMasses;  // statics.h

inline constexpr int kLanes = 32;

/// Lanes x columns without the heap. The rows are counted at run time so that the compiler loops
/// over them: unrolled, one expression becomes hundreds of instructions.
template <int columns>
using LaneArray = Eigen::Array<double, Eigen::Dynamic, columns, 0, kLanes, columns>;

/// One number a lane.
using Lanes = LaneArray<1>;

/// What else held when the rows of a block were taken, a row a lane; NaN where it is not known. A
/// matrix without rows is not known of any lane. Only effects ask for it.
struct MeasurementConditions {
  Eigen::MatrixXd wrench;    ///< lanes x 6, on the tool at the last frame's origin, in its axes
  Eigen::MatrixXd velocity;  ///< lanes x joints
  Eigen::MatrixXd normal;    ///< lanes x 3, outward, of the touched surface, world, unit
  Eigen::VectorXd temperature, time;  ///< C, s
  std::vector<int> set;               ///< of the data set
};

/// Location of a body in the world frame.
struct Location {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< m

  // Friends, so that no product of matrices looks at them: that doubles the time to compile one.
  friend Location operator*(const Location& a, const Location& b) {
    return {a.R * b.R, a.p + a.R * b.p};
  }
  friend Eigen::Vector3d operator*(const Location& X, const Eigen::Vector3d& point) {
    return X.p + X.R * point;
  }
};

/// The same lane by lane.
struct Locations {
  LaneArray<9> rotation{kLanes, 9};  ///< column 3 j + i holds R(i, j)
  LaneArray<3> position{kLanes, 3};  ///< m

  void resize(int lanes) {
    rotation.resize(lanes, 9);
    position.resize(lanes, 3);
  }
  Eigen::Matrix3d R(int lane) const;
  Eigen::Vector3d p(int lane) const { return position.row(lane).matrix().transpose(); }
  Location at(int lane) const { return {R(lane), p(lane)}; }
};

/// Joint readings of a block: kLanes x joints, or 1 x joints (rad or m). Lanes past `count` repeat
/// the last one.
struct ConfigurationBlock {
  Eigen::ArrayXXd q;
  int count = 0;
  Eigen::ArrayXXd added = {};  ///< lanes x joints, to the joint variables; without rows: nothing
  MeasurementConditions conditions = {};
  /// About where the last link stands in the first lane, of a machine with loops: they are closed
  /// from there. Nothing: from the robot's home. Where it belongs to another assembly mode than
  /// home, no lane closes.
  std::optional<Location> start = {};
  /// Where the body that is asked for stood in each lane at readings near these, of a machine with
  /// loops: they are closed from there, which is quick; where that leads nowhere, as without.
  const Locations* near = nullptr;

  int lanes() const { return static_cast<int>(q.rows()); }
};

/// Psi of a block, (6 lanes) x parameters: row c lanes + lane is component c (dx dy dz of the
/// body's origin, then the rotation vector, both in the world frame) of configuration `lane`.
using PsiBlock = Eigen::MatrixXd;

/// The lanes of a block that have no location, for the loops of the machine do not close there, and
/// why. What was written of such a lane is finite and means nothing.
struct Closure {
  std::uint32_t open = 0;             ///< bit `lane`
  std::vector<std::string> why = {};  ///< by lane; empty when every lane closes
  bool closes() const { return open == 0; }
  bool closes(int lane) const { return ((open >> lane) & 1U) == 0; }
  void leave_open(int lane, std::string reason);
  void add(const Closure& other);  ///< the first reason of a lane stays
};
static_assert(kLanes == 32, "a bit for each lane");

/// The body whose location is asked for: the tool's frame, or the first or last moving link (whose
/// location the parameters of frames behind it do not change). Of a machine with loops the last
/// link is the platform, and the first its base: what turns with the machine as a whole. From
/// first_passive on, the links behind passive joints (see body_behind); from first_named on, those
/// of Robot::links() (see link_body).
enum class Body : int { endpoint, last_link, first_link, first_passive, first_named = 1 << 16 };

/// The universal joint that a chain of a platform has in the base, the spherical one in the
/// platform.
enum class PassiveKind : int { universal, spherical };

/// A joint that nothing drives and nothing reads. What it says is the link behind it as seen from
/// what carries it (the base or the platform), a body: the joint's centre, and the link along z.
struct PassiveJoint {
  std::string name;  ///< "leg1.universal"
  int chain = 0;     ///< from 0
  PassiveKind kind = PassiveKind::universal;
  double swing = 0;  ///< most that the link turns there from its direction at home (rad); 0: any
};

/// The link behind the joint of `kind` of `chain` (from 0): its location is in the frame that
/// carries the joint, the world or the platform.
inline Body body_behind(int chain, PassiveKind kind) {
  return static_cast<Body>(static_cast<int>(Body::first_passive) + 2 * chain +
                           static_cast<int>(kind));
}

/// The body of Robot::links()[k].
inline Body link_body(int k) { return static_cast<Body>(static_cast<int>(Body::first_named) + k); }

struct NamedBody {
  std::string name;
  Body body = Body::endpoint;
};

struct Joint {
  std::string name;  ///< the frame that it moves
  Quantity quantity = Quantity::angle;
  double lower = 0, upper = 0;  ///< of the joint reading; equal when the file gives none
  bool limited() const { return upper > lower; }
  /// How far the reading can go altogether: without limits a turn or 2 m, half of it to each side
  /// of zero.
  double range() const;
  /// The reading keeps `margin` from the limits, if there are any.
  bool allows(double reading, double margin = 0) const {
    return !limited() || !(reading < lower + margin || reading > upper - margin);
  }
};

/// Changes of the parameters that do nothing but choose another frame: three shifts and three turns
/// of it.
struct FrameMotions {
  std::string what;       ///< "the base's frame"
  Eigen::MatrixXd moves;  ///< parameters x 6
};

/// One kind of machine. Immutable; a vector xi of parameter values goes beside it.
class Robot {
 public:
  virtual ~Robot() = default;

  virtual std::string_view kind() const = 0;
  virtual const std::string& name() const = 0;
  virtual const std::vector<Joint>& joints() const = 0;

  /// Every candidate parameter in the order of the file; xi has one value for each.
  virtual const std::vector<Parameter>& parameters() const = 0;

  /// Indices into parameters(), most preferred first (Khalil and Dombre 11.4.2.1): of a dependent
  /// group the earlier ones are identified and the later ones are grouped with them.
  virtual const std::vector<int>& preference() const = 0;

  /// Location of `body` at each configuration and, unless null, its derivatives to every parameter
  /// (`X` and `psi` are resized; zero where a lane stays open). `xi` has parameters().size()
  /// entries.
  virtual Closure locate(const ConfigurationBlock& block, const Eigen::VectorXd& xi, Body body,
                         Locations& X, PsiBlock* psi) const = 0;
  /// Has loops, so that locate may leave lanes open.
  virtual bool has_loops() const { return false; }
  /// Of a machine that could be put together in several ways: where its last link stands, by the
  /// maker's figures, in the middle of its readings. Loops are closed from there, or from the lane
  /// before, and only in the way that this belongs to.
  virtual std::optional<Location> home() const { return std::nullopt; }
  /// Joints that a method may speak of; empty where the kind gives none.
  virtual const std::vector<PassiveJoint>& passive_joints() const;
  /// Names of what moves between the base and the last link: an arm's frames, a delta's carriages.
  virtual const std::vector<std::string>& links() const;
  /// Every passive joint is within its limit at readings `q`, by the maker's figures.
  virtual bool within_passive_limits(const Eigen::VectorXd&) const { return true; }

  /// dX of `body` per joint reading, (6 lanes) x joints, laid out as Psi; `psi` is that of the
  /// block and the body.
  virtual void joint_jacobian(const ConfigurationBlock& block, const Eigen::VectorXd& xi, Body body,
                              const PsiBlock& psi, Eigen::MatrixXd& J) const = 0;
  /// Index of the parameter that the variable of joint `j` is added to, so that it is the joint's
  /// zero; where several share it, the one that has most of it.
  virtual int variable_parameter(int j) const = 0;
  /// The change of the parameters that does as much as one of the variable of joint `j`.
  virtual Eigen::VectorXd variable_change(const Eigen::VectorXd& xi, int j) const;

  /// Changes of the joint variables per reading at values `xi`, joints x joints: for a chain
  /// coupling K (11.16).
  virtual Eigen::MatrixXd variables_per_reading(const Eigen::VectorXd& xi) const;

  /// Of a machine that legs carry (struts, rods or links, one behind each joint): index of the
  /// parameter that is the length of joint `j`'s, or is added to it; -1 of one without.
  virtual int leg_parameter(int) const { return -1; }
  /// Lengths of the legs at values `xi` and readings `q` (m); empty of a machine without.
  virtual Eigen::VectorXd leg_lengths(const Eigen::VectorXd&, const Eigen::VectorXd&) const {
    return {};
  }

  /// The frames that the parameters are given in, at values `xi`; empty where the kind does not
  /// say.
  virtual std::vector<FrameMotions> frame_motions(const Eigen::VectorXd&) const { return {}; }

  /// Readings that the machine can take, drawn within `span` (joints x lower, upper) by `uniform`
  /// numbers from 0 to 1.
  virtual Eigen::VectorXd draw(const Eigen::MatrixX2d& span,
                               const std::function<double()>& uniform) const;

  /// Masses and links of a chain; null of a machine that is none.
  virtual const Statics* statics() const { return nullptr; }
  /// What weighs, of a machine of any structure; null where its file says nothing of it.
  virtual const PointMasses* masses() const { return nullptr; }
  /// Where the tool points, in its own frame.
  virtual Eigen::Vector3d tool_axis() const { return Eigen::Vector3d::UnitZ(); }

  /// Its file and what a person reads of it.
  virtual const RobotText& text() const = 0;
};

/// Values of all parameters as the file has them.
Eigen::VectorXd values(const Robot& robot);
/// Centres of the priors.
Eigen::VectorXd nominal_values(const Robot& robot);

/// Index of the joint called `name`, or -1.
int find_joint(const Robot& robot, std::string_view name);
/// Place of the joint that `body` is behind among the passive ones, or -1.
int passive_index(const Robot& robot, Body body);
/// The robot can be asked for `body`.
bool has_body(const Robot& robot, Body body);
/// Every body that it can be asked for, by name: "endpoint", "last_link", "first_link", its passive
/// joints and its links.
std::vector<NamedBody> named_bodies(const Robot& robot);
/// The one called `name`; nothing where there is none.
std::optional<Body> find_body(const Robot& robot, std::string_view name);
/// Every reading keeps `margin`, a share of its joint's range, from the joint's limits, and the
/// passive joints keep theirs.
bool within_limits(const Robot& robot, const Eigen::VectorXd& q, double margin = 0);

/// Readings `q` alone, of one lane.
ConfigurationBlock block_of(const Eigen::VectorXd& q);
/// Location of `body` at readings `q`, at which the loops of the machine must close.
Location locate(const Robot& robot, const Eigen::VectorXd& xi, const Eigen::VectorXd& q,
                Body body = Body::endpoint);

/// "theta2 j2.theta", or the one where both are the same.
std::string full_name(const Parameter& parameter);

/// How the robot's parameters are called, for a message: "theta2 or j2.theta".
std::string name_example(const Robot& robot);

/// What an effect that bears no load sees of a robot at `q`, with the file's own values: the poses
/// of its links, or the tool's alone where the kind has no model of them.
std::vector<Eigen::Isometry3d> seen_poses(const Robot& robot, const Eigen::VectorXd& q);

/// Index of the parameter called `name` (its name or FRAME.FIELD), or -1.
int find_parameter(const Robot& robot, std::string_view name);
/// Indices of all parameters whose name or FRAME.FIELD matches `pattern`, in which * stands for any
/// text.
std::vector<int> match_parameters(const Robot& robot, std::string_view pattern);

}  // namespace selfcal
