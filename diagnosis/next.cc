// Expected log evidence of A over B, A true: half of what A's rows leave beyond geometry and B, in
// squared sigmas. The odds after the new rows are those of now times the exponential of its growth.
#include "diagnosis/next.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "constraints/configurations.h"
#include "diagnosis/causes.h"
#include "kinematics/corrected_robot.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr int kNewRows = 12;
constexpr double kPayload = 5;   ///< kg
constexpr double kWorth = 0.02;  ///< of probability that a step must bring to be told
constexpr size_t kMostSteps = 3;

/// Rows of `data` that spread over the fit rows, evenly.
std::vector<int> spread_rows(const DataSet& data) {
  std::vector<int> fit, some;
  for (int row = 0; row < data.rows.rows(); ++row)
    if (!data.rows.check[row]) fit.push_back(row);
  const int count = std::min<int>(kNewRows, static_cast<int>(fit.size()));
  for (int i = 0; i < count; ++i) some.push_back(fit[i * fit.size() / count]);
  return some;
}

/// The data set and after it its rows `rows` once more, each a configuration of its own.
DataSet with_copies(const DataSet& data, const std::vector<int>& rows) {
  std::vector<int> all(static_cast<size_t>(data.rows.rows()));
  std::iota(all.begin(), all.end(), 0);
  all.insert(all.end(), rows.begin(), rows.end());
  DataSet more = data;
  more.rows = taken(data.rows, all);
  for (size_t i = static_cast<size_t>(data.rows.rows()); i < more.rows.repeat.size(); ++i)
    more.rows.repeat[i] = -1;
  return more;
}

struct Step {
  const char* what;
  void (*change)(const View&, DataSet& more, Eigen::Index first);
};

void payload(const View& view, DataSet& more, Eigen::Index first) {
  Observations& rows = more.rows;
  if (rows.wrench.rows() == 0) rows.wrench.setZero(rows.q.rows(), 6);
  const Eigen::Vector3d weight = kPayload * view.geometry().mechanics().gravity;
  for (Eigen::Index i = first; i < rows.q.rows(); ++i) {
    const Eigen::Matrix3d R = view.geometry().link_poses(rows.q.row(i).transpose()).back().linear();
    rows.wrench.row(i).head<3>() += (R.transpose() * weight).transpose();
  }
}

void other_side(const View&, DataSet& more, Eigen::Index first) {
  Observations& rows = more.rows;
  if (rows.velocity.rows() > 0) rows.velocity.bottomRows(rows.q.rows() - first) *= -1;
}

void three_times_the_speed(const View&, DataSet& more, Eigen::Index first) {
  Observations& rows = more.rows;
  if (rows.velocity.rows() > 0) rows.velocity.bottomRows(rows.q.rows() - first) *= 3;
}

void again_at_the_end(const View& view, DataSet& more, Eigen::Index first) {
  Observations& rows = more.rows;
  if (rows.time.size() > 0) rows.time.tail(rows.q.rows() - first).setConstant(view.site().end + 1);
}

/// The ball that the touches of a set so far lie in: the surface may end there.
Patch seen_of(const View& view, const Observations& rows, int set, Eigen::Index first) {
  const Eigen::MatrixXd tips = view.tips();
  std::vector<int> own;
  for (int row = 0; row < first; ++row)
    if (rows.set[row] == set) own.push_back(row);
  Patch patch;
  if (own.empty()) return patch;
  patch.centre = tips(own, Eigen::all).colwise().mean().transpose();
  for (const int row : own)
    patch.radius = std::max(patch.radius, (tips.row(row).transpose() - patch.centre).norm());
  return patch;
}

/// Other configurations that touch the same surfaces, or any where nothing is touched. Rows of
/// shared points stay: elsewhere they would be of another point.
void joints_elsewhere(const View& view, DataSet& more, Eigen::Index first) {
  const State& state = view.adjusted().fitted.state;
  std::vector<std::vector<int>> rows_of(more.sets.size());
  for (int row = static_cast<int>(first); row < more.rows.rows(); ++row)
    rows_of[more.rows.set[row]].push_back(row);
  DataSet found;
  found.sets = more.sets;
  std::vector<SampleRequest> requests;
  for (int s = 0; s < static_cast<int>(more.sets.size()); ++s) {
    const Method& method = *more.sets[s].method;
    if (method.group_freedom() > 0 || method.paired()) continue;
    SampleRequest request;
    request.set = s;
    request.rows = static_cast<int>(rows_of[s].size());
    request.own = state.own[s];
    if (method.constrains()) request.patch = seen_of(view, more.rows, s, first);
    requests.push_back(std::move(request));
  }
  Random random(1);
  sample_rows(view.geometry(), state.xi, requests, random, found);
  std::vector<std::size_t> used(more.sets.size(), 0);
  for (int i = 0; i < found.rows.rows(); ++i) {
    const int s = found.rows.set[i];
    more.rows.q.row(rows_of[s][used[s]++]) = found.rows.q.row(i);
  }
}

constexpr Step kSteps[] = {
    {"repeat 12 rows with a payload of 5 kg", payload},
    {"repeat 12 rows approached from the other side", other_side},
    {"repeat 12 rows at three times the speed", three_times_the_speed},
    {"repeat 12 rows of the beginning once more at the end", again_at_the_end},
    {"add 12 rows with the joints elsewhere in their range", joints_elsewhere},
};

/// Rows of the geometry, A's own columns and B's, of a data set; whitened.
class Paper {
 public:
  Paper(const View& view, const std::vector<Node>& a, const std::vector<Node>& b)
      : view_(view), of_a_(count(a)) {
    entries_ = a;
    entries_.insert(entries_.end(), b.begin(), b.end());
    value_.resize(0);
    for (const Node& entry : a) {
      Problems problems;
      const auto effect = make_effect(entry, view.geometry(), view.site(), problems);
      for (size_t k = 0; effect && k < effect->parameters().size(); ++k) {
        value_.conservativeResize(value_.size() + 1);
        value_[value_.size() - 1] = effect->parameters()[k].value;
      }
    }
  }

  /// Squared sigmas of A beyond geometry and B.
  double apart(const DataSet& data) const {
    Problems problems;
    const auto robot = correct(view_.shared_geometry(), entries_, view_.site(), problems);
    if (!robot) return 0;
    const Equations equations(*robot, data, Use::fit);
    State state = view_.adjusted().fitted.state;
    const Eigen::Index geometry = state.xi.size();
    state.xi.conservativeResize(static_cast<Eigen::Index>(robot->parameters().size()));
    state.xi.tail(state.xi.size() - geometry).setZero();
    const DenseEquations dense = equations.dense(
        state, view_.noise_of_sets(), std::vector<char>(static_cast<size_t>(data.rows.rows()), 0));
    const Eigen::MatrixXd of_a = dense.W.middleCols(geometry, of_a_);
    const Eigen::VectorXd left = of_a * value_.head(of_a_);
    std::vector<int> others;
    for (int c = 0; c < dense.W.cols(); ++c)
      if (c < geometry ? view_.adjusted().prior.free[c] != 0 : c >= geometry + of_a_)
        others.push_back(c);
    Eigen::MatrixXd explain =
        Eigen::MatrixXd::Zero(dense.W.rows() + static_cast<Eigen::Index>(others.size()),
                              static_cast<Eigen::Index>(others.size()));
    explain.topRows(dense.W.rows()) = dense.W(Eigen::all, others);
    for (size_t i = 0; i < others.size(); ++i)
      if (others[i] < geometry)
        explain(dense.W.rows() + static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) =
            1 / view_.adjusted().prior.sigma[others[i]];
    Eigen::VectorXd target = Eigen::VectorXd::Zero(explain.rows());
    target.head(left.size()) = left;
    return beyond(explain, target).squaredNorm();
  }

 private:
  Eigen::Index count(const std::vector<Node>& entries) const {
    Eigen::Index n = 0;
    Problems problems;
    for (const Node& entry : entries)
      if (const auto effect = make_effect(entry, view_.geometry(), view_.site(), problems))
        n += static_cast<Eigen::Index>(effect->parameters().size());
    return n;
  }

  const View& view_;
  Eigen::Index of_a_;
  std::vector<Node> entries_;
  Eigen::VectorXd value_;
};

/// The cause among the candidates that stands first in the verdict's list of look-alikes.
const CauseResult* look_alike(const Diagnosis& diagnosis) {
  for (const CauseResult& each : diagnosis.candidates)
    for (const std::string& name : diagnosis.verdict.confounded_with)
      if (each.effect != diagnosis.verdict.effect && !each.correction.entries.empty() &&
          name.substr(0, name.find('@')) == each.effect)
        return &each;
  return nullptr;
}

std::string first_label(const CauseResult& cause) {
  return label(cause.effect, cause.where.empty() ? "" : cause.where.front());
}

}  // namespace

std::vector<NextStep> next_steps(const View& view, const DataSet& data,
                                 const Diagnosis& diagnosis) {
  const CauseResult* other = look_alike(diagnosis);
  if (!other || diagnosis.verdict.correction.entries.empty()) return {};
  const Paper paper(view, diagnosis.verdict.correction.entries, other->correction.entries);
  double own = diagnosis.verdict.probability;  // without that of its look-alikes
  for (const CauseResult& each : diagnosis.candidates)
    if (each.effect == diagnosis.verdict.effect) own = each.probability;
  const double p = std::clamp(own / (own + other->probability), 0.01, 0.99);
  const double now = paper.apart(data);
  std::vector<NextStep> steps;
  for (const Step& step : kSteps) {
    DataSet more = with_copies(data, spread_rows(data));
    step.change(view, more, data.rows.rows());
    const double gain = (paper.apart(more) - now) / 2;
    const double after = 1 / (1 + (1 - p) / p * std::exp(-std::max(gain, 0.0)));
    if (after <= p + kWorth) continue;
    std::vector<int> added(more.rows.rows() - data.rows.rows());
    std::iota(added.begin(), added.end(), data.rows.rows());
    steps.push_back({step.what,
                     {first_label(diagnosis.verdict), first_label(*other)},
                     after,
                     taken(more.rows, added)});
  }
  std::sort(steps.begin(), steps.end(), [](const NextStep& a, const NextStep& b) {
    return a.probability_after > b.probability_after;
  });
  if (steps.size() > kMostSteps) steps.resize(kMostSteps);
  return steps;
}

}  // namespace selfcal
