// What may differ between two data sets, as candidates: columns that only the second's rows have.
#pragma once

#include <string>
#include <vector>

#include "constraints/equations/equations.h"
#include "diagnosis/comparison/comparison.h"
#include "diagnosis/evidence/candidates.h"

namespace selfcal {

struct Changeable {
  Candidates candidates;
  std::vector<int> columns;  ///< of the dense equations, by parameter
  std::vector<EffectParameter> parameters;
};

/// What a surface or an instrument that stands elsewhere is called.
std::string fixture_moved(Between between);

/// `W` are the dense equations of `before` and `after`, one behind the other.
Changeable changeable(const Equations& equations, const Eigen::MatrixXd& W, const DataSet& before,
                      const DataSet& after, Between between);

}  // namespace selfcal
