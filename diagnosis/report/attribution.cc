#include "diagnosis/report/attribution.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/constants.h"

namespace selfcal {
namespace {

/// What each joint's own effects take of the residual when all effects there are share it.
std::vector<Share> by_joint(const LinearisedModel& linearised, const EvidenceEvaluator& evaluator) {
  std::vector<MarginalLikelihood::Term> terms;
  std::vector<int> joint;
  const std::vector<Joint>& joints = linearised.geometry().joints();
  const std::vector<Candidate>& all = linearised.candidates().list;
  for (size_t c = 0; c < all.size(); ++c) {
    if (evaluator.beyond_nuisance(static_cast<int>(c)) <= kDiagnosis.report.least_beyond_nuisance)
      continue;
    terms.push_back({&evaluator.block(static_cast<int>(c)), 1});
    joint.push_back(all[c].joint);
  }
  for (MarginalLikelihood::Term& term : terms)
    term.size = kDiagnosis.report.of_joints / std::sqrt(static_cast<double>(terms.size()));
  const MarginalLikelihood& plain = evaluator.marginal_likelihood(0);
  const Eigen::VectorXd v = plain.mean(terms);
  std::vector<double> share(joints.size(), 0);
  Eigen::Index at = 0;
  for (size_t t = 0; t < terms.size(); ++t)
    for (const int column : terms[t].block->columns) {
      const double part = v[at++] * plain.right()[column] / plain.total();
      if (joint[t] >= 0) share[joint[t]] += part;
    }
  std::vector<Share> list;
  for (size_t j = 0; j < joints.size(); ++j)
    list.push_back({joints[j].name, std::clamp(share[j], 0.0, 1.0)});
  return list;
}

/// Squared residuals by row of the data set, and what noise alone would leave there once the
/// geometry has taken its part.
struct RowSquares {
  std::vector<int> row;
  std::vector<double> squares, noise;
  double total = 0;

  /// Share of the rows that `in` picks, beyond the noise.
  template <class In>
  double share(In in) const {
    double sum = 0;
    for (size_t i = 0; i < row.size(); ++i)
      if (in(row[i])) sum += squares[i] - noise[i];
    return total > 0 ? std::clamp(sum / total, 0.0, 1.0) : 0;
  }
};

RowSquares row_squares(const LinearisedModel& linearised) {
  const DenseEquations kept = linearised.kept();
  const Whitened whitened = linearised.whitened_geometry();
  const Eigen::VectorXd e = linearised.geometry_residuals(whitened);
  const Eigen::VectorXd noise = linearised.geometry_leaves(whitened);
  RowSquares rows;
  for (size_t i = 0; i < kept.row.size(); ++i) {
    if (kept.row[i] < 0) continue;
    if (rows.row.empty() || rows.row.back() != kept.row[i]) {
      rows.row.push_back(kept.row[i]);
      rows.squares.push_back(0);
      rows.noise.push_back(0);
    }
    rows.squares.back() += std::pow(e[static_cast<Eigen::Index>(i)], 2);
    rows.noise.back() += noise[static_cast<Eigen::Index>(i)];
  }
  for (const double s : rows.squares) rows.total += s;
  return rows;
}

/// Regions about points as far from each other as can be.
std::vector<Region> by_region(const RowSquares& rows, const Eigen::MatrixXd& tips) {
  std::vector<Region> regions;
  std::vector<double> distance(rows.row.size(), std::numeric_limits<double>::infinity());
  std::vector<int> nearest(rows.row.size(), 0);
  for (int r = 0; r < kDiagnosis.report.regions && r < static_cast<int>(rows.row.size()); ++r) {
    const auto farthest =
        r == 0 ? 0 : std::max_element(distance.begin(), distance.end()) - distance.begin();
    Region region;
    region.centre = tips.row(rows.row[static_cast<size_t>(farthest)]).transpose();
    for (size_t i = 0; i < rows.row.size(); ++i) {
      const double d = (tips.row(rows.row[i]).transpose() - region.centre).norm();
      if (d >= distance[i]) continue;
      distance[i] = d;
      nearest[i] = r;
    }
    regions.push_back(region);
  }
  for (size_t r = 0; r < regions.size(); ++r) {
    std::vector<char> in(static_cast<size_t>(tips.rows()), 0);
    for (size_t i = 0; i < rows.row.size(); ++i)
      if (nearest[i] == static_cast<int>(r)) {
        in[rows.row[i]] = 1;
        regions[r].radius = std::max(regions[r].radius, distance[i]);
      }
    regions[r].share = rows.share([&](int row) { return in[row] != 0; });
  }
  return regions;
}

std::vector<Interval> by_time(const RowSquares& rows, const DataSet& data,
                              const MeasurementContext& context) {
  std::vector<Interval> list;
  if (context.end <= context.begin) return list;
  const double step = (context.end - context.begin) / kDiagnosis.report.times;
  for (int i = 0; i < kDiagnosis.report.times; ++i) {
    Interval each{context.begin + i * step, context.begin + (i + 1) * step, 0};
    const bool last = i + 1 == kDiagnosis.report.times;
    each.share = rows.share([&](int row) {
      const double t = data.rows.time[row];
      return t >= each.from && (t < each.to || (last && t <= each.to + 1e-9));
    });
    list.push_back(each);
  }
  return list;
}

/// Shares of overlapping noise may exceed one together; they are told as parts of one.
template <class List>
void at_most_one(List& list) {
  double sum = 0;
  for (const auto& each : list) sum += each.share;
  for (auto& each : list) each.share /= std::max(sum, 1.0);
}

}  // namespace

Where attribution(const LinearisedModel& linearised, const EvidenceEvaluator& evaluator,
                  const DataSet& data) {
  Where where;
  where.by_joint = by_joint(linearised, evaluator);
  const RowSquares rows = row_squares(linearised);
  for (size_t s = 0; s < data.sets.size(); ++s)
    where.by_set.push_back({data.sets[s].name, rows.share([&](int row) {
                              return data.rows.set[row] == static_cast<int>(s);
                            })});
  where.by_region = by_region(rows, linearised.tips());
  where.by_time = by_time(rows, data, linearised.context());
  at_most_one(where.by_joint);
  at_most_one(where.by_set);
  at_most_one(where.by_region);
  at_most_one(where.by_time);
  return where;
}

}  // namespace selfcal
