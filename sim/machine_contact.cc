// Where a path meets the true surfaces: the endpoint's distance from each is sampled along the
// path, kLanes places at once, and every change of its sign narrowed down by sampling between the
// two.
#include <algorithm>
#include <cmath>

#include "constraints/sampling/contact.h"
#include "kinematics/statics.h"
#include "sim/machine.h"

namespace selfcal {
namespace {

constexpr int kBlocks = 4;     // of kLanes places along a path
constexpr int kNarrowing = 3;  // each time kLanes - 1 times closer

}  // namespace

Random Machine::stream_of(const std::string& label) const {
  // FNV-1a: equal on every machine, which std::hash is not.
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : label) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  std::seed_seq sequence{static_cast<std::uint32_t>(scenario_.seed),
                         static_cast<std::uint32_t>(hash), static_cast<std::uint32_t>(hash >> 32)};
  return Random(sequence);
}

/// Joints give way under gravity: true = reading + c tau, tau at the true place.
Eigen::ArrayXXd Machine::true_joints(const Eigen::ArrayXXd& readings) const {
  if (!compliance_) return readings;
  Eigen::ArrayXXd joints = readings;
  for (Eigen::Index lane = 0; lane < joints.rows(); ++lane) {
    const Eigen::VectorXd reading = readings.row(lane).matrix().transpose();
    Eigen::VectorXd q = reading;
    for (int i = 0; i < 2; ++i) q += reading - reading_of(*compliance_, q);
    joints.row(lane) = q.transpose().array();
  }
  return joints;
}

Machine::Chance Machine::chance_of(const std::string& label) const {
  Random random = stream_of(label);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  Chance chance{normal(random), uniform(random) < settings_.missed, 0};
  if (uniform(random) >= scenario_.false_triggers.share) return chance;
  const FalseTriggers& triggers = scenario_.false_triggers;
  chance.early = triggers.least + (triggers.most - triggers.least) * uniform(random);
  return chance;
}

bool Machine::is_false(const std::string& label) const {
  const Chance chance = chance_of(label);
  return !chance.missed && chance.early > 0;
}

/// How far before the true surface the trigger closes (m); infinitely late when it is missed.
double Machine::offset(const MotionRequest& request, int set) {
  const Chance chance = chance_of(request.label);
  if (chance.missed) return -HUGE_VAL;
  if (chance.early > 0) false_touches_.push_back(request.label);
  return scenario_.sets[set].noise * chance.noise + chance.early;
}

/// What else holds on a path that meets a surface.
MeasurementConditions Machine::conditions(const MotionRequest& request, const Trajectory& path,
                                          const TrueSurface& surface) const {
  const Eigen::VectorXd way = path.at(1) - path.at(0);
  const double most = way.cwiseAbs().maxCoeff();
  const double speed = most > 0 ? std::min(request.speed, settings_.speed) / most : 0;
  MeasurementConditions held;
  held.velocity = (speed * way).transpose().replicate(kLanes, 1);
  held.normal = surface.outward.transpose().replicate(kLanes, 1);
  held.temperature.setConstant(kLanes, celsius());
  held.time.setConstant(kLanes, seconds(now_));
  held.set.assign(kLanes, surface.set);
  return held;
}

/// Its weight on the tool, in the axes that each lane has it in.
void Machine::hang_payload(ConfigurationBlock& block) const {
  Locations X;
  robot_->locate(block, truth_.xi, Body::endpoint, X, nullptr);
  block.conditions.wrench.setZero(kLanes, 6);
  for (int lane = 0; lane < kLanes; ++lane)
    block.conditions.wrench.row(lane).head<3>() =
        (settings_.payload * X.R(lane).transpose() * gravity_of(*robot_)).transpose();
}

std::vector<Machine::Crossing> Machine::crossings(const MotionRequest& request,
                                                  const Trajectory& path) {
  std::vector<Crossing> found;
  if (request.kind == MoveKind::visit) return found;
  if (request.kind == MoveKind::seat) {
    found.push_back({1.0, true});
    return found;
  }
  if (request.kind == MoveKind::touch) {
    ++visits_[request.label];
    contact_set_ = -1;
  }
  ConfigurationBlock block{Eigen::ArrayXXd(kLanes, path.at(0).size()), kLanes};
  Locations X;
  Closure closure;  // no surface is crossed where the robot cannot stand
  const bool carries = settings_.payload > 0 && request.label.ends_with(kWithPayload);
  const auto locate = [&](double from, double to) {
    for (int lane = 0; lane < kLanes; ++lane)
      block.q.row(lane) = path.at(from + (to - from) * lane / (kLanes - 1.0)).transpose().array();
    block.q = true_joints(block.q);
    if (carries) hang_payload(block);
    closure = robot_->locate(block, truth_.xi, Body::endpoint, X, nullptr);
  };
  for (const TrueSurface& surface : surfaces_) {
    if (!settings_.effects.empty()) block.conditions = conditions(request, path, surface);
    double off = contact_set_ == surface.set ? contact_offset_ : 0;
    bool drawn = request.kind != MoveKind::touch;
    const auto outside = [&](int lane) { return surface.outward.dot(X.p(lane)) - surface.d - off; };
    for (int part = 0; part < kBlocks; ++part) {
      const double first = static_cast<double>(part) / kBlocks;
      locate(first, first + 1.0 / kBlocks);
      // The touch's own offset moves the crossing; the nearest true surface tells whose it is.
      if (!drawn && closure.closes(kLanes - 1) && surface.within.contains(X.p(kLanes - 1)) &&
          outside(kLanes - 1) < 0.02) {
        off = offset(request, surface.set);
        contact_offset_ = off;
        contact_set_ = surface.set;
        drawn = true;
        part = -1;  // from the beginning, as an early trigger may lie behind
        continue;
      }
      for (int lane = 0; lane + 1 < kLanes; ++lane) {
        if (!closure.closes(lane) || !closure.closes(lane + 1)) continue;
        const bool here = outside(lane) > 0, there = outside(lane + 1) > 0;
        if (here == there || !surface.within.contains(X.p(lane + 1))) continue;
        const double step = 1.0 / kBlocks / (kLanes - 1.0);
        double low = first + lane * step, high = low + step;
        for (int i = 0; i < kNarrowing; ++i) {
          locate(low, high);
          int at = 1;
          while (at + 1 < kLanes && (outside(at) > 0) == here) ++at;
          const double width = (high - low) / (kLanes - 1.0);
          high = low + at * width;
          low = high - width;
        }
        found.push_back({high, here});
        locate(first, first + 1.0 / kBlocks);
      }
    }
  }
  std::ranges::sort(found, {}, &Crossing::s);
  if (request.kind == MoveKind::retract && found.empty() && closed_)
    found.push_back({0.5, false});  // out of a socket
  return found;
}

/// Where the tool comes to sit: the nearest configuration in the true socket or nest, a little off.
Eigen::VectorXd Machine::seat(const MotionRequest& request, const Eigen::VectorXd& from) {
  ++visits_[request.label];
  Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(
      request.q.data(), static_cast<Eigen::Index>(request.q.size()));
  DataSet data;
  data.sets = sets_;
  double nearest = HUGE_VAL;
  const Eigen::Vector3d p = locate(*robot_, truth_.xi, q).p;
  for (std::size_t s = 0; s < sets_.size(); ++s)
    for (std::size_t g = 0; g < scenario_.sets[s].places.size(); ++g) {
      const double far = (scenario_.sets[s].places[g].p - p).norm();
      if (far >= nearest) continue;
      nearest = far;
      data.rows.set = {static_cast<int>(s)};
      data.rows.group = {static_cast<int>(g)};
    }
  if (nearest == HUGE_VAL) return from;
  Random random = stream_of(request.label);
  std::normal_distribution<double> normal;
  const SetScenario& set = scenario_.sets[data.rows.set[0]];
  const std::vector<Quantity> equations = sets_[data.rows.set[0]].method->equations();
  Eigen::VectorXd wanted(static_cast<Eigen::Index>(equations.size()));
  for (Eigen::Index a = 0; a < wanted.size(); ++a)
    wanted[a] = normal(random) * (equations[a] == Quantity::angle ? set.noise_angle : set.noise);
  move_to_residual(*robot_, data, truth_, 0, wanted, q);
  return q;
}

}  // namespace selfcal
