#include "constraints/equations/shared_touches.h"

#include <cmath>

namespace selfcal {

void SharedTouches::whiten(int row, int previous, Row s) {
  const auto before = by_touch_.find(previous);
  double b = 1;
  const bool aside = s.isZero(0);
  if (before != by_touch_.end() && !aside) {
    const double a = -1 / (2 * before->second.b);
    b = std::sqrt(1 - a * a);
    s = ((s - a * before->second.v) / b).eval();
  }
  if (before != by_touch_.end()) by_touch_.erase(before);
  if (!aside) by_touch_[row] = {s, b};
}

}  // namespace selfcal
