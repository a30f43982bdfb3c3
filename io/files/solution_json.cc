// One function for each part of result.json, in the order of the file.
#include "io/files/solution_json.h"

#include "io/files/json_parts.h"

namespace selfcal {
namespace {

/// Standard deviations are negative where there is none.
Json sigma(double number) { return number < 0 ? Json(nullptr) : finite(number); }

Json of_verdict(const Verdict& verdict) {
  return Json::object({{"answer", to_string(verdict.answer)},
                       {"why", verdict.why},
                       {"p_value", finite(verdict.p_value)}});
}

Json of_parameter(const ParameterResult& result) {
  const auto carrier = [](const Carrier& each) {
    return Json::object({{"name", each.name}, {"coefficient", finite(each.coefficient)}});
  };
  return Json::object({{"name", result.parameter.name},
                       {"frame", result.parameter.frame},
                       {"unit", result.parameter.unit()},
                       {"nominal", finite(result.parameter.nominal)},
                       {"value", finite(result.value)},
                       {"sigma", sigma(result.sigma)},
                       {"prior_sigma", finite(result.parameter.tolerance)},
                       {"status", to_string(result.status)},
                       {"grouped_with", array_of(result.grouped_with, carrier)}});
}

Json of_covariance(const Solution& solution) {
  Json matrix = Json::array();
  for (Eigen::Index i = 0; i < solution.covariance.rows(); ++i) {
    matrix.push_back(array_of(solution.covariance.row(i), finite));
  }
  return Json::object({{"order", solution.covariance_order}, {"matrix", std::move(matrix)}});
}

Json of_set(const SetResult& set) {
  const auto nuisance = [](const NuisanceResult& each) {
    return Json::object(
        {{"name", each.name}, {"value", finite(each.value)}, {"sigma", sigma(each.sigma)}});
  };
  Json json = Json::object({{"name", set.name},
                            {"method", set.method},
                            {"rows", set.rows},
                            {"used", set.used},
                            {"aligned", set.aligned},
                            {"noise_sigma", finite(set.noise_sigma)}});
  if (set.noise_angle_sigma > 0) json["noise_angle_sigma"] = finite(set.noise_angle_sigma);
  if (set.repeat_sigma >= 0) json["repeat_sigma"] = finite(set.repeat_sigma);
  if (set.repeat_angle_sigma >= 0) json["repeat_angle_sigma"] = finite(set.repeat_angle_sigma);
  json["own"] = array_of(set.nuisance, nuisance);
  return json;
}

Json of_outlier(const Outlier& outlier) {
  return Json::object({{"row", outlier.row},
                       {"set", outlier.set},
                       {"part", outlier.check ? "check" : "fit"},
                       {"residual", finite(outlier.residual)},
                       {"why", outlier.why}});
}

/// Appends figures (Figures or AngleFigures) to `json`; without rows there are none.
template <class Any>
void add_numbers(const Any& figures, Json& json) {
  const auto known = [&](double number) {
    return figures.rows > 0 ? finite(number) : Json(nullptr);
  };
  json["rows"] = figures.rows;
  json["rms_before"] = known(figures.rms_before);
  json["rms_after"] = known(figures.rms_after);
  json["mean_after"] = known(figures.mean_after);
  json["max_after"] = known(figures.max_after);
}

void add_figures(const Figures& figures, Json& json) {
  add_numbers(figures, json);
  if (figures.angle.rows > 0) add_numbers(figures.angle, json["angle"]);
}

Json of_residuals(const Residuals& residuals) {
  Json fit = Json::object(), check = Json::object();
  add_figures(residuals.fit, fit);
  add_figures(residuals.check, check);
  check["rms_without_rejected"] =
      residuals.check.rows > 0 ? finite(residuals.check.rms_without_outliers) : Json(nullptr);
  check["by_set"] = array_of(residuals.check_by_set, [](const SetFigures& set) {
    Json json = Json::object({{"name", set.name}, {"aligned", set.aligned}});
    add_figures(set.figures, json);
    return json;
  });
  return Json::object({{"fit", std::move(fit)}, {"check", std::move(check)}});
}

/// `turned`: rows tell how the endpoint is turned.
Json of_endpoint(const EndpointSigma& endpoint, bool turned) {
  const auto known = [&](double value) { return endpoint.poses > 0 ? finite(value) : Json(); };
  return Json::object({{"aligned", endpoint.aligned},
                       {"rms", known(endpoint.rms)},
                       {"median", known(endpoint.median)},
                       {"max", known(endpoint.max)},
                       {"angle_rms", turned ? known(endpoint.angle) : Json()},
                       {"poses", endpoint.poses}});
}

Json of_scale(const RobotScale& scale) {
  const auto length = [](const ScaleLength& each) {
    const bool alone = each.by_others_sigma < 0;
    return Json::object({{"set", each.set},
                         {"what", each.what},
                         {"value", finite(each.value)},
                         {"sigma", finite(each.sigma)},
                         {"share", finite(each.share)},
                         {"per_tenth_mm", finite(1e-4 * each.moves)},
                         {"expected", finite(each.expected)},
                         {"expected_sigma", sigma(each.expected_sigma)},
                         {"unseen", finite(each.unseen)},
                         {"by_others", alone ? Json() : finite(each.by_others)},
                         {"by_others_sigma", sigma(each.by_others_sigma)},
                         {"odd", each.odd}});
  };
  const bool known = !scale.stands_on.empty();
  return Json::object({{"stands_on", array_of(scale.stands_on, length)},
                       {"excess", known ? finite(scale.excess) : Json()},
                       {"excess_sigma", known ? finite(scale.excess_sigma) : Json()},
                       {"against_maker", scale.against_maker}});
}

/// Probabilities are negative where there is none.
Json of_uncertainty(const Uncertainty& u) {
  const auto line = [](const BudgetLine& each) {
    return Json::object({{"source", each.source}, {"sigma", finite(each.sigma)}});
  };
  const auto pair = [](const Correlation& each) {
    return Json::object({{"a", each.a}, {"b", each.b}, {"value", finite(each.value)}});
  };
  const auto cell = [](const GridCell& each) {
    return Json::object({{"center", array_of(each.center, finite)},
                         {"sigma", finite(each.sigma)},
                         {"bias", sigma(each.bias)},
                         {"poses", each.poses},
                         {"rows", each.rows}});
  };
  const auto figure = [](bool known, double number) { return known ? finite(number) : Json(); };
  const bool fit = u.lack_of_fit.p_value >= 0, normal = u.residuals.normality_p >= 0;
  const bool ordered = u.residuals.autocorrelation_p >= 0, repeated = u.repeats.poses > 0;
  return Json::object({{"freedoms", finite(u.freedoms)},
                       {"k95", finite(u.k)},
                       {"expanded", finite(u.expanded)},
                       {"budget", array_of(u.budget, line)},
                       {"lack_of_fit",
                        {{"F", figure(fit, u.lack_of_fit.F)},
                         {"p_value", sigma(u.lack_of_fit.p_value)},
                         {"freedoms", figure(fit, u.lack_of_fit.freedoms)},
                         {"repeat_freedoms", finite(u.lack_of_fit.repeat_freedoms)}}},
                       {"residuals",
                        {{"count", u.residuals.count},
                         {"skewness", figure(normal, u.residuals.skewness)},
                         {"kurtosis", figure(normal, u.residuals.kurtosis)},
                         {"normality_p", sigma(u.residuals.normality_p)},
                         {"autocorrelation", figure(ordered, u.residuals.autocorrelation)},
                         {"autocorrelation_p", sigma(u.residuals.autocorrelation_p)}}},
                       {"correlations", array_of(u.correlations, pair)},
                       {"repeats",
                        {{"poses", u.repeats.poses},
                         {"accuracy", figure(repeated, u.repeats.accuracy)},
                         {"repeatability", figure(repeated, u.repeats.repeatability)}}},
                       {"grid", array_of(u.grid, cell)}});
}

Json of_prior(const Solution& solution) {
  return Json::object({{"value", finite(solution.prior_chi2)},
                       {"dof", finite(solution.prior_dof)},
                       {"widening", finite(solution.prior_widening)}});
}

Json of_observability(const Observability& observability) {
  return Json::object({{"condition", finite(observability.condition)},
                       {"o1", finite(observability.o1)},
                       {"o2", finite(observability.o2)},
                       {"o3", finite(observability.o3)},
                       {"o4", finite(observability.o4)},
                       {"o5", finite(observability.o5)}});
}

}  // namespace

nlohmann::ordered_json to_json(const ControllerSigma& controller) {
  return Json::object({{"parameters", controller.parameters},
                       {"left", finite(controller.left)},
                       {"sigma", sigma(controller.sigma)}});
}

nlohmann::ordered_json to_json(const Solution& solution, const std::string& robot_name,
                               const std::string& model_hash) {
  const auto note_as = [](const char* key) {
    return [key](const Note& note) {
      return Json::object({{"parameter", note.parameter}, {key, note.text}});
    };
  };
  Json json = Json::object();
  json["robot"] = robot_name;
  json["model_hash"] = model_hash;
  json["converged"] = solution.converged;
  json["stop_reason"] = solution.stop_reason;
  json["iterations"] = solution.iterations;
  json["verdict"] = of_verdict(solution.verdict);
  json["parameters"] = array_of(solution.parameters, of_parameter);
  json["covariance"] = of_covariance(solution);
  json["gauge"] = array_of(solution.gauge, note_as("why"));
  json["unexcited"] = array_of(solution.unexcited, note_as("what"));
  json["sets"] = array_of(solution.sets, of_set);
  json["rejected"] = array_of(solution.outliers, of_outlier);
  json["residual"] = of_residuals(solution.residual);
  json["endpoint_sigma"] = of_endpoint(solution.endpoint, solution.orientation_seen);
  json["endpoint_sigma"]["workspace"] = of_endpoint(solution.workspace, solution.orientation_seen);
  json["endpoint_sigma"]["strays"] = solution.strays;
  json["scale"] = of_scale(solution.scale);
  json["uncertainty"] =
      solution.uncertainty.budget.empty() ? Json() : of_uncertainty(solution.uncertainty);
  json["prior_chi2"] = of_prior(solution);
  json["observability"] = of_observability(solution.observability);
  json["warnings"] = solution.warnings;
  return json;
}

}  // namespace selfcal
