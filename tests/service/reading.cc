// What the joints read at the moment of an edge, against numbers worked out by hand.
#include "app/service/front_end/reading.h"

#include <gtest/gtest.h>

#include <cmath>

namespace selfcal {
namespace {

EncoderSample sample_of(Nanoseconds time, std::vector<std::int64_t> counts) {
  EncoderSample sample;
  sample.time = time;
  sample.joints = static_cast<int>(counts.size());
  std::ranges::copy(counts, sample.counts.begin());
  return sample;
}

const std::vector<EncoderScale> kTwoScales = {{1e-3, 100}, {-2e-3, 0}};

TEST(Reading, TurnsCountsIntoReadingsByStepAndZero) {
  const Eigen::VectorXd q = reading_of(sample_of(0, {1100, 500}), kTwoScales);
  EXPECT_DOUBLE_EQ(q[0], 1.0);
  EXPECT_DOUBLE_EQ(q[1], -1.0) << "a negative step turns the joint";
}

TEST(Reading, IsExactBetweenTwoSamplesAtASteadySpeed) {
  // Over 4 ms joint 0 goes from 1.0 to 1.4 and joint 1 from -1.0 to -0.2: 100 and 200 rad/s.
  const Reading reading =
      reading_between(sample_of(0, {1100, 500}), sample_of(4 * kMillisecond, {1500, 100}),
                      1 * kMillisecond, kTwoScales);
  constexpr double kRounding = 1e-15;  // a few roundings of numbers about 1
  EXPECT_NEAR(reading.q[0], 1.1, kRounding);
  EXPECT_NEAR(reading.q[1], -0.8, kRounding);
  EXPECT_NEAR(reading.dq[0], 100, 100 * kRounding);
  EXPECT_NEAR(reading.dq[1], 200, 200 * kRounding);
}

TEST(Reading, IsTheSamplesOwnAtTheMomentOfASample) {
  const EncoderSample first = sample_of(0, {1100, 500}), second = sample_of(100, {1500, 100});
  EXPECT_EQ(reading_between(first, second, 0, kTwoScales).q, reading_of(first, kTwoScales));
  const Eigen::VectorXd last = reading_between(first, second, 100, kTwoScales).q;
  EXPECT_LT((last - reading_of(second, kTwoScales)).norm(), 1e-15);  // rounding of 1 + (1.4 - 1)
  const Reading still = reading_between(second, second, 100, kTwoScales);
  EXPECT_EQ(still.q, reading_of(second, kTwoScales));
  EXPECT_EQ(still.dq, Eigen::VectorXd::Zero(2)) << "one sample tells no speed";
}

TEST(Reading, IsOffByAnEighthOfAccelerationTimesTimeSquaredAtMost) {
  constexpr double a = 20, t = 0.002, step = 1e-9;  // rad/s^2, s, rad
  const std::vector<EncoderScale> scales = {{step, 0}};
  const auto q = [&](Nanoseconds at) { return a * seconds(at) * seconds(at) / 2; };
  const auto sample = [&](Nanoseconds at) { return sample_of(at, {std::llround(q(at) / step)}); };
  double most = 0;
  for (Nanoseconds start = 0; start < 20 * kMillisecond; start += 3 * kMillisecond)
    for (int i = 0; i <= 20; ++i) {
      const Nanoseconds at = start + i * nanoseconds(t) / 20;
      const Reading reading =
          reading_between(sample(start), sample(start + nanoseconds(t)), at, scales);
      most = std::max(most, std::abs(reading.q[0] - q(at)));
    }
  const double bound = a * t * t / 8;  // 10 urad, met half way between the samples
  EXPECT_LE(most, bound + step);       // half a count of each sample
  EXPECT_GE(most, bound - step);
}

TEST(SampleHistory, FindsTheTwoSamplesAroundAMoment) {
  SampleHistory history;
  EXPECT_TRUE(history.empty());
  EXPECT_FALSE(history.around(0));
  for (Nanoseconds t = 10; t <= 50; t += 10) history.add(sample_of(t, {t}));
  EXPECT_EQ(history.around(25)->first.time, 20);
  EXPECT_EQ(history.around(25)->second.time, 30);
  EXPECT_EQ(history.around(30)->first.time, 30) << "a sample at the very moment is both";
  EXPECT_EQ(history.around(30)->second.time, 30);
  EXPECT_EQ(history.around(10)->first.time, 10);
  EXPECT_FALSE(history.around(9)) << "the one before is gone";
  EXPECT_FALSE(history.around(51)) << "the one after has not come";
}

TEST(SampleHistory, HasNothingAcrossAGap) {
  constexpr Nanoseconds kPeriod = 2 * kMillisecond;
  SampleHistory history;
  for (int i = 0; i < 10; ++i) history.add(sample_of(i * kPeriod, {i}));
  history.add(sample_of(12 * kPeriod, {12}));  // two samples were lost
  history.add(sample_of(13 * kPeriod, {13}));
  history.add(sample_of(17 * kPeriod, {17}));  // three
  EXPECT_TRUE(history.around(10 * kPeriod));
  EXPECT_TRUE(history.around(12 * kPeriod + 1));
  EXPECT_FALSE(history.around(14 * kPeriod));
  EXPECT_TRUE(history.around(17 * kPeriod)) << "the sample of the very moment";
}

TEST(SampleHistory, HasNothingAcrossWhatBrokeOff) {
  SampleHistory history;
  for (int k = 0; k < 5; ++k) history.add(sample_of(k * kMillisecond, {100 + k}));
  EncoderSample after = sample_of(5 * kMillisecond, {105});
  after.follows = false;
  history.add(after);
  history.add(sample_of(6 * kMillisecond, {106}));
  EXPECT_TRUE(history.around(7 * kMillisecond / 2));
  EXPECT_FALSE(history.around(9 * kMillisecond / 2));
  EXPECT_TRUE(history.around(11 * kMillisecond / 2));
}

TEST(SampleHistory, DropsAndCountsSamplesThatDoNotFollowInTime) {
  SampleHistory history;
  history.add(sample_of(10, {1}));
  history.add(sample_of(10, {2}));
  history.add(sample_of(5, {3}));
  history.add(sample_of(11, {4}));
  EXPECT_EQ(history.out_of_order(), 2u);
  EXPECT_EQ(history.last().counts[0], 4);
  EXPECT_EQ(history.around(10)->first.counts[0], 1);
}

TEST(SampleHistory, KeepsTheLastSamplesOnly) {
  SampleHistory history;
  for (Nanoseconds t = 1; t <= 100'000; ++t) history.add(sample_of(t, {t}));
  EXPECT_TRUE(history.around(100'000 - 1000));
  EXPECT_FALSE(history.around(100'000 - 5000)) << "4096 are kept";
}

TEST(SampleHistory, TellsWhetherTheJointsStandOnceItHasThreeSamples) {
  const std::vector<EncoderScale> scales = {{1e-6, 0}, {-1e-6, 0}};
  const Eigen::ArrayXd units = Eigen::ArrayXd::Ones(2);
  constexpr double kSpeed = 1e-3;  // 20 counts over 20 ms
  const Nanoseconds span = 20 * kMillisecond;
  const auto moved = [&](std::int64_t counts) {
    SampleHistory history;
    for (int i = 0; i <= 10; ++i)
      history.add(sample_of(i * 2 * kMillisecond, {7, counts * i / 10}));
    return history.at_rest(scales, units, kSpeed, span);
  };
  EXPECT_EQ(moved(0), true);
  // And a dither of 10 counts (10 urad).
  EXPECT_EQ(moved(29), true);
  EXPECT_EQ(moved(31), false);
  EXPECT_EQ(moved(-31), false);

  SampleHistory history;
  history.add(sample_of(0, {0, 0}));
  EXPECT_FALSE(history.at_rest(scales, units, kSpeed, span));
  history.add(sample_of(2 * kMillisecond, {0, 0}));
  EXPECT_FALSE(history.at_rest(scales, units, kSpeed, span)) << "two samples say little";
  history.add(sample_of(4 * kMillisecond, {0, 0}));
  EXPECT_EQ(history.at_rest(scales, units, kSpeed, span), true);
}

TEST(SampleHistory, ForgivesASlideADitherInProportionToItsWay) {
  for (const double half_way : {0.05, 5.0}) {  // m: of a machine of 10 cm, of one of 10 m
    const std::vector<EncoderScale> scales = {{1e-2 * 1e-5 * half_way, 0}};
    const auto rests_after = [&](std::int64_t counts) {
      SampleHistory history;
      for (int i = 0; i < 3; ++i) history.add(sample_of(i * 2 * kMillisecond, {counts * i / 2}));
      return history.at_rest(scales, Eigen::ArrayXd::Constant(1, half_way), 0, 10 * kMillisecond);
    };
    EXPECT_EQ(rests_after(98), true) << half_way;
    EXPECT_EQ(rests_after(102), false) << half_way;
  }
}

TEST(SampleHistory, ForgivesOneCountBetweenTwoSteps) {
  const std::vector<EncoderScale> coarse = {{1e-3, 0}};
  SampleHistory history;
  for (int i = 0; i < 11; ++i) history.add(sample_of(i * 2 * kMillisecond, {i / 10}));
  EXPECT_EQ(history.at_rest(coarse, Eigen::ArrayXd::Ones(1), 1e-4, 20 * kMillisecond), true);
}

}  // namespace
}  // namespace selfcal
