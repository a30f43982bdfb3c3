#include "app/report/plan_report.h"

#include <algorithm>

#include "app/report/curve_report.h"
#include "app/report/format.h"
#include "io/files/json_parts.h"

namespace selfcal {
namespace {

std::string joined_names(const std::vector<Set>& sets) {
  std::string names;
  for (const Set& each : sets) names += (names.empty() ? "" : ", ") + each.name;
  return names;
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

std::string plan_report(const Robot& robot, const PlanRequest& request,
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
  const double least = std::min(plan.random.observability.o1, plan.planned.observability.o1);
  text += printed("observability of %d parameters%s\n  %-10s %12s %12s\n", plan.parameters,
                  least > 0 ? "" : " (-: so few configurations do not tell all of them)", "",
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
  text += curve_report(plan.curve, target, "of them", "");
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
  put_curve(plan.curve, target, json);
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
