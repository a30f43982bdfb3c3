// From a sender's clock to ours, by one offset for all its topics.

#include "io/dds/time_mapping.h"

#include <cstdlib>

namespace selfcal {

bool TimeMapping::observe(Nanoseconds stamp, Nanoseconds arrived) {
  const bool first = !known_;
  const Nanoseconds offset = arrived - stamp;
  if (!first && std::abs(offset - offset_) <= kStep) return false;
  offset_ = offset;
  known_ = true;
  if (first) return false;
  ++steps_;
  return true;
}

std::optional<Nanoseconds> TimeMapping::ours(Nanoseconds stamp) const {
  if (!known_) return std::nullopt;
  return stamp + offset_;
}

}  // namespace selfcal
