#include "app/report/plan_words.h"

#include <algorithm>

#include "app/report/format.h"
#include "io/files/json_parts.h"

namespace selfcal {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kCurveColumns = 9;  // of the curve in words

std::string joined_names(const std::vector<Set>& sets) {
  std::string names;
  for (const Set& each : sets) names += (names.empty() ? "" : ", ") + each.name;
  return names;
}

/// The least count whose sigma is within the target; negative where none is.
int enough(const std::vector<double>& curve, double target) {
  for (std::size_t n = 0; n < curve.size(); ++n)
    if (curve[n] <= target) return static_cast<int>(n);
  return -1;
}

/// Counts at which the curve is told: doubling, and the last.
std::vector<std::size_t> told_counts(std::size_t last) {
  std::vector<std::size_t> counts{last};
  while (counts.back() > 1 && counts.size() < kCurveColumns)
    counts.push_back((counts.back() * 2 + 1) / 3);
  std::reverse(counts.begin(), counts.end());
  return counts;
}

std::string enough_words(const ConfigurationPlan& plan, double target) {
  const int count = enough(plan.curve, target);
  if (count == 0) return "the maker's figures alone know it to the target of " + mm(target) + " mm";
  return count < 0
             ? "the target of " + mm(target) + " mm is not reached"
             : std::to_string(count) + " of them know it to the target of " + mm(target) + " mm";
}

Json observability_json(const Observability& o) {
  return {{"condition", finite(o.condition)},
          {"o1", o.o1},
          {"o2", o.o2},
          {"o3", o.o3},
          {"o4", o.o4},
          {"o5", finite(o.o5)}};
}

Json figures_json(const PlanFigures& figures) {
  return {{"sigma", finite(figures.sigma)},
          {"observability", figures.observability.o1 > 0 ? observability_json(figures.observability)
                                                         : Json(nullptr)}};
}

}  // namespace

std::string plan_words(const Robot& robot, const PlanRequest& request,
                       const ConfigurationPlan& plan, double target) {
  const bool pairs = std::ranges::any_of(plan.units, [](const Unit& u) { return u.size() > 1; });
  std::string text =
      printed("%s by %s: %zu of %d configurations%s, chosen by %s\n", robot.name().c_str(),
              joined_names(plan.data.sets).c_str(), plan.units.size(), plan.candidates,
              pairs ? " or pairs" : "", std::string(to_string(request.criterion)).c_str());
  text += printed(
      "end position in the workspace, 1 sigma%s: %s mm %s, %s mm after as many at random, %s mm "
      "after these\n",
      plan.aligned ? ", what the rows cannot place taken out" : "", mm(plan.sigma_before).c_str(),
      request.pool.taken.rows.rows() > 0 ? "after those taken already" : "by the maker's figures",
      mm(plan.random.sigma).c_str(), mm(plan.planned.sigma).c_str());
  if (plan.sigma_beyond > 0.1 * plan.planned.sigma)
    text += printed(
        "  %s mm of it are of what such rows never tell; of the rest %s mm after as many at "
        "random, "
        "%s mm after these\n",
        mm(plan.sigma_beyond).c_str(), mm(plan.rest(plan.random.sigma)).c_str(),
        mm(plan.rest(plan.planned.sigma)).c_str());
  text += printed("observability of %d parameters\n  %-10s %12s %12s\n", plan.parameters, "",
                  "at random", "planned");
  for (const auto& [name, index] : {std::pair{"condition", &Observability::condition},
                                    {"o1", &Observability::o1},
                                    {"o2", &Observability::o2},
                                    {"o3", &Observability::o3},
                                    {"o4", &Observability::o4},
                                    {"o5", &Observability::o5}}) {
    const double before = plan.random.observability.*index;
    const double after = plan.planned.observability.*index;
    text += printed("  %-10s %12s %12s\n", name, before > 0 ? printed("%.4g", before).c_str() : "-",
                    after > 0 ? printed("%.4g", after).c_str() : "-");
  }
  text += printed("motion: %s in this order, %s in a random one\n", duration(plan.way).c_str(),
                  duration(plan.way_random).c_str());
  std::string counts, sigmas;
  for (const std::size_t n : told_counts(plan.curve.size() - 1)) {
    counts += printed(" %8zu", n);
    sigmas += printed(" %8s", mm(plan.curve[n]).c_str());
  }
  text += "how many: " + enough_words(plan, target) + "\n  count     " + counts + "\n  sigma, mm " +
          sigmas + "\n";
  return text;
}

Json plan_json(const Robot& robot, const PlanRequest& request, const ConfigurationPlan& plan,
               double target) {
  Json json{{"robot", robot.name()},
            {"criterion", to_string(request.criterion)},
            {"count", plan.units.size()},
            {"candidates", plan.candidates},
            {"parameters", plan.parameters},
            {"aligned", plan.aligned},
            {"before", {{"sigma", finite(plan.sigma_before)}}},
            {"sigma_beyond", finite(plan.sigma_beyond)},
            {"random", figures_json(plan.random)},
            {"planned", figures_json(plan.planned)},
            {"motion", {{"time", plan.way}, {"time_random_order", plan.way_random}}},
            {"target", target}};
  const int count = enough(plan.curve, target);
  json["enough"] = count < 0 ? Json(nullptr) : Json(count);
  json["curve"] = array_of(plan.curve, finite);
  json["configurations"] = Json::array();
  const Observations& rows = plan.data.rows;
  for (int row = 0; row < rows.rows(); ++row) {
    const Set& set = plan.data.sets[rows.set[row]];
    Json each{{"set", set.name}};
    if (rows.group[row] >= 0) each["group"] = set.groups[rows.group[row]];
    const Eigen::VectorXd q = rows.q.row(row).transpose();
    each["q"] = array_of(q, finite);
    json["configurations"].push_back(std::move(each));
  }
  return json;
}

}  // namespace selfcal
