// How long a service takes from a contact to its request to stop, seen from outside: the stamps
// that the writers' own processes gave to the trigger's level and to the request.
#pragma once

#include <optional>
#include <vector>

#include "io/dds/endpoint.h"

namespace selfcal {

class StopWatch {
 public:
  StopWatch(const DdsParticipant& participant, const std::string& robot);

  /// Takes what has come. A closing followed by a stop before the trigger opens is a contact.
  void listen();
  /// From contact to stop request (s), in the order of the contacts.
  const std::vector<double>& took() const { return took_; }
  /// Every stop request (ns since 1970), in the order in which they were heard.
  const std::vector<Nanoseconds>& stops() const { return stops_; }

 private:
  struct Moment {
    dds_time_t time;
    enum class What : std::uint8_t { closed, opened, stop } what;
  };
  DdsReader<dds::StampedBool> trigger_;
  DdsReader<dds::MotionRequest> requests_;
  std::vector<Moment> moments_;
  std::optional<bool> level_;
  std::vector<double> took_;
  std::vector<Nanoseconds> stops_;
};

/// The value below which `share` of them lie; NaN of none.
double quantile(std::vector<double> values, double share);

}  // namespace selfcal
