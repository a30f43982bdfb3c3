// Rows that scatter the more, the faster the tool moves, or the nearer it is to one end of the
// cell, or that are one in every so many of the file. No structure shows that, for their errors
// have nothing in common but their size: time stamps that jitter, a beam that bends, a part that
// shakes, a counter of several that is read wrongly.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string>

#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"

namespace selfcal {

struct UnevenNoise {
  std::string where;  ///< "where the tool moves fast" and the like
  std::string than;   ///< "at the other end", "all others"
  double times = 1;   ///< rms of the third of the configurations there, over that of the other end
  double p = 1;       ///< that noise which is even shows as much, of all that was asked
};

/// What the squares of rows (averaged over a configuration) go along with, by their ranks; one
/// thing at a time. `squares`: by configuration; `along`: configurations x 1 of a rank correlation
/// that is above zero, configurations x 3 of any direction. The probability that chance shows as
/// much.
double probability_of_even(const Eigen::VectorXd& squares, const Eigen::MatrixXd& along);

/// Of the rows that identify, with the best explanation; nothing where they are even or too few.
std::optional<UnevenNoise> uneven_noise(const LinearisedModel& linearised, const DataSet& data);

/// "the rows scatter 2.1 times as much where the tool moves fast (even noise does so in 3e-06 of
/// cases)".
std::string uneven_in_words(const UnevenNoise& uneven);

/// Where nothing is named and the noise is plainly uneven, the verdict becomes `unknown` and says
/// so.
void doubt_even_noise(const LinearisedModel& linearised, const DataSet& data, Diagnosis& diagnosis);

/// Uneven noise beside a cause that is named; empty where there is none.
std::string warning_of_uneven_noise(const LinearisedModel& linearised, const DataSet& data,
                                    const Diagnosis& diagnosis);

}  // namespace selfcal
