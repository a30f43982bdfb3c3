// One function for each part of diagnosis.json, in the order of the file.
#include "app/report/diagnosis_json.h"

#include <cmath>

#include "io/files/json_parts.h"

namespace selfcal {
namespace {

Json of_gap(const Gap& gap) {
  const auto known = [&](double number) { return gap.rows > 0 ? finite(number) : Json(nullptr); };
  Json json = Json::object({{"rms_nominal", known(gap.rms_nominal)},
                            {"rms_before", known(gap.rms_before)},
                            {"rms_after", known(gap.rms_after)},
                            {"rms_all", known(gap.rms_all)},
                            {"max_before", known(gap.max_before)},
                            {"max_after", known(gap.max_after)},
                            {"max_all", known(gap.max_all)},
                            {"noise_floor", known(gap.noise_floor)}});
  const auto add = [&](const Closed& closed, const char* fraction, const char* interval) {
    json[fraction] = closed.fraction ? finite(*closed.fraction) : Json(nullptr);
    const bool bounded = closed.fraction && std::isfinite(closed.least + closed.most);
    json[interval] =
        bounded ? Json::array({finite(closed.least), finite(closed.most)}) : Json(nullptr);
  };
  add(gap.closed, "closed_fraction", "closed_interval");
  add(gap.closed_all, "closed_all", "closed_all_interval");
  json["judged_on"] = gap.validated_on;
  json["rows"] = gap.rows;
  json["false_rows"] = gap.false_rows;
  const Rms& all = gap.with_false_rows;
  json["with_false_rows"] = Json::object({{"rms_before", known(all.before)},
                                          {"rms_after", known(all.after)},
                                          {"rms_all", known(all.all)}});
  return json;
}

Json of_value(const NamedValue& p) {
  return Json::object({{"name", p.name},
                       {"value", finite(p.value)},
                       {"sigma", finite(p.sigma)},
                       {"unit", p.unit},
                       {"usual", {p.usual_least, p.usual_most}}});
}

Json or_null(const std::optional<double>& value) { return value ? finite(*value) : Json(nullptr); }

Json of_named(const CauseResult& cause) {
  return Json::object({{"effect", cause.effect},
                       {"where", cause.where},
                       {"probability", finite(cause.probability)},
                       {"closes_alone", or_null(cause.closes_alone)},
                       {"closes_beside", or_null(cause.closes_beside)}});
}

Json of_candidate(const CauseResult& cause) {
  return Json::object({{"effect", cause.effect},
                       {"where", cause.where},
                       {"shape", cause.shape},
                       {"probability", finite(cause.probability)},
                       {"p_value", finite(cause.p_value)},
                       {"rms_after", cause.rms_after > 0 ? finite(cause.rms_after) : Json(nullptr)},
                       {"survival", finite(cause.beyond_nuisance)},
                       {"visible", finite(cause.visible)},
                       {"parameters", array_of(cause.parameters, of_value)},
                       {"confounded_with", cause.confounded_with}});
}

Json of_shown(const ShownCause& cause) {
  return Json::object({{"effect", cause.effect},
                       {"where", cause.where},
                       {"probability", finite(cause.probability)},
                       {"parameters", array_of(cause.parameters, of_value)},
                       {"confounded_with", cause.confounded_with}});
}

Json of_shared(const SharedCause& cause) {
  Json json = Json::object({{"effect", cause.effect}, {"where", cause.where}});
  json["parameters"] = array_of(cause.parameters, [](const SideBySide& each) {
    return Json::object({{"name", each.robot.name},
                         {"unit", each.robot.unit},
                         {"robot", finite(each.robot.value)},
                         {"robot_sigma", finite(each.robot.sigma)},
                         {"simulation", finite(each.simulation.value)},
                         {"simulation_sigma", finite(each.simulation.sigma)},
                         {"sigmas", finite(each.sigmas)}});
  });
  return json;
}

Json of_where(const Where& where) {
  Json joints = Json::object(), sets = Json::object();
  for (const Share& each : where.by_joint) joints[each.name] = finite(each.share);
  for (const Share& each : where.by_set) sets[each.name] = finite(each.share);
  Json json = Json::object({{"by_joint", std::move(joints)}, {"by_set", std::move(sets)}});
  json["by_region"] = array_of(where.by_region, [](const Region& r) {
    return Json::object({{"center", {r.centre.x(), r.centre.y(), r.centre.z()}},
                         {"radius", finite(r.radius)},
                         {"share", finite(r.share)}});
  });
  json["by_time"] = array_of(where.by_time, [](const Interval& i) {
    return Json::object({{"from", i.from}, {"to", i.to}, {"share", finite(i.share)}});
  });
  return json;
}

}  // namespace

nlohmann::ordered_json to_json(const Comparison& comparison) {
  Json json = Json::object({{"why", comparison.why},
                            {"none", finite(comparison.none)},
                            {"unknown", finite(comparison.unknown)}});
  json["changes"] = array_of(comparison.changes, [](const Change& each) {
    return Json::object({{"effect", each.effect},
                         {"where", each.where},
                         {"probability", finite(each.probability)},
                         {"values", array_of(each.values, of_value)}});
  });
  return json;
}

nlohmann::ordered_json to_json(const Differences& differences) {
  return Json::object({{"why", differences.sentences},
                       {"robot_only", array_of(differences.robot_only, of_shown)},
                       {"simulation_only", array_of(differences.simulation_only, of_shown)},
                       {"both", array_of(differences.both, of_shared)},
                       {"geometry", to_json(differences.geometry)}});
}

nlohmann::ordered_json to_json(const Diagnosis& diagnosis) {
  Json json = Json::object();
  json["gap"] = of_gap(diagnosis.gap);
  json["verdict"] = Json::object({{"effect", diagnosis.verdict.effect},
                                  {"where", diagnosis.verdict.where},
                                  {"probability", finite(diagnosis.verdict.probability)},
                                  {"p_value", finite(diagnosis.p_value)},
                                  {"why", diagnosis.why}});
  json["verdict"]["named"] = array_of(diagnosis.named, of_named);
  json["candidates"] = array_of(diagnosis.candidates, of_candidate);
  json["practice"] = Json::object({{"sessions", diagnosis.simulation.sessions},
                                   {"right", finite(diagnosis.simulation.right)},
                                   {"false_alarms", finite(diagnosis.simulation.false_alarms)},
                                   {"temperature", finite(diagnosis.simulation.temperature)}});
  json["where"] = of_where(diagnosis.where);
  json["detectable"] = array_of(diagnosis.detectable, [](const Detectable& each) {
    return Json::object({{"effect", each.effect},
                         {"where", each.where},
                         {"smallest", finite(each.smallest)},
                         {"unit", each.unit}});
  });
  json["untestable"] = array_of(diagnosis.untestable, [](const Untestable& each) {
    return Json::object({{"effect", each.effect}, {"where", each.at}, {"why", each.why}});
  });
  json["next"] = array_of(diagnosis.next, [](const NextStep& each) {
    return Json::object({{"what", each.what},
                         {"separates", each.separates},
                         {"probability_after", finite(each.probability_after)}});
  });
  json["next_why"] = diagnosis.next_why;
  json["rejected"] = array_of(diagnosis.outliers, [](const Outlier& each) {
    return Json::object({{"row", each.row},
                         {"set", each.set},
                         {"part", each.check ? "check" : "fit"},
                         {"residual", finite(each.residual)},
                         {"why", each.why}});
  });
  json["warnings"] = diagnosis.warnings;
  return json;
}

nlohmann::ordered_json next_json(const Diagnosis& diagnosis, const DataSet& data) {
  const auto cells = [](const Eigen::MatrixXd& values, Eigen::Index row) {
    Json list = Json::array();
    for (Eigen::Index i = 0; i < values.cols(); ++i) list.push_back(finite(values(row, i)));
    return list;
  };
  Json json;
  json["steps"] = array_of(diagnosis.next, [&](const NextStep& each) {
    Json rows = Json::array();
    for (int row = 0; row < each.rows.rows(); ++row) {
      Json one = {{"set", data.sets[each.rows.set[row]].name}, {"q", cells(each.rows.q, row)}};
      if (each.rows.wrench.rows() > 0) one["wrench"] = cells(each.rows.wrench, row);
      if (each.rows.velocity.rows() > 0) one["dq"] = cells(each.rows.velocity, row);
      if (each.rows.time.size() > 0 && !data.order_is_time)
        one["time"] = finite(each.rows.time[row]);
      if (!each.rows.repeat.empty() && each.rows.repeat[row] >= 0)
        one["repeat"] = "n" + std::to_string(each.rows.repeat[row]);
      rows.push_back(std::move(one));
    }
    return Json::object({{"what", each.what},
                         {"separates", each.separates},
                         {"probability_after", finite(each.probability_after)},
                         {"rows", rows}});
  });
  json["why"] = diagnosis.next_why;
  return json;
}

}  // namespace selfcal
