// Expected log evidence of A over B, A true: half of what A's rows leave beyond geometry and B, in
// squared sigmas. The odds after the new rows are those of now times the exponential of its growth.
#include "diagnosis/report/experiment_design.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "diagnosis/report/further_rows.h"
#include "diagnosis/search/causes.h"
#include "kinematics/corrected_robot.h"
#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr double kWorth = 0.02;  ///< of probability that a step must bring to be told
constexpr size_t kMostSteps = 3;

/// Rows of the geometry, A's own columns and B's, of a data set; whitened.
class Paper {
 public:
  Paper(const LinearisedModel& view, const std::vector<Node>& a, const std::vector<Node>& b)
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
    expects(robot != nullptr, "causes that were weighed are effects that the robot can have");
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

  const LinearisedModel& view_;
  Eigen::Index of_a_;
  std::vector<Node> entries_;
  Eigen::VectorXd value_;
};

/// The cause among the candidates that stands first in the verdict's list of look-alikes.
const CauseResult* look_alike(const Diagnosis& diagnosis) {
  for (const CauseResult& each : diagnosis.candidates)
    for (const std::string& name : diagnosis.verdict.confounded_with)
      if (each.effect != diagnosis.verdict.effect && !each.correction.empty() &&
          name.substr(0, name.find('@')) == each.effect)
        return &each;
  return nullptr;
}

std::string first_label(const CauseResult& cause) {
  return label(cause.effect, cause.where.empty() ? "" : cause.where.front());
}

}  // namespace

std::vector<NextStep> next_steps(const LinearisedModel& view, const DataSet& data,
                                 const Diagnosis& diagnosis) {
  const CauseResult* other = look_alike(diagnosis);
  if (!other || diagnosis.verdict.correction.empty()) return {};
  const Paper paper(view, entries_of(diagnosis.verdict.correction), entries_of(other->correction));
  double nuisance = 0;  // as the candidates have it
  for (const CauseResult& each : diagnosis.candidates)
    if (each.effect == diagnosis.verdict.effect) nuisance = each.probability;
  const double p = std::clamp(nuisance / (nuisance + other->probability), 0.01, 0.99);
  const double now = paper.apart(data);
  std::vector<NextStep> steps;
  for (const CandidateRows& further : candidate_rows(view, data)) {
    const DataSet& more = further.both;
    const double gain = (paper.apart(more) - now) / 2;
    const double after = 1 / (1 + (1 - p) / p * std::exp(-std::max(gain, 0.0)));
    if (after <= p + kWorth) continue;
    std::vector<int> added(more.rows.rows() - data.rows.rows());
    std::iota(added.begin(), added.end(), data.rows.rows());
    steps.push_back({further.what,
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
