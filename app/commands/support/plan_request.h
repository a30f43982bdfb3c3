// What `selfcal plan` is asked, as the planning takes it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/commands/support/method_sets.h"
#include "constraints/planning/configuration_plan.h"
#include "constraints/planning/next_place.h"

namespace selfcal {

/// As the command line has them.
struct PlanArguments {
  std::string file, separate, start, prior, further, out, criterion = "sigma";
  MethodOptions options;
  int count = 30, candidates = 1000, groups = 2, step = 1;
  std::vector<double> speed, workspace;
  std::optional<double> target;
  double spacing = 0, longest = 0;
  unsigned long long seed = 1;
  bool json = false;
};

/// What the options ask of a robot.
Result<PlanRequest> plan_request(const Robot& robot, const PlanArguments& arguments);

/// Where a further set of the method that is asked for would help most, beside `planned`.
Result<NextRequest> next_request(const Robot& robot, const PlanArguments& arguments,
                                 DataSet planned);

}  // namespace selfcal
