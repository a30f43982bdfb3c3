#include "constraints/planning/touch_choice.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "constraints/identifiability/endpoint_sigma.h"
#include "constraints/planning/better_places.h"
#include "constraints/planning/detmax.h"
#include "constraints/sampling/random_poses.h"
#include "constraints/sampling/workspace_poses.h"

namespace selfcal {
namespace {

constexpr int kTouchSweeps = 1;    // a session waits for its plan
constexpr int kJudgedPoses = 300;  // at which the end position is judged
constexpr unsigned long long kJudgedSeed = 1;
/// Of the variance of what touches of the surfaces themselves would read, beside that of the end
/// position. Rows kept aside judge there: where a surface is known along a line alone they judge
/// nothing. Of 120 surfaces planned with a hundredth of that four were, with three hundredths one,
/// and the end position is known as well.
constexpr double kSurfacesCount = 0.03;

/// Poses where the end position counts: in the workspace's box, else over all that the joints can
/// do, for the region of the touches is what is chosen.
Eigen::MatrixXd judged_poses(const Robot& robot, const Eigen::VectorXd& xi,
                             const Workspace& workspace) {
  if (workspace.box) {
    Eigen::MatrixXd poses = workspace_poses(robot, xi, workspace, {}, kJudgedPoses, kJudgedSeed);
    if (poses.rows() > 0) return poses;
  }
  return closing_poses(robot, xi, random_poses(robot, nullptr, kJudgedPoses, kJudgedSeed));
}

/// The touches of a surface, or of one socket or nest of a set, which are exchanged for each other.
struct Kinds {
  std::vector<int> of;     ///< by candidate
  std::vector<int> set;    ///< by kind
  std::vector<int> share;  ///< by kind: of the touches of its set
};

/// Every socket of a set has as many touches as the others.
Kinds kinds_of(const std::vector<PossibleTouch>& candidates, const std::vector<int>& counts) {
  Kinds kinds;
  std::map<std::pair<int, int>, int> number;
  std::vector<int> of_set(counts.size(), 0);
  for (const PossibleTouch& each : candidates) {
    const auto [found, added] =
        number.try_emplace({each.set, each.group}, static_cast<int>(kinds.set.size()));
    if (added) {
      kinds.set.push_back(each.set);
      ++of_set[each.set];
    }
    kinds.of.push_back(found->second);
  }
  for (const int set : kinds.set)
    kinds.share.push_back((counts[set] + of_set[set] - 1) / of_set[set]);
  return kinds;
}

/// Ratios that are held and steps between faces: touches hardly differ in what these make of the
/// end position, and a choice among them is as good, and quicker, with both taken as exact.
enum class Given { exact, doubted };

/// Designs of touches for the end position, in the columns that are not known; `weight` is of the
/// robot's parameters.
class TouchDesigns {
 public:
  TouchDesigns(const Robot& robot, const Eigen::VectorXd& xi, const std::vector<Set>& sets,
               const std::vector<PossibleTouch>& candidates, const KnownBefore& known,
               const Eigen::MatrixXd& weight, Given given)
      : robot_(robot), xi_(xi), sets_(sets), columns_(robot, sets) {
    for (const PossibleTouch& each : candidates) columns_.add(each);
    for (const PossibleTouch& each : known.made) columns_.add(each);
    const Eigen::MatrixXd covariance = covariance_before(robot, known.prior, columns_);
    for (Eigen::Index c = 0; c < covariance.rows(); ++c)
      if (covariance(c, c) > 0 && (given == Given::doubted || !is_given(c))) open_.push_back(c);
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(covariance.rows(), covariance.rows());
    all.topLeftCorner(weight.rows(), weight.cols()) = weight;
    objective_.criterion = Criterion::sigma;
    objective_.prior = inverse_of_covariance(covariance(open_, open_));
    objective_.weight = all(open_, open_);
    objective_.nuisance =
        std::ranges::count_if(open_, [&](Eigen::Index c) { return c >= weight.rows(); });
    for (const Eigen::MatrixXd& W : rows(known.made)) objective_.prior += W.transpose() * W;
  }

  /// Counts what the candidates, of rows `W`, would read of each surface or socket as well.
  void count_surfaces(const std::vector<PossibleTouch>& candidates,
                      const std::vector<Eigen::MatrixXd>& W, const Kinds& kinds) {
    std::vector<double> each(kinds.set.size(), 0);
    for (const int kind : kinds.of) ++each[static_cast<std::size_t>(kind)];
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(objective_.weight.rows(), objective_.weight.cols());
    for (std::size_t i = 0; i < W.size(); ++i) {
      const double noise = touch_noise(sets_[static_cast<std::size_t>(candidates[i].set)]);
      sum += noise * noise / each[static_cast<std::size_t>(kinds.of[i])] * W[i].transpose() * W[i];
    }
    objective_.weight += kSurfacesCount / static_cast<double>(each.size()) * sum;
  }

  /// Rows of touches of surfaces and sockets that the candidates have.
  std::vector<Eigen::MatrixXd> rows(const std::vector<PossibleTouch>& touches) {
    std::vector<Eigen::MatrixXd> rows = touch_rows(robot_, xi_, sets_, touches, columns_);
    for (Eigen::MatrixXd& each : rows) each = each(Eigen::all, open_).eval();
    return rows;
  }
  Design of(const std::vector<Eigen::MatrixXd>& rows, std::vector<int> kinds) const {
    return {rows, objective_, std::move(kinds)};
  }

 private:
  bool is_given(Eigen::Index column) const {
    const auto& parameters = robot_.parameters();
    const auto at = static_cast<std::size_t>(column);
    return at < parameters.size() ? !parameters[at].free : columns_.is_step(column);
  }

  const Robot& robot_;
  const Eigen::VectorXd& xi_;
  const std::vector<Set>& sets_;
  PlaceColumns columns_;
  std::vector<Eigen::Index> open_;
  Objective objective_;
};

/// Of the end position over the poses where it counts.
Eigen::MatrixXd weight_of(const Robot& robot, const Eigen::VectorXd& xi,
                          const std::vector<Set>& sets,
                          const std::vector<PossibleTouch>& candidates,
                          const Workspace& workspace) {
  EndpointQuestion question;
  question.robot = &robot;
  question.xi = xi;
  question.unseen = unseen_by_touches(robot, xi, sets, candidates);
  question.point_unknown = std::ranges::none_of(
      candidates, [&](const PossibleTouch& each) { return sets[each.set].method->sees_point(); });
  question.poses = judged_poses(robot, xi, workspace);
  return endpoint_deviations(question).weight;
}

/// Moves those of the candidates that identify.
void move_touches(const Robot& robot, const std::vector<PossibleTouch>& candidates,
                  const std::vector<int>& fit, TouchDesigns& designs, const TouchMoves& moves,
                  const Progress& progress) {
  std::vector<PossibleTouch> touches;
  for (const int i : fit) touches.push_back(candidates[i]);
  Design design = designs.of(designs.rows(touches), {});
  std::vector<int> all(fit.size());
  std::iota(all.begin(), all.end(), 0);
  design.choose(all);
  Eigen::VectorXd range(static_cast<Eigen::Index>(robot.joints().size()));
  for (Eigen::Index j = 0; j < range.size(); ++j)
    range[j] = robot.joints()[static_cast<std::size_t>(j)].range();
  Moves of_design;
  of_design.sweeps = kTouchSweeps;
  of_design.range = [&](int) { return range; };
  of_design.look = [&](int unit, const Eigen::MatrixXd& by) {
    const auto looked = moves.look(fit[static_cast<std::size_t>(unit)], by);
    std::vector<PossibleTouch> possible;
    for (const auto& each : looked)
      if (each) possible.push_back(*each);
    std::vector<Eigen::MatrixXd> list(looked.size());
    if (possible.empty()) return list;
    std::vector<Eigen::MatrixXd> rows = designs.rows(possible);
    std::size_t next = 0;
    for (std::size_t i = 0; i < looked.size(); ++i)
      if (looked[i]) list[i] = std::move(rows[next++]);
    return list;
  };
  of_design.take = [&](int unit, int column) {
    return moves.take(fit[static_cast<std::size_t>(unit)], column);
  };
  move_to_better_places(design, of_design, progress);
}

/// The best one after the other, `left` of each set and no more of a kind than `share`.
void choose_one_by_one(Design& design, const Kinds& kinds, std::vector<int>& left,
                       std::vector<int> share) {
  for (;;) {
    std::pair<int, double> best{-1, 0};
    for (std::size_t kind = 0; kind < kinds.set.size(); ++kind) {
      if (left[kinds.set[kind]] <= 0 || share[kind] <= 0) continue;
      const std::pair<int, double> each = design.best(+1, static_cast<int>(kind));
      if (each.first >= 0 && (best.first < 0 || each.second > best.second)) best = each;
    }
    if (best.first < 0) return;
    design.change(best.first, +1);
    const int kind = design.kind(best.first);
    --left[kinds.set[kind]];
    --share[kind];
  }
}

}  // namespace

TouchChoice choose_touches(const Robot& robot, const Eigen::VectorXd& xi,
                           const std::vector<Set>& sets,
                           const std::vector<PossibleTouch>& candidates, const TouchCounts& counts,
                           const Workspace& workspace, Random& random, const Progress& progress,
                           const TouchMoves& moves, const KnownBefore& known) {
  TouchChoice choice;
  if (candidates.empty()) return choice;
  const Kinds kinds = kinds_of(candidates, counts.fit);
  TouchDesigns designs(robot, xi, sets, candidates, known,
                       weight_of(robot, xi, sets, candidates, workspace), Given::exact);
  const std::vector<Eigen::MatrixXd> W = designs.rows(candidates);
  designs.count_surfaces(candidates, W, kinds);
  Design design = designs.of(W, kinds.of);
  std::vector<int> wanted = counts.fit;
  choose_one_by_one(design, kinds, wanted, kinds.share);
  // What a socket out of reach leaves goes to the others.
  choose_one_by_one(design, kinds, wanted, std::vector<int>(kinds.set.size(), INT_MAX));
  exchange(design, progress);
  choice.fit = design.chosen();
  if (moves.look) move_touches(robot, candidates, choice.fit, designs, moves, progress);
  // A socket or nest that nothing identifies judges nothing.
  std::set<std::pair<int, int>> identified;
  for (const int i : choice.fit) identified.emplace(candidates[i].set, candidates[i].group);
  for (const PossibleTouch& each : known.made) identified.emplace(each.set, each.group);
  std::vector<int> order(candidates.size()), left = counts.check;
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  for (const int i : order)
    if (!design.has(i) && identified.contains({candidates[i].set, candidates[i].group}) &&
        left[candidates[i].set]-- > 0)
      choice.check.push_back(i);
  return choice;
}

std::vector<double> sigma_by_count(const Robot& robot, const Eigen::VectorXd& xi,
                                   const std::vector<Set>& sets,
                                   const std::vector<PossibleTouch>& touches,
                                   const Eigen::MatrixXd& weight, const Progress& progress,
                                   const Eigen::MatrixXd& prior) {
  TouchDesigns designs(robot, xi, sets, touches, {prior, {}}, weight, Given::doubted);
  Design design = designs.of(designs.rows(touches), {});
  std::vector<int> all(touches.size());
  std::iota(all.begin(), all.end(), 0);
  design.choose(all);
  std::vector<double> sigma;
  for (const double merit : left_out_one_by_one(design, progress))
    sigma.push_back(std::sqrt(-merit));
  return sigma;
}

}  // namespace selfcal
