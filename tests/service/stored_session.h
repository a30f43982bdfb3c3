// A session of touches of two parallel planes, as the store has it.
#pragma once

#include <cmath>

#include "app/service/session/session.h"
#include "app/service/session/session_rows.h"
#include "tests/service/cell.h"

namespace selfcal {

inline constexpr double kStep = 1e-6;  // rad, of the encoders
inline const std::vector<EncoderScale> kScales(6, EncoderScale{kStep, 1000});

/// Two planes, of which the second is parallel to the first.
inline Config two_planes() {
  const auto config = load_text(
      "robot: " + example("rx90.robot.yaml").string() +
      "\nmotion: {home: [0, -0.6, 0.9, 0, 1.2, 0]}\ntrigger: {delay: 0.001}\nsets:\n"
      "  near: {method: plane, noise: 2.0e-5, surface: {point: [0.7, 0, 0.2], normal: [0, 0, 1]},\n"
      "         within: {center: [0.7, 0, 0.2], radius: 0.3}}\n"
      "  far: {method: plane, noise: 2.0e-5, parallel_to: {set: near, distance: 0.1, noise: "
      "1e-6},\n"
      "        surface: {point: [0.7, 0, 0.1], normal: [0, 0, 1]},\n"
      "        within: {center: [0.7, 0, 0.1], radius: 0.3}}\n");
  EXPECT_TRUE(config) << config.error().what;
  return *config;
}

inline Decoding decoding_of(const Config& config) {
  auto decoding = read_decoding(decoding_text(config, kScales));
  EXPECT_TRUE(decoding) << decoding.error().what;
  return *decoding;
}

/// A touch at which every joint reads `q`, standing.
inline TouchRecord touch_of(int step, TouchOutcome outcome = TouchOutcome::taken, double q = 0.5) {
  TouchRecord touch;
  touch.step = step;
  touch.outcome = outcome;
  touch.edge = kSecond;
  touch.before.time = kSecond - 10 * kMillisecond;
  touch.after.time = kSecond + 10 * kMillisecond;
  touch.before.joints = touch.after.joints = 6;
  touch.before.counts.fill(std::llround(q / kStep) + 1000);
  touch.after.counts = touch.before.counts;
  return touch;
}

inline Session session_of(int steps) {
  Session session;
  session.record.kind = "full";
  for (int i = 0; i < steps; ++i) {
    StepRecord step;
    step.index = i;
    step.set = i % 2 == 0 ? "near" : "far";
    step.check = i == 1;
    step.touch.assign(6, 0.5);
    session.plan.push_back(step);
  }
  return session;
}

}  // namespace selfcal
