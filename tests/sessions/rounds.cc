// A session by rounds: planned anew from what is known, and ended once that is enough.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/service/session/session.h"
#include "tests/support/cell.h"
#include "tests/support/end_position.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

using nlohmann::json;

CellOptions by_rounds() {
  CellOptions options;
  options.live = true;
  options.config = "rounds: {touches: 50, margin: 1.5}\nlimits: {planning: 600}\n";
  return options;
}

void set_target(const Cell& cell, const std::string& target) {
  std::string text = text_of(cell.folder / "config.yaml");
  replace(text, "target: 1.0e-3", "target: " + target);
  std::ofstream(cell.folder / "config.yaml") << text;
}

/// The median error (m) of the end position after the result.
double error_of(const Cell& cell, const ResultMessage& result) {
  const auto machine = cell.machine();
  Eigen::VectorXd found = values(machine->robot());
  const json solution = json::parse(result.json);
  for (const json& each : solution["parameters"])
    found[find_parameter(machine->robot(), each["name"].get<std::string>())] = each["value"];
  return aligned_errors(machine->robot(), found, machine->truth().xi)[250];
}

/// How often a session that was planned went back to planning.
int further_plans(const Cell& cell) {
  int count = -1;
  std::string last;
  for (const StatusMessage& each : cell.statuses) {
    count += each.state == "planning" && last != "planning";
    last = each.state;
  }
  return count;
}

TEST(Rounds, EndASessionOnceTheTargetIsReachedWithMargin) {
  Cell cell(by_rounds());
  set_target(cell, "0.5e-3");
  cell.start_robot();
  cell.start_service();
  ASSERT_TRUE(cell.start_session());
  ASSERT_TRUE(cell.until([&] { return !cell.results.empty() && cell.in_state("idle"); }));
  const ResultMessage& result = cell.results.back();
  EXPECT_EQ(result.answer, "improved") << result.why;
  EXPECT_EQ(result.decision, "applied") << result.why;
  EXPECT_LE(result.endpoint_sigma, 0.5e-3 / 1.5);
  const std::size_t planned = must(cell.store()->plan(result.session)).size();
  std::printf("target 0.5 mm: sigma %.4f mm, median error %.4f mm after %zu of 240 touches\n",
              1e3 * result.endpoint_sigma, 1e3 * error_of(cell, result), planned);
  EXPECT_LT(planned, 240U);
  EXPECT_LT(error_of(cell, result), 0.5e-3);
}

TEST(Rounds, PlanTheRestAnewAndGoOnWhereTheServiceIsKilledMeanwhile) {
  Cell cell(by_rounds());
  set_target(cell, "1.0e-5");  // more than all touches tell
  cell.start_robot();
  cell.start_service();
  ASSERT_TRUE(cell.start_session());
  ASSERT_TRUE(cell.until([&] { return cell.touches() > 0 && cell.in_state("planning"); }));
  cell.kill_service();
  const std::size_t before = cell.touches();
  cell.start_service();
  ASSERT_TRUE(cell.until([&] { return !cell.results.empty(); }, 600 * kSecond));
  const ResultMessage& result = cell.results.back();
  EXPECT_EQ(result.session, 1) << "the same session";
  const auto plan = must(cell.store()->plan(1));
  EXPECT_EQ(plan.size(), 240U) << "all are made where the target is not reached";
  std::printf("%zu touches before the kill; %d further plans; sigma %.4f mm, error %.4f mm\n",
              before, further_plans(cell), 1e3 * result.endpoint_sigma,
              1e3 * error_of(cell, result));
  EXPECT_GE(further_plans(cell), 3);
  const auto touched = std::ranges::find_if(
      cell.progress, [](const ProgressMessage& each) { return !each.set.empty(); });
  EXPECT_TRUE(std::all_of(touched, cell.progress.end(), [&](const ProgressMessage& each) {
    return each.session == result.session && each.planned > 0;
  })) << "planning goes on within the session";
  EXPECT_LT(error_of(cell, result), 0.1e-3);
}

}  // namespace
}  // namespace selfcal
