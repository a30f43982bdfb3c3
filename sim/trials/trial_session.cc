// Four surfaces cut through the workspace and are touched all over, or a tracker follows the tip;
// rows come in random order with pauses, immediate repeats after one another.
#include "sim/trials/trial_session.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "constraints/sampling/configurations.h"
#include "constraints/sampling/random_poses.h"
#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"
#include "sim/trials/trial_robot.h"

namespace selfcal {
namespace {

constexpr double kRepeatPause = 8;  // s
constexpr double kNormalNoise = 1e-3;

class SessionMaker {
 public:
  SessionMaker(const std::shared_ptr<const Robot>& robot, const Eigen::VectorXd& xi,
               const SessionPlan& plan, Random& random)
      : robot_(*robot), xi_(xi), plan_(plan), random_(random) {
    out_.robot = robot;
    out_.world.robot = robot.get();
  }

  TrialSession run() {
    plan_takes();
    if (plan_.touches)
      place_surfaces();
    else
      add_set("tracker", "position");
    sample();
    if (!out_.unreached.empty()) return std::move(out_);
    time_rows();
    fill_rows();
    return std::move(out_);
  }

 private:
  /// How often each configuration is taken, and whether to judge.
  void plan_takes() {
    for (int rows = 0; rows < plan_.rows;) {
      int times = chance(random_, plan_.repeated) ? 2 + pick(random_, 2) : 1;
      times = std::min(times, plan_.rows - rows);
      takes_.push_back(times);
      check_.push_back(chance(random_, 0.3));
      rows += times;
    }
  }

  void add_set(const std::string& name, const std::string& method) {
    Node entry = Node::map();
    entry.set("method", Node::of(method));
    if (!plan_.touches) entry.set("noise", Node::of(2e-5));
    Problems problems;
    out_.data.sets.push_back(make_set(name, entry, problems));
    expects(!problems.any(), "a trial's set is well formed");
  }

  void place_surfaces() {
    const Eigen::Vector3d directions[] = {
        {0.05, -0.09, 1}, {1, 0.11, 0.09}, {0.1, 1, -0.15}, {-0.6, 0.7, 0.38}};
    const Eigen::MatrixXd q = random_poses(robot_, nullptr, 200, random_());
    std::vector<Eigen::Vector3d> tips;
    for (Eigen::Index i = 0; i < q.rows(); ++i)
      tips.push_back(tip_of(robot_, xi_, q.row(i).transpose(), nullptr));
    for (int s = 0; s < 4; ++s) {
      TrialSurface surface;
      surface.name = "plane" + std::to_string(s + 1);
      surface.normal = (directions[s] +
                        0.06 * Eigen::Vector3d(normal(random_), normal(random_), normal(random_)))
                           .normalized();
      std::vector<double> heights;
      for (const Eigen::Vector3d& tip : tips) heights.push_back(surface.normal.dot(tip));
      std::sort(heights.begin(), heights.end());
      const double place = s == 0 ? uniform(random_, 0.12, 0.35) : uniform(random_, 0.6, 0.82);
      surface.distance = heights[static_cast<size_t>(place * 199)];
      add_set(surface.name, "plane");
      out_.world.surfaces.push_back(surface);
    }
  }

  void sample() {
    const auto sets = static_cast<int>(out_.data.sets.size());
    std::vector<SampleRequest> requests;
    for (int s = 0; s < sets; ++s) {
      SampleRequest request;
      request.set = s;
      const auto count = static_cast<int>(takes_.size());
      request.rows = count / sets + (s < count % sets ? 1 : 0);
      if (plan_.touches) {
        const TrialSurface& surface = out_.world.surfaces[static_cast<size_t>(s)];
        request.nuisance =
            out_.data.sets[s].method->nuisance_of({surface.normal, surface.distance});
      }
      requests.push_back(request);
    }
    Sampled sampled = sample_rows(robot_, xi_, requests, random_, out_.data);
    out_.truth = sampled.truth;
    out_.unreached = sampled.unreached;
  }

  void time_rows() {
    const double gap = uniform(random_, 1500, 13000) / static_cast<double>(takes_.size());
    double now = 0;
    for (const int times : takes_)
      for (int k = 0; k < times; ++k) {
        now += k > 0 ? kRepeatPause : 2 - gap * std::log(uniform(random_, 1e-6, 1));
        times_.push_back(std::round(now * 100) / 100);
      }
    out_.world.duration = now;
    out_.world.air = draw_air(now, random_);
  }

  /// Configurations in random order, each as often as it is taken.
  void fill_rows() {
    std::vector<int> order(takes_.size());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random_);
    const Observations sampled = out_.data.rows;
    Observations& rows = out_.data.rows;
    rows = {};
    make_room(rows);
    int row = 0;
    for (size_t c = 0; c < takes_.size(); ++c) {
      Instant at = approach(sampled, order[c], static_cast<int>(c));
      for (int k = 0; k < takes_[c]; ++k, ++row) {
        at.row = row;
        at.time = times_[static_cast<size_t>(row)];
        write(rows, at, check_[c] != 0, takes_[c] > 1);
        out_.world.rows.push_back(at);
      }
    }
    centre_surfaces();
  }

  void make_room(Observations& rows) const {
    const auto n = static_cast<Eigen::Index>(times_.size());
    const auto joints = static_cast<Eigen::Index>(robot_.joints().size());
    rows.q.resize(n, joints);
    rows.velocity.resize(n, joints);
    rows.time.resize(n);
    rows.temperature.resize(n);
    if (plan_.touches) {
      rows.normal.resize(n, 3);
    } else {
      rows.position.resize(n, 3);
      rows.wrench.setZero(n, 6);
    }
    rows.group.assign(times_.size(), -1);
  }

  /// Where a configuration is, how it is approached and what it carries.
  Instant approach(const Observations& sampled, int from, int configuration) {
    Instant at;
    at.configuration = configuration;
    at.set = sampled.set[static_cast<size_t>(from)];
    at.q = sampled.q.row(from).transpose();
    look(robot_, xi_, at);
    at.velocity = Eigen::VectorXd::NullaryExpr(at.q.size(), [&] { return normal(random_); });
    if (!plan_.touches) {
      at.velocity *= log_uniform(random_, 0.008, 0.032) / at.velocity.norm();
      if (loaded_ && chance(random_, 0.5)) load(at);
      return at;
    }
    at.normal = out_.world.surfaces[static_cast<size_t>(at.set)].normal;
    Eigen::MatrixXd J;
    tip_of(robot_, xi_, at.q, &J);
    const Eigen::Vector3d tip =
        log_uniform(random_, 2e-3, 2e-2) *
        (-at.normal + 0.1 * Eigen::Vector3d(normal(random_), normal(random_), normal(random_)));
    const Eigen::VectorXd needed = least_squares(J, tip);
    const Eigen::VectorXd idle = at.velocity - least_squares(J, J * at.velocity);
    at.velocity = needed + 0.3 * needed.norm() / std::max(idle.norm(), 1e-9) * idle;
    return at;
  }

  void load(Instant& at) {
    const Eigen::Matrix3d R = at.poses.back().linear();
    const auto within = [&](double most) {
      return Eigen::Vector3d(
          Eigen::Vector3d::NullaryExpr([&] { return uniform(random_, -most, most); }));
    };
    at.force = R * within(most_load_);
    at.moment = R * within(0.1 * most_load_);
  }

  void write(Observations& rows, const Instant& at, bool check, bool repeated) {
    rows.set.push_back(at.set);
    rows.repeat.push_back(repeated ? at.configuration : -1);
    rows.check.push_back(check ? 1 : 0);
    rows.q.row(at.row) = at.q.transpose();
    rows.velocity.row(at.row) = at.velocity.transpose();
    rows.time[at.row] = at.time;
    rows.temperature[at.row] =
        std::round(100 * (out_.world.air.at(at.time) + 0.1 * normal(random_))) / 100;
    const auto rough = [&] { return kNormalNoise * normal(random_); };
    if (plan_.touches) {
      const Eigen::Vector3d n = at.normal + Eigen::Vector3d(rough(), rough(), rough());
      rows.normal.row(at.row) = n.normalized().transpose();
      return;
    }
    const Eigen::Matrix3d R = at.poses.back().linear();
    rows.wrench.row(at.row) << (R.transpose() * at.force).transpose(),
        (R.transpose() * at.moment).transpose();
  }

  void centre_surfaces() {
    for (size_t s = 0; s < out_.world.surfaces.size(); ++s) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      int count = 0;
      for (const Instant& each : out_.world.rows)
        if (each.set == static_cast<int>(s)) {
          sum += each.poses.back().translation();
          ++count;
        }
      out_.world.surfaces[s].centre = sum / std::max(count, 1);
    }
  }

  const Robot& robot_;
  const Eigen::VectorXd& xi_;
  const SessionPlan plan_;
  Random& random_;
  // What legs give way to shows under loads alone.
  const bool loaded_ = chance(random_, runs_on_legs(robot_) ? 1 : 0.6);
  const double most_load_ = most_load(robot_);  ///< N, and a tenth as many N m
  std::vector<int> takes_;
  std::vector<char> check_;
  std::vector<double> times_;
  TrialSession out_;
};

}  // namespace

TrialSession draw_session(const std::shared_ptr<const Robot>& robot, const Eigen::VectorXd& xi,
                          const SessionPlan& plan, Random& random) {
  return SessionMaker(robot, xi, plan, random).run();
}

}  // namespace selfcal
