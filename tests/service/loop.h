// The loop around a robot of the test's, whose time passes in the service's turns.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include "app/service/loop/service.h"
#include "tests/io/store_content.h"
#include "tests/io/store_records.h"
#include "tests/service/cell.h"
#include "tests/support/domain.h"

namespace selfcal {

/// Stands at home or swings about it, and does nothing that it is asked, though it may say so.
struct BusyRobot final : Clock, EncoderSource, TouchTrigger, Motion {
  Nanoseconds now() override { return time; }
  std::int64_t unix_ms() override { return 1'790'000'000'000 + time / kMillisecond + ahead_ms; }
  /// A fifth of a millisecond is twenty: what is planned meanwhile takes its time.
  void wait(Nanoseconds) override {
    usleep(200);
    time += 20 * kMillisecond;
  }
  const std::vector<EncoderScale>& scales() const override { return counts; }
  Result<void> take(std::vector<EncoderSample>& out) override {
    EncoderSample sample{.time = time, .joints = 6};
    for (int j = 0; j < 6; ++j) sample.counts[j] = std::llround(home[j] / counts[j].step);
    if (working) sample.counts[0] += (++swing % 100) * 1000;
    out.push_back(sample);
    return {};
  }
  std::uint64_t dropped() const override { return 0; }
  std::optional<bool> closed() override { return touching; }
  Result<void> take(std::vector<Edge>& out) override {
    out.insert(out.end(), edges.begin(), edges.end());
    edges.clear();
    return {};
  }
  Result<void> request(const MotionRequest& request) override {
    asked.push_back(request.kind);
    last = request;
    if (when_asked) when_asked();
    if (obeys) replies.push_back({request.id, MotionReply::Outcome::done, ""});
    return {};
  }
  Result<void> stop(const std::string&) override {
    ++stops;
    if (when_stopped) when_stopped();
    return {};
  }
  Result<void> take(std::vector<MotionReply>& out) override {
    out.insert(out.end(), replies.begin(), replies.end());
    replies.clear();
    return {};
  }
  int senders() const override { return 1; }
  std::uint64_t strange() const override { return 0; }

  Nanoseconds time = 1000 * kSecond;
  std::int64_t ahead_ms = 0;  // of the true time, as the wall clock is set
  std::vector<EncoderScale> counts{6, EncoderScale{1e-6, 0}};
  double home[6] = {0, -0.6, 0.9, 0, 1.2, 0};
  bool working = false, touching = false, obeys = false;
  int swing = 0, stops = 0;
  std::function<void()> when_stopped, when_asked;
  std::vector<Edge> edges;
  std::vector<MotionReply> replies;
  std::vector<MoveKind> asked;
  MotionRequest last;
};

/// Commands as the test says them.
struct Person final : Messenger {
  void publish(const StatusMessage&) override {}
  void publish(const ProgressMessage&) override {}
  void publish(const ResultMessage&) override {}
  void publish(const std::vector<HealthMessage>&, const std::string&) override {}
  void reply(const CommandReplyMessage& reply) override { replies.push_back(reply); }
  void take(std::vector<CommandMessage>& out) override {
    out.insert(out.end(), said.begin(), said.end());
    said.clear();
  }
  std::uint64_t refused() const override { return 0; }
  std::uint64_t unsent() const override { return 0; }
  void say(const std::string& verb) {
    said.push_back({.id = verb, .verb = verb, .from = "a test"});
  }

  std::vector<CommandMessage> said;
  std::vector<CommandReplyMessage> replies;
};

class Loop : public testing::Test {
 protected:
  Config config(const CellKeys& more = {}) const {
    CellKeys keys{{"state", scratch.folder().string()},
                  {"sets.touches", "8"},
                  {"limits.planning", "3600"},
                  {"commands.over", "loopback"},
                  {"commands.allow", "[start, done, abort]"}};
    for (const auto& [key, value] : more) keys[key] = value;
    return must(load_cell(keys));
  }
  /// The service begins, or begins anew.
  void start(Config config) {
    service.reset();
    journal.reset();
    store = opened(scratch.folder());
    journal = std::make_unique<Journal>(opened(scratch.folder()));
    Models models = must(Models::load(config.robot, *store));
    service.emplace(std::move(config), Ports{&robot, &robot, &robot, &robot}, person, *store,
                    *journal, std::move(models), "");
  }
  /// What the parts of a service share, without a service.
  ServiceContext context_of(Config cell) {
    store = opened(scratch.folder());
    journal = std::make_unique<Journal>(opened(scratch.folder()));
    Models models = must(Models::load(cell.robot, *store));
    return {std::move(cell),  Ports{&robot, &robot, &robot, &robot}, person, *store, *journal,
            std::move(models)};
  }
  const ExtendedState& state() const { return service->extended_state(); }
  bool turning(const std::function<bool()>& holds) {
    for (const Nanoseconds end = robot.time + 3600 * kSecond; robot.time < end; service->turn())
      if (holds()) return true;
    ADD_FAILURE() << to_string(state().state) << ": " << state().why;
    return false;
  }
  bool comes_to(ServiceState wanted) {
    return turning([&] { return state().state == wanted; });
  }
  void turn_for(Nanoseconds time) {
    for (const Nanoseconds end = robot.time + time; robot.time < end;) service->turn();
  }

  /// Beside the service, which may be writing.
  void change_store(const std::string& sql) const {
    with_sqlite(scratch.folder() / "selfcal.db", "PRAGMA busy_timeout = 5000;" + sql);
  }

  const Scratch scratch;
  BusyRobot robot;
  Person person;
  std::unique_ptr<Store> store;
  std::unique_ptr<Journal> journal;
  std::optional<Service> service;
};

/// A session that an earlier life has left before its touch.
inline void leave_session(Store& store, const Config& config,
                          const std::vector<EncoderScale>& scales, const std::string& kind,
                          bool loaded) {
  SessionRecord record;
  record.kind = kind;
  record.model_hash = model_hash(*config.robot);
  record.config = decoding_text(config, scales);
  record.config_hash = config_hash(config, scales);
  StepRecord step;
  step.set = "table";
  step.loaded = loaded;
  step.start = step.touch = step.end = {0.3, -0.6, 0.9, 0, 1.2, 0};
  must(store.begin(record, {step}));
}

/// The touch is with the payload.
inline void leave_loaded_session(Store& store, const Config& config,
                                 const std::vector<EncoderScale>& scales) {
  leave_session(store, config, scales, "cause", true);
}

}  // namespace selfcal
