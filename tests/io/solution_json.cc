// result.json against the file format, key by key.
#include "io/files/solution_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace selfcal {
namespace {

using testing::ElementsAre;

std::vector<std::string> keys(const nlohmann::ordered_json& json) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

Solution example() {
  Solution solution;
  solution.converged = true;
  solution.stop_reason = "step below 1e-12";
  solution.iterations = 5;
  solution.verdict = {Answer::improved, "better", 1e-9};
  ParameterResult found;
  found.parameter.name = "theta2";
  found.parameter.frame = "j2";
  found.parameter.quantity = Quantity::angle;
  found.parameter.tolerance = 2e-3;
  found.value = 0.1 + 0.2;
  found.sigma = 2.1e-6;
  ParameterResult grouped = found;
  grouped.status = Status::grouped;
  grouped.sigma = -1;
  grouped.grouped_with = {{"theta2", -1.0}};
  solution.parameters = {found, grouped};
  solution.covariance_order = {"theta2", "r3"};
  solution.covariance = Eigen::Matrix2d{{4e-12, 1e-13}, {1e-13, 9e-12}};
  solution.gauge = {{"r4", "scale is free"}};
  solution.unexcited = {{"K5", "j5 moved little"}};
  SetResult set;
  set.name = "table";
  set.method = "plane";
  set.rows = 92;
  set.nuisance = {{"table.nx", 0.01, 1e-6}};
  solution.sets = {set};
  solution.outliers = {{17, "table", 4.1e-4, false, "outlier"},
                       {18, "table", 3.9e-4, true, "outlier among the check rows"}};
  solution.residual.fit = {180, false, 1.2e-3, 2.1e-5, 1.7e-5, 6e-5, 0, {}};
  solution.strays = 3e-5;
  solution.observability.condition = std::numeric_limits<double>::infinity();
  return solution;
}

TEST(SolutionJson, HasTheKeysOfTheFormatInItsOrder) {
  const auto json = to_json(example(), "arm", "sha256:0");
  EXPECT_THAT(keys(json),
              ElementsAre("robot", "model_hash", "converged", "stop_reason", "iterations",
                          "verdict", "parameters", "covariance", "gauge", "unexcited", "sets",
                          "rejected", "residual", "endpoint_sigma", "scale", "uncertainty",
                          "prior_chi2", "observability", "warnings"));
  EXPECT_THAT(keys(json["parameters"][0]),
              ElementsAre("name", "frame", "unit", "nominal", "value", "sigma", "prior_sigma",
                          "status", "grouped_with"));
  EXPECT_THAT(keys(json["rejected"][0]), ElementsAre("row", "set", "part", "residual", "why"));
  EXPECT_THAT(keys(json["residual"]["fit"]),
              ElementsAre("rows", "rms_before", "rms_after", "mean_after", "max_after"));
  EXPECT_THAT(keys(json["residual"]["check"]),
              ElementsAre("rows", "rms_before", "rms_after", "mean_after", "max_after",
                          "rms_without_rejected", "by_set"));
  EXPECT_EQ(json["endpoint_sigma"]["strays"], 3e-5);
  EXPECT_EQ(json["gauge"].dump(), R"([{"parameter":"r4","why":"scale is free"}])");
  EXPECT_EQ(json["unexcited"].dump(), R"([{"parameter":"K5","what":"j5 moved little"}])");
  EXPECT_EQ(json["sets"][0]["own"].dump(), R"([{"name":"table.nx","value":0.01,"sigma":1e-06}])");
  EXPECT_EQ(json["covariance"]["matrix"].dump(), "[[4e-12,1e-13],[1e-13,9e-12]]");
}

TEST(SolutionJson, SpellsAnswersAndStatesAsTheFormatDoes) {
  auto solution = example();
  solution.verdict.answer = Answer::not_determined;
  solution.parameters[0].status = Status::no_effect;
  const auto json = to_json(solution, "arm", "sha256:0");
  EXPECT_EQ(json["verdict"]["answer"], "not-determined");
  EXPECT_EQ(json["parameters"][0]["status"], "no-effect");
  EXPECT_EQ(json["rejected"][0]["part"], "fit");
  EXPECT_EQ(json["rejected"][1]["part"], "check");
  EXPECT_EQ(json["parameters"][0]["unit"], "rad");
  EXPECT_EQ(json["parameters"][1]["grouped_with"].dump(),
            R"([{"name":"theta2","coefficient":-1.0}])");
}

TEST(SolutionJson, WritesNullForWhatIsNotKnown) {
  const auto json = to_json(example(), "arm", "sha256:0");
  EXPECT_TRUE(json["parameters"][1]["sigma"].is_null());
  EXPECT_TRUE(json["observability"]["condition"].is_null());
  EXPECT_EQ(json["residual"]["check"]["rows"], 0);
  EXPECT_TRUE(json["residual"]["check"]["rms_after"].is_null());
}

TEST(SolutionJson, KeepsNumbersBitByBit) {
  const std::string text = to_json(example(), "arm", "sha256:0").dump();
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json["parameters"][0]["value"].get<double>(), 0.1 + 0.2);
}

}  // namespace
}  // namespace selfcal
