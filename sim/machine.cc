#include "sim/machine.h"

#include <algorithm>
#include <cmath>

#include "kinematics/corrected_robot.h"
#include "sim/true_sets.h"

namespace selfcal {
namespace {

constexpr double kFinestStep = 1e-9;  // rad or m, of an encoder without a step
constexpr Nanoseconds kBounce = 40'000;
constexpr double kDrifts = 3600;  // s, over which a base drifts
constexpr Nanoseconds kAfterglow = kSecond / 2;

template <class T>
void bound(std::deque<T>& queue, std::size_t most) {
  while (queue.size() > most) queue.pop_front();
}

template <class T>
void hand_over(std::deque<T>& queue, std::vector<T>& out) {
  out.insert(out.end(), queue.begin(), queue.end());
  queue.clear();
}

std::vector<TrueSurface> true_surfaces(const Scenario& scenario, const std::vector<Set>& sets,
                                       const std::vector<Eigen::VectorXd>& nuisance) {
  std::vector<TrueSurface> surfaces;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const std::optional<Plane> plane = true_plane(sets, s, nuisance);
    if (!plane || !plane->d) continue;
    const Eigen::Vector3d outward = *outward_normal(scenario, sets, s, nuisance);
    surfaces.push_back(
        {static_cast<int>(s), outward, plane->n.dot(outward) * *plane->d, scenario.sets[s].within});
  }
  return surfaces;
}

bool holds(const MachineFault& fault, Nanoseconds t) {
  return seconds(t) >= fault.at && seconds(t) < fault.at + fault.duration;
}

/// True locations of the sockets and nests, one column a group.
Eigen::MatrixXd true_groups(const SetScenario& scenario, const Method& method) {
  Eigen::MatrixXd groups;
  for (const Location& place : scenario.places) {
    const Eigen::VectorXd values = method.start_group({place});
    groups.conservativeResize(values.size(), groups.cols() + 1);
    groups.rightCols(1) = values;
  }
  return groups;
}

}  // namespace

Machine::Machine(const Scenario& scenario, std::shared_ptr<const Robot> robot, Eigen::VectorXd home,
                 Problems& problems)
    : scenario_(scenario),
      settings_(scenario.machine),
      robot_(std::move(robot)),
      path_(std::move(home)) {
  sets_ = make_sets(scenario, problems);
  truth_.xi = true_parameters(scenario, *robot_, problems);
  if (problems.any()) return;
  compliance_ = true_compliance(scenario, *robot_, truth_.xi, problems);
  truth_.nuisance = true_own_values(scenario, sets_, *robot_, truth_.xi, problems);
  if (problems.any()) return;
  for (std::size_t s = 0; s < sets_.size(); ++s) {
    if (!scenario.sets[s].locked.empty())
      problems.add(*scenario.sets[s].locked_place,
                   "set " + sets_[s].name + " locked: a machine has every joint free");
    const std::optional<Plane> plane = true_plane(sets_, s, truth_.nuisance);
    const bool known = plane && plane->d;
    if (known && scenario.sets[s].within.radius <= 0)
      problems.add(scenario.sets[s].entry.place,
                   "set " + sets_[s].name + ": a machine needs `within` of every surface");
    if (!known && scenario.sets[s].places.empty() && sets_[s].method->planned() != Planned::lock)
      problems.add(scenario.sets[s].entry.place,
                   "set " + sets_[s].name + ": a machine needs planes, locks or `places`");
    truth_.groups.push_back(true_groups(scenario.sets[s], *sets_[s].method));
    for (std::size_t g = 0; g < scenario.sets[s].places.size(); ++g)
      if (sets_[s].groups.size() <= g) sets_[s].groups.push_back("g" + std::to_string(g));
  }
  if (problems.any()) return;
  for (const MachineFault& fault : settings_.faults)
    if (fault.what == MachineFault::What::misread && find_joint(*robot_, fault.joint) < 0)
      problems.list.push_back("machine fault misread: the robot has no joint " + fault.joint);
  if (problems.any()) return;
  surfaces_ = true_surfaces(scenario, sets_, truth_.nuisance);
  add_effects(problems);
  const double step = scenario.encoder_step > 0 ? scenario.encoder_step : kFinestStep;
  scales_.assign(robot_->joints().size(), {step, 0});
}

/// From here on the true robot is the nominal one with what the model lacks.
void Machine::add_effects(Problems& problems) {
  if (settings_.effects.empty()) return;
  MeasurementContext context;
  context.end = kDrifts;
  context.velocities = context.speeds = true;
  context.reference = settings_.temperature;
  for (const Set& set : sets_) context.sets.emplace_back().name = set.name;
  for (const TrueSurface& surface : surfaces_) {
    MeasuredSet& set = context.sets[static_cast<std::size_t>(surface.set)];
    set.touch = TouchedSurface::plane;
    set.centre = surface.within.centre;
    set.normal = surface.outward;
  }
  if (settings_.warming != 0)
    for (double t = 0; t <= 24 * 3600; t += 60) {
      context.times.push_back(t);
      context.temperatures.push_back(settings_.temperature + settings_.warming * t / 3600);
    }
  std::shared_ptr<const Robot> robot = correct(robot_, settings_.effects, context, problems);
  if (!robot) return;
  const Eigen::Index geometry = truth_.xi.size();
  const Eigen::VectorXd all = values(*robot);
  truth_.xi.conservativeResize(all.size());
  truth_.xi.tail(all.size() - geometry) = all.tail(all.size() - geometry);
  robot_ = std::move(robot);
}

bool Machine::broken(MachineFault::What what, Nanoseconds t) const {
  return std::ranges::any_of(settings_.faults, [&](const MachineFault& fault) {
    return fault.what == what && holds(fault, t);
  });
}

bool Machine::busy() const { return moving_ || turn_ || now_ < last_motion_ + kAfterglow; }

double Machine::celsius() const {
  return settings_.temperature + settings_.warming * seconds(now_) / 3600;
}

EncoderSample Machine::sample(Nanoseconds t) const {
  EncoderSample sample;
  sample.time = t;
  sample.joints = static_cast<int>(scales_.size());
  Eigen::VectorXd q = path_.q(t);
  for (const MachineFault& fault : settings_.faults)
    if (fault.what == MachineFault::What::misread && holds(fault, t))
      q[find_joint(*robot_, fault.joint)] += fault.by;
  for (int j = 0; j < sample.joints; ++j) sample.counts[j] = std::llround(q[j] / scales_[j].step);
  return sample;
}

void Machine::advance(Nanoseconds now) {
  if (now <= now_) return;
  pass_crossings(now);
  pass_lock(now);
  if (moving_ && now >= path_.end()) {
    now_ = path_.end();
    last_motion_ = now_;
    reply(moving_->id, MotionReply::Outcome::done, "");
    moving_.reset();
  }
  const auto most = static_cast<Nanoseconds>(EncoderSource::kMostSamples);
  Nanoseconds t = std::max(sampled_ + period(), (now / period() - most) * period());
  for (; t <= now; t += period()) {
    if (!broken(MachineFault::What::encoders, t)) samples_.push_back(sample(t));
    sampled_ = t;
  }
  bound(samples_, EncoderSource::kMostSamples);
  now_ = now;
  stick(now);
}

Nanoseconds Machine::next_sample() const { return sampled_ + period(); }

std::optional<Nanoseconds> Machine::next_edge() const {
  if (ahead_.empty()) return std::nullopt;
  const Nanoseconds when = path_.when(ahead_.front().s);
  if (when > path_.end()) return std::nullopt;
  return when + nanoseconds(settings_.trigger_delay);
}

void Machine::stick(Nanoseconds until) {
  const bool stuck = broken(MachineFault::What::stuck, until);
  if (stuck == stuck_) return;
  stuck_ = stuck;
  if (closed_ != stuck) edges_.push_back({until, stuck});
  closed_ = stuck;
}

void Machine::put_edge(Nanoseconds time, bool closed) {
  if (stuck_ || closed_ == closed) return;
  closed_ = closed;
  const Nanoseconds at = time + nanoseconds(settings_.trigger_delay);
  edges_.push_back({at, closed});
  for (int i = 0; i < settings_.bounce; ++i) {
    edges_.push_back({at + (2 * i + 1) * kBounce, !closed});
    edges_.push_back({at + (2 * i + 2) * kBounce, closed});
  }
  bound(edges_, TouchTrigger::kMostEdges);
}

void Machine::pass_crossings(Nanoseconds until) {
  while (!ahead_.empty()) {
    const Nanoseconds when = path_.when(ahead_.front().s);
    if (when > until || when > path_.end()) return;
    put_edge(when, ahead_.front().closes);
    ahead_.erase(ahead_.begin());
  }
}

void Machine::reply(std::uint64_t id, MotionReply::Outcome outcome, std::string why) {
  replies_.push_back({id, outcome, std::move(why)});
  bound(replies_, 64);
}

void Machine::request(const MotionRequest& request) {
  if (broken(MachineFault::What::silent, now_)) return;
  const auto refuse = [&](const std::string& why) {
    reply(request.id, MotionReply::Outcome::refused, why);
  };
  if (broken(MachineFault::What::refuse, now_)) return refuse("the drives are off");
  if (request.q.size() != robot_->joints().size())
    return refuse("the robot has " + std::to_string(robot_->joints().size()) + " joints");
  for (std::size_t j = 0; j < request.q.size(); ++j) {
    const Joint& joint = robot_->joints()[j];
    if (!joint.allows(request.q[j]))
      return refuse(joint.name + " cannot go to " + format_number(request.q[j]));
  }
  if (const std::string why = cannot_stand(request); !why.empty()) return refuse(why);
  if (moving_) stop("another move was asked for");
  if (request.kind == MoveKind::lock || request.kind == MoveKind::release)
    return turn_lock(request);
  begin(request);
}

/// Of a machine with loops: why they do not close where it shall go.
std::string Machine::cannot_stand(const MotionRequest& request) const {
  if (!robot_->has_loops()) return {};
  ConfigurationBlock block = block_of(Eigen::Map<const Eigen::VectorXd>(
      request.q.data(), static_cast<Eigen::Index>(request.q.size())));
  block.q = true_joints(block.q);
  Locations X;
  const Closure closure = robot_->locate(block, truth_.xi, Body::endpoint, X, nullptr);
  return closure.closes() ? "" : "it cannot stand there: " + closure.why[0];
}

void Machine::begin(const MotionRequest& request) {
  const Eigen::VectorXd here = path_.q(now_);
  Eigen::VectorXd target = Eigen::Map<const Eigen::VectorXd>(
      request.q.data(), static_cast<Eigen::Index>(request.q.size()));
  if (request.kind == MoveKind::seat) target = seat(request, here);
  if (request.kind == MoveKind::visit) target = give_way(request);
  path_ = Trajectory(here, target, std::min(request.speed, settings_.speed), settings_.acceleration,
                     now_);
  ahead_ = crossings(request, path_);
  moving_ = request;
  label_ = request.label;
  last_motion_ = now_;
  reply(request.id, MotionReply::Outcome::accepted, "");
}

void Machine::stop(const std::string& why) {
  if (!moving_ || broken(MachineFault::What::silent, now_)) return;
  path_.stop(now_);
  pass_crossings(path_.end());
  ahead_.clear();
  reply(moving_->id, MotionReply::Outcome::stopped, why);
  moving_.reset();
  last_motion_ = std::max(now_, path_.end());
}

void Machine::take(std::vector<EncoderSample>& out) { hand_over(samples_, out); }
void Machine::take(std::vector<Edge>& out) { hand_over(edges_, out); }
void Machine::take(std::vector<MotionReply>& out) { hand_over(replies_, out); }

}  // namespace selfcal
