// The answer: the end position must be known to the target, and a paired test
// on the check rows (Wilcoxon's signed ranks of |before| - |after|) must say that they improved, at
// 95 %; their squares must fall, and those of their angles must not rise. Where the end position is
// not known to the target, but the check rows are no better and the fitted rows do not contradict
// the maker's figures either, there is nothing to improve: that is an answer too.
#include <algorithm>
#include <cmath>

#include "constraints/estimation/judgement.h"
#include "constraints/statistics.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

constexpr double kSignificance = 0.05;
/// Normal quantile of the same, and how much the squares of angles that say little may rise.
constexpr double kRise = 1.645, kLittle = 0.1;

/// A false reading: far under both models, each by its own noise, and no farther under the new one
/// than the old one's noise explains. What the new model alone makes far counts, however far it is.
bool is_false(size_t i, const Judged& before, const Judged& after) {
  const RowResidual &b = before.check[i], &a = after.check[i];
  return is_outlier(b, before) && is_outlier(a, after) &&
         a.size() - b.size() <
             (b.lengths > 0
                  ? chi_quantile(b.lengths, kOutlierQuantile) * before.check_scale[b.set].length
                  : chi_quantile(b.angles, kOutlierQuantile) * before.check_scale[b.set].angle) *
                 b.factor;
}

/// The rows' squares fall, of all and of each set that only judges: many small gains must not
/// outvote one great loss. False readings say nothing of either model.
bool lengths_fall(const Judged& before, const Judged& after) {
  double all = 0;
  std::vector<double> of_set(after.aligned.size(), 0);
  for (size_t i = 0; i < after.check.size(); ++i) {
    if (is_false(i, before, after)) continue;
    const double gain = std::pow(before.check[i].size(), 2) - std::pow(after.check[i].size(), 2);
    all += gain;
    if (after.aligned[after.check[i].set]) of_set[after.check[i].set] += gain;
  }
  return all > 0 && std::ranges::none_of(of_set, [](double gain) { return gain < 0; });
}

/// The squares of a set's angles rise by more than a tenth, and by more than chance explains:
/// angles in which noise outweighs the robot may say nothing, but must not contradict.
bool angles_rise(const Judged& before, const Judged& after) {
  struct Sum {
    double before = 0, loss = 0, squares = 0;
  };
  std::vector<Sum> of_set(after.aligned.size());
  for (size_t i = 0; i < after.check.size(); ++i) {
    if (is_false(i, before, after)) continue;
    const double b = std::pow(before.check[i].angle, 2), a = std::pow(after.check[i].angle, 2);
    Sum& sum = of_set[after.check[i].set];
    sum.before += b;
    sum.loss += a - b;
    sum.squares += std::pow(a - b, 2);
  }
  return std::ranges::any_of(of_set, [](const Sum& sum) {
    return sum.loss > kLittle * sum.before && sum.loss > kRise * std::sqrt(sum.squares);
  });
}

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
  return text +
         with_figures(" (over the whole range of the joints %.3g mm)", 1e3 * grounds.endpoint.rms);
}

/// Of each configuration that judges, on average over its repeats: these share more than their
/// noise, so that one of them says as much as many.
std::vector<double> gains(const Judged& before, const Judged& after, const Residuals& residual) {
  std::vector<double> gain(static_cast<size_t>(residual.check.configurations), 0), count = gain;
  for (size_t i = 0; i < after.check.size(); ++i) {
    const auto at = static_cast<size_t>(residual.check_rows[i].configuration);
    gain[at] += before.check[i].size() - after.check[i].size();
    ++count[at];
  }
  for (size_t at = 0; at < gain.size(); ++at) gain[at] /= count[at];
  return gain;
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

Verdict verdict(const Judged& before, const Judged& after, const Residuals& residual,
                const Grounds& grounds) {
  Verdict v;
  if (residual.check.rows == 0) {
    v.why = "no check rows to judge by";
    return v;
  }
  v.p_value = signed_rank_p(gains(before, after, residual));
  v.why = change(residual.check, v.p_value) + "; " + certainty(grounds);
  const bool worse_turned = angles_rise(before, after);
  const bool better = v.p_value < kSignificance && lengths_fall(before, after) && !worse_turned;
  if (!grounds.converged) {
    v.why = "the identification did not converge; " + v.why;
  } else if (!grounds.contradictions.empty()) {
    for (const std::string& each : grounds.contradictions) v.why += "; " + each;
  } else if (known_to(grounds.workspace, grounds.target)) {
    v.answer = better ? Answer::improved : Answer::not_improved;
    if (worse_turned) v.why += "; the angles are met worse than before";
  } else {
    if (grounds.workspace.poses >= kFewestPoses)
      v.why += with_figures(", %.3g mm wanted", 1e3 * grounds.target);
    if (better || !grounds.nominal_explains) return v;
    v.answer = Answer::not_improved;
    v.why += "; the rows ask for no other robot than the maker's";
  }
  return v;
}

}  // namespace selfcal
