// The Hexa Slide of Rauf, Kim and Ryu with the constraint link: nominal sets, what the device
// reads, and which postures are measured.
#pragma once

#include <memory>
#include <vector>

#include "constraints/planning/design.h"
#include "kinematics/robot.h"
#include "tests/recovery/session.h"

namespace selfcal::recovery {

/// Of the 54 errors of a nominal set: the largest, the mean of their sizes, their root mean square
/// (m). Table 2.
struct NominalErrors {
  double most, mean, sigma;
};
inline constexpr NominalErrors kNone{0, 0, 0},
    kTable2[] = {{1.8e-3, 0.8e-3, 0.87e-3}, {2.8e-3, 1.33e-3, 1.45e-3}, {9.2e-3, 4.99e-3, 5.28e-3}};

/// Errors of either sign that have these statistics: one is the largest, the sizes of the others
/// are of a beta distribution, drawn until both means are within two per cent.
std::vector<double> drawn_errors(const NominalErrors& wanted, Random& random);

/// A Hexa Slide whose parameters are off Table 1.
std::unique_ptr<Robot> slider(const NominalErrors& off, Random& random);

/// What the device reads at `count` postures drawn at random; `sigma` is said of its angles and of
/// the carriages' readings.
DataSet device_rows(int count, double sigma, Random& random);

/// The expected error of the end position in the range of the postures, which is what shall become
/// small.
Objective by_end_position(const Robot& nominal, Random& random);

struct Choice {
  std::vector<int> rows;
  double expected = 0;  ///< m, sigma of the end position in the range of the postures
};

enum class ChosenBy { chance, condition, end_position };

/// `count` of the rows: any, the best together by the condition number, or from there on by what
/// `end_position` expects of them.
Choice best_rows(const Robot& nominal, const DataSet& pool, int count, ChosenBy by,
                 const Objective& end_position, Random& random);

/// Uniform noise of up to `noise` m and rad on readings and angles.
void add_noise(double noise, Random& random, Observations& rows);

struct PostureError {
  double position = 0, turn = 0;  ///< means (m, rad)
};

/// Of 50 postures drawn at random.
PostureError posture_error(const Robot& exact, const Eigen::VectorXd& xi);

}  // namespace selfcal::recovery
