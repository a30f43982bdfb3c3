#include "diagnosis/search.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace selfcal {
namespace {

constexpr double kAbsorbed = 1e-3;  ///< share that survives below which a candidate says nothing
constexpr int kAgreements = 3;
constexpr double kWorthwhile = 5;  ///< log evidence that a cause must bring to be reckoned with
constexpr double kSlack = 0.25;    ///< of slack columns, over the main ones

double log_add(double a, double b) {
  const double top = std::max(a, b);
  return std::isinf(top) ? top : top + std::log(std::exp(a - top) + std::exp(b - top));
}

double middle(const EffectParameter& p) { return std::sqrt(p.usual_least * p.usual_most); }

}  // namespace

const std::vector<double>& Bench::sizes() {
  static const std::vector<double> list{0.25, 0.5, 1, 2, 4, 8, 16};
  return list;
}

Bench::Bench(const Whitened& rows, const std::vector<Structure>& structures, const Candidates& all,
             const std::vector<EffectParameter>& parameters, const SearchRule& rule)
    : all_(all), rule_(rule), structures_(structures) {
  for (const Structure& structure : structures_) workbenches_.emplace_back(rows, structure);
  const Eigen::MatrixXd& G = workbenches_.front().gram();
  const auto n = static_cast<double>(rows.C.rows());
  for (const Candidate& candidate : all.list) {
    Block block;
    std::vector<double> unit;
    double visible = 0, whole = 0, largest = 0;
    for (const int k : candidate.main) {
      const double u = middle(parameters[static_cast<size_t>(k)]);
      visible += u * u * G(k, k);
      whole += u * u * rows.C.col(k).squaredNorm();
      largest = std::max(largest, u / parameters[static_cast<size_t>(k)].usual_most);
    }
    survival_.push_back(whole > 0 ? std::sqrt(std::max(visible, 0.0) / whole) : 0);
    seen_.push_back(survival_.back() > kAbsorbed);
    const double scale = seen_.back() ? std::sqrt(n / visible) : 0;
    amplitude_.push_back(scale * largest);
    for (const int k : candidate.main) {
      block.columns.push_back(k);
      unit.push_back(scale * middle(parameters[static_cast<size_t>(k)]));
    }
    double slack = 0;
    for (const int k : candidate.slack) slack += rows.C.col(k).squaredNorm();
    for (const int k : candidate.slack) {
      block.columns.push_back(k);
      unit.push_back(slack > 0 ? kSlack * scale * std::sqrt(whole / slack) : 0);
    }
    block.unit =
        Eigen::Map<const Eigen::VectorXd>(unit.data(), static_cast<Eigen::Index>(unit.size()));
    blocks_.push_back(std::move(block));
  }
  for (int s = 0; s < static_cast<int>(structures_.size()); ++s) agree(s, rows);
}

/// The geometry's priors weigh rightly only where the noise does: the structure's size is taken
/// from what its best explanation leaves.
void Bench::agree(int s, const Whitened& rows) {
  for (int i = 0; i < kAgreements; ++i) {
    double best = workbenches_[s].log_evidence({});
    double variance = workbenches_[s].total() / workbenches_[s].freedom();
    for (int c = 0; c < static_cast<int>(blocks_.size()); ++c) {
      if (!seen_[c]) continue;
      const Single single = weigh(workbenches_[s], c);
      if (single.log_sum - kWorthwhile < best) continue;
      best = single.log_sum - kWorthwhile;
      const Workbench::Term term{&blocks_[c], single.size};
      variance = workbenches_[s].estimate({&term, 1}).variance;
    }
    if (std::abs(std::log(variance)) < 0.1) return;
    structures_[s].root *= std::sqrt(variance);
    structures_[s].noise *= variance;
    workbenches_[s] = Workbench(rows, structures_[s]);
  }
}

void Bench::look_at(const Eigen::VectorXd& y, const Eigen::VectorXd& pull) {
  for (Workbench& workbench : workbenches_) workbench.look_at(y, pull);
}

double Bench::plausibility(int candidate, double size) const {
  // Three times the usual largest is as good as any; ten times that costs two.
  const double beyond = std::log10(size * amplitude_[candidate] / 3);
  return beyond > 0 ? -2 * beyond * beyond : 0;
}

double Bench::log_prior(const std::vector<int>& candidates, int structure) const {
  double sum = 0;
  std::set<std::string> families;
  std::set<Cause> causes;
  for (const int c : candidates) {
    const Candidate& each = all_.list[static_cast<size_t>(c)];
    sum += each.log_prior;
    if (!causes.insert({each.effect, each.at}).second)
      sum += std::log(rule_.same_family);
    else if (!families.insert(each.effect).second)
      sum += std::log(rule_.same_family);
    else
      sum += std::log(rule_.family_odds) + (families.size() > 1 ? std::log(rule_.another) : 0);
  }
  sum += std::log(structures_[structure].probability);
  if (structures_[structure].kind == 0) return sum;
  return sum + std::log(rule_.unknown_odds) + (families.empty() ? 0 : std::log(rule_.another));
}

Bench::Single Bench::weigh(const Workbench& workbench, int candidate) const {
  Single single{-INFINITY, -INFINITY, 1};
  for (const double size : sizes()) {
    const Workbench::Term term{&blocks_[candidate], size};
    const double log = workbench.log_evidence({&term, 1}) + plausibility(candidate, size) -
                       std::log(static_cast<double>(sizes().size()));
    single.log_sum = log_add(single.log_sum, log);
    if (log > single.log_best) {
      single.log_best = log;
      single.size = size;
    }
  }
  return single;
}

double Bench::held(const Hypothesis& h) const {
  // The sizes of candidates at hand stay at their best: one of the grid, about two of which matter.
  double sum = 0;
  for (size_t i = 0; i < h.candidates.size(); ++i)
    sum += plausibility(h.candidates[i], h.sizes[i]) -
           std::log(static_cast<double>(sizes().size()) / 2);
  return sum;
}

double Bench::evidence(int candidate) const {
  return seen_[candidate] ? weigh(workbenches_.front(), candidate).log_sum -
                                workbenches_.front().log_evidence({})
                          : 0;
}

double Bench::best_single() const {
  size_t home = 0;
  for (size_t s = 1; s < structures_.size(); ++s)
    if (structures_[s].kind == 0 &&
        workbenches_[s].log_evidence({}) > workbenches_[home].log_evidence({}))
      home = s;
  double best = -INFINITY;
  for (int c = 0; c < static_cast<int>(blocks_.size()); ++c)
    if (seen_[c]) best = std::max(best, weigh(workbenches_[home], c).log_sum);
  return best - workbenches_[home].log_evidence({});
}

std::vector<Workbench::Term> Bench::terms(const Hypothesis& hypothesis) const {
  std::vector<Workbench::Term> list;
  for (size_t i = 0; i < hypothesis.candidates.size(); ++i)
    list.push_back({&blocks_[hypothesis.candidates[i]], hypothesis.sizes[i]});
  return list;
}

Hypothesis Bench::grow(Hypothesis h, size_t most) const {
  const auto log_weight = [&](const Hypothesis& of) {
    return workbenches_[of.structure].given(terms(of)).log_evidence({}) + held(of) +
           log_prior(of.candidates, of.structure);
  };
  h.log_weight = log_weight(h);
  while (h.candidates.size() < most) {
    const Workbench rest = workbenches_[h.structure].given(terms(h));
    std::set<std::string> families;
    for (const int c : h.candidates) families.insert(all_.list[static_cast<size_t>(c)].effect);
    Hypothesis best = h;
    for (int c = 0; c < static_cast<int>(blocks_.size()); ++c) {
      if (!seen_[c] || std::count(h.candidates.begin(), h.candidates.end(), c)) continue;
      if (families.size() >= 3 && !families.contains(all_.list[static_cast<size_t>(c)].effect))
        continue;
      Hypothesis more = h;
      const Single single = weigh(rest, c);
      more.candidates.push_back(c);
      more.sizes.push_back(single.size);
      more.log_weight = single.log_sum + held(h) + log_prior(more.candidates, more.structure);
      if (more.log_weight > best.log_weight + 1) best = more;
    }
    if (best.candidates.size() == h.candidates.size()) break;
    best.log_weight = log_weight(best);
    for (size_t i = 0; i + 1 < best.candidates.size(); ++i) {
      Hypothesis less = best;
      less.candidates.erase(less.candidates.begin() + static_cast<std::ptrdiff_t>(i));
      less.sizes.erase(less.sizes.begin() + static_cast<std::ptrdiff_t>(i));
      less.log_weight = log_weight(less);
      if (less.log_weight > best.log_weight) {
        best = less;
        --i;
      }
    }
    h = best;
  }
  return h;
}

double Bench::detectable(int candidate, double log_evidence) const {
  // A cause of visible size r adds about n r^2 / 2 to the log evidence.
  const double r = std::sqrt(2 * log_evidence / workbenches_.front().freedom());
  return r *
         blocks_[candidate]
             .unit
             .head(static_cast<Eigen::Index>(all_.list[static_cast<size_t>(candidate)].main.size()))
             .maxCoeff();
}

Posterior Bench::search() const {
  const int n = static_cast<int>(blocks_.size()), structures = static_cast<int>(structures_.size());
  std::map<std::pair<std::vector<int>, int>, Hypothesis> visited;
  const auto note = [&](std::vector<int> candidates, int structure, std::vector<double> at,
                        double log) -> const Hypothesis& {
    std::vector<size_t> order(candidates.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(),
              [&](size_t a, size_t b) { return candidates[a] < candidates[b]; });
    Hypothesis h;
    h.structure = structure;
    for (const size_t i : order) {
      h.candidates.push_back(candidates[i]);
      h.sizes.push_back(at[i]);
    }
    h.log_weight = log + log_prior(h.candidates, structure);
    Hypothesis& slot = visited[{h.candidates, structure}];
    if (slot.candidates.empty() || h.log_weight > slot.log_weight) slot = h;
    return slot;
  };

  std::vector<std::pair<double, int>> best_structures;
  for (int s = 0; s < structures; ++s) {
    Hypothesis h = note({}, s, {}, workbenches_[s].log_evidence({}));
    double best = h.log_weight;
    for (int c = 0; c < n; ++c) {
      if (!seen_[c]) continue;
      const Single single = weigh(workbenches_[s], c);
      best = std::max(best, note({c}, s, {single.size}, single.log_sum).log_weight);
    }
    if (structures_[s].kind > 0) best_structures.emplace_back(-best, s);
  }
  std::sort(best_structures.begin(), best_structures.end());
  std::vector<char> kept(static_cast<size_t>(structures), 0);
  for (int s = 0; s < structures; ++s) kept[s] = structures_[s].kind == 0;
  for (size_t i = 0; i < best_structures.size() && static_cast<int>(i) < rule_.most_structures; ++i)
    kept[best_structures[i].second] = 1;

  const auto best_of = [&](size_t size, int most) {
    std::vector<Hypothesis> list;
    for (const auto& [key, h] : visited)
      if (h.candidates.size() == size && kept[h.structure]) list.push_back(h);
    std::sort(list.begin(), list.end(),
              [](const auto& a, const auto& b) { return a.log_weight > b.log_weight; });
    // Not one cause in all its shapes: two of each cause and structure go on.
    std::map<std::pair<std::vector<Cause>, int>, int> taken;
    std::vector<Hypothesis> diverse;
    for (const Hypothesis& h : list) {
      std::vector<Cause> causes;
      for (const int c : h.candidates)
        causes.emplace_back(all_.list[static_cast<size_t>(c)].effect,
                            all_.list[static_cast<size_t>(c)].at);
      if (++taken[{causes, h.structure}] > 2) continue;
      diverse.push_back(h);
      if (static_cast<int>(diverse.size()) == most) break;
    }
    return diverse;
  };
  const auto extend = [&](const std::vector<Hypothesis>& from) {
    for (const Hypothesis& h : from) {
      const Workbench rest = workbenches_[h.structure].given(terms(h));
      for (int c = 0; c < n; ++c) {
        if (!seen_[c] || std::count(h.candidates.begin(), h.candidates.end(), c)) continue;
        const Single single = weigh(rest, c);
        std::vector<int> candidates = h.candidates;
        std::vector<double> at = h.sizes;
        candidates.push_back(c);
        at.push_back(single.size);
        note(candidates, h.structure, at, single.log_sum + held(h));
      }
    }
  };
  extend(best_of(1, rule_.extended_singles));
  extend(best_of(2, rule_.extended_pairs));

  Posterior posterior;
  double total = -INFINITY;
  for (const auto& [key, h] : visited) {
    posterior.hypotheses.push_back(h);
    total = log_add(total, h.log_weight);
  }
  std::sort(posterior.hypotheses.begin(), posterior.hypotheses.end(),
            [](const auto& a, const auto& b) { return a.log_weight > b.log_weight; });
  posterior.log_total = total - workbenches_.front().log_evidence({});
  for (Hypothesis& h : posterior.hypotheses) {
    h.log_weight -= total;
    const double p = std::exp(h.log_weight);
    const bool unknown = structures_[h.structure].kind > 0;
    if (unknown) posterior.unknown += p;
    if (!unknown && h.candidates.empty()) posterior.none += p;
    std::set<std::string> families;
    std::set<Cause> causes;
    for (const int c : h.candidates) {
      const Candidate& each = all_.list[static_cast<size_t>(c)];
      families.insert(each.effect);
      causes.insert({each.effect, each.at});
    }
    for (const std::string& f : families) posterior.family[f] += p;
    for (const Cause& c : causes) posterior.cause[c] += p;
  }
  return posterior;
}

}  // namespace selfcal
