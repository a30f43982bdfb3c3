// Sessions of platforms whose leg sensors read what no platform can have: touches and visits are
// put aside by name, and the session goes on.
#include <gmock/gmock.h>

#include <fstream>
#include <string>

#include "tests/support/cell.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

/// First one sensor reads far too much, then all six read too little and too much by turns.
std::string misreading(double much, double first, double second, double time) {
  const auto fault = [&](const std::string& leg, double by, double at) {
    return "{what: misread, joint: " + leg + ", by: " + std::to_string(by) +
           ", at: " + std::to_string(at) + ", for: " + std::to_string(time) + "}";
  };
  std::string faults = fault("leg3", much, first);
  for (int leg = 1; leg <= 6; ++leg)
    faults += ", " + fault("leg" + std::to_string(leg), leg % 2 == 0 ? 0.3 : -0.3, second);
  return "lock_time: 0.3, faults: [" + faults + "]";
}

/// The log of a session that went on all the same.
std::string log_of_survived(const std::string& robot, const std::string& machine,
                            const std::string& wide) {
  CellOptions options;
  options.robot = robot;
  options.machine = machine;
  Cell cell(options);
  // Sensors that could read what the legs together cannot have.
  std::string text = text_of(cell.folder / "stewart.robot.yaml");
  for (const std::string narrow = "[0.55, 1.15]"; text.find(narrow) != std::string::npos;)
    text.replace(text.find(narrow), narrow.size(), wide);
  std::ofstream(cell.folder / "stewart.robot.yaml") << text;
  cell.start_service();
  if (!cell.start_session()) return {};
  cell.until([&] { return !cell.results.empty(); });
  if (cell.results.empty()) return {};
  const ResultMessage& result = cell.results.back();
  EXPECT_EQ(result.answer, "improved") << result.why;
  EXPECT_EQ(result.decision, "applied") << result.why;
  return cell.log();
}

constexpr const char* kOutOfRange = "leg3 reads [12]\\.[0-9]*, out of its range";

TEST(PlatformSession, NamesALegOutOfRangeAndALostAssemblyModeOnPlanesAndGoesOn) {
  const std::string log = log_of_survived("stewart", misreading(0.9, 60, 90, 6), "[0.25, 1.45]");
  EXPECT_THAT(log, testing::ContainsRegex(kOutOfRange));
  EXPECT_THAT(log, HasSubstr("the assembly mode is lost: no location of the platform"));
}

TEST(PlatformSession, NamesLegsOutOfRangeUnderLocksAndGoesOn) {
  const std::string log =
      log_of_survived("stewart_lock", misreading(0.9, 60, 80, 5), "[0.25, 1.45]");
  EXPECT_THAT(log, testing::ContainsRegex(kOutOfRange));
}

TEST(PlatformSession, NamesALostAssemblyModeUnderLocksAndGoesOn) {
  const std::string log = log_of_survived("stewart_lock", misreading(1.4, 60, 80, 8), "[0.2, 1.9]");
  EXPECT_THAT(log, HasSubstr("the assembly mode is lost: no location of the platform"));
}

}  // namespace
}  // namespace selfcal
