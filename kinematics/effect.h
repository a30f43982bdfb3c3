// A non-geometric effect: what the geometry of a robot leaves out.
//
// It adds to the joint variables and to the location of the tip,
//   joint variables += A v,   location of the tip += B v   (twist in the world frame, at the tip)
// where v are the effect's own parameters and A, B (its regressor) follow from the conditions of
// a configuration: load, direction of motion, temperature, time, touched surface. What is not
// linear (a moment, a wave number, a time constant) is the effect's shape, given and not estimated
// by the identification. A and B are taken at the geometry of the file: the difference is of second
// order in errors that are small, and derivatives stay exact.
#pragma once

#include <Eigen/Dense>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinematics/description.h"
#include "kinematics/mechanics.h"

namespace selfcal {

class Robot;

/// What an effect says its regressor of: one configuration and what held when its row was taken.
/// What is not known is NaN.
struct RegressorInput {
  const Mechanics* mechanics = nullptr;  ///< null of a robot without statics
  Eigen::VectorXd q;                     ///< readings (rad or m)
  /// Of the links, world, as the file has them; of a robot without statics the tool's alone.
  std::vector<Eigen::Isometry3d> poses;
  Load wrench;  ///< on the tool, world axes, at the tip; zero when not known
  Eigen::Vector3d gravity{0, 0, -9.81};  ///< m/s^2, world
  /// By joint, of gravity and wrench (N m, N); of a machine that is no chain only where an effect
  /// asks (Effect::of_torques).
  Eigen::VectorXd torque;
  Eigen::VectorXd velocity;           ///< of the readings, by joint, just before (rad/s, m/s)
  Eigen::VectorXd variable_velocity;  ///< of the joint variables, the same
  double temperature = 0, time = 0;   ///< C, s
  Eigen::Vector3d normal;             ///< outward, of the touched surface, world, unit
  int set = -1;                       ///< of the data set; -1 outside one
  /// How the tip moves per length of each leg, 6 x joints (m/m, rad/m; world axes), and the legs'
  /// lengths (m), with the file's own values. Only where an effect asks (Effect::of_legs); zero
  /// where the loops do not close.
  Eigen::MatrixXd legs;
  Eigen::VectorXd leg_lengths;
  Eigen::VectorXd leg_weights;  ///< pull of all that the file says weighs, along each leg (N)
};

/// d(joint variables) and d(location of the tip) to each of the effect's parameters.
struct Regressor {
  Eigen::MatrixXd joints;  ///< joints x parameters
  Eigen::MatrixXd tip;     ///< 6 x parameters: shift (m), then rotation vector, world
};

/// One surface or target of a data set, as far as effects at it ask.
struct MeasuredSet {
  std::string name;
  TouchedSurface touch = TouchedSurface::none;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of its rows (m)
  /// Of a flat surface, outward, by its rows; zero when not known.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  bool lengths = false;       ///< an instrument measured positions or lengths
  bool without_rows = false;  ///< it has none here, so that nothing is known of it
  Eigen::Vector3d device = Eigen::Vector3d::Zero();  ///< origin of the lengths (m, world)
};

/// T0 where neither an entry nor a record says one (C).
inline constexpr double kRoomTemperature = 20;

/// Where and when the rows of a data set were taken; empty for a robot outside one.
struct MeasurementContext {
  std::vector<MeasuredSet> sets;
  std::vector<double> times, temperatures;  ///< s ascending, C: the record of the thermometer
  double begin = 0, end = 0;                ///< s, of the rows
  bool loads = false;                       ///< rows carry wrenches
  bool velocities = false, speeds = false;  ///< rows carry dq; and it is more than a sign
  /// C, T0 where an entry gives none: the mean of the record, or what a simulated robot starts at.
  std::optional<double> reference = {};

  int find(std::string_view set) const;  ///< -1 when there is none
  bool touched() const;                  ///< a surface, in some set
};

struct EffectParameter {
  std::string name;  ///< within its place: "c"
  std::string unit;
  /// Of its magnitude; an effect gives lengths for a machine of 1.5 m (size_of), and has them in
  /// proportion to its own robot.
  double usual_least = 0, usual_most = 0;
  bool positive = false;  ///< physics allows no other sign
  double value = 0;
};

class Effect {
 public:
  virtual ~Effect() = default;

  std::string_view name() const { return name_; }
  /// A joint's frame, a set, "probe", "base"; empty for the whole robot.
  const std::string& at() const { return at_; }
  const std::vector<EffectParameter>& parameters() const { return parameters_; }
  /// Of a robot that a diagnosis corrected: it was named, or only found beside what was. Nothing
  /// where its entry does not say.
  const std::optional<bool>& named() const { return named_; }
  /// The entry that it was made from.
  const Node& entry() const { return entry_; }
  /// The entry of a robot file with parameters `v`; where they are beyond what any machine has, it
  /// says that they are meant.
  Node describe(const Eigen::VectorXd& v) const;
  /// True when the robot itself deviates, false when only its measurement does.
  virtual bool of_machine() const { return true; }
  /// Asks for RegressorInput::legs.
  virtual bool of_legs() const { return false; }
  /// Asks for RegressorInput::torque.
  virtual bool of_torques() const { return false; }
  /// What rows must have so that it can be seen: "temperatures that change".
  virtual std::string needs() const = 0;
  /// `into` is zero and of the right size.
  virtual void regressor(const RegressorInput& at, Regressor& into) const = 0;

 protected:
  friend std::unique_ptr<Effect> make_effect(const Node&, const Robot&, const MeasurementContext&,
                                             Problems&);
  /// What describe() adds beside effect, at, named and the parameters. What neither the entry nor
  /// the rows say is left out: other rows may.
  virtual void describe_shape(Node&) const {}

  std::string at_;
  std::vector<EffectParameter> parameters_;

 private:
  std::string name_;
  std::optional<bool> named_;
  Node entry_;
};

/// Why an effect of load or of links says nothing of a robot without either.
inline constexpr std::string_view kNoStatics = "this kind of robot has no statics model";
/// Why an effect of load says nothing of a robot that can have masses, and whose file has none.
inline constexpr std::string_view kNoMasses =
    "the robot's file gives no `masses:` of what it carries";
/// Why an effect of legs says nothing of other robots.
inline constexpr std::string_view kNoLegs = "no legs carry this kind of robot";

/// What an effect is made from.
struct EffectPlan {
  Fields& fields;
  const Robot& robot;
  const MeasurementContext& context;
  std::string& place;  ///< where it acts: `at` of the entry, empty where it says nothing

  /// Index of the joint called `at`; notes a problem and gives 0 otherwise.
  int joint() const;
  /// Legs carry the robot. Notes a problem otherwise.
  bool legs() const;
  /// The same of a robot with legs; without them it notes a problem and gives -1.
  int leg() const;
  /// Index of the set called `at`; -1 outside a data set. Notes a problem when the context lacks
  /// it.
  int set() const;
  /// Masses and links, for an effect that cannot do without; null of a robot that has none,
  /// after noting a problem: the effect is not made.
  const Mechanics* mechanics() const;
  /// What loads the joints is known: a chain's links, or what the file says weighs. Notes a problem
  /// otherwise.
  bool torques() const;
  /// T0 of what warms (C): `reference` of the entry, else the context's; nothing without both.
  std::optional<double> reference() const;
  /// Notes a problem unless `at` is `only`, or missing: then it is `only`.
  void expect_place(std::string_view only) const;
};

/// None is there twice.
bool all_differ(std::vector<double> numbers);

/// The effect that an entry of a robot file's `effects` describes:
/// {effect: joint_compliance, at: j2, c: 2.1e-6}. Null after a problem.
std::unique_ptr<Effect> make_effect(const Node& node, const Robot& robot,
                                    const MeasurementContext& context, Problems& problems);
/// The effects that make_effect knows.
std::vector<std::string_view> effect_names();

/// Whether an effect is with a robot from one session to the next.
enum class EffectLasting {
  kept,           ///< the robot keeps it, and its model can have it
  apart,          ///< it stays, where the robot's model has no place for it
  moves,          ///< something comes to be elsewhere: what was is no more
  moved_at_will,  ///< the same, as far as a person may have put it
};
/// Of an effect by its name; `apart` of a name that is none.
EffectLasting lasting_of(std::string_view effect);

}  // namespace selfcal
