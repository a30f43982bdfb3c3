// A judging row that neither model comes near is a false one: it would drown both figures, is left
// out of them and named.
#include "diagnosis/closing.h"

#include <algorithm>
#include <cmath>

#include "constraints/judgement.h"
#include "constraints/statistics.h"
#include "diagnosis/view.h"
#include "kinematics/corrected_robot.h"

namespace selfcal {
namespace {

constexpr double kFar = 1 - 1e-6;
constexpr double kBeyond = 1.25;  ///< a judging row's prediction has an error of its own

Adjusted adjusted_model(const Equations& equations, const std::vector<double>& effect_sigma,
                        const DiagnosisOptions& options) {
  Options free = geometry_options(options);
  free.effect_sigma = effect_sigma;
  for (const Parameter& p : equations.robot().parameters())
    if (p.part == Part::effect) free.free.push_back(p.name);
  return adjust(equations, free, {});
}

}  // namespace

Closing close_gap(const std::shared_ptr<const Robot>& geometry, const Adjusted& before,
                  const DataSet& data, const Correction& correction, const Site& site, double noise,
                  const DiagnosisOptions& options) {
  Closing closing;
  Problems problems;
  closing.model = correct(geometry, correction.entries, site, problems);
  const Equations plain(*geometry, data, Use::fit), corrected(*closing.model, data, Use::fit);
  closing.after = adjusted_model(corrected, correction.sigma, options);
  const Judged nominal = judge(*geometry, data, plain, before.before);
  const Judged geometric = judge(*geometry, data, plain, before.fitted);
  const Judged whole = judge(*closing.model, data, corrected, closing.after.fitted);
  // A set that only judges has a noise of its own: what its data sheet says, if it does.
  const auto floor_of = [&](const RowResidual& row) {
    const double own =
        data.sets[row.set].noise > 0 ? data.sets[row.set].noise : whole.check_scale[row.set].length;
    return row.lengths * std::pow(row.factor * (whole.aligned[row.set] ? own : noise), 2);
  };
  const auto square = [](const RowResidual& row) { return row.length * row.length; };
  for (size_t i = 0; i < whole.check.size(); ++i) {
    const RowResidual& b = geometric.check[i];
    const RowResidual& a = whole.check[i];
    if (a.lengths == 0) continue;
    const double near = std::min(a.length, b.length), limit = chi_quantile(a.lengths, kFar);
    if (near > kBeyond * limit * std::max(noise, whole.check_scale[a.set].length)) {
      closing.rejected.push_back({a.row + 1, data.sets[a.set].name, a.length, true,
                                  "neither the geometry nor the named effects come near it"});
      continue;
    }
    closing.judged.push_back({square(nominal.check[i]), square(b), square(a), floor_of(a)});
  }
  return closing;
}

}  // namespace selfcal
