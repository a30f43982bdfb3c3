// The few distributions that the identification judges by. Of what is no number they say: 1.
#pragma once

#include <vector>

namespace selfcal {

/// Quantile of the chi distribution (length of a standard normal vector of `freedom` entries).
double chi_quantile(int freedom, double probability);
/// Probability that a chi-square variable of `freedom` (any positive number) exceeds `value`.
double chi_square_exceeds(double value, double freedom);
/// Logarithm of the probability that it stays below `value` (positive), also where that is too
/// small for a number.
double log_chi_square_below(double value, double freedom);
/// A variance that others add up to, and the freedoms that tell it; infinite where it is known.
struct VariancePart {
  double variance = 0, freedoms = 0;
};
/// Freedoms of the sum of `parts` (Welch and Satterthwaite); infinite where all that is in it is
/// known.
double effective_freedoms(const std::vector<VariancePart>& parts);
/// Probability that an F variable exceeds `value`.
double f_exceeds(double value, double upper_freedom, double lower_freedom);

/// Value that a Student t variable of `freedom` (any positive number; 1 for others) stays below
/// with `probability`.
double student_quantile(double probability, double freedom);
/// Probability that a Student t variable of `freedom` (any positive number) stays below `value`.
double student_below(double value, double freedom);

/// Probability that of `drawn` out of `all`, `having` of which have something, `seen` and more have
/// it (Fisher's exact test).
double as_many_drawn(unsigned seen, unsigned drawn, unsigned having, unsigned all);

/// One-sided Wilcoxon signed-rank test that the differences are positive rather than symmetric
/// about zero; exact up to 50 differences without ties, normal approximation with tie correction
/// beyond. Zeros and what is no number are dropped; 1 when nothing is left.
double signed_rank_p(const std::vector<double>& differences);

/// Median; 0 of nothing.
double median(std::vector<double> values);

}  // namespace selfcal
