// Tails of the distributions that the search asks a million times, so that they cost no more than a
// logarithm; the exact ones are in constraints/statistics.h.
#pragma once

#include <vector>

namespace selfcal {

/// log P(chi-square of some freedom < value), from cubics in log(value) between exact values and
/// slopes, a quarter of a sigma apart: within 1e-4.
class NoiseTail {
 public:
  NoiseTail() = default;
  explicit NoiseTail(double freedom);
  /// 0 where the probability is one to rounding.
  double log_below(double value) const;

 private:
  double freedom_ = 0, first_ = 0, step_ = 1;  ///< the latter two of log(value)
  struct Knot {
    double value, slope;
  };
  std::vector<Knot> knots_;
};

/// P(Student's t < value): the normal value of the same probability (Hill, Algorithm 395,
/// Communications of the ACM 13, 1970), within 1e-5 from ten freedoms on.
double student_below_nearly(double value, double freedom);

}  // namespace selfcal
