// Records to put into a store, filled so that nothing is zero by chance.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "io/store/store.h"

namespace selfcal {

/// The open store of a folder; the test ends when there is none.
inline std::unique_ptr<Store> opened(const std::filesystem::path& folder) {
  Result<Store::Opened> opened = Store::open(folder);
  EXPECT_TRUE(opened.has_value()) << opened.error().what;
  EXPECT_EQ(opened->set_aside, "");
  return std::move(opened->store);
}

inline SessionRecord some_session() {
  SessionRecord session;
  session.kind = "full";
  session.reason = "schedule: every night";
  session.model_hash = std::string(64, 'a');
  session.config_hash = std::string(64, 'b');
  session.config = "joints: [a, b]\nsets: {}\n";
  session.seed = 0xfedcba9876543210;
  session.started_ms = 1'790'000'000'123;
  return session;
}

/// Steps over four planes in four groups each, every seventh to judge.
inline std::vector<StepRecord> some_plan(int steps, int joints, std::uint64_t seed = 1) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> reading(-3, 3);
  std::vector<StepRecord> plan(static_cast<std::size_t>(steps));
  for (int i = 0; i < steps; ++i) {
    StepRecord& step = plan[static_cast<std::size_t>(i)];
    step.index = i;
    step.set = "plane " + std::to_string(i % 4);
    step.group = std::to_string(i / 4 % 4);
    step.check = i % 7 == 6;
    step.via_home = i % 5 == 4;
    for (std::vector<double>* q : {&step.start, &step.touch, &step.end}) {
      for (int joint = 0; joint < joints; ++joint) q->push_back(reading(generator));
    }
    step.way.assign(static_cast<std::size_t>(i % 3), step.start);
  }
  return plan;
}

/// Counts of nanoradians up to 3 rad, the robot moving a little between the samples 1 ms apart.
inline TouchRecord some_touch(int step, int joints, std::uint64_t seed = 1) {
  std::mt19937_64 generator(seed * 1000 + static_cast<std::uint64_t>(step));
  std::uniform_int_distribution<std::int64_t> count(-3'000'000'000, 3'000'000'000);
  std::uniform_int_distribution<std::int64_t> moved(-20'000, 20'000);
  TouchRecord touch;
  touch.step = step;
  touch.unix_ms = 1'790'000'000'123 + 5000 * step;
  touch.before.time = 86'400 * kSecond + 5 * kSecond * step;
  touch.edge = touch.before.time + 123'456;
  touch.after.time = touch.before.time + kMillisecond;
  touch.before.joints = touch.after.joints = joints;
  for (std::size_t i = 0; i < static_cast<std::size_t>(joints); ++i) {
    touch.before.counts[i] = count(generator);
    touch.after.counts[i] = touch.before.counts[i] + moved(generator);
  }
  touch.temperature = 21.37 + 0.01 * step;
  return touch;
}

inline ResultRecord some_result(std::int64_t session) {
  ResultRecord result;
  result.session = session;
  result.unix_ms = 1'790'000'900'000;
  result.answer = ResultAnswer::improved;
  result.decision = ResultDecision::candidate;
  result.why = "errors fell from 1.2 mm to 18 µm";
  result.p_value = 0.1 + 0.2;
  result.check_before = 1.2e-3;
  result.check_after = -0.0;
  result.endpoint_sigma = std::numeric_limits<double>::denorm_min();
  result.touches = 240;
  result.outliers = 3;
  result.identified = 27;
  result.json = "{\"answer\": \"better\"}";
  result.robot_text = "robot: of session " + std::to_string(session) + "\n";
  return result;
}

inline SlotRecord candidate_of(const ResultRecord& result) {
  return {result.session, result.unix_ms, std::string(64, 'a'), result.robot_text};
}

/// A session of all its touches, taken at the first attempt, its result and its candidate.
inline std::int64_t whole_session(Store& store, int steps, bool with_candidate = false) {
  const std::int64_t id = store.begin(some_session(), some_plan(steps, 6)).value();
  for (int i = 0; i < steps; ++i) {
    EXPECT_TRUE(store.add(id, some_touch(i, 6, static_cast<std::uint64_t>(id))).has_value());
  }
  const ResultRecord result = some_result(id);
  const SlotRecord candidate = candidate_of(result);
  EXPECT_TRUE(store.finish(result, with_candidate ? &candidate : nullptr).has_value());
  return id;
}

inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

inline void expect_same(const TouchRecord& a, const TouchRecord& b) {
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.attempt, b.attempt);
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_EQ(a.why, b.why);
  EXPECT_EQ(a.unix_ms, b.unix_ms);
  EXPECT_EQ(a.edge, b.edge);
  EXPECT_TRUE(same_bits(a.temperature, b.temperature) ||
              (std::isnan(a.temperature) && std::isnan(b.temperature)));
  for (const auto& [x, y] : {std::pair{a.before, b.before}, std::pair{a.after, b.after}}) {
    EXPECT_EQ(x.time, y.time);
    EXPECT_EQ(x.joints, y.joints);
    EXPECT_EQ(x.counts, y.counts);
  }
}

}  // namespace selfcal
