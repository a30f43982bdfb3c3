// Touches that could be made of the surfaces, sockets and locks of a cell, each with a way in and
// out.
//
// Random configurations touch a surface, several postures at one point, or sit in a socket. Usable
// are those whose tool leans no farther than it may from the way in, and that are entered along a
// straight joint path from home, straight in from the clearance on, slowly at last, with nothing in
// the way.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/planning/planned_touch.h"

namespace selfcal {

/// All that it is made of outlives it.
class TouchCandidates {
 public:
  TouchCandidates(const Robot& robot, const Eigen::VectorXd& xi, const std::vector<Set>& sets,
                  const std::vector<Obstacle>& obstacles, const TouchPlanOptions& options)
      : robot_(robot), xi_(xi), sets_(sets), obstacles_(obstacles), options_(options) {}

  /// A touch of a plane moved by each column of `by` and brought back to it by the least change;
  /// nothing where it is out of its patch or the joints' limits.
  std::vector<std::optional<Eigen::VectorXd>> moved(const TouchTarget& target,
                                                    const PlannedTouch& touch,
                                                    const Eigen::MatrixXd& by) const;

  /// The touch at readings `q`, where it can be made.
  std::optional<PlannedTouch> at(const TouchTarget& target, const PlannedTouch& touch,
                                 const Eigen::VectorXd& q) const;

  /// `tell` hears of the share of the wanted ones that is found.
  std::vector<PlannedTouch> of(const TouchTarget& target, Random& random,
                               const std::function<void(double)>& tell) const;

 private:
  void sample(const TouchTarget& target, Random& random, std::vector<PlannedTouch>& usable) const;
  /// Anywhere on the nominal surface within its patch, but at its edge, which a touch may miss (m).
  Eigen::Vector3d point_of(const TouchTarget& target, Random& random) const;
  /// The same, far enough from the points of the usable touches; nothing where none was found.
  std::optional<Eigen::Vector3d> spaced_point(const TouchTarget& target,
                                              const std::vector<PlannedTouch>& usable,
                                              Random& random) const;
  /// Those of the sampled configurations that are usable.
  void take(const TouchTarget& target, const std::shared_ptr<const Method>& method,
            const SampleRequest& request, Random& random, std::vector<PlannedTouch>& usable) const;
  /// Those of `touches`, of rows `rows` of `data`, that can be made, with where they begin and
  /// where they are given up.
  std::vector<PlannedTouch> entered(const TouchTarget& target, const DataSet& data,
                                    const State& truth, const std::vector<int>& rows,
                                    const std::vector<PlannedTouch>& touches) const;
  /// Nothing in the way of a touch whose ends are known.
  bool free_to_enter(const TouchTarget& target, const PlannedTouch& touch) const;
  /// Through home the robot comes to where it becomes slow, and goes back from there, at once.
  bool straight_from_home(const PlannedTouch& touch, int obstacle) const;
  bool locks(int set) const { return sets_[set].method->planned() == Planned::lock; }

  const Robot& robot_;
  const Eigen::VectorXd& xi_;
  const std::vector<Set>& sets_;
  const std::vector<Obstacle>& obstacles_;
  const TouchPlanOptions& options_;
};

}  // namespace selfcal
