// The identification: which parameters, from which rows, with what certainty.
//
// Minimises, over the free parameters xi and the sets' own unknowns,
//   sum over rows of rho(|r / sigma_set|) + sum over xi of ((xi - nominal) / tolerance)^2
// by Gauss-Newton steps on R of a streamed QR of W (11.31, 11.32), with Levenberg-Marquardt damping
// behind it when a step fails. The estimate is the mean of the posterior: a direction that the rows
// do not determine stays where the prior puts it.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "constraints/data_set.h"
#include "constraints/progress.h"
#include "kinematics/robot.h"

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

struct OwnResult {
  std::string name;
  double value = 0, sigma = 0;
};

struct SetResult {
  std::string name, method;
  int rows = 0;  ///< `fit` rows that give an equation, or `check` rows when there are no others
  int used = 0;  ///< of them, not put aside
  bool identifies = false;       ///< has `fit` rows
  bool aligned = false;          ///< own unknowns fitted to `check` rows, robot held
  double noise_sigma = 0;        ///< m, one scalar residual
  double noise_angle_sigma = 0;  ///< rad; 0 when the method has no angles
  double repeat_sigma = -1;      ///< m, from immediate repeats alone; negative without
  std::vector<OwnResult> own;
};

struct Rejected {
  int row = 0;  ///< from 1
  std::string set;
  double residual = 0;  ///< m; infinite of a row that the robot cannot take
  bool check = false;
  std::string why;
};

/// Figures of the angles beside the residuals of rows (rad), of the rows that have any.
struct AngleFigures {
  int rows = 0;
  double rms_before = 0, rms_after = 0, mean_after = 0, max_after = 0;
};

/// Figures of row residuals (m; app/selfcal-data.5 says what the residual of a row is).
struct Figures {
  int rows = 0;
  double rms_before = 0, rms_after = 0, mean_after = 0, max_after = 0;
  double rms_without_rejected = 0;
  AngleFigures angle;
};

struct SetFigures {
  std::string name;
  bool aligned = false;
  Figures figures;
};

/// One row that judges.
struct CheckRow {
  double residual = 0;    ///< m, after
  bool rejected = false;  ///< beyond the noise
};

struct Residuals {
  Figures fit, check;
  std::vector<CheckRow> check_rows;  ///< in the order of the data set's
  std::vector<SetFigures> check_by_set;
};

enum class Answer { improved, not_improved, not_determined };
std::string_view to_string(Answer answer);

struct Verdict {
  Answer answer = Answer::not_determined;
  std::string why;
  double p_value = 1;  ///< of the paired test on the check rows; 1 without check rows
};

struct EndpointSigma {
  bool aligned = false;
  double rms = 0, median = 0, max = 0;  ///< m
  int poses = 0;                        ///< 0 where nothing was identified: not known
};

/// A length that the entry of a set gives and that the robot's scale stands on (m).
struct ScaleLength {
  std::string set, what;        ///< what: in words, "distance from table"
  double value = 0, sigma = 0;  ///< as given
  double share = 0;             ///< relative change of the robot's lengths with it over its own
  double moves = 0;             ///< end position for one of it (rms over the poses)
  /// What the maker's lengths and the rows make of it where none of these lengths is given.
  double expected = 0, expected_sigma = 0;
  double unseen = 0;  ///< an error smaller than this would rather not be noticed
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

struct Observability {
  double condition = 0, o1 = 0, o2 = 0, o3 = 0, o4 = 0, o5 = 0;
};

struct Note {
  std::string parameter, text;
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
  std::vector<Rejected> rejected;
  Residuals residual;
  EndpointSigma endpoint;
  RobotScale scale;
  double prior_chi2 = 0;
  double prior_dof = 0;
  double prior_widening = 1;
  Observability observability;
  std::vector<std::string> warnings;
  Eigen::VectorXd values;  ///< of every parameter, in the robot's order
};

struct Options {
  std::vector<std::string> fix;   ///< names or patterns held at the model's value
  std::vector<std::string> free;  ///< names or patterns freed (gear ratios)
  bool gears = false;             ///< every transmission ratio is free, whatever it is called
  bool priors = true;  ///< false: the rows alone (tests); needs every direction determined
  double most_rejected =
      0.05;  ///< share of a set's rows that may be put aside, and 2 sigma of it, 0 to 0.5
  int most_iterations = 200;  ///< 1 to 1000
  /// 1 sigma of each of the effects' parameters; empty: what the robot says of them.
  std::vector<double> effect_sigma = {};
  unsigned long long seed = 1;  ///< of the poses at which the endpoint is judged
};

/// Identifies. `data` must fit `robot` (as io's reader makes sure); names in `options` must exist.
Solution identify(const Robot& robot, const DataSet& data, const Options& options = {},
                  const Progress& progress = {});

}  // namespace selfcal
