#include "tests/support/bridged_session.h"

#include <csignal>
#include <cstdio>

#include "tests/support/text.h"

namespace selfcal {

std::size_t calibrate_through_bridge(Cell& cell, const std::string& action) {
  Running bridge({"bridge", cell.folder / "config.yaml", "--action", action, "--touch", "touch",
                  "--acceleration", "3000"},
                 cell.folder / "bridge.log");
  cell.start_service();
  if (!cell.start_session() ||
      !cell.until([&] { return !cell.results.empty() || cell.in_state("fault"); }))
    return 0;
  if (cell.in_state("fault")) {
    ADD_FAILURE() << cell.statuses.back().why << cell.log() << text_of(cell.folder / "bridge.log");
    return 0;
  }
  EXPECT_TRUE(bridge.alive());
  std::size_t taken = 0, all = 0;
  for (const TouchRecord& touch : must(cell.store()->touches(1))) {
    ++all;
    taken += touch.outcome == TouchOutcome::taken;
  }
  const ResultMessage& result = cell.results.back();
  std::printf("%zu of %zu touches taken; %s, %.3g to %.3g mm\n", taken, all, result.answer.c_str(),
              1e3 * result.check_before, 1e3 * result.check_after);
  EXPECT_GE(taken, 60u);
  EXPECT_EQ(result.answer, "improved");
  EXPECT_EQ(bridge.end(SIGTERM), 0);
  return taken;
}

}  // namespace selfcal
