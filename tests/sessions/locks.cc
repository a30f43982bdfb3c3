// Sessions of a platform whose passive joints are locked one after another, and whose locks slip.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support/cell.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A whole session with locks that slip by 1 mrad where `slips` says so.
ResultMessage lock_session(Cell& cell) {
  cell.start_service();
  if (!cell.start_session()) return {};
  cell.until([&] { return !cell.results.empty(); });
  return cell.results.empty() ? ResultMessage{} : cell.results.back();
}

CellOptions lock_cell(const std::string& slips, const std::string& faults = {}) {
  CellOptions options;
  options.robot = "stewart_lock";
  options.machine = "lock_time: 0.3, lock_slips: [" + slips + "]" +
                    (faults.empty() ? "" : ", faults: [" + faults + "]");
  return options;
}

/// A session that a fault ends: until the service stands still and says `why`.
void expect_a_fault(const std::string& fault, const std::string& why) {
  Cell cell(lock_cell("", fault));
  cell.start_service();
  ASSERT_TRUE(cell.start_session());
  EXPECT_TRUE(cell.until(
      [&] {
        return std::ranges::any_of(cell.statuses, [&](const StatusMessage& each) {
          return each.state == "fault" && each.why.find(why) != std::string::npos;
        });
      },
      60 * kSecond))
      << why;
  EXPECT_TRUE(cell.results.empty());
}

/// Largest error of an identified parameter over its sigma.
double worst_sigmas(const Cell& cell, const ResultMessage& result) {
  const auto machine = cell.machine();
  const auto solution = nlohmann::json::parse(result.json);
  double worst = 0;
  for (const auto& each : solution["parameters"]) {
    if (each["status"] != "identified") continue;
    const int i = find_parameter(machine->robot(), each["name"].get<std::string>());
    worst = std::max(worst, std::abs(each["value"].get<double>() - machine->truth().xi[i]) /
                                each["sigma"].get<double>());
  }
  return worst;
}

TEST(LockSession, CalibratesAPlatformWithoutAProbe) {
  Cell cell(lock_cell(""));
  const ResultMessage result = lock_session(cell);
  EXPECT_EQ(result.answer, "improved") << result.why;
  EXPECT_EQ(result.decision, "applied") << result.why;
  EXPECT_THAT(result.why, HasSubstr(" mrad;"));
  EXPECT_LT(worst_sigmas(cell, result), 5);  // of some 40 parameters
  EXPECT_THAT(cell.log(), Not(HasSubstr("slipped")));
}

TEST(LockSession, FitsTheRowsAfterASlipOnTheirOwnAndSaysSo) {
  Cell cell(lock_cell("20"));
  const ResultMessage result = lock_session(cell);
  EXPECT_EQ(result.answer, "improved") << result.why;
  // The first lock has thirty configurations; 20 urad of play, known from eleven rows at least on
  // either side: 4 sigma.
  EXPECT_THAT(cell.log(),
              testing::ContainsRegex("slipped by (0\\.9[6-9]|1|1\\.0[1-4]) mrad between "
                                     "configurations 19 and 20 of 90"));
  EXPECT_THAT(result.json, HasSubstr("slipped by"));
  EXPECT_LT(worst_sigmas(cell, result), 5);
}

TEST(LockSession, AsksAPersonWhenALockSlipsAgainAndAgain) {
  Cell cell(lock_cell("8, 15, 22"));
  const ResultMessage result = lock_session(cell);
  EXPECT_THAT(cell.log(), HasSubstr("its lock slipped again and again; all of it is put aside"));
  EXPECT_EQ(result.decision, "candidate") << result.why;
}

TEST(LockSession, StopsWhereALockIsRefusedComesTooLateOrOpensByItself) {
  expect_a_fault("{what: lock_refuse, at: 0}", "the lock for configuration 1 of 90 was refused");
  expect_a_fault("{what: lock_late, at: 0}",
                 "its release before configuration 1 of 90 took longer");
  expect_a_fault("{what: lock_open, at: 0}",
                 "the lock's confirmation by the trigger for configuration 1 of 90 took longer");
  expect_a_fault("{what: lock_open, at: 60}", "the lock opened by itself at configuration ");
}

}  // namespace
}  // namespace selfcal
