// Two data sets of one robot as one system of equations, with columns of their own for what may
// differ.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "constraints/estimation/adjustment.h"
#include "diagnosis/comparison/changeable.h"
#include "diagnosis/evidence/evidence_evaluator.h"

namespace selfcal {

/// One of the two fitted alone, which tells noise and false rows: a change is neither.
struct FittedSession {
  FittedSession(const Robot& geometry, DataSet rows, const DiagnosisOptions& options,
                const Progress& progress);
  DataSet data;
  Fit fit;
};

/// `session` with these sets, and those that refer to them, under other names: they
/// share nothing with those of another session.
FittedSession parted(FittedSession session, const std::vector<std::string>& sets);

class Pair {
 public:
  /// Fits both together.
  Pair(std::shared_ptr<const Robot> geometry, const FittedSession& before,
       const FittedSession& after, Between between, const DiagnosisOptions& options,
       const Progress& progress);
  Pair(const Pair&) = delete;

  const Changeable& changes() const { return changes_; }
  /// By row of both: false within its own data set.
  const std::vector<char>& outlier() const { return outlier_; }
  /// Of large data sets every so many configurations of each: the smaller one's are worth more.
  DenseEquations weighed(const std::vector<char>& outlier) const;
  EvidenceEvaluator evaluator(const DenseEquations& rows, SearchRule rule) const;
  /// By row of both: what these changes, fitted to `rows`, leave of it is far beyond noise.
  std::vector<char> outliers_among(const DenseEquations& rows, const Hypothesis& changes) const;

 private:
  void add_noise_of(const FittedSession& part);
  Whitened whitened(const DenseEquations& rows) const;

  std::shared_ptr<const Robot> geometry_;
  const double most_outliers_;
  const int first_rows_;
  const DataSet both_;
  const Equations equations_;
  std::vector<Scale> noise_;  ///< by set of both
  std::vector<double> rows_;  ///< by set of both, how many told its noise
  std::vector<char> outlier_;
  Adjusted adjusted_;
  DenseEquations every_;
  Changeable changes_;
};

}  // namespace selfcal
