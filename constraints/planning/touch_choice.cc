#include "constraints/planning/touch_choice.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "constraints/identifiability/endpoint_sigma.h"
#include "constraints/identifiability/given_doubt.h"
#include "constraints/methods/shared/unit_normal.h"
#include "constraints/planning/better_places.h"
#include "constraints/planning/detmax.h"
#include "constraints/sampling/random_poses.h"
#include "constraints/sampling/workspace_poses.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr double kNoise = 2e-5;          // m, where a set does not say its own
constexpr double kAngleNoise = 2e-5;     // rad, as well
constexpr double kLeastVariance = 1e-9;  // of a column's own, in any direction
constexpr double kLeastSeen = 1e-9;      // of the largest, of a motion that no row sees
constexpr int kTouchSweeps = 1;          // a session waits for its plan
constexpr int kJudgedPoses = 300;        // at which the end position is judged
constexpr unsigned long long kJudgedSeed = 1;

/// What is not known exactly of a surface or a socket.
struct PlaceUnknowns {
  int column = 0;          ///< first of three
  Eigen::Vector3d normal;  ///< that the plane's unknowns belong to
};

/// The set whose surface or sockets are those of set `s`.
int place_of(const std::vector<Set>& sets, int s) {
  return sets[s].reference < 0 ? s : sets[s].reference;
}

/// Columns of the surfaces and sockets, after those of the robot.
class Columns {
 public:
  Columns(int first, const std::vector<Set>& sets) : first_(first), sets_(sets) {}

  /// Takes the columns of the candidate's surface or socket in.
  void add(const PossibleTouch& candidate) {
    (void)of(candidate);
    (void)step_of(candidate);
  }

  /// That of the candidate's surface or socket; two faces that are a known distance apart are one
  /// place, and have one normal though their ways out are opposite.
  PlaceUnknowns of(const PossibleTouch& candidate) {
    const int place = place_of(sets_, candidate.set);
    const auto [found, added] =
        at_.try_emplace({place, candidate.group}, PlaceUnknowns{end(), candidate.outward});
    if (added) {
      const Set& set = sets_[place];
      const bool known = set.method->place_known();
      const double turn = known ? std::pow(doubt_of_turn(set), 2) : kPlaceVariance;
      variances_.insert(variances_.end(), 2, turn);
      variances_.push_back(known ? of_lengths(set, false) : kPlaceVariance);
    }
    return found->second;
  }

  /// That of the step from the face that the candidate's is a known distance from; -1 without.
  int step_of(const PossibleTouch& candidate) {
    const Set& set = sets_[candidate.set];
    if (set.reference < 0 || candidate.group >= 0) return -1;
    const bool opposite = of(candidate).normal.dot(candidate.outward) < 0;
    const auto [found, added] = step_.try_emplace(candidate.set, end());
    if (added) variances_.push_back(of_lengths(set, opposite));
    return found->second;
  }

  bool is_step(Eigen::Index column) const {
    return std::ranges::any_of(step_, [&](const auto& each) { return each.second == column; });
  }
  int end() const { return first_ + static_cast<int>(variances_.size()); }
  /// 1 sigma² of each beforehand.
  const std::vector<double>& variances() const { return variances_; }

 private:
  static double of_lengths(const Set& set, bool opposite) {
    double variance = 0;
    for (const KnownLength& each : set.method->known_lengths())
      variance += std::pow(each.sigma, 2) + std::pow(doubt_of_length(set, each, opposite), 2);
    return variance;
  }

  int first_;
  const std::vector<Set>& sets_;
  std::vector<double> variances_;
  std::map<std::pair<int, int>, PlaceUnknowns> at_;
  std::map<int, int> step_;
};

/// Rows of a candidate in the unknowns of its surface or socket, of the step from another face
/// (`step`, -1 without), and of the robot, whose body moves with `psi`.
Eigen::MatrixXd touch_row(const PossibleTouch& each, const PlaceUnknowns& nuisance, int step,
                          int columns, const Eigen::MatrixXd& psi, const Eigen::Vector3d& p) {
  const bool socket = each.group >= 0;
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(socket ? 3 : 1, columns);
  const Eigen::MatrixXd moves = psi.topRows<3>();
  W.leftCols(moves.cols()) = socket ? moves : Eigen::MatrixXd(nuisance.normal.transpose() * moves);
  if (socket)
    W.middleCols(nuisance.column, 3) = -Eigen::Matrix3d::Identity();
  else
    W.middleCols(nuisance.column, 3) << p.transpose() * tangents(nuisance.normal), -1;
  if (step >= 0) W(0, step) = -1;
  return W;
}

/// Of a lock: the leg's direction turns off the unknown one, dr_a = (u x e_a) . turn.
Eigen::MatrixXd lock_rows(const PlaceUnknowns& nuisance, int columns, const Eigen::MatrixXd& psi) {
  const auto E = tangents(nuisance.normal);
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(2, columns);
  for (int a = 0; a < 2; ++a) {
    const Eigen::Vector3d turn = nuisance.normal.cross(E.col(a));
    W.row(a).head(psi.cols()) = turn.transpose() * psi.bottomRows<3>();
    W(a, nuisance.column + a) = -1;
  }
  return W;
}

/// Whitened rows of the candidates, one matrix each (1 row for a surface, 3 for a socket, 2 for a
/// lock).
std::vector<Eigen::MatrixXd> rows_of(const Robot& robot, const Eigen::VectorXd& xi,
                                     const std::vector<Set>& sets,
                                     const std::vector<PossibleTouch>& candidates,
                                     Columns& columns) {
  for (const PossibleTouch& each : candidates) columns.add(each);
  const auto parameters = static_cast<Eigen::Index>(robot.parameters().size());
  std::vector<Eigen::MatrixXd> rows;
  ConfigurationBlock block{Eigen::ArrayXXd(kLanes, static_cast<int>(robot.joints().size())), 0};
  Locations X;
  PsiBlock psi;
  for (std::size_t first = 0; first < candidates.size(); first += block.count) {
    const Body body = sets[candidates[first].set].method->body();
    block.count = 0;
    while (block.count < kLanes && first + block.count < candidates.size() &&
           sets[candidates[first + block.count].set].method->body() == body)
      ++block.count;
    for (int lane = 0; lane < kLanes; ++lane)
      block.q.row(lane) = candidates[first + std::min(lane, block.count - 1)].q.transpose().array();
    robot.locate(block, xi, body, X, &psi);
    for (int lane = 0; lane < block.count; ++lane) {
      const PossibleTouch& each = candidates[first + lane];
      Eigen::MatrixXd moves(6, parameters);
      for (int c = 0; c < 6; ++c) moves.row(c) = psi.row(c * kLanes + lane);
      const Set& set = sets[each.set];
      if (set.method->planned() == Planned::lock)
        rows.push_back(lock_rows(columns.of(each), columns.end(), moves) / angle_noise(set));
      else
        rows.push_back(touch_row(each, columns.of(each), columns.step_of(each), columns.end(),
                                 moves, X.p(lane)) /
                       touch_noise(set));
    }
  }
  return rows;
}

/// Of each column before any touch, `given` of the robot's parameters (without rows: the makers'
/// tolerances); zero of what is known exactly.
Eigen::MatrixXd prior_covariance(const Robot& robot, const Eigen::MatrixXd& given,
                                 const Columns& columns) {
  const auto parameters = static_cast<Eigen::Index>(robot.parameters().size());
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(columns.end(), columns.end());
  if (given.rows() > 0) C.topLeftCorner(parameters, parameters) = given;
  for (Eigen::Index i = 0; i < parameters; ++i) {
    const Parameter& each = robot.parameters()[static_cast<std::size_t>(i)];
    if (!each.free && C(i, i) <= 0) C(i, i) = std::pow(doubt_of_fixed(each), 2);
    if (each.free && given.rows() == 0) C(i, i) = std::pow(each.tolerance, 2);
  }
  Eigen::Index at = parameters;
  for (const double variance : columns.variances()) {
    C(at, at) = variance;
    ++at;
  }
  return C;
}

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
      : robot_(robot),
        xi_(xi),
        sets_(sets),
        columns_(static_cast<int>(robot.parameters().size()), sets) {
    for (const PossibleTouch& each : candidates) columns_.add(each);
    for (const PossibleTouch& each : known.made) columns_.add(each);
    const Eigen::MatrixXd covariance = prior_covariance(robot, known.prior, columns_);
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

  /// Rows of touches of surfaces and sockets that the candidates have.
  std::vector<Eigen::MatrixXd> rows(const std::vector<PossibleTouch>& touches) {
    std::vector<Eigen::MatrixXd> rows = rows_of(robot_, xi_, sets_, touches, columns_);
    for (Eigen::MatrixXd& each : rows) each = each(Eigen::all, open_).eval();
    return rows;
  }
  Design of(const std::vector<PossibleTouch>& touches, std::vector<int> kinds) {
    return {rows(touches), objective_, std::move(kinds)};
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
  Columns columns_;
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
  return endpoint_weight(question);
}

/// Moves those of the candidates that identify.
void move_touches(const Robot& robot, const std::vector<PossibleTouch>& candidates,
                  const std::vector<int>& fit, TouchDesigns& designs, const TouchMoves& moves,
                  const Progress& progress) {
  std::vector<PossibleTouch> touches;
  for (const int i : fit) touches.push_back(candidates[i]);
  Design design = designs.of(touches, {});
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

Eigen::MatrixXd inverse_of_covariance(const Eigen::MatrixXd& C) {
  const Eigen::VectorXd by = C.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd one = by.asDiagonal() * C * by.asDiagonal();
  return by.asDiagonal() *
         inverse_of_positive(one + kLeastVariance * Eigen::MatrixXd::Identity(C.rows(), C.cols())) *
         by.asDiagonal();
}

Eigen::MatrixXd unseen_by_touches(const Robot& robot, const Eigen::VectorXd& xi,
                                  const std::vector<Set>& sets,
                                  const std::vector<PossibleTouch>& touches) {
  Eigen::MatrixXd seen = Eigen::MatrixXd::Zero(6, 6);  // of the motions that rows would tell
  for (const PossibleTouch& each : touches) {
    if (!sets[place_of(sets, each.set)].method->place_known()) continue;
    const Eigen::Vector3d p = locate(robot, xi, each.q).p;
    Eigen::Matrix<double, 6, 1> row;
    row << each.outward, p.cross(each.outward);
    seen += row * row.transpose();
  }
  const Symmetric eigen = symmetric_eigen(seen);
  const double least = kLeastSeen * std::max(1.0, eigen.values.maxCoeff());
  const Eigen::Index unseen = (eigen.values.array() <= least).count();
  return eigen.vectors.leftCols(unseen);  // the values come in increasing order
}

double touch_noise(const Set& set) { return set.noise > 0 ? set.noise : kNoise; }

double angle_noise(const Set& set) { return set.noise_angle > 0 ? set.noise_angle : kAngleNoise; }

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
  Design design = designs.of(candidates, kinds.of);
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
  Design design =
      TouchDesigns(robot, xi, sets, touches, {prior, {}}, weight, Given::doubted).of(touches, {});
  std::vector<int> all(touches.size());
  std::iota(all.begin(), all.end(), 0);
  design.choose(all);
  std::vector<double> sigma;
  for (const double merit : left_out_one_by_one(design, progress))
    sigma.push_back(std::sqrt(-merit));
  return sigma;
}

Eigen::MatrixXd covariance_after(const Robot& robot, const Eigen::VectorXd& xi,
                                 const std::vector<Set>& sets,
                                 const std::vector<PossibleTouch>& touches,
                                 const Eigen::MatrixXd& prior) {
  Columns columns(static_cast<int>(robot.parameters().size()), sets);
  const std::vector<Eigen::MatrixXd> rows = rows_of(robot, xi, sets, touches, columns);
  Eigen::MatrixXd C = prior_covariance(robot, prior, columns);
  for (const Eigen::MatrixXd& W : rows)
    for (Eigen::Index a = 0; a < W.rows(); ++a) {
      const Eigen::VectorXd gain = C * W.row(a).transpose();
      C -= gain * gain.transpose() / (1 + W.row(a).dot(gain));
    }
  const auto parameters = static_cast<Eigen::Index>(robot.parameters().size());
  return C.topLeftCorner(parameters, parameters);
}

}  // namespace selfcal
