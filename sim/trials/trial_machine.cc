// A session without deviations; causes drawn until calibration leaves enough of them; their size
// set to what shall be visible; each touch moved to where the deviating machine meets the surface.
#include "sim/trials/trial_machine.h"

#include <algorithm>
#include <cmath>

#include "kinematics/linear_algebra.h"
#include "sim/trials/trial_causes.h"
#include "sim/trials/trial_robot.h"
#include "sim/trials/trial_visible.h"

namespace selfcal {
namespace {

constexpr double kLeastSurvival = 0.12;  // below this the honest answer is "absorbed"
constexpr int kEffectTries = 40;         // of one effect
constexpr int kMixtures = 10;            // of effects
constexpr int kTouchSteps = 12;          // Newton steps of a touch
constexpr double kTouchMet = 1e-12;      // m

class TrialMaker {
 public:
  explicit TrialMaker(const TrialRequest& request) : request_(request) {
    std::seed_seq sequence{static_cast<unsigned>(request.seed),
                           static_cast<unsigned>(request.seed >> 32),
                           static_cast<unsigned>(request.number)};
    random_ = Random(sequence);
  }

  MadeTrial run() {
    draw_machine();
    if (!out_.unreached.empty()) return std::move(out_);
    const TrialCalibration calibration(session_, out_.truth.noise);
    choose_causes(calibration);
    if (!out_.unreached.empty()) return std::move(out_);
    take_rows();
    judge(calibration);
    round_readings();
    out_.robot = session_.robot;
    out_.data = std::move(session_.data);
    return std::move(out_);
  }

 private:
  void draw_machine() {
    std::shared_ptr<const Robot> robot = request_.robot;
    if (!robot) robot = draw_arm(random_);
    const Eigen::VectorXd xi = draw_geometry(*robot, random_);
    SessionPlan plan;
    plan.touches = request_.touches.value_or(chance(random_, 0.65));
    plan.rows = request_.least_rows + pick(random_, request_.most_rows - request_.least_rows + 1);
    plan.repeated = uniform(random_, 0.10, 0.15);
    session_ = draw_session(robot, xi, plan, random_);
    out_.unreached = session_.unreached;
    Weights weights = draw_weights(*robot, random_);
    session_.world.mass = std::move(weights.mass);
    session_.world.com = std::move(weights.com);
    TrialLedger& truth = out_.truth;
    truth.measure = plan.touches ? "planes" : "positions";
    truth.rows = plan.rows;
    truth.noise = uniform(random_, 8e-6, 2.5e-5);
    encoder_step_ = log_uniform(random_, 2e-6, 1e-5);
    false_share_ = uniform(random_, 0, 0.02);
  }

  /// Names of the causes: a quarter nothing, a tenth of all two.
  std::vector<std::string> mixture() {
    const double u = uniform(random_, 0, 1);
    if (!request_.second.empty()) return {request_.effect, request_.second};
    if (!request_.effect.empty()) return {request_.effect};
    if (u < 0.25) return {"none"};
    if (u < 0.40) return {"unknown"};
    const std::vector<std::string> listed = listed_causes(session_.world);
    const auto n = static_cast<int>(listed.size());
    const int first = pick(random_, n);
    std::vector<std::string> names{listed[static_cast<size_t>(first)]};
    if (u >= 0.90)
      names.push_back(listed[static_cast<size_t>((first + 1 + pick(random_, n - 1)) % n)]);
    return names;
  }

  void choose_causes(const TrialCalibration& calibration) {
    constexpr double kSizes[] = {0.5, 0.75, 1, 1.5, 2.5, 4};
    for (int attempt = 0; attempt < kMixtures; ++attempt) {
      const std::vector<std::string> names = mixture();
      const double drawn = kSizes[pick(random_, 6)];
      out_.unreached.clear();
      if (names.front() == "none") return;
      const double r = request_.r.value_or(drawn);
      if (draw_all(names, r, calibration)) return enter(names, r);
      if (!request_.effect.empty()) return;
    }
  }

  bool draw_all(const std::vector<std::string>& names, double r,
                const TrialCalibration& calibration) {
    causes_.clear();
    for (const std::string& name : names)
      if (!draw(name, r, calibration)) {
        causes_.clear();
        out_.unreached = name + ": calibration absorbs it wherever it acts";
        return false;
      }
    return true;
  }

  void enter(const std::vector<std::string>& names, double r) {
    TrialLedger& truth = out_.truth;
    truth.r = r;
    truth.effect = names.front();
    if (names.size() > 1) truth.second = names.back();
    for (size_t i = 0; i < names.size(); ++i) {
      truth.where[names[i]] = causes_[i].where;
      truth.physics += (i > 0 ? "; " : "") + causes_[i].physics;
    }
  }

  TrialCause draw_law(const std::string& name) {
    const auto law = request_.laws.find(name);
    if (law == request_.laws.end()) return draw_cause(name, session_.world, random_);
    TrialCause cause = law->second(session_.world, random_);
    cause.effect = name;
    return cause;
  }

  bool draw(const std::string& name, double r, const TrialCalibration& calibration) {
    for (int attempt = 0; attempt < kEffectTries; ++attempt) {
      TrialCause cause = draw_law(name);
      if (!cause.act) continue;
      const TrialCalibration::Size size = calibration.size(calibration.seen(shifts({cause})));
      if (!(size.visible > kLeastSurvival * size.whole)) continue;
      cause.size = r / size.visible;
      causes_.push_back(std::move(cause));
      return true;
    }
    return false;
  }

  static Deviation deviation(const std::vector<TrialCause>& causes, const Instant& at) {
    Deviation sum{Eigen::VectorXd::Zero(at.q.size())};
    for (const TrialCause& cause : causes) {
      Deviation one{Eigen::VectorXd::Zero(at.q.size())};
      cause.act(at, one);
      sum.joints += cause.size * one.joints;
      sum.readings += cause.size * one.readings;
      sum.legs += cause.size * one.legs;
      sum.tip += cause.size * one.tip;
    }
    return sum;
  }

  /// The true one, with what is added to its legs.
  Eigen::VectorXd geometry(const Deviation& d) const {
    return with_legs(*session_.robot, session_.truth.xi, d.legs);
  }

  Eigen::Vector3d shift(const std::vector<TrialCause>& causes, const Instant& at) const {
    const Deviation d = deviation(causes, at);
    return deviating_tip(d, at, nullptr) -
           tip_of(*session_.robot, session_.truth.xi, at.q, nullptr);
  }

  Eigen::Vector3d deviating_tip(const Deviation& d, const Instant& at, Eigen::MatrixXd* J) const {
    return tip_of(*session_.robot, geometry(d), at.q + d.readings, J, d.joints) + d.tip;
  }

  Eigen::MatrixXd shifts(const std::vector<TrialCause>& causes) const {
    Eigen::MatrixXd all(static_cast<Eigen::Index>(session_.world.rows.size()), 3);
    for (const Instant& at : session_.world.rows) all.row(at.row) = shift(causes, at).transpose();
    return all;
  }

  void take_rows() {
    noise_.setZero(out_.truth.rows, 3);
    for (Instant& at : session_.world.rows) {
      for (int axis = 0; axis < 3; ++axis)
        noise_(at.row, axis) = out_.truth.noise * normal(random_);
      const bool is_false = chance(random_, false_share_);
      const double early = log_uniform(random_, 5e-5, 5e-3);
      if (is_false) out_.false_rows.push_back(at.row);
      if (session_.world.touches())
        touch(at, noise_(at.row, 0) + (is_false ? early : 0));
      else
        track(at, is_false ? early : 0);
    }
  }

  /// Moves the joints to where the deviating tip is `wanted` outside the surface.
  void touch(Instant& at, double wanted) {
    const Robot& robot = *session_.robot;
    const TrialSurface& surface = session_.world.surfaces[static_cast<size_t>(at.set)];
    for (int step = 0; step < kTouchSteps; ++step) {
      const Deviation d = deviation(causes_, at);
      Eigen::MatrixXd J;
      const Eigen::Vector3d tip = deviating_tip(d, at, &J);
      const double miss = wanted + surface.distance - surface.normal.dot(tip);
      if (std::abs(miss) < kTouchMet) break;
      const Eigen::VectorXd along = J.transpose() * surface.normal;
      at.q += along * (miss / along.squaredNorm());
      look(robot, session_.truth.xi, at);
    }
    session_.data.rows.q.row(at.row) = at.q.transpose();
  }

  void track(const Instant& at, double astray) {
    const Deviation d = deviation(causes_, at);
    Eigen::Vector3d p = deviating_tip(d, at, nullptr) + noise_.row(at.row).transpose();
    if (astray > 0)
      p += astray * Eigen::Vector3d(normal(random_), normal(random_), normal(random_)).normalized();
    session_.data.rows.position.row(at.row) = p.transpose();
  }

  /// What is visible after all at the final rows, and how far a told fit closes the gap.
  void judge(const TrialCalibration& calibration) {
    out_.shifts = shifts(causes_);
    out_.visible = calibration.size(calibration.seen(out_.shifts)).visible;
    Eigen::MatrixXd columns(calibration.seen(out_.shifts).size(),
                            static_cast<Eigen::Index>(causes_.size()));
    for (size_t i = 0; i < causes_.size(); ++i)
      columns.col(static_cast<Eigen::Index>(i)) = calibration.seen(shifts({causes_[i]}));
    Eigen::MatrixXd disturbance = noise_;
    if (session_.world.touches())
      for (const Instant& at : session_.world.rows)
        disturbance.row(at.row) = noise_(at.row, 0) * at.normal.transpose();
    out_.truth.told_closed =
        calibration.told_closed(calibration.seen(out_.shifts + disturbance), columns);
  }

  void round_readings() {
    Observations& rows = session_.data.rows;
    rows.q =
        rows.q.unaryExpr([&](double q) { return std::round(q / encoder_step_) * encoder_step_; });
    const auto cut = [](Eigen::MatrixXd& values, double decimals) {
      values =
          values.unaryExpr([&](double v) { return std::round(v * decimals) / decimals + 0.0; });
    };
    cut(rows.q, 1e9);
    cut(rows.position, 1e7);
    cut(rows.velocity, 1e7);
    cut(rows.normal, 1e5);
    cut(rows.wrench, 1e3);
  }

  const TrialRequest& request_;
  Random random_;
  TrialSession session_;
  std::vector<TrialCause> causes_;
  double encoder_step_ = 5e-6, false_share_ = 0;
  Eigen::MatrixXd noise_;  ///< rows x 3 (m); of touches the first is along the normal
  MadeTrial out_;
};

}  // namespace

MadeTrial make_trial(const TrialRequest& request) { return TrialMaker(request).run(); }

}  // namespace selfcal
