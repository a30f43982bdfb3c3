#include "diagnosis/evidence/candidates.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "diagnosis/constants.h"

namespace selfcal {
namespace {

/// 1 to `count`.
std::vector<double> up_to(int count) {
  std::vector<double> numbers(static_cast<size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 1.0);
  return numbers;
}

bool spreads(const Eigen::VectorXd& column, double least) {
  double low = INFINITY, high = -INFINITY;
  for (const double v : column)
    if (std::isfinite(v)) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  return high - low > least;
}

class Maker {
 public:
  Maker(const Robot& robot, const DataSet& data, const Site& site)
      : robot_(robot), data_(data), site_(site) {}

  Candidates run() {
    for (const Joint& joint : robot_.joints()) {
      of_joint(joint);
      ++joint_;
    }
    joint_ = -1;
    of_time();
    of_tool();
    of_touch();
    of_devices();
    spread_priors();
    return std::move(all_);
  }

 private:
  /// One shape of a cause; those `beside` it take up its errors. Where the robot or the site cannot
  /// have it, that is told.
  void add(std::string_view effect, const std::string& at, EffectShape shape = {},
           std::vector<EffectShape> beside = {}) {
    Candidate candidate{.effect = std::string(effect), .at = at, .joint = joint_};
    const auto made = static_cast<std::ptrdiff_t>(all_.made.size());
    const int parameters = parameters_;
    Problems problems;
    candidate.needs = take(candidate, shape, candidate.main, problems);
    for (const EffectShape& each : beside) take(candidate, each, candidate.slack, problems);
    if (problems.any()) {
      all_.made.erase(all_.made.begin() + made, all_.made.end());
      parameters_ = parameters;
      const bool told = std::ranges::any_of(all_.untestable, [&](const Untestable& each) {
        return each.effect == effect && each.at == at;
      });
      if (!told) cannot(effect, at, problems.list.front());
      return;
    }
    candidate.shape = std::move(shape);
    candidate.beside = std::move(beside);
    all_.list.push_back(std::move(candidate));
  }

  /// Numbers the parameters of one shape, and says what rows must have for it.
  std::string take(const Candidate& of, const EffectShape& shape, std::vector<int>& parameters,
                   Problems& problems) {
    all_.made.push_back({of.effect, of.at, shape});
    const auto effect = make_effect(entry_of(all_.made.back()), robot_, site_, problems);
    if (!effect) return {};
    for (size_t k = 0; k < effect->parameters().size(); ++k) parameters.push_back(parameters_++);
    return effect->needs();
  }

  void cannot(std::string_view effect, const std::string& at, const std::string& why) {
    all_.untestable.push_back({std::string(effect), at, why});
  }

  void of_joint(const Joint& joint) {
    const std::string& at = joint.name;
    const Statics* statics = robot_.statics();
    const bool masses = statics && statics->mechanics().masses_known();
    const bool loads = statics && (statics->mechanics().gravity.norm() > 0 || site_.loads);
    if (!statics)
      for (const char* effect : {"joint_compliance", "link_compliance"})
        cannot(effect, at, std::string(kNoStatics));
    if (loads && (masses || site_.loads)) {
      add("joint_compliance", at);
      add("joint_compliance", at, {}, {{.lumps = true}});
      if (statics->mechanics().masses_assumed) all_.list.back().doubt = kDiagnosis.shapes.assumed;
      add("link_compliance", at);
    } else if (loads) {
      add("joint_compliance", at, {.lumps = true});
      cannot("link_compliance", at, "the robot file gives no masses and the rows no loads");
    }
    of_leg(at);
    of_waves(at);
    if (site_.velocities)
      add("backlash", at);
    else
      cannot("backlash", at, "the rows carry no dq: the side of approach is not known");
    if (statics && (masses || site_.loads)) add("backlash", at, {.by = "load"});
    for (const Joint& other : robot_.joints())
      if (other.name != at) add("joint_coupling", at, {.from = other.name});
    for (const double moment : moments(-1)) add("zero_shift", at, {.moment = moment});
    if (moments(-1).empty()) cannot("zero_shift", at, "the rows carry no time");
  }

  void of_leg(const std::string& at) {
    if (robot_.leg_parameter(0) < 0) return;
    // What hangs on the tip is known as the rows' loads, or else by how it bends the legs alone.
    add("leg_compliance", at, {.mass = site_.loads ? 0.0 : 1.0});
    if (warms())
      add("leg_thermal_growth", at);
    else
      cannot("leg_thermal_growth", at, "the rows carry no temperatures that change");
    if (site_.loads)
      add("joint_clearance", at);
    else
      cannot("joint_clearance", at, "the rows carry no loads: which end of its play is not known");
  }

  void of_waves(const std::string& at) {
    const size_t first = all_.list.size();
    for (int k = 1; k <= kDiagnosis.shapes.most_waves; ++k)
      add("transmission_error", at, {.waves = {1.0 * k}});
    all_.list.push_back(together(first, 2));
    all_.profiles.push_back(together(first, kDiagnosis.shapes.profile));
  }

  /// The waves 1 to `count` of one joint as one shape; `first` is the one of a single wave.
  Candidate together(size_t first, int count) const {
    const Candidate& one = all_.list[first];
    Candidate sum{.effect = one.effect, .at = one.at, .joint = one.joint, .needs = one.needs};
    for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
      const std::vector<int>& nuisance = all_.list[first + i].main;
      sum.main.insert(sum.main.end(), nuisance.begin(), nuisance.end());
    }
    sum.shape.waves = up_to(count);
    return sum;
  }

  void of_time() {
    if (site_.end > site_.begin) {
      const double span = site_.end - site_.begin;
      add("base_drift", "base");
      for (const double share : {0.15, 0.5}) add("base_drift", "base", {.settle = share * span});
      for (const int most : {2, 4}) add("base_drift", "base", {.half_waves = up_to(most)});
    } else {
      cannot("base_drift", "base", "the rows carry no time");
    }
    if (!robot_.statics()) return cannot("thermal_expansion", "", std::string(kNoStatics));
    if (!warms())
      return cannot("thermal_expansion", "", "the rows carry no temperatures that change");
    add("thermal_expansion", "");
    for (const double share : {0.125, 0.25, 0.5, 1.0})
      if (site_.end > site_.begin)
        add("thermal_expansion", "", {.lag = share * (site_.end - site_.begin)});
  }

  void of_tool() {
    const std::vector<double> at = moments(-1);
    for (const double moment : at) add("tool_shift", "probe", {.moment = moment});
    if (at.empty()) cannot("tool_shift", "probe", "the rows carry no time");
    const Statics* statics = robot_.statics();
    if (!statics) return cannot("tool_compliance", "probe", std::string(kNoStatics));
    if (statics->mechanics().gravity.norm() > 0 || site_.loads)
      add("tool_compliance", "probe");
    else
      cannot("tool_compliance", "probe", "without gravity the rows carry no loads");
  }

  /// Instruments that measure lengths, whose unit may be off or grow with the air's temperature.
  void of_devices() {
    for (size_t s = 0; s < site_.sets.size(); ++s) {
      const SiteSet& set = site_.sets[s];
      if (!set.lengths || rows_of(static_cast<int>(s)) < kDiagnosis.shapes.fewest_rows) continue;
      add("scale_error", set.name);
      if (warms()) add("scale_error", set.name, {.by = "temperature"});
    }
  }

  bool warms() const {
    return data_.rows.temperature.size() > 0 &&
           spreads(data_.rows.temperature, kDiagnosis.shapes.warms);
  }

  void of_touch() {
    const bool touches = std::any_of(site_.sets.begin(), site_.sets.end(),
                                     [](const SiteSet& set) { return set.touch; });
    if (!touches) return;
    if (data_.rows.normal.rows() > 0)
      add("probe_pretravel", "probe");
    else
      cannot("probe_pretravel", "probe", "the rows carry no normals");
    if (site_.speeds && data_.rows.normal.rows() > 0)
      add("trigger_latency", "probe");
    else
      cannot("trigger_latency", "probe", "the rows carry no approach velocities");
    for (size_t s = 0; s < site_.sets.size(); ++s) {
      if (!site_.sets[s].touch || rows_of(static_cast<int>(s)) < kDiagnosis.shapes.fewest_rows)
        continue;
      add("plane_form_error", site_.sets[s].name);
      if (data_.rows.normal.rows() == 0) continue;
      for (const double moment : moments(static_cast<int>(s)))
        add("fixture_shift", site_.sets[s].name, {.moment = moment});
    }
  }

  int rows_of(int set) const {
    return static_cast<int>(std::count(data_.rows.set.begin(), data_.rows.set.end(), set));
  }

  /// Between the rows of a set (-1: of all), as many rows from one to the next; of few rows between
  /// any two.
  std::vector<double> moments(int set) const {
    std::set<double> times;
    for (int row = 0; row < data_.rows.rows() && data_.rows.time.size() > 0; ++row)
      if ((set < 0 || data_.rows.set[row] == set) && std::isfinite(data_.rows.time[row]))
        times.insert(data_.rows.time[row]);
    const std::vector<double> t(times.begin(), times.end());
    std::vector<double> list;
    const auto n = static_cast<double>(t.size());
    const int most = n <= kDiagnosis.shapes.few_times ? static_cast<int>(t.size()) - 1
                                                      : kDiagnosis.shapes.moments;
    for (int i = 1; i <= most && n >= 8; ++i) {
      const auto at = static_cast<size_t>(std::lround(n * i / (most + 1)));
      if (at == 0 || at >= t.size()) continue;
      const double moment = (t[at - 1] + t[at]) / 2;
      if (list.empty() || moment > list.back()) list.push_back(moment);
    }
    return list;
  }

  void spread_priors() {
    for (Candidate& each : all_.list) {
      std::set<std::string> places;
      int shapes = 0;
      for (const Candidate& other : all_.list) {
        if (other.effect != each.effect) continue;
        places.insert(other.at);
        shapes += other.at == each.at;
      }
      each.log_prior = -std::log(static_cast<double>(places.size())) - std::log(shapes);
    }
    // As probable as one of the shapes that it holds.
    for (Candidate& profile : all_.profiles)
      profile.log_prior =
          std::ranges::find(all_.list, profile.main.front(), [](const Candidate& each) {
            return each.main.front();
          })->log_prior;
  }

  const Robot& robot_;
  const DataSet& data_;
  const Site& site_;
  Candidates all_;
  int parameters_ = 0;
  int joint_ = 0;  ///< whose candidates are made; -1 after the last one
};

}  // namespace

Candidates with_profiles(Candidates all) {
  all.list.insert(all.list.end(), all.profiles.begin(), all.profiles.end());
  all.profiles.clear();
  return all;
}

Candidates candidates(const Robot& robot, const DataSet& data, const Site& site) {
  return Maker(robot, data, site).run();
}

}  // namespace selfcal
