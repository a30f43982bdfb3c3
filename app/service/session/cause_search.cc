#include "app/service/session/cause_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/service/session/touch_decision.h"
#include "constraints/estimation/identification.h"
#include "constraints/measurement_context.h"
#include "constraints/planning/other_approach.h"
#include "io/files/robot_file.h"
#include "kinematics/corrected_robot.h"
#include "kinematics/effect.h"
#include "kinematics/expects.h"
#include "kinematics/statics.h"

namespace selfcal {
namespace {

constexpr int kPool = 80;  // touches in other places that are asked for; four times are found
constexpr int kSessionsBack = 1000;  // among which the full one is looked for
constexpr int kMostRepeated = 60;    // of the touches before

class TouchPool {
 public:
  TouchPool(const Robot& robot, const Config& config, const DataSet& data, unsigned long long seed)
      : robot_(robot), xi_(values(robot)), config_(config), data_(data), random_(seed) {}

  CellTouches run(const std::vector<StepRecord>& before, const Progress& progress) {
    repeat(before);
    elsewhere(progress);
    return rows();
  }

 private:
  const TouchTarget* target_of(int set) const {
    const auto found = std::ranges::find(config_.targets, set, &TouchTarget::set);
    return found == config_.targets.end() ? nullptr : &*found;
  }

  bool is_in_rows(const Set& set) const {
    return std::ranges::find(data_.sets, set.name, &Set::name) != data_.sets.end();
  }

  void add(PlannedTouch touch, const char* what) {
    touch.check = touch.via_home = false;
    touch.way.clear();
    touches_.push_back(std::move(touch));
    what_.emplace_back(what);
  }

  /// The touch, and the same contact otherwise.
  void add_with_others(const PlannedTouch& touch, const char* as_it_is, const char* otherwise,
                       bool slowly) {
    add(touch, as_it_is);
    const TouchTarget& target = *target_of(touch.set);
    for (PlannedTouch& other :
         other_approaches(robot_, xi_, target, config_.obstacles, config_.plan, touch, 1, random_))
      add(std::move(other), otherwise);
    if (!slowly) return;
    PlannedTouch slow = touch;
    slow.slow = true;
    add(std::move(slow), "slowly");
  }

  void repeat(const std::vector<StepRecord>& before) {
    std::vector<PlannedTouch> old;
    for (const StepRecord& step : before) {
      const auto set = std::ranges::find(config_.sets, step.set, &Set::name);
      if (step.check || step.slow || step.loaded || set == config_.sets.end() ||
          !is_in_rows(*set) || step.start.empty() || set->method->planned() != Planned::surface)
        continue;
      PlannedTouch touch;
      touch.set = static_cast<int>(set - config_.sets.begin());
      touch.outside = touch.start = vector_of(step.start);
      touch.touch = vector_of(step.touch);
      touch.end = vector_of(step.end);
      old.push_back(std::move(touch));
    }
    const std::size_t count = std::min<std::size_t>(old.size(), kMostRepeated);
    for (std::size_t i = 0; i < count; ++i) {
      PlannedTouch& touch = old[i * old.size() / count];
      add_with_others(touch, "once more", "once more by other joints", i % 3 == 0);
      if (!config_.causes.payload || !robot_.statics() || i % 2 != 0) continue;
      touch.loaded = true;
      add(touch, "once more with the payload");
    }
  }

  void elsewhere(const Progress& progress) {
    std::vector<TouchTarget> targets;
    for (const TouchTarget& each : config_.targets)
      if (each.plane && is_in_rows(config_.sets[each.set])) targets.push_back(each);
    if (targets.empty()) return;
    for (TouchTarget& each : targets)
      each.touches = std::max<int>(4, kPool / static_cast<int>(targets.size()));
    const TouchCandidates candidates(robot_, xi_, config_.sets, config_.obstacles, config_.plan);
    const auto usable = usable_touches(candidates, targets, random_, progress);
    int number = 0;
    for (const std::vector<PlannedTouch>& of_target : usable)
      for (const PlannedTouch& each : of_target) {
        if (++number % 3 == 0)
          add_with_others(each, "in other postures", "in other postures by other joints", false);
        else
          add(each, "in other postures");
      }
  }

  CellTouches rows() {
    const auto count = static_cast<Eigen::Index>(touches_.size());
    Observations out;
    out.q.resize(count, static_cast<Eigen::Index>(robot_.joints().size()));
    out.velocity.resizeLike(out.q);
    out.normal.resize(count, 3);
    out.noise_factor.setOnes(count);
    out.temperature.setConstant(count, last_temperature());
    out.time.setZero(count);
    if (config_.causes.payload && robot_.statics()) out.wrench.setZero(count, 6);
    for (Eigen::Index i = 0; i < count; ++i) {
      const PlannedTouch& touch = touches_[static_cast<std::size_t>(i)];
      out.q.row(i) = touch.touch.transpose();
      out.normal.row(i) = target_of(touch.set)->outward.transpose();
      out.velocity.row(i) = velocity(touch).transpose();
      if (touch.loaded)
        out.wrench.row(i).head<3>() =
            (*config_.causes.payload * locate(robot_, xi_, touch.touch).R.transpose() *
             gravity_of(robot_))
                .transpose();
      const auto set = std::ranges::find(data_.sets, config_.sets[touch.set].name, &Set::name);
      out.set.push_back(static_cast<int>(set - data_.sets.begin()));
      out.group.push_back(-1);
      out.check.push_back(0);
    }
    return {std::move(touches_), {std::move(out), std::move(what_)}};
  }

  double last_temperature() const {
    const Eigen::VectorXd& all = data_.rows.temperature;
    return all.size() > 0 ? all[all.size() - 1] : std::nan("");
  }

  /// Of the joints at the contact.
  Eigen::VectorXd velocity(const PlannedTouch& touch) const {
    const Eigen::VectorXd way = touch.end - touch.start;
    const double length = (endpoint(robot_, touch.end) - endpoint(robot_, touch.start)).norm();
    const double speed = touch.slow ? config_.speeds.touch / kSlower : config_.speeds.touch;
    return length > 0 ? Eigen::VectorXd(speed / length * way) : Eigen::VectorXd(0 * way);
  }

  const Robot& robot_;
  const Eigen::VectorXd xi_;
  const Config& config_;
  const DataSet& data_;
  Random random_;
  std::vector<PlannedTouch> touches_;
  std::vector<std::string> what_;
};

/// A zero that has slipped is none: it is a parameter.
bool is_kept(const FoundEffect& found) {
  return lasting_of(found.what.effect) == EffectLasting::kept;
}

}  // namespace

std::optional<SessionRecord> base_of_cause(Store& store, const std::string& model_hash,
                                           const std::string& config_hash, std::int64_t before) {
  const auto sessions = store.sessions(kSessionsBack);
  if (!sessions) return std::nullopt;
  for (const SessionRecord& each : *sessions)
    if (each.id < before && each.kind == to_string(SessionKind::full) &&
        each.state == SessionState::finished && each.model_hash == model_hash &&
        each.config_hash == config_hash)
      return each;
  return std::nullopt;
}

CellTouches possible_touches(const Robot& robot, const Config& config,
                             const std::vector<StepRecord>& before, const DataSet& data,
                             unsigned long long seed, const Progress& progress) {
  return TouchPool(robot, config, data, seed).run(before, progress);
}

std::optional<CorrectedModel> corrected_model(const Robot& active, const DataSet& data,
                                              const Diagnosis& diagnosis,
                                              const Progress& progress) {
  Correction named = named_of(diagnosis.found);
  std::erase_if(named, [](const FoundEffect& each) { return !is_kept(each); });
  if (named.empty() || !diagnosis.model) return std::nullopt;
  Problems problems;
  const std::shared_ptr<const Robot> robot =
      correct(geometry_of(diagnosis.model), entries_of(named), context_of(active, data), problems);
  expects(robot != nullptr, "what was named is effects that the robot can have");
  Options options;
  for (const Parameter& each : robot->parameters())
    if (each.part == Part::effect) options.free.push_back(each.name);
  for (const FoundEffect& each : named)
    options.effect_sigma.insert(options.effect_sigma.end(), each.sigma.begin(), each.sigma.end());
  CorrectedModel model{identify(*robot, data, options, progress), {}};
  model.robot_text = robot_text(*robot, model.solution.values);
  return model;
}

}  // namespace selfcal
