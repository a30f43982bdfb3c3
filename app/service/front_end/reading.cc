#include "app/service/front_end/reading.h"

#include <algorithm>
#include <cmath>

namespace selfcal {
namespace {

constexpr double kDither = 1e-5;  // units of a reading, that encoders of a robot at rest move
constexpr Nanoseconds kMostPeriods = 3;              // between the samples around a moment,
constexpr Nanoseconds kLeastGap = 4 * kMillisecond;  // or so much

}  // namespace

Eigen::VectorXd reading_of(const EncoderSample& sample, const std::vector<EncoderScale>& scales) {
  Eigen::VectorXd q(sample.joints);
  for (int j = 0; j < sample.joints; ++j) q[j] = scales[j].reading(sample.counts[j]);
  return q;
}

Reading reading_between(const EncoderSample& before, const EncoderSample& after, Nanoseconds at,
                        const std::vector<EncoderScale>& scales) {
  const Eigen::VectorXd first = reading_of(before, scales), second = reading_of(after, scales);
  if (after.time <= before.time) return {first, Eigen::VectorXd::Zero(first.size()), 0};
  const double share =
      static_cast<double>(at - before.time) / static_cast<double>(after.time - before.time);
  const double period = seconds(after.time - before.time);
  return {first + share * (second - first), (second - first) / period,
          period * std::max(share * (1 - share), 0.0) / std::sqrt(3)};
}

bool SampleHistory::add(const EncoderSample& sample) {
  if (!samples_.empty() && sample.time <= samples_.back().time) {
    ++out_of_order_;
    // Three in a row: the sender's clock has been set back, and what came before is of another
    // time.
    if (++back_in_a_row_ < 3) return false;
    samples_.clear();
  }
  back_in_a_row_ = 0;
  samples_.push_back(sample);
  if (samples_.size() > kMost) samples_.pop_front();
  return true;
}

std::optional<std::pair<EncoderSample, EncoderSample>> SampleHistory::around(Nanoseconds t) const {
  const auto after = std::ranges::lower_bound(samples_, t, {}, &EncoderSample::time);
  if (after == samples_.end()) return std::nullopt;
  if (after->time == t) return std::pair{*after, *after};
  if (after == samples_.begin()) return std::nullopt;
  if (!after->follows) return std::nullopt;
  const EncoderSample& before = *std::prev(after);
  if (after->time - before.time > std::max(kMostPeriods * period(), kLeastGap)) return std::nullopt;
  return std::pair{before, *after};
}

Nanoseconds SampleHistory::period() const {
  constexpr std::size_t kLast = 33;
  if (samples_.size() < 3) return 0;
  std::vector<Nanoseconds> gaps;
  for (std::size_t i = samples_.size() - std::min(kLast, samples_.size()); i + 1 < samples_.size();
       ++i)
    gaps.push_back(samples_[i + 1].time - samples_[i].time);
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::ranges::nth_element(gaps, middle);
  return *middle;
}

std::optional<bool> SampleHistory::at_rest(const std::vector<EncoderScale>& scales,
                                           const Eigen::ArrayXd& units, double speed,
                                           Nanoseconds span) const {
  if (samples_.empty()) return std::nullopt;
  const auto first =
      std::ranges::lower_bound(samples_, samples_.back().time - span, {}, &EncoderSample::time);
  if (samples_.end() - first < 3) return std::nullopt;
  const double by_speed = speed * seconds(samples_.back().time - first->time);
  for (int j = 0; j < first->joints; ++j) {
    const auto counts = std::abs(samples_.back().counts[j] - first->counts[j]);
    if (counts > 1 &&
        static_cast<double>(counts) * std::abs(scales[j].step) > kDither * units[j] + by_speed)
      return false;
  }
  return true;
}

}  // namespace selfcal
