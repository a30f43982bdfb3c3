// Opens several endpoints, of which the first that fails is what is told.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "io/dds/endpoint.h"

namespace selfcal {

class DdsOpening {
 public:
  explicit DdsOpening(const DdsParticipant& participant) : participant_(participant) {}

  template <class T>
  void open(DdsWriter<T>& writer, const std::string& topic, const DdsQos& qos,
            Wakeup* wakeup = nullptr) {
    take(writer, DdsWriter<T>::open(participant_, topic, qos, wakeup));
  }
  template <class T>
  void open(DdsReader<T>& reader, const std::string& topic, const DdsQos& qos,
            Wakeup* wakeup = nullptr) {
    take(reader, DdsReader<T>::open(participant_, topic, qos, wakeup));
  }
  /// What `make` returns, or the failure.
  template <class Make>
  auto finish(Make make) -> Result<decltype(make())> {
    if (failure_) return tl::make_unexpected(*failure_);
    return make();
  }

 private:
  /// Moves what was opened to its place, or keeps its failure.
  template <class T>
  void take(T& place, Result<T> opened) {
    if (opened)
      place = *std::move(opened);
    else if (!failure_)
      failure_ = std::move(opened).error();
  }
  const DdsParticipant& participant_;
  std::optional<Failure> failure_;
};

}  // namespace selfcal
