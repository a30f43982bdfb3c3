#include "diagnosis/evidence/candidates.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "constraints/statistics.h"
#include "diagnosis/constants.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

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
  Maker(const Robot& robot, const DataSet& data, const MeasurementContext& context,
        const Hints& hints)
      : robot_(robot), data_(data), context_(context), hints_(hints) {}

  Candidates run() {
    for (size_t j = 0; j < robot_.joints().size(); ++j)
      take_of({.joint = static_cast<int>(j), .name = robot_.joints()[j].name});
    take_of({});
    for (size_t s = 0; s < context_.sets.size(); ++s)
      take_of({.set = static_cast<int>(s), .name = context_.sets[s].name});
    spread_priors();
    return std::move(all_);
  }

 private:
  /// What the effects suppose of one place.
  void take_of(const EffectPlace& place) {
    const DiagnosisConstants::Shapes& rules = kDiagnosis.shapes;
    const Supposed asked{
        .robot = robot_,
        .context = context_,
        .warms = warms(),
        .normals = data_.rows.normal.rows() > 0,
        .most_waves = rules.most_waves,
        .profile = rules.profile,
        .hinted_waves = hints_.fine_waves,
        .hinted_share = rules.fine_share,
        .assumed = rules.assumed,
        .moments = [this](int set) { return moments(set); },
        .shows = [this](int set) { return rows_of(set) >= kDiagnosis.shapes.fewest_rows; }};
    const Suppositions supposed = suppose(asked, place);
    all_.untestable.insert(all_.untestable.end(), supposed.untestable().begin(),
                           supposed.untestable().end());
    for (const Supposition& each : supposed.list()) {
      if (each.together == 0) {
        add(each, place);
        if (each.shape.moment) add_finer(each, place);
        continue;
      }
      (each.profile ? all_.profiles : all_.list).push_back(together(each));
    }
  }

  /// Where the robot or the context cannot have it, that is told.
  void add(const Supposition& supposed, const EffectPlace& place, double share = 1) {
    Candidate candidate{.effect = supposed.effect, .at = supposed.at, .joint = place.joint};
    const auto made = static_cast<std::ptrdiff_t>(all_.made.size());
    const int parameters = parameters_;
    Problems problems;
    candidate.needs = take(candidate, supposed.shape, candidate.main, problems);
    for (const Slack& each : supposed.slack) {
      candidate.slack.push_back({.doubt = each.doubt});
      take(candidate, each.shape, candidate.slack.back().list, problems);
    }
    if (problems.any() || candidate.main.empty()) {
      all_.made.erase(all_.made.begin() + made, all_.made.end());
      parameters_ = parameters;
      const bool told = std::ranges::any_of(all_.untestable, [&](const Untestable& each) {
        return each.effect == supposed.effect && each.at == supposed.at;
      });
      if (!told)
        all_.untestable.push_back(
            {supposed.effect, supposed.at,
             problems.any() ? problems.list.front() : "it has no figure that rows could tell"});
      return;
    }
    candidate.shape = supposed.shape;
    candidate.share = share * supposed.share;
    candidate.odds = supposed.odds;
    if (supposed.shape.moment) candidate.between = around(*supposed.shape.moment, place.set);
    if (supposed.drifts && data_.order_is_time) candidate.meant = kDiagnosis.shapes.order_as_time;
    all_.list.push_back(std::move(candidate));
  }

  /// Numbers the parameters of one shape, and says what rows must have for it.
  std::string take(const Candidate& of, const EffectShape& shape, std::vector<int>& parameters,
                   Problems& problems) {
    all_.made.push_back({of.effect, of.at, shape});
    const auto effect = make_effect(entry_of(all_.made.back()), robot_, context_, problems);
    if (!effect) return {};
    for (size_t k = 0; k < effect->parameters().size(); ++k) parameters.push_back(parameters_++);
    return effect->needs();
  }

  /// The first waves of one joint as one shape.
  Candidate together(const Supposition& supposed) const {
    const auto first = std::ranges::find_if(all_.list, [&](const Candidate& each) {
      return each.effect == supposed.effect && each.at == supposed.at;
    });
    Candidate sum{
        .effect = first->effect, .at = first->at, .joint = first->joint, .needs = first->needs};
    for (auto one = first; one != first + supposed.together; ++one) {
      sum.main.insert(sum.main.end(), one->main.begin(), one->main.end());
      sum.shape.waves.insert(sum.shape.waves.end(), one->shape.waves.begin(),
                             one->shape.waves.end());
    }
    return sum;
  }

  bool warms() const {
    return data_.rows.temperature.size() > 0 &&
           spreads(data_.rows.temperature, kDiagnosis.shapes.warms);
  }

  int rows_of(int set) const {
    return static_cast<int>(std::count(data_.rows.set.begin(), data_.rows.set.end(), set));
  }

  /// A likely step at the moments between those next to its own, each the less probable.
  void add_finer(Supposition step, const EffectPlace& place) {
    const auto found = std::ranges::find_if(hints_.steps, [&](const ShapedEffect& each) {
      return each.effect == step.effect && each.at == step.at && each.shape == step.shape;
    });
    if (found == hints_.steps.end() || all_.list.empty() || all_.list.back().shape != step.shape)
      return;
    const double own = *step.shape.moment;
    const std::vector<double> coarse = moments(place.set), t = times(place.set);
    const auto at = std::ranges::find(coarse, own);
    const double from = at == coarse.begin() ? t.front() : *(at - 1),
                 to = at + 1 == coarse.end() ? t.back() : *(at + 1);
    std::vector<double> between;
    for (size_t i = 1; i < t.size(); ++i)
      if (const double moment = (t[i - 1] + t[i]) / 2;
          moment > from && moment < to && moment != own)
        between.push_back(moment);
    const auto most = static_cast<size_t>(kDiagnosis.shapes.moments);
    const size_t few = std::min(between.size(), most);
    const double share = 2.0 / std::max(2.0, static_cast<double>(few) + 1);
    all_.list.back().share *= share;
    for (size_t i = 0; i < few; ++i) {
      step.shape.moment = between[i * between.size() / few];
      add(step, place, share);
    }
  }

  /// When the rows of a set (-1: of all) were taken, ascending.
  std::vector<double> times(int set) const {
    std::set<double> times;
    for (int row = 0; row < data_.rows.rows() && data_.rows.time.size() > 0; ++row)
      if ((set < 0 || data_.rows.set[row] == set) && std::isfinite(data_.rows.time[row]))
        times.insert(data_.rows.time[row]);
    return {times.begin(), times.end()};
  }

  /// The row of a set (-1: of all) before a moment and that behind (s).
  std::pair<double, double> around(double moment, int set) const {
    const std::vector<double> t = times(set);
    const auto behind = std::ranges::lower_bound(t, moment);
    return {behind == t.begin() ? moment : *(behind - 1), behind == t.end() ? moment : *behind};
  }

  /// Between the rows of a set (-1: of all), as many rows from one to the next, and where they
  /// pause, for then something is moved; of few rows between any two.
  std::vector<double> moments(int set) const {
    const std::vector<double> t = times(set);
    const auto n = static_cast<double>(t.size());
    if (n < kDiagnosis.shapes.fewest_times) return {};
    const int most = n <= kDiagnosis.shapes.few_times ? static_cast<int>(t.size()) - 1
                                                      : kDiagnosis.shapes.moments;
    std::set<double> list;
    const auto add_before = [&](size_t row) { list.insert((t[row - 1] + t[row]) / 2); };
    for (int i = 1; i <= most; ++i) {
      const auto at = static_cast<size_t>(std::lround(n * i / (most + 1)));
      if (at > 0 && at < t.size()) add_before(at);
    }
    for (const size_t row : after_pauses(t)) add_before(row);
    return {list.begin(), list.end()};
  }

  /// The rows after the longest pauses, by far longer than is usual.
  static std::vector<size_t> after_pauses(const std::vector<double>& t) {
    std::vector<double> steps;
    for (size_t i = 1; i < t.size(); ++i) steps.push_back(t[i] - t[i - 1]);
    const double usual = median(steps);
    std::vector<size_t> rows;
    for (size_t i = 1; i < t.size(); ++i)
      if (steps[i - 1] > kDiagnosis.shapes.pause * usual) rows.push_back(i);
    std::ranges::sort(rows, std::ranges::greater{}, [&](size_t row) { return steps[row - 1]; });
    rows.resize(std::min(rows.size(), kDiagnosis.shapes.most_pauses));
    return rows;
  }

  void spread_priors() {
    for (Candidate& each : all_.list) {
      std::set<std::string> places;
      double shapes = 0;
      for (const Candidate& other : all_.list) {
        if (other.effect != each.effect) continue;
        places.insert(other.at);
        if (other.at == each.at) shapes += other.share;
      }
      each.log_prior =
          std::log(each.odds * each.share / (shapes * static_cast<double>(places.size())));
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
  const MeasurementContext& context_;
  const Hints& hints_;
  Candidates all_;
  int parameters_ = 0;
};

}  // namespace

Candidates with_profiles(Candidates all) {
  all.list.insert(all.list.end(), all.profiles.begin(), all.profiles.end());
  all.profiles.clear();
  return all;
}

Candidates candidates(const Robot& robot, const DataSet& data, const MeasurementContext& context,
                      const Hints& hints) {
  return Maker(robot, data, context, hints).run();
}

}  // namespace selfcal
