// Expected log evidence of A over B, A true: half of what A's rows leave beyond geometry and B, in
// squared sigmas. The odds after the new rows are those of now times the exponential of its growth.
#include "diagnosis/report/experiment_design.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "diagnosis/report/further_rows.h"
#include "diagnosis/search/causes.h"
#include "kinematics/corrected_robot.h"
#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr double kWorth = 0.02;  ///< of probability that a step must bring to be worth its while
constexpr size_t kMostSteps = 3, kMostForUnknown = 4;
constexpr double kEdge = 0.05;  ///< least probable cause that may yet be there where none is named

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

std::string first_label(const CauseResult& cause) {
  return label(cause.effect, cause.where.empty() ? "" : cause.where.front());
}

/// Is it the one or the other? Without another one: or noise.
struct Question {
  const CauseResult* one;
  const CauseResult* other;
  double probability;  ///< of the one, now

  std::vector<std::string> names() const {
    return {first_label(*one), other ? first_label(*other) : std::string(kNone)};
  }
};

double odds(double one, double other) {
  return std::clamp(one / std::max(one + other, 1e-12), 0.01, 0.99);
}

/// The most probable of the causes that are listed as look-alikes; null where none of them is
/// known.
const CauseResult* look_alike(const Diagnosis& diagnosis, const CauseResult& of) {
  for (const CauseResult& each : diagnosis.candidates)
    for (const std::string& name : of.confounded_with)
      if (each.effect != of.effect && !each.correction.empty() &&
          name.substr(0, name.find('@')) == each.effect)
        return &each;
  return nullptr;
}

std::vector<Question> questions(const Diagnosis& diagnosis) {
  std::vector<Question> list;
  for (const CauseResult& each : diagnosis.named)
    if (const CauseResult* other = look_alike(diagnosis, each); other && !each.correction.empty())
      list.push_back({&each, other, odds(each.probability, other->probability)});
  if (names_effect(diagnosis.verdict.effect)) return list;
  double none = 0;
  for (const CauseResult& each : diagnosis.candidates)
    if (each.effect == kNone) none = each.probability;
  for (const CauseResult& each : diagnosis.candidates) {
    const bool named = std::ranges::count(diagnosis.named, each.effect, &CauseResult::effect) > 0;
    if (each.correction.empty() || each.probability < kEdge || named) continue;
    list.push_back({&each, nullptr, odds(each.probability, none)});
    break;
  }
  return list;
}

/// The structure may be anything: the answer, or what these rows cannot tell from it.
bool unknown_at_issue(const Diagnosis& diagnosis) {
  return diagnosis.verdict.effect == kUnknown ||
         std::ranges::any_of(diagnosis.named, [](const CauseResult& each) {
           return std::ranges::count(each.confounded_with, kUnknown) > 0;
         });
}

class Planner {
 public:
  Planner(const LinearisedModel& view, const DataSet& data, const Diagnosis& diagnosis)
      : view_(view), data_(data), diagnosis_(diagnosis), asked_(questions(diagnosis)) {}

  NextSteps run() {
    if (asked_.empty() && !unknown_at_issue(diagnosis_)) return {{}, why_nothing()};
    further_ = candidate_rows(view_, data_);
    for (const Question& each : asked_) try_all(each);
    std::ranges::stable_sort(next_.steps, std::ranges::greater{}, &NextStep::probability_after);
    if (next_.steps.size() > kMostSteps) next_.steps.resize(kMostSteps);
    if (unknown_at_issue(diagnosis_)) look_closer();
    if (next_.steps.empty() && next_.why.empty())
      next_.why = "this robot and these rows leave nothing to change from one visit to another";
    return std::move(next_);
  }

 private:
  std::string why_nothing() const {
    if (names_effect(diagnosis_.verdict.effect)) return "nothing looks like what is named";
    return "no cause is as probable as 5 %: more of the same rows would only lower that";
  }

  Observations rows_of(const CandidateRows& further) const {
    std::vector<int> added(further.both.rows.rows() - data_.rows.rows());
    std::iota(added.begin(), added.end(), data_.rows.rows());
    return taken(further.both.rows, added);
  }

  /// All that are worth their while; where none is, the best of them, and that it is not.
  void try_all(const Question& asked) {
    const Paper paper(view_, entries_of(asked.one->correction),
                      asked.other ? entries_of(asked.other->correction) : std::vector<Node>{});
    const double now = paper.apart(data_), p = asked.probability;
    std::vector<NextStep> steps;
    for (const CandidateRows& further : further_) {
      const double gain = std::max((paper.apart(further.both) - now) / 2, 0.0);
      steps.push_back(
          {further.what, asked.names(), 1 / (1 + (1 - p) / p * std::exp(-gain)), rows_of(further)});
    }
    if (steps.empty()) return;
    std::ranges::stable_sort(steps, std::ranges::greater{}, &NextStep::probability_after);
    if (steps.front().probability_after <= p + kWorth) {
      next_.why += (next_.why.empty() ? "" : "; ") + std::string("a dozen rows of no kind tell ") +
                   asked.names().front() + " from " + asked.names().back() +
                   ": take more of the first step's";
      steps.resize(1);
    }
    for (NextStep& each : steps)
      if (steps.size() == 1 || each.probability_after > p + kWorth)
        next_.steps.push_back(std::move(each));
  }

  /// What would show of which kind the structure is; how sure one would be then, nobody knows.
  void look_closer() {
    size_t told = 0;
    for (const CandidateRows& each : further_)
      if (!each.tells.empty() && told++ < kMostForUnknown)
        next_.steps.push_back({each.what,
                               {kUnknown, each.tells},
                               std::numeric_limits<double>::quiet_NaN(),
                               rows_of(each)});
  }

  const LinearisedModel& view_;
  const DataSet& data_;
  const Diagnosis& diagnosis_;
  const std::vector<Question> asked_;
  std::vector<CandidateRows> further_;
  NextSteps next_;
};

}  // namespace

NextSteps next_steps(const LinearisedModel& view, const DataSet& data, const Diagnosis& diagnosis) {
  return Planner(view, data, diagnosis).run();
}

}  // namespace selfcal
