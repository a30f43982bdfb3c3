// A passive joint of the true platform is locked: from then on the leg keeps the direction that it
// had, but for the lock's own play, and every move gives way to it.
#include <algorithm>
#include <cmath>

#include "constraints/methods/shared/unit_normal.h"
#include "constraints/sampling/contact.h"
#include "kinematics/rotation.h"
#include "sim/machine.h"

namespace selfcal {

int Machine::set_of_lock(const std::string& lock) const {
  for (std::size_t s = 0; s < sets_.size(); ++s)
    if (sets_[s].method->planned() == Planned::lock && sets_[s].method->lock() == lock)
      return static_cast<int>(s);
  return -1;
}

void Machine::turn_lock(const MotionRequest& request) {
  const bool engages = request.kind == MoveKind::lock;
  const int set = engages ? set_of_lock(request.label) : -1;
  if (engages && (set < 0 || broken(MachineFault::What::lock_refuse, now_)))
    return reply(request.id, MotionReply::Outcome::refused,
                 "there is no lock of " + request.label + ", or it does not answer");
  reply(request.id, MotionReply::Outcome::accepted, "");
  label_ = request.label;
  turn_ = LockTurn{request.id, now_ + nanoseconds(settings_.lock_time), set};
}

void Machine::pass_lock(Nanoseconds until) {
  using What = MachineFault::What;
  if (turn_ && turn_->due <= until && !broken(What::lock_late, until)) {
    const LockTurn turn = *turn_;
    turn_.reset();
    if (turn.set >= 0) engage(turn.set);
    locked_ = turn.set;
    put_edge(turn.due, turn.set >= 0);
    reply(turn.id, MotionReply::Outcome::done, "");
  }
  if (locked_ < 0) return;
  if (broken(What::lock_open, until)) {
    locked_ = -1;
    return put_edge(until, false);
  }
}

/// Where the scenario says so.
void Machine::slip() {
  if (std::ranges::count(settings_.lock_slips, ++lock_visits_) == 0) return;
  const Eigen::VectorXd step = Eigen::Vector2d(settings_.lock_slip, 0);
  sets_[locked_].method->retract(truth_.nuisance[locked_], step);
}

/// With the leg as it stands.
void Machine::engage(int set) {
  const Eigen::VectorXd q = true_joints(path_.q(now_).transpose().array()).row(0).transpose();
  Random random = stream_of(label_);
  truth_.nuisance[set] = sets_[set].method->through(
      locate(*robot_, truth_.xi, q, sets_[set].method->body()), nullptr, random);
}

/// The readings nearest those asked for that the engaged lock allows, within its play.
Eigen::VectorXd Machine::give_way(const MotionRequest& request) {
  ++visits_[request.label];
  Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(
      request.q.data(), static_cast<Eigen::Index>(request.q.size()));
  if (locked_ < 0) return q;
  slip();
  DataSet data;
  data.sets = sets_;
  data.rows.set = {locked_};
  data.rows.group = {-1};
  Random random = stream_of(request.label);
  std::normal_distribution<double> normal;
  Eigen::VectorXd wanted(2);
  for (double& each : wanted) each = scenario_.sets[locked_].noise * normal(random);
  move_to_residual(*robot_, data, truth_, 0, wanted, q);
  return q;
}

}  // namespace selfcal
