// Rows before any cause is known: how noisy they are, which of them are weighed.
#pragma once

#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/fitting/fit.h"

namespace selfcal {

/// The rows that have equations, in order and each once, and by equation its row's place among
/// them; -1 of an equation of no row.
struct RowPlaces {
  explicit RowPlaces(const std::vector<int>& row_of_equation);
  std::vector<int> rows, of;
};

/// What the rows themselves say, whatever the data sheet does: one noise for all sets of a method
/// and stated noise, since the set that holds the cause would otherwise be taken for a noisy one;
/// of a set whose rows all judge, with no other of its kind, what its data sheet says. By set.
std::vector<Scale> pooled_noise(const DataSet& data, const Fit& fitted);
/// Noise of each set's lengths and angles over that of all, by set, from what the best explanation
/// leaves (`residuals`) of `rows` (without their columns), each of which keeps the share `leaves`
/// beyond the geometry: one for all sets of a method and stated noise but for those with rows
/// enough for their own, and none below `least` (by set, in what the residuals are whitened by). 1
/// where the rows do not tell them apart.
std::vector<Scale> unlike_noise(const DataSet& data, const DenseEquations& rows,
                                const Eigen::VectorXd& residuals, const Eigen::VectorXd& leaves,
                                const std::vector<Scale>& least);
/// What the data sheet says, by set, which the noise is at least; 0 where it says nothing and where
/// repeats of the rows tell what the noise really is.
std::vector<Scale> declared_noise(const DataSet& data);

/// By row, 1 where it takes part: of rows with more than `most` of `equations` one of every so many
/// configurations, with its repeats as far as they tell more; none that are kept aside to judge.
std::vector<char> weighed_rows(const Observations& rows, double equations, double most);

/// Those of the rows that `take` (by row) holds, and those that no row carries.
std::vector<int> equations_of(const DenseEquations& all, const std::vector<char>& take);
/// Of these equations of `all`, which row and quantity they are of.
void add_labels(const DenseEquations& all, const std::vector<int>& equations, DenseEquations& to);
/// The equations of the rows that `take` (by row) holds, and those that no row carries.
DenseEquations kept(const DenseEquations& all, const std::vector<char>& take);

/// By row of the data set (which has `rows`), 1 where what an explanation of so many `unknowns`
/// leaves of it (`residuals`, by equation) lies beyond one in a hundred thousand: the farthest, up
/// to a share of about `most`.
std::vector<char> outliers_among(const DenseEquations& all, const Eigen::VectorXd& residuals,
                                 double unknowns, std::size_t rows, double most);

/// The endpoint's pose with the robot file's own values, by row.
std::vector<Eigen::Isometry3d> ends(const Robot& robot, const Observations& rows);
/// Where it is (rows x 3, m).
Eigen::MatrixXd tips(const Robot& robot, const Observations& rows);

}  // namespace selfcal
