// Part of constants.h: what a diagnosis takes for granted where it says what it found. Sources as
// there.
#pragma once

#include <cstddef>

namespace selfcal {

/// What a person is told.
struct ReportConstants {
  int regions = 6, times = 6;  ///< 2 to 20 [habit]
  /// Over the noise, of all effects of the joints together, that share what is left; 1 to 10
  /// [trials]
  double of_joints = 2;
  std::size_t most_look_alikes = 3;  ///< that a sentence names; 1 to 10 [habit]
  double sigmas = 2;                 ///< by which a value is beyond a limit; 1 to 3 [habit]
  /// Share beyond the nuisance parameters below which nothing can be said; 1e-3 to 0.1 [trials]
  double least_beyond_nuisance = 0.02;
  /// Of the usual largest, by two sigma: what is larger is no usual cause; 2 to 10 [physics]
  double far_beyond = 3;
  double beside = 0.5;  ///< least probability that is told beside the unknown [habit]
  /// Over what is left with the named causes alone: everything found is worse; 1.02 to 1.2
  /// [habit]
  double rest_worse = 1.05;
  double gear_sigmas = 3;  ///< of a ratio that is told; 2 to 5 [habit]
  /// Of the squares of a gear's waves about their mean, that a line explains: the unit of a reading
  /// that is off makes such; 0.8 to 0.98 [habit]
  double straight = 0.9;
  /// Of the usual largest: beyond it by two sigma is no machine. A tool or a fixture that is
  /// exchanged may be moved as far as one likes; 10 to 100 [physics]
  double impossible = 20;
  /// The same of what is moved at will: it is no longer the same thing; 50 to 300 [physics]
  double elsewhere = 100;
  /// Of the usual smallest compliance: stiffer by two sigma is no machine; 5 to 50 [physics]
  double too_stiff = 10;
  double other_sign = 3;  ///< sigmas beyond zero that no spring has; 2 to 5 [habit]
  /// Of the usual largest drift: a step may be taken for one; 2 to 10 [physics]
  double too_far = 3;
  /// Of the squares that a moved instrument leaves: named effects that leave less tell it better;
  /// 0.5 to 1 [habit]
  double better_than_moved = 0.8;
  /// 1 sigma of a gear's ratio that a file may have wrongly, where a cause would be named that is
  /// far beyond its usual size; 0.003 to 0.1 [physics]
  double wrong_ratio = 0.03;
  /// Of a gear's error, in what the rows move its joint by: of fewer whatever grows along it
  /// looks like one; 0.5 to 1.5 [physics]
  double fewest_waves = 0.75;
  /// Rows put aside, at least, that may have something in common, and the probability by which
  /// they do by chance; 3 to 8, 1e-4 to 0.01 [habit]
  int fewest_alike = 4;
  double alike_by_chance = 1e-3;
  double beyond_sheet = 10;  ///< of the data sheet's noise; 3 to 30 [physics]
  /// Of the noise: repeats that show so much confirm it; 0.1 to 1 [habit]
  double confirmed = 0.3;
  /// Where nothing is found in rows that scatter more than their files state: how wrong a stated
  /// noise is, in its logarithm (1 sigma, of a Student variable of five freedoms); how probable
  /// it is, over none, that something unknown scatters them; log evidence of repeats by which it
  /// is noise all the same; 0.1 to 0.4, 0.03 to 0.3, 1 to 5 [physics]
  double sheet_is_off = 0.15, scattered = 0.1, surely_confirmed = 2.3;
  /// Of what scatters them, over the noise, any size between as probable; 0.1 to 0.5, 4 to 64
  /// [physics]
  double least_scattered = 0.25, most_scattered = 16;
  double gravity_off = 0.1;   ///< m/s^2, from the usual; 0.05 to 0.5 [physics]
  double worth_a_word = 1.3;  ///< of the stated noise; 1.1 to 2 [habit]
  /// Of what noise and the geometry's own doubt explain: rows kept aside that are left so much
  /// farther, and hardly by chance, are no noise, if they give as many equations as told; 1.4 to
  /// 2, 0.001 to 0.05, 5 to 30 [trials]; so many of them are asked, 100 to 1000 [cost]
  double beyond_noise = 1.6, beyond_noise_by_chance = 0.01;
  int fewest_beyond_noise = 10;
  std::size_t most_beyond_noise = 300;
  double few_false = 0.2;  ///< of the rows kept aside, may be false readings; 0.1 to 0.4 [habit]
  /// Of what calibration leaves is still there: little gain; 0.5 to 0.95 [habit]
  double hardly_closes = 0.8;
  /// Of the gap, that what is named closes at most by 95 %: nothing is named; 0.1 to 0.4 [habit]
  double closes_little = 0.3;
  /// Of what is left with the forces: less without them is a slip; 0.8 to 1 [habit]
  double forces_cost = 0.97;
  double withdrawn = 0.95;  ///< probability of `unknown` that is left then; 0.5 to 1 [habit]
  /// The same where what is named closes nothing: as often it is there, and small; 0.5 to 0.95
  /// [trials]
  double withdrawn_idle = 0.6;
  double worth = 0.02;     ///< of probability that a step must bring; 0 to 0.2 [habit]
  double most_times = 10;  ///< as many rows as a step has, that anybody takes; 2 to 50 [habit]
  std::size_t most_steps = 3, most_for_unknown = 4;  ///< 1 to 10 [habit]
  /// Least probable cause that may yet be there where none is named; 0.01 to 0.3 [habit]
  double edge = 0.05;
  double least_at_issue =
      0.02;  ///< probability of a cause that rows are chosen for; 0 to 0.1 [habit]
  std::size_t most_at_issue = 5;  ///< 2 to 10 [cost]
  double least_of_pair = 0.01;    ///< probability of either of two causes; 0.001 to 0.1 [habit]
  double settled = 0.95;          ///< probability from which no row is asked for; 0.8 to 1 [habit]
};

}  // namespace selfcal
