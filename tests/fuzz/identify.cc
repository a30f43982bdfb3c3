// The identification of a small data set, told in every way the program has: what is said to be
// known is a number, and what is written reads back.
#include "app/report/page/identification_page.h"
#include "app/report/summary.h"
#include "constraints/estimation/engagements.h"
#include "io/files/solution_json.h"
#include "tests/fuzz/small_data_set.h"

namespace selfcal {
namespace {

void expect_known(const Solution& solution) {
  for (const ParameterResult& each : solution.parameters) {
    const std::string& name = each.parameter.name;
    promise(std::isfinite(each.value), name + " is no number");
    if (each.status != Status::identified && each.status != Status::grouped) continue;
    promise(std::isfinite(each.sigma) && each.sigma >= 0, name + " has no sigma");
  }
  for (const SetResult& set : solution.sets)
    for (const NuisanceResult& each : set.nuisance)
      promise(std::isfinite(each.value), set.name + "." + each.name + " is no number");
  promise(solution.covariance.allFinite(), "a covariance is no number");
  promise(solution.verdict.p_value >= 0 && solution.verdict.p_value <= 1, "no p value");
  promise(std::isfinite(solution.residual.fit.rms_after), "no rms of the rows");
  promise(std::isfinite(solution.residual.check.rms_after), "no rms of the rows kept aside");
  promise(solution.endpoint.poses == 0 || std::isfinite(solution.endpoint.rms), "no sigma");
  promise(solution.workspace.poses == 0 || std::isfinite(solution.workspace.rms), "no sigma");
}

void try_identify(Bytes bytes) {
  Options options;
  const std::uint8_t asked = bytes.byte();
  options.gears = asked % 4 == 1;
  if (asked % 8 == 2) options.fix = {"d*"};
  if (asked % 8 == 3) options.fix = {"*"};
  const auto loaded = small_data_set(bytes);
  if (!loaded) return;
  const Robot& robot = *loaded->robot;
  std::erase_if(options.fix,
                [&](const std::string& name) { return match_parameters(robot, name).empty(); });
  const Engagements found = identify_engagements(robot, loaded->data, options);
  const Solution& solution = found.solution;
  expect_known(solution);
  const auto json = to_json(solution, robot.name(), model_hash(robot));
  promise(!json.dump(1).empty() && !summary(found.data, solution).empty(), "told in no word");
  promise(!page_of(identification_data({robot, found.data, "given", 0}, solution)).empty(),
          "no page");
  const auto again = robot_of(robot_text(robot, solution.values), "calibrated.robot.yaml");
  promise(again.has_value(), again ? "" : again.error().what);
}

}  // namespace
}  // namespace selfcal

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  selfcal::try_identify({data, size});
  return 0;
}
