// What an identification answers with: parameters with their certainty, sets, figures, the verdict.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <string_view>
#include <vector>

#include "kinematics/parameter.h"

namespace selfcal {

enum class Status { identified, grouped, no_effect, held, fixed };
std::string_view to_string(Status status);

struct Carrier {
  std::string name;
  double coefficient = 0;
};

struct ParameterResult {
  Parameter parameter;
  double value = 0;
  double sigma = -1;  ///< marginal posterior; negative for held, fixed and no-effect
  Status status = Status::identified;
  std::vector<Carrier> grouped_with;
};

struct NuisanceResult {
  std::string name;
  double value = 0, sigma = 0;
};

/// Directions of the parameters that rows do not tell, for one reason.
struct Lost {
  int count = 0;
  std::string why;
  std::vector<std::string> parameters;  ///< that take part; empty where the reason says it
};

struct SetResult {
  std::string name, method;
  int rows = 0;  ///< `fit` rows that give an equation, or `check` rows when there are no others
  int used = 0;  ///< of them, not put aside
  bool identifies = false;         ///< has `fit` rows
  bool aligned = false;            ///< nuisance parameters fitted to `check` rows, robot held
  double noise_sigma = 0;          ///< m, one scalar residual; 0 when the method has no lengths
  double noise_angle_sigma = 0;    ///< rad; 0 when the method has no angles
  double repeat_sigma = -1;        ///< m, from immediate repeats alone; negative without
  double repeat_angle_sigma = -1;  ///< rad, the same
  bool unexplained = false;        ///< scatters more than its data sheet or its repeats say
  std::vector<NuisanceResult> nuisance;
};

struct Outlier {
  int row = 0;  ///< from 1
  std::string set;
  double residual = 0;  ///< m; infinite of a row that the robot cannot take
  bool check = false;
  std::string why;
  bool angle_alone = false;  ///< the residual is of angles (rad)
};

/// A lock that turned between two rows of its set, which are counted from 0.
struct LockSlip {
  std::string set, lock;  ///< lock: the joint, in words
  int before = 0, after = 0;
  double angle = 0;      ///< rad
  double statistic = 0;  ///< how clear it is (change_point.h)
};

/// Figures of the angles beside the residuals of rows (rad), of the rows that have any.
struct AngleFigures {
  int rows = 0;
  double rms_before = 0, rms_after = 0, mean_after = 0, max_after = 0;
};

/// Figures of row residuals: of the rows with lengths (m), or where every row has angles alone, of
/// these (rad). app/selfcal-data.5 says what the residual of a row is.
struct Figures {
  int rows = 0;
  bool angle_alone = false;
  double rms_before = 0, rms_after = 0, mean_after = 0, max_after = 0;
  double rms_without_outliers = 0;
  AngleFigures angle;
  int configurations = 0;  ///< of them; repeats of one count once
  /// Of those within the noise, as rms_without_outliers; 0 where there are none.
  int rows_without_outliers = 0;
  double rms_before_without_outliers = 0;
};

struct SetFigures {
  std::string name;
  bool aligned = false;
  Figures figures;
};

/// One row that judges, as a model meets it.
struct CheckRow {
  double residual = 0;       ///< m; rad of a row that has angles alone
  bool outlier = false;      ///< beyond the noise
  int configuration = 0;     ///< from 0 on; repeats have the same
  int set = 0;               ///< from 0
  bool aligned = false;      ///< unknowns of its set were fitted to rows that judge
  double angle = 0;          ///< rad
  double noise = 0;          ///< the most that noise alone makes of `residual`
  int row = 0;               ///< from 0; of the data set
  bool angle_alone = false;  ///< `residual` is one of angles
};

/// A row before (the maker's robot, placed) and after, for a person to look at.
struct RowFigure {
  int row = 0, set = 0;                          ///< from 0; of the data set
  bool check = false, outlier = false;           ///< judges; beyond the noise
  double before = 0, after = 0;                  ///< m; rad of a row that has angles alone
  double angle_before = 0, angle_after = 0;      ///< rad, of a row that has lengths and angles
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< of the method's body, world (m), after
  /// Shortest way from the body to where the row's lengths would be met, world (m); zero of a row
  /// without lengths.
  Eigen::Vector3d way_before = Eigen::Vector3d::Zero(), way_after = Eigen::Vector3d::Zero();
};

struct Residuals {
  Figures fit, check;
  /// Those that gave an equation, in the order of the data set; of more than 100 000 every so many.
  std::vector<RowFigure> rows;
  std::vector<CheckRow> check_rows;  ///< after, in the order of the data set's
  std::vector<SetFigures> check_by_set;
};

/// The frame of a set's positions moved against the robot's base between two of its rows.
struct FrameStep {
  std::string set;
  int before = 0, after = 0;  ///< rows, from 0
  double shift = 0;           ///< m, in the middle of the rows
  double turn = 0;            ///< rad
  double share = 0;           ///< of the squares that calibration leaves, explained by it
};

enum class Answer { improved, not_improved, not_determined };
std::string_view to_string(Answer answer);

struct Verdict {
  Answer answer = Answer::not_determined;
  std::string why;
  double p_value = 1;  ///< of the paired test on the check rows; 1 without check rows
};

/// 1 sigma of where the endpoint is, over some poses.
struct EndpointSigma {
  bool aligned = false;  ///< a motion of the world or the target's point is taken out
  double rms = 0, median = 0, max = 0;  ///< m
  double angle = 0;                     ///< rad, rms of how it is turned
  int poses = 0;  ///< 0 where nothing was identified or no pose was found: not known
  std::vector<double> by_pose = {};  ///< m, in the order of the poses
};

/// Poses below which an rms over them says little: of 20 it is uncertain by a sixth of itself.
inline constexpr int kFewestPoses = 20;

/// The end position is known, to the target (m).
inline bool known_to(const EndpointSigma& sigma, double target) {
  return sigma.poses >= kFewestPoses && sigma.rms <= target;
}

/// A length that the entry of a set gives and that the robot's scale stands on (m).
struct ScaleLength {
  std::string set, what;        ///< what: in words, "distance from table"
  double value = 0, sigma = 0;  ///< as given
  double share = 0;             ///< relative change of the robot's lengths with it over its own
  double moves = 0;             ///< end position for one of it (rms over the poses)
  /// What the maker's lengths and the rows make of it where none of these lengths is given.
  double expected = 0, expected_sigma = 0;
  double unseen = 0;  ///< an error of it alone smaller than this would rather not be noticed
  /// The same where the others are given; the sigma is negative where there are none.
  double by_others = 0, by_others_sigma = -1;
  bool odd = false;  ///< contradicts what the others make of it, more than any other one
};

/// What gives the robot's scale, and whether the maker's lengths agree.
struct RobotScale {
  std::vector<ScaleLength> stands_on;
  double excess = 0, excess_sigma = 0;      ///< of these lengths over what is expected, relative
  bool against_maker = false;               ///< the excess is beyond the tolerances
  std::vector<std::string> contradictions;  ///< in words
};

/// Sources of doubt: what the rows' noise makes, and what halves of the rows differ by beyond that,
/// which no geometry explains: halves in time, and of the configurations, whose laws the geometry
/// imitates.
inline constexpr std::string_view kNoiseOfRows = "noise of the rows";
inline constexpr std::string_view kSharedErrors = "rows that share errors";
inline constexpr std::string_view kImitatedLaws = "laws that the geometry imitates";
inline constexpr std::string_view kWhatWasGiven = "what was given";

/// A part of the end position's doubt in the workspace, 1 sigma (m); the squares add up.
struct BudgetLine {
  std::string source;
  double sigma = 0;
};

/// What is left of the rows beyond the spread of their immediate repeats, over that spread.
struct LackOfFit {
  double F = 0, p_value = -1;  ///< p negative without repeats
  double freedoms = 0, repeat_freedoms = 0;
};

/// Whether what is left of the lengths looks like independent normal noise.
struct ResidualTests {
  int count = 0;
  double skewness = 0, kurtosis = 0;  ///< 0 and 3 of normal noise
  double normality_p = -1, autocorrelation = 0, autocorrelation_p = -1;  ///< p negative: too few
};

struct Correlation {
  std::string a, b;
  double value = 0;
};

/// Of poses that were measured repeatedly, after; the worst pose (m).
struct PoseRepeats {
  int poses = 0;
  double accuracy = 0, repeatability = 0;
};

/// A part of the workspace.
struct GridCell {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< m, world, of its poses
  double sigma = 0;                                  ///< m
  double bias = -1;  ///< m, length of the mean residual of the rows there; else what is expected
  int poses = 0, rows = 0;
};

/// How good the result is, as metrology says it.
struct Uncertainty {
  double freedoms = 0;
  double k = 0;         ///< coverage factor of 95 % (Student)
  double expanded = 0;  ///< m, k times the end position's sigma in the workspace
  std::vector<BudgetLine> budget;
  LackOfFit lack_of_fit;
  ResidualTests residuals;
  std::vector<Correlation> correlations;  ///< of the robot's parameters, beyond 0.9
  PoseRepeats repeats;
  std::vector<GridCell> grid;
};

struct Observability {
  double condition = 0, o1 = 0, o2 = 0, o3 = 0, o4 = 0, o5 = 0;
};

struct Note {
  std::string parameter, text;
  std::string joint = {};  ///< whose further movement would help, where one's would
};

struct Solution {
  bool converged = false;
  std::string stop_reason;
  int iterations = 0;
  Verdict verdict;
  std::vector<ParameterResult> parameters;
  std::vector<std::string> covariance_order;
  Eigen::MatrixXd covariance;
  std::vector<Note> gauge, unexcited;
  std::vector<SetResult> sets;  ///< empty when no row identifies
  std::vector<Outlier> outliers;
  Residuals residual;
  EndpointSigma endpoint;   ///< over all that the joints can do
  EndpointSigma workspace;  ///< over where it counts: the verdict's
  double strays = 0;        ///< m, in each direction, from any geometry, beside that; 0: not seen
  bool orientation_seen = false;  ///< rows tell how the endpoint is turned
  RobotScale scale;
  Uncertainty uncertainty;  ///< without budget where nothing was identified
  double prior_chi2 = 0;
  double prior_dof = 0;
  double prior_widening = 1;
  Observability observability;
  std::vector<FrameStep> frame_steps;       ///< of sets of positions, the largest of each
  std::vector<LockSlip> slips;              ///< of locked joints, in the order of the rows
  std::vector<std::string> locks_left_out;  ///< sets of which nothing was used, for their slips
  std::vector<std::string> warnings;
  Eigen::VectorXd values;  ///< of every parameter, in the robot's order
};

}  // namespace selfcal
