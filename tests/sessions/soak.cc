// A robot's nights, one after the other with the clock speeded up: it drifts, it breathes with the
// seasons, and now and then something happens to it. Every event is found in the night after it,
// nothing is found where nothing is, and neither memory nor store grow beyond their bounds.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "app/service/loop/service.h"
#include "kinematics/description.h"
#include "sim/ports.h"
#include "tests/support/cell.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

constexpr std::int64_t kDay = 86'400'000;  // ms

/// Takes what the service tells of sessions later than those that it knows.
class NightListener final : public Messenger {
 public:
  explicit NightListener(std::int64_t known) : known_(known) {}
  void publish(const StatusMessage&) override {}
  void publish(const ProgressMessage&) override {}
  void publish(const ResultMessage& result) override {
    if (result.session > known_) results.push_back(result);
  }
  void publish(const std::vector<HealthMessage>&, const std::string&) override {}
  void reply(const CommandReplyMessage&) override {}
  void take(std::vector<CommandMessage>&) override {}
  std::uint64_t refused() const override { return 0; }
  std::uint64_t unsent() const override { return 0; }

  std::vector<ResultMessage> results;

 private:
  std::int64_t known_;
};

/// What is otherwise than on the first night.
struct NightChange {
  double theta2 = 0, r4 = 0, theta3 = 0;  // rad, m, rad
  /// How far the end is off by it, roughly: an arm of a metre.
  double size() const { return std::abs(theta2) + std::abs(r4) + std::abs(theta3); }
  NightChange operator-(const NightChange& o) const {
    return {theta2 - o.theta2, r4 - o.r4, theta3 - o.theta3};
  }
};

double own_megabytes() {
  std::ifstream pages("/proc/self/statm");
  std::size_t mapped = 0, resident = 0;
  pages >> mapped >> resident;
  return static_cast<double>(resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE))) / 1e6;
}

class Soak : public testing::Test {
 protected:
  static CellOptions options() {
    CellOptions options;
    options.id = "soak";
    options.touches = 16;
    // Planning and identification are as fast as the computer, and the clock is not.
    options.config =
        "limits: {planning: 3600, computing: 3600}\n"
        "store_mb: 2\n";
    return options;
  }

  void SetUp() override {
    std::string config = text_of(cell.folder / "config.yaml");
    replace(config, "\nschedule: {}",
            "\nschedule: {every_hours: 0.001, check_first: true, check_p: 1.0e-4, "
            "full_after_checks: 30}");
    std::ofstream(cell.folder / "config.yaml") << config;
    scenario = text_of(cell.folder / "rx90_cell.scenario.yaml");
    const auto machine = cell.machine();
    for (const char* name : {"theta2", "r4", "theta3"}) {
      const int at = find_parameter(machine->robot(), name);
      first[name] = machine->truth().xi[at] - nominal_values(machine->robot())[at];
    }
  }

  /// Steady wear, a year's breathing, and a collision at each event.
  NightChange change_of(int night) const {
    const double year = 2 * std::numbers::pi * night / 365.0;
    return {2e-8 * night, 10e-6 * std::sin(year), 4e-4 * (night / event_every)};
  }

  /// Sessions of one night, by a service that is started in the evening and ended in the morning.
  std::vector<ResultMessage> sleep_over(int night) {
    const NightChange change = change_of(night);
    std::string tonight = scenario;
    replace(tonight, "errors:",
            "errors:\n  parameters: {theta2: " + format_number(first["theta2"] + change.theta2) +
                ", r4: " + format_number(first["r4"] + change.r4) +
                ", theta3: " + format_number(first["theta3"] + change.theta3) + "}");
    std::ofstream(cell.folder / "rx90_cell.scenario.yaml") << tonight;
    Config config = must(load_config(cell.folder / "config.yaml"));
    const auto machine = must(load_machine(cell.folder / "rx90_cell.scenario.yaml", config));
    std::filesystem::create_directories(config.state);
    auto opened = must(Store::open(config.state));
    EXPECT_EQ(opened.set_aside, "");
    Journal journal(must(Store::open(config.state)).store);
    Models models = must(Models::load(config.robot, *opened.store));
    // While the robot stands, a fifth of a millisecond is twenty.
    SimulatedPorts ports(*machine, kFirstEvening + night * kDay, [](Nanoseconds longest) {
      usleep(200);
      return std::min<Nanoseconds>(longest, 20 * kMillisecond);
    });
    NightListener listener(last_session);
    Service service(std::move(config), ports.ports(), listener, *opened.store, journal,
                    std::move(models), "");
    const auto asleep = [&] {
      return !listener.results.empty() && service.extended_state().state == ServiceState::idle &&
             (listener.results.back().kind == "full" ||
              listener.results.back().answer == "explained");
    };
    while (!asleep() && service.extended_state().state != ServiceState::fault) service.turn();
    EXPECT_EQ(service.extended_state().state, ServiceState::idle) << service.extended_state().why;
    service.shut_down();
    bytes = must(opened.store->bytes());
    if (!listener.results.empty()) last_session = listener.results.back().session;
    return listener.results;
  }

  static constexpr std::int64_t kFirstEvening = 1'790'000'000'000;
  Cell cell{options()};
  std::string scenario;
  std::map<std::string, double> first;  ///< errors of the first night
  int event_every = 90;
  std::int64_t bytes = 0, last_session = 0;
};

TEST_F(Soak, FindsEveryEventAndNothingElseNightAfterNight) {
  const int nights = repetitions("SELFCAL_NIGHTS", 12);
  event_every = nights < 100 ? 5 : 90;
  int events = 0, recognised = 0, false_alarms = 0, checks = 0, full = 0, followed = 0;
  NightChange calibrated;
  double early = 0;
  std::int64_t largest = 0;
  for (int night = 0; night < nights && !HasFailure(); ++night) {
    const NightChange change = change_of(night);
    const bool event = night > 0 && night % event_every == 0;
    const double off = (change - calibrated).size();
    const std::vector<ResultMessage> results = sleep_over(night);
    ASSERT_FALSE(results.empty()) << "night " << night;
    const bool checked = results.front().kind == "check";
    const bool alarm = checked && results.front().answer == "not-explained";
    checks += checked;
    events += event;
    recognised += event && (alarm || !checked);
    if (!event && alarm) off < 2e-5 ? ++false_alarms : ++followed;
    const ResultMessage& last = results.back();
    if (last.kind == "full") {
      ++full;
      if (last.decision == "applied") calibrated = change;
      EXPECT_TRUE(!event || last.decision == "applied") << "night " << night << ": " << last.why;
    }
    largest = std::max(largest, bytes);
    if (night == nights / 4) early = own_megabytes();
  }
  const double late = own_megabytes();
  std::printf(
      "%d nights: %d checks, %d full sessions; %d events, %d recognised; %d times drift was "
      "followed, %d false alarms; %.1f MB after a quarter, %.1f MB at the end; store %.2f MB at "
      "most\n",
      nights, checks, full, events, recognised, followed, false_alarms, early, late,
      1e-6 * static_cast<double>(largest));
  EXPECT_EQ(recognised, events);
  EXPECT_EQ(false_alarms, 0);
  EXPECT_LT(late, early + 8) << "the allocator's own reserves aside, it does not grow";
  EXPECT_LT(largest, 2'200'000) << "store_mb: 2, and what the last session added";
  // What happened stands in the history: each event's session, applied.
  int applied = 0;
  for (const ResultRecord& result : must(cell.store()->results(1'000'000)))
    applied += result.decision == ResultDecision::applied;
  EXPECT_GE(applied, events + 1);
}

}  // namespace
}  // namespace selfcal
