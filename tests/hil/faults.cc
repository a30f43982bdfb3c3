// Every fault of the bus and of the line, injected once into a running session: the state that the
// service goes to, what its diagnostics say, and that nothing collected is lost.
#include <gmock/gmock.h>
#include <linux/can/error.h>
#include <signal.h>

#include <cstdio>
#include <cstring>
#include <fstream>

#include "io/clock.h"
#include "tests/hil/bus_cell.h"
#include "tests/hil/meddler.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

using testing::ContainsRegex;

constexpr canid_t kSync = 0x80, kSecondJoint = 0x182, kThirdJoint = 0x183;

void pause(Nanoseconds length) { Wakeup().wait(length); }

can_frame error_frame(canid_t classes) {
  can_frame frame{};
  frame.can_id = CAN_ERR_FLAG | classes;
  frame.len = CAN_ERR_DLC;
  return frame;
}

/// A fault, how it is ended, and what the service is to say of it.
struct Fault {
  const char* name;
  std::function<void()> inject, heal;
  const char* state;       ///< "fault", or "collecting" where it goes on
  const char* diagnostic;  ///< in one of its lines
};

/// In a session that has been planned and goes on as long as there are faults to inject.
class Faults : public InTheMachine {
 protected:
  void SetUp() override {
    InTheMachine::SetUp();
    if (IsSkipped()) return;
    meddler = std::make_unique<Meddler>(wires);
    CellOptions options = small_session();
    options.touches = 12;
    options.id = "faulty";
    options.config += "touch: {repeats: 3, most_lost: 2}\n";
    cell = std::make_unique<BusCell>(options, wires, meddler->robot());
    slow_down();
    cell->start_bus_robot();
    cell->start_service();
    ASSERT_TRUE(cell->start_session()) << cell->robot_log();
    collect();
  }

  /// A hundred samples a second are enough here, and leave the processor to the service; a robot
  /// that repeats a touch more than eight times a second is taken for a chattering line.
  void slow_down() const {
    const auto path = cell->folder / "rx90_cell.scenario.yaml";
    std::string scenario = text_of(path);
    replace(scenario, "encoder_period: 0.002", "encoder_period: 0.01");
    replace(scenario, "acceleration: 3000", "acceleration: 200");
    std::ofstream(path) << scenario;
  }

  /// Waits for two more touches.
  void collect() {
    const std::size_t done = cell->touches();
    ASSERT_TRUE(cell->until([&] { return cell->touches() >= done + 2; }, 1800 * kSecond));
  }
  /// Starts again after a fault or a session, once the service has found all well.
  void go_on() {
    ASSERT_TRUE(cell->until([&] { return cell->in_state("idle"); }, 120 * kSecond))
        << "is in " << cell->statuses.back().state << ": " << cell->statuses.back().why;
    ASSERT_TRUE(cell->start_session());
    collect();
  }
  std::string text_of_health() const {
    std::string text;
    if (cell->health.empty()) return text;
    for (const HealthMessage& line : cell->health.back().lines) {
      text += line.name + " (" + std::to_string(static_cast<int>(line.level)) + ") " + line.message;
      for (const auto& [key, value] : line.values) text += " " + key + "=" + value;
      text += "\n";
    }
    return text;
  }
  std::vector<Nanoseconds> taken() const {
    std::vector<Nanoseconds> edges;
    for (const TouchRecord& touch : must(cell->store()->touches(cell->statuses.back().session)))
      if (touch.outcome == TouchOutcome::taken) edges.push_back(touch.edge);
    return edges;
  }
  void show(const Fault& fault, const std::string& line) {
    std::printf("| %-22s | %-10s | %-100s | %-100s |\n", fault.name,
                cell->statuses.back().state.c_str(), cell->statuses.back().why.c_str(),
                line.c_str());
    std::fflush(stdout);
  }

  bool noticed(const Fault& fault);
  void go_through(const Fault& fault);
  void refuse_in_self_test(const Fault& fault);

  std::unique_ptr<Meddler> meddler;
  std::unique_ptr<BusCell> cell;
};

/// Injects the fault and waits for what the service is to say of it.
bool Faults::noticed(const Fault& fault) {
  cell->listen();
  cell->health.clear();
  fault.inject();
  std::string line;
  const bool said = cell->until(
      [&] {
        for (const HealthReport& report : cell->health)
          for (const HealthMessage& each : report.lines)
            if (each.message.find(fault.diagnostic) != std::string::npos) line = each.message;
        return !line.empty() && cell->in_state(fault.state);
      },
      180 * kSecond);
  EXPECT_TRUE(said) << text_of_health() << cell->statuses.back().why;
  show(fault, line);
  return said;
}

void Faults::go_through(const Fault& fault) {
  SCOPED_TRACE(fault.name);
  if (cell->in_state("idle")) go_on();  // the session before is done
  const std::vector<Nanoseconds> before = taken();
  ASSERT_TRUE(noticed(fault));
  fault.heal();
  // A service that goes on may still come to a fault of what the healing leaves behind.
  if (std::string(fault.state) == "fault")
    go_on();
  else
    collect();
  const std::vector<Nanoseconds> after = taken();
  ASSERT_GE(after.size(), before.size());
  EXPECT_TRUE(std::equal(before.begin(), before.end(), after.begin())) << "a touch is lost";
}

/// A fault that is there when the service starts.
void Faults::refuse_in_self_test(const Fault& fault) {
  SCOPED_TRACE(fault.name);
  cell->kill_service();
  cell->start_service();
  ASSERT_TRUE(noticed(fault));
  fault.heal();
  ASSERT_TRUE(cell->until([&] { return cell->in_state("idle"); }, 120 * kSecond));
}

TEST_F(Faults, LeadToAStateASentenceAndNoLoss) {
  const auto nothing = [](const can_frame&, const PutFrame&) {};
  const auto through = [](const can_frame& frame, const PutFrame& put) { put(frame, 0); };
  const auto honest = [&] { meddler->honest(); };
  const auto command = [](const std::string& text) { ASSERT_EQ(std::system(text.c_str()), 0); };
  const auto rule = [&](canid_t id, FrameRule of_it) {
    meddler->frames([=](const can_frame& frame, const PutFrame& put) {
      (frame.can_id == id ? of_it : FrameRule(through))(frame, put);
    });
  };
  // 140 changes a second until the service has had enough of it.
  const auto chatter = [&] {
    for (int i = 0; i < 4000 && !cell->in_state("fault"); ++i) {
      meddler->drive(i % 2 == 0);
      pause(7 * kMillisecond);
      if (i % 30 == 0) cell->listen();
    }
  };
  const std::vector<Fault> faults = {
      {"interface down and up", [&] { command("ip link set vcan0 down"); },
       [&] { command("ip link set vcan0 up"); }, "fault", "the interface is down"},
      {"bus off and restart",
       [&] {
         meddler->frames(nothing);
         meddler->put(error_frame(CAN_ERR_BUSOFF));
       },
       [&] {
         meddler->put(error_frame(CAN_ERR_RESTARTED));
         honest();
       },
       "fault", "the controller is off the bus"},
      {"error frames",
       [&] {
         for (int i = 0; i < 200; ++i) {
           meddler->put(error_frame(CAN_ERR_PROT | CAN_ERR_BUSERROR));
           pause(5 * kMillisecond);
         }
       },
       honest, "collecting", "errors on the bus"},
      {"a joint missing", [&] { rule(kThirdJoint, nothing); }, honest, "fault",
       "frames are missing (j3"},
      {"a joint late",
       [&] {
         rule(kThirdJoint,
              [](const can_frame& frame, const PutFrame& put) { put(frame, 7 * kMillisecond); });
       },
       honest, "fault", "frames come late (j3"},
      {"frames before SYNC",
       [&] {
         rule(kSync,
              [](const can_frame& frame, const PutFrame& put) { put(frame, 3 * kMillisecond); });
       },
       honest, "fault", "frames come late (j"},
      {"a counter that jumps",
       [&] {
         // One frame a second; a counter that stays where it jumped to is another matter.
         rule(kSecondJoint, [last = std::make_shared<Nanoseconds>(0)](const can_frame& frame,
                                                                      const PutFrame& put) {
           can_frame changed = frame;
           const Nanoseconds now = monotonic_now() / kSecond;
           if (std::exchange(*last, now) != now) changed.data[3] ^= 1;
           put(changed, 0);
         });
       },
       honest, "collecting", "a counter jumped (j2)"},
      {"frames twice",
       [&] {
         rule(kSecondJoint,
              [n = std::make_shared<int>(0)](const can_frame& frame, const PutFrame& put) {
                put(frame, 0);
                if (++*n % 10 == 0) put(frame, 0);
              });
       },
       honest, "collecting", "frames come twice (j2"},
      {"a second sender",
       [&] {
         rule(kSecondJoint, [](const can_frame& frame, const PutFrame& put) {
           can_frame other = frame;
           other.data[1] = static_cast<__u8>(other.data[1] + 1);
           put(frame, 0);
           put(other, kMillisecond);
         });
       },
       honest, "fault", "a second sender (j2"},
      {"overrun of the queue",
       [&] {
         ::kill(cell->service_pid(), SIGSTOP);
         for (int i = 0; i < 20'000; ++i) {
           can_frame frame{};
           frame.can_id = kSync;
           meddler->put(frame);
         }
         ::kill(cell->service_pid(), SIGCONT);
       },
       honest, "collecting", "frames were lost in the queue ("},
      {"trigger chatters", chatter, honest, "fault", "the trigger chatters"},
      {"trigger stuck closed", [&] { meddler->level([](bool) { return true; }); }, honest, "fault",
       "the trigger is stuck closed"},
      {"trigger stuck open", [&] { meddler->level([](bool) { return false; }); }, honest, "fault",
       "touches in a row gave nothing"},
      {"trigger inverted", [&] { meddler->level([](bool closed) { return !closed; }); }, honest,
       "fault", "the trigger is stuck closed"},
      {"more edges than 16",
       [&] {
         ::kill(cell->service_pid(), SIGSTOP);
         for (int i = 0; i < 500; ++i) meddler->drive(i % 2 == 0);
         ::kill(cell->service_pid(), SIGCONT);
       },
       honest, "collecting", "more edges came at once than the kernel keeps"},
      {"wall clock + 1 h", [&] { step_wall_clock(3600 * kSecond); }, honest, "collecting",
       "the wall clock stepped"},
      {"wall clock - 1 h", [&] { step_wall_clock(-3600 * kSecond); }, honest, "collecting",
       "the wall clock stepped"},
  };
  for (const Fault& fault : faults) {
    go_through(fault);
    if (HasFatalFailure()) return;
  }
  cell->listen();
  const std::string health = text_of_health();
  std::printf("%s", health.c_str());
  for (const char* met : {"met_overrun=[1-9]", "met_bus_off=1[ \n]", "met_missing=[1-9]",
                          "met_time_stepped=2[ \n]", "selfcal: trigger [^\n]* dropped=[1-9]"})
    EXPECT_THAT(health, ContainsRegex(met));

  EXPECT_TRUE(cell->command("abort").accepted);
  const std::vector<Fault> at_start = {
      {"at start: closed", [&] { meddler->level([](bool) { return true; }); }, honest, "fault",
       "closed while the robot stands"},
      {"at start: inverted", [&] { meddler->level([](bool closed) { return !closed; }); }, honest,
       "fault", "closed while the robot stands"},
      {"at start: chatters", chatter, honest, "fault", "the trigger chatters"},
  };
  for (const Fault& fault : at_start) {
    refuse_in_self_test(fault);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace selfcal
