// A choice of candidate measurements, and what adding or removing one would make of it.
//
// With C = (prior + WᵀW)^-1 of the chosen, a candidate w (k x m) changes
//   det C^-1 by det(I +- w C wᵀ)                              (determinant lemma)
//   C by -+ U Uᵀ,  U = C wᵀ L^-T,  L Lᵀ = I +- w C wᵀ         (Woodbury)
//   trace(A C) by -+ trace((I +- w C wᵀ)^-1 w C A C wᵀ)
// Of every candidate only w C wᵀ and w C A C wᵀ are kept, and updated by the same rule: a change
// costs m k² for each candidate. The other indices are of the eigenvalues of C: the changes that
// raise them most to first order are judged exactly.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <utility>
#include <vector>

#include "constraints/planning/criterion.h"

namespace selfcal {

class Design {
 public:
  /// A candidate is what one measurement adds to W: k x m, k up to kMostEquations (may differ),
  /// whitened. One is exchanged for one of its own kind only (one of kinds 0, 1, … each; all of
  /// one kind where there are none).
  Design(const std::vector<Eigen::MatrixXd>& candidates, Objective objective,
         std::vector<int> kinds = {});

  /// Chooses these and no others.
  void choose(const std::vector<int>& chosen);
  /// Indices of the chosen, ascending.
  std::vector<int> chosen() const;
  bool has(int candidate) const { return in_[static_cast<std::size_t>(candidate)] != 0; }
  int candidates() const { return static_cast<int>(in_.size()); }
  int kind(int candidate) const { return kinds_[static_cast<std::size_t>(candidate)]; }
  /// How many kinds there are.
  int kinds() const { return 1 + *std::max_element(kinds_.begin(), kinds_.end()); }
  /// How many rows a candidate has.
  Eigen::Index rows(int candidate) const { return k_[static_cast<std::size_t>(candidate)]; }

  /// What the objective asks to be large: -trace(weight C) of `sigma`, the log of the others (of o1
  /// that of the determinant).
  double merit() const;
  /// The candidate outside whose addition (+1), or inside whose removal (-1), leaves the largest
  /// merit, of one kind or of any (-1), and that merit; -1 without one.
  std::pair<int, double> best(int sign, int kind = -1) const;
  /// Of `sigma`: the merit without one that is chosen.
  double merit_without(int candidate) const;
  /// Adds (+1) or removes (-1) a candidate.
  void change(int candidate, int sign);
  /// The one of its kind that is the best in place of `candidate`, itself where no other is better,
  /// and the merit then.
  std::pair<int, double> best_instead_of(int candidate);
  /// Makes anew what changes have rounded.
  void refresh();

  /// The merit with each of these measurements besides, which are no candidates: its rows, as a
  /// candidate's.
  std::vector<double> merits_with(const std::vector<Eigen::MatrixXd>& measurements) const;
  /// Another measurement takes the place of a candidate that is not chosen; as many rows.
  void replace(int candidate, const Eigen::MatrixXd& w);

 private:
  /// C of some columns, and for each candidate its block of w C wᵀ, in rows as W's.
  struct Moments {
    Eigen::MatrixXd C, seen;
  };
  /// What a measurement of rows `w` changes: C by -+ U Uᵀ.
  struct Rise {
    Eigen::MatrixXd U;
    double log_determinant = 0;  ///< of I +- w C wᵀ
  };

  void scale_columns();
  Eigen::MatrixXd information(Eigen::Index first, Eigen::Index columns) const;
  /// W C of those columns to `products`, where that is asked for.
  Moments moments(Eigen::Index first, Eigen::Index columns, Eigen::MatrixXd* products) const;
  /// For each candidate its block of A B^T, in rows as W's.
  Eigen::MatrixXd blocks_of(const Eigen::Ref<const Eigen::MatrixXd>& A,
                            const Eigen::Ref<const Eigen::MatrixXd>& B) const;
  /// Candidates one after the other.
  struct Stretch {
    std::size_t first, end;
  };
  /// Adds or removes a candidate and follows what these are worth; false where all was made anew.
  bool change_within(const Stretch& these, std::size_t candidate, int sign);
  /// `by`: W U of the candidates' rows.
  void update(Moments& at, const Stretch& these, const Rise& rise, const Eigen::MatrixXd& by,
              int sign) const;
  Eigen::Index rows_in(const Stretch& these) const {
    return at_[these.end - 1] + k_[these.end - 1] - at_[these.first];
  }
  double merit_besides(const Eigen::MatrixXd& w) const;
  static Rise rise_of(const Eigen::MatrixXd& C, const Eigen::MatrixXd& w, int sign);
  double merit_of_spectrum(const Eigen::MatrixXd& C) const;
  std::pair<int, double> best_by_spectrum(int sign, int kind) const;
  /// May be added (+1) or removed (-1), and is of the kind.
  bool may(std::size_t candidate, int sign, int kind) const {
    return (in_[candidate] != 0) != (sign > 0) && (kind < 0 || kinds_[candidate] == kind);
  }
  double merit_after(std::size_t candidate, int sign) const;
  Eigen::Index interest() const { return W_.cols() - objective_.nuisance; }
  Eigen::MatrixXd rows_of(std::size_t candidate) const;

  Objective objective_;
  Eigen::MatrixXd W_;                 ///< of all candidates, columns scaled
  std::vector<Eigen::Index> at_, k_;  ///< first row and rows of each candidate
  Eigen::Index widest_ = 0;           ///< most rows of one
  Eigen::VectorXd scale_;             ///< a column is that of its parameter over this
  std::vector<char> in_;
  std::vector<int> kinds_;        ///< by candidate
  std::vector<Stretch> of_kind_;  ///< from the first to the last of each
  Moments all_, nuisance_;        ///< of all columns, of the last ones alone
  // Of `sigma`: the blocks of w C A C wᵀ, as seen, and trace(A C).
  Eigen::MatrixXd spread_;
  double trace_ = 0;
  double log_determinant_ = 0;  ///< of the information, that of the nuisance columns taken off
};

}  // namespace selfcal
