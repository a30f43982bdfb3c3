// How many commands a second are heard: a bucket that fills by `per_second` up to `most`.
#pragma once

#include <algorithm>

#include "io/ports.h"

namespace selfcal {

class Allowance {
 public:
  Allowance(double per_second, double most) : per_second_(per_second), most_(most), left_(most) {}

  /// Takes one, if there is one left at this moment.
  bool take(Nanoseconds now) {
    left_ = std::min(most_, left_ + seconds(std::max<Nanoseconds>(0, now - last_)) * per_second_);
    last_ = now;
    if (left_ < 1) return false;
    left_ -= 1;
    return true;
  }

 private:
  double per_second_, most_, left_;
  Nanoseconds last_ = 0;
};

}  // namespace selfcal
