// The answer: the end position must be known to the target, and the check rows must be met better.
// Where the end position is not known to the target, but the check rows are no better and the
// fitted rows do not contradict the maker's figures either, there is nothing to improve: that is an
// answer too.
#include <algorithm>
#include <cmath>
#include <vector>

#include "constraints/estimation/check_comparison.h"
#include "constraints/estimation/judgement.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

/// How well the end position is known: where it counts, and all over.
std::string certainty(const Grounds& grounds) {
  if (grounds.workspace.poses == 0)
    return "no configuration within the joint limits reaches the workspace";
  if (grounds.workspace.poses < kFewestPoses)
    return "only " + std::to_string(grounds.workspace.poses) +
           " of the configurations tried reach the workspace within the joint limits, " +
           std::to_string(kFewestPoses) + " are needed to say how well the end position is known";
  std::string text =
      with_figures("end position in the workspace known to %.3g mm", 1e3 * grounds.workspace.rms);
  if (grounds.orientation_seen)
    text += with_figures(" and %.3g mrad", 1e3 * grounds.workspace.angle);
  text += " (over the whole range of the joints";
  if (grounds.beyond_rows) text += ", most of it beyond these rows,";
  text += with_figures(" %.3g mm)", 1e3 * grounds.endpoint.rms);
  if (!known_to(grounds.workspace, grounds.target))
    text += with_figures(", %.3g mm wanted", 1e3 * grounds.target);
  return text;
}

/// Where the robot strays from any geometry by more than the doubt of its own, or than is wanted.
std::string straying(const Grounds& grounds) {
  const bool beyond = grounds.strays > grounds.target;
  if (!grounds.converged || grounds.workspace.poses < kFewestPoses ||
      (!beyond && std::sqrt(3) * grounds.strays <= grounds.workspace.rms))
    return {};
  std::string text =
      with_figures("; beside that the robot strays by %.2g mm in each direction from any geometry",
                   1e3 * grounds.strays);
  if (beyond) text += with_figures(", more than the %.3g mm wanted", 1e3 * grounds.target);
  return text;
}

/// Of what a check row was met by before: what is left of it where it is no better for any use; and
/// of all of them those that must be better.
constexpr double kHardlyLess = 0.99, kFewestBetter = 0.25;

bool hardly_better(const std::vector<RowFigure>& rows) {
  double judging = 0, better = 0;
  for (const RowFigure& row : rows) {
    judging += row.check;
    better += row.check && (row.after < kHardlyLess * row.before ||
                            row.angle_after < kHardlyLess * row.angle_before);
  }
  return better < kFewestBetter * judging;
}

/// Of what the check rows were met by before: what is left where much of it is not the robot's.
constexpr double kMostOfGross = 0.5;

/// What no robot does is in the rows, and hardly less of it than before: which of them show how the
/// robot is cannot be said.
std::string gross_rows(const Figures& check, const Grounds& grounds) {
  if (check.angle_alone || grounds.strays <= std::max(grounds.most_strays, grounds.target) ||
      check.rms_after <= kMostOfGross * check.rms_before)
    return {};
  return "; most of what is left of the rows is not the robot's: find the set or the rows that are "
         "wrong first";
}

/// What became of the check rows.
std::string change(const Figures& check, double p_value) {
  std::string text = with_figures(
      check.angle_alone ? "check residual %.4g to %.4g mrad" : "check residual %.4g to %.4g mm",
      1e3 * check.rms_before, 1e3 * check.rms_after);
  if (check.angle.rows > 0 && !check.angle_alone)
    text += with_figures(", angles %.3g to %.3g mrad", 1e3 * check.angle.rms_before,
                         1e3 * check.angle.rms_after);
  return text + " (p " + (p_value < 1e-9 ? "< 1e-9" : with_figures("= %.2g", p_value)) + ")";
}

}  // namespace

Verdict verdict(const Judged& before, const Residuals& residual, const Grounds& grounds) {
  Verdict v;
  if (residual.check.rows == 0) {
    v.why = "no check rows to judge by";
    for (const std::string& each : grounds.contradictions) v.why += "; " + each;
    return v;
  }
  const CheckComparison compared = compare_check_rows(check_rows(before), residual.check_rows);
  v.p_value = compared.p_value;
  v.why = change(residual.check, v.p_value) + "; " + certainty(grounds) + straying(grounds);
  if (!grounds.converged) {
    v.why = "the identification did not converge; " + v.why;
  } else if (!grounds.contradictions.empty()) {
    for (const std::string& each : grounds.contradictions) v.why += "; " + each;
  } else if (known_to(grounds.workspace, grounds.target) && compared.too_few()) {
    v.why += "; no test of so few configurations kept aside can say that they are met better";
  } else if (const std::string gross = gross_rows(residual.check, grounds);
             known_to(grounds.workspace, grounds.target) && !gross.empty()) {
    v.why += gross;
  } else if (known_to(grounds.workspace, grounds.target)) {
    const bool hardly = compared.better() && hardly_better(residual.rows);
    v.answer = compared.better() && !hardly ? Answer::improved : Answer::not_improved;
    if (hardly) v.why += "; by less than a hundredth, which is of no use to anyone";
    if (compared.angles_rise) v.why += "; the angles are met worse than before";
  } else {
    if (compared.better() || !grounds.nominal_explains) return v;
    v.answer = Answer::not_improved;
    v.why += "; the rows ask for no other robot than the maker's";
  }
  return v;
}

}  // namespace selfcal
