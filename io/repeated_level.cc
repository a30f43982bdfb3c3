#include "io/repeated_level.h"

#include <algorithm>

namespace selfcal {

void RepeatedLevel::hear(bool level, std::uint64_t publisher, Nanoseconds now) {
  if (publisher != publisher_) {
    repeats_ = false;
    longest_ = 0;
  }
  if (publisher != publisher_ || level != level_ || now - heard_ > silence_)
    same_since_ = now;
  else
    longest_ = std::max(longest_, now - heard_);
  repeats_ = repeats_ || now - same_since_ > silence_;
  publisher_ = publisher;
  heard_ = now;
  level_ = level;
}

}  // namespace selfcal
