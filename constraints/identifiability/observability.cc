// Observability measures from the singular values of R of W.
#include "constraints/identifiability/observability.h"

#include <cmath>

#include "kinematics/linear_algebra.h"

namespace selfcal {

Observability observability(const Eigen::MatrixXd& W, int rows) {
  Observability result;
  if (W.cols() == 0 || rows == 0) return result;
  const Eigen::VectorXd s = singular_values(W).values;
  const double largest = s[0], least = s[s.size() - 1];
  result.condition = largest / least;
  result.o1 = std::exp(s.array().log().mean()) / std::sqrt(static_cast<double>(rows));
  result.o2 = least / largest;
  result.o3 = least;
  result.o4 = least * least / largest;
  result.o5 = 1 / s.cwiseInverse().sum();
  return result;
}

}  // namespace selfcal
