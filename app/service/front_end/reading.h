// What the joints read at the very moment of an edge.
#pragma once

#include <Eigen/Dense>
#include <deque>
#include <optional>
#include <utility>

#include "io/ports.h"

namespace selfcal {

/// Joint readings (rad or m) and their speed at one moment.
struct Reading {
  Eigen::VectorXd q, dq;
  /// 1 sigma of the moment at which the joints were at q (s): a robot that begins to stop at some
  /// instant after the contact makes the later sample lag by up to its whole way.
  double sigma_time = 0;
};

Eigen::VectorXd reading_of(const EncoderSample& sample, const std::vector<EncoderScale>& scales);

/// Between two samples a time T apart, by linear interpolation: exact at a steady speed v. Stopped
/// at once at the share s of T it is off by v T s (1 - s), and later by less: the error is taken as
/// uniform within that, sigma_time = T s (1 - s) / sqrt 3.
Reading reading_between(const EncoderSample& before, const EncoderSample& after, Nanoseconds at,
                        const std::vector<EncoderScale>& scales);

/// The last samples, as many as a touch needs; bounded.
class SampleHistory {
 public:
  /// False, and counted, for a sample that does not follow the last one in time. After three of
  /// them in a row the history begins anew: the sender's clock has been set back.
  bool add(const EncoderSample& sample);
  void clear() { samples_.clear(); }
  bool empty() const { return samples_.empty(); }
  const EncoderSample& last() const { return samples_.back(); }
  std::uint64_t out_of_order() const { return out_of_order_; }

  /// The usual time between samples: the median of the last ones; 0 with fewer than three.
  Nanoseconds period() const;
  /// The two samples around a moment; nothing while the later one has not come, when the earlier
  /// one is gone, or when the two are farther apart than three usual periods (and 4 ms): samples
  /// were lost or a clock was set, and in between the joints may have done anything.
  std::optional<std::pair<EncoderSample, EncoderSample>> around(Nanoseconds t) const;
  /// True when no joint moved faster than `speed` over the last `span`, one count and a dither of a
  /// hundred-thousandth of its unit (units_of_readings) aside; nothing as long as there are fewer
  /// than three samples in it.
  std::optional<bool> at_rest(const std::vector<EncoderScale>& scales, const Eigen::ArrayXd& units,
                              double speed, Nanoseconds span) const;

 private:
  static constexpr std::size_t kMost = 4096;
  std::deque<EncoderSample> samples_;
  std::uint64_t out_of_order_ = 0;
  int back_in_a_row_ = 0;
};

}  // namespace selfcal
