// What one kind of measurement says: the residual of a row, its derivative to the endpoint's
// location, the unknowns it brings along and what it can never see.
//
// A method never touches Psi. It gives r and G = dr/dX for each row; the equations multiply G by
// Psi (chain rule) to get rows of W, Delta Y = -r. So one method serves every kind of robot.
#pragma once

#include <Eigen/Dense>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "constraints/methods/observations.h"
#include "kinematics/robot.h"

namespace selfcal {

using Random = std::mt19937_64;

/// Most scalar equations that one row of any method gives (the calibration index of 11.5).
inline constexpr int kMostEquations = 18;

/// Markers of circle points: fewer do not tell how a body is turned.
inline constexpr int kFewestMarkers = 3, kMostMarkers = kMostEquations / 3;

/// Name of the column with a coordinate (0 to 2) of a marker (from 0) of circle points: "m1x".
std::string marker_column(int marker, int coordinate);

/// The plane n . P = d.
struct Plane {
  Eigen::Vector3d n = Eigen::Vector3d::UnitZ();  ///< unit
  std::optional<double> d = {};                  ///< m; nothing where only the direction is known
};

/// What a session's plan can do for a method: touch a surface, sit in sockets or nests, visit what
/// a lock allows, or nothing.
enum class Planned { no, surface, places, lock };

/// Rows of one set to be evaluated together, one a lane.
struct MethodInput {
  int count = 0;
  const Observations* data = nullptr;
  const int* rows = nullptr;          ///< row index per lane
  const Locations* now = nullptr;     ///< of the method's body
  const Locations* before = nullptr;  ///< of the previous row of the group; paired methods only
  const Eigen::VectorXd* nuisance = nullptr;   ///< the set's own values
  const Eigen::VectorXd* reference = nullptr;  ///< own values of the set referred to, if any
  const Eigen::MatrixXd* groups = nullptr;     ///< group values, one column per group of the set
};

/// Residuals and derivatives, lane by lane; sized by the equations, zero before evaluate.
struct MethodOutput {
  using Block = Eigen::ArrayXXd;
  Block r;            ///< column a is equation a
  Block G_now;        ///< column 6 a + c is dr_a / d(component c of the location)
  Block G_before;     ///< the same for the previous row
  Block D_own;        ///< column a m + k, m the own freedom
  Block D_reference;  ///< column a m + k, m the own freedom of the set referred to
  Block D_group;      ///< column a g + k, g the group freedom

  void clear(int lane);  ///< sets all of a lane to zero
  /// Makes room and sets everything to zero.
  void resize(int equations, int nuisance, int reference, int group);
};

/// One equation between nuisance parameters that no row carries (a known step between planes).
struct OwnEquation {
  double residual = 0, sigma = 1;
  Eigen::VectorXd D_own, D_reference;
};

/// One equation between two groups of a set (a known distance between two sockets).
struct GroupDistance {
  int a = 0, b = 0;
  double distance = 0, noise = 0;
  int known = 0;  ///< its place among the known lengths
};

/// A length that the entry of a set gives: it may be what the scale of the robot stands on.
struct KnownLength {
  std::string what;     ///< in words, after the set's name ("distance from table")
  double value = 0;     ///< m
  double sigma = 0;     ///< m, as stated; 0 where it is taken as exact
  bool by_row = false;  ///< the residual of every row falls with it, by as much; otherwise the
                        ///< residual of the own equation or link of its place in their list does
};

/// A number that a method reports of its nuisance parameters: name without the set's ("nx"), value,
/// and its gradient to the own freedoms and to those of the set referred to.
struct NuisanceReport {
  std::string name;
  double value = 0;
  Eigen::VectorXd D_own, D_reference;
  bool derived = false;  ///< follows from the others reported
};

/// A column of one measured number a row that a method brings along: the file's reader, its writer
/// and the simulation know it from here.
struct MeasuredColumn {
  std::string name;
  Quantity quantity = Quantity::length;
  bool never_negative = false;
};

/// One constraint method with the options of one set. Immutable. "Values" describe an unknown fully
/// (a plane's unit normal and distance), its "freedom" is the number of independent changes.
class Method {
 public:
  virtual ~Method() = default;

  virtual std::string_view name() const = 0;
  /// Quantity of each scalar equation of a row (length or angle); their count is the calibration
  /// index.
  virtual std::vector<Quantity> equations() const = 0;
  /// Columns of the data set that every row needs, of those that every data set may have ("x",
  /// "qw", "nx", "group").
  virtual std::vector<std::string> columns() const { return {}; }
  /// The columns that the method brings along, which every row needs as well; of a paired method
  /// they may be empty in the first row of a group.
  virtual std::vector<MeasuredColumn> measures() const { return {}; }
  /// True when each row is compared with the previous row of its group.
  virtual bool paired() const { return false; }
  /// True when successive rows of a group share a touch, and so its noise.
  virtual bool shares_touches() const { return false; }
  /// The gauge: true when the rows may be satisfied by a robot of any size (touches: what is
  /// touched shrinks with it). Whether they are, by what is known of it, held_scale judges from all
  /// rows.
  virtual bool may_leave_scale_free() const { return false; }
  /// True when rows are measured in the frame of a device whose pose is a nuisance parameter, or
  /// from a point that is: the base is not seen then.
  virtual bool frame_unknown() const { return false; }
  /// Where the device stands from which lengths are measured (m, world): with `frame_unknown` it
  /// follows from the own values.
  virtual Eigen::Vector3d device(const Eigen::VectorXd& nuisance) const;
  /// True when the target point is an unknown of the set, in place of the tool frames.
  virtual bool point_unknown() const { return false; }
  /// True when every three equations are a vector in the world's axes of which only the length
  /// matters. The equations take it in axes that turn with the world (see README.md).
  virtual bool vectors() const { return false; }
  /// True when a row holds only at certain configurations (a touch); false for an instrument's
  /// reading, which any configuration has.
  virtual bool constrains() const { return true; }
  /// Name of the only joint that moves between the rows of a group; empty of methods that let all
  /// move.
  virtual std::string turning_joint() const { return {}; }
  /// True when one of the equations is of a length, or of an angle, which has a noise of its own.
  bool has_lengths() const;
  bool has_angles() const;
  /// True when no unknown of its own, point or touch ties one row to another.
  bool every_row_alone() const;
  /// True when a row tells how the endpoint is turned, beside where it is.
  virtual bool sees_orientation() const { return has_angles(); }
  /// True when a row tells where the endpoint is.
  virtual bool sees_point() const { return !point_unknown(); }
  virtual Body body() const { return point_unknown() ? Body::last_link : Body::endpoint; }

  virtual Planned planned() const { return Planned::no; }
  /// The joint that is locked, as the robot is asked for it ("leg 1 universal"); empty for none.
  virtual std::string lock() const { return {}; }
  /// True when where the touched surface lies, or how it is turned, is given.
  virtual bool place_known() const { return false; }
  /// What the tool touches; instruments, sockets and nests have no surface.
  virtual TouchedSurface touches() const { return TouchedSurface::none; }
  /// The touched plane; nothing of other methods.
  virtual std::optional<Plane> plane(const Eigen::VectorXd& nuisance,
                                     const Eigen::VectorXd* reference) const;
  /// Own values of the plane as the method keeps them, n perhaps turned; empty of methods that
  /// touch none and of those that refer to another set.
  virtual Eigen::VectorXd nuisance_of(const Plane& plane) const;

  /// Name of another set whose nuisance parameters this one shares, or empty.
  virtual std::string reference() const { return {}; }
  /// True when it can share the nuisance parameters of `other`.
  virtual bool can_refer_to(const Method& other) const;

  virtual int tangent_dimension() const { return 0; }
  /// What freedom `i` of the tangent changes: a length, an angle or a ratio.
  virtual Quantity tangent_quantity(int) const { return Quantity::length; }
  /// Own values that fit locations X (of body()) of the rows best, as a start. Behind those of the
  /// rows X has those of sets that refer to this one, moved so that their mean is the rows'.
  virtual Eigen::VectorXd start(const std::vector<Location>& X, const std::vector<int>& rows,
                                const Observations& data, const Eigen::VectorXd* reference,
                                const Location& tool) const;
  /// Own values for a robot that may stand farther from what is touched than this is large: where a
  /// fit of these ends, that of `nuisance` sets out.
  virtual Eigen::VectorXd from_afar(const Eigen::VectorXd& nuisance) const { return nuisance; }
  virtual void retract(Eigen::VectorXd& nuisance, const Eigen::VectorXd& step) const;
  virtual std::vector<NuisanceReport> report(const Eigen::VectorXd& nuisance,
                                             const Eigen::VectorXd* reference) const;
  virtual std::vector<OwnEquation> own_equations(const Eigen::VectorXd& nuisance,
                                                 const Eigen::VectorXd* reference) const;

  virtual int group_freedom() const { return 0; }
  virtual Eigen::VectorXd start_group(const std::vector<Location>& X) const;
  virtual void retract_group(Eigen::Ref<Eigen::VectorXd> group, const Eigen::VectorXd& step) const;
  /// Names, without set and group ("x"), of the group values that are reported: the first ones,
  /// each moved by the freedom of its own place.
  virtual std::vector<std::string> group_names() const { return {}; }
  virtual std::vector<GroupDistance> links() const { return {}; }
  virtual std::vector<KnownLength> known_lengths() const { return {}; }
  /// Residual of a link and its derivatives to the two groups' freedoms.
  virtual double link_residual(const GroupDistance& link, const Eigen::VectorXd& a,
                               const Eigen::VectorXd& b, Eigen::VectorXd& D_a,
                               Eigen::VectorXd& D_b) const;

  /// Residuals and derivatives of `in.count` rows.
  virtual void evaluate(const MethodInput& in, MethodOutput& out) const = 0;

  /// Simulation: own values of a random instance of the constraint that location X satisfies
  /// (of a plane parallel to the reference: the one at the known distance from it).
  virtual Eigen::VectorXd through(const Location& X, const Eigen::VectorXd* reference,
                                  Random& random) const;
  /// Simulation: writes what a row knows before it is reached (the outward normal of a touch).
  virtual void approach(const Eigen::VectorXd& nuisance, const Eigen::VectorXd* reference,
                        Observations& data, int row) const;
  /// Simulation: writes what a perfect instrument reads at X (and `before`) into row `row`.
  virtual void measure(const Location& X, const Location& before, const Eigen::VectorXd& nuisance,
                       Observations& data, int row) const;
};

}  // namespace selfcal
