// Whose messages are believed on a topic that one robot alone writes.
//
// A domain is open to anyone: a second writer of joint states, of the trigger or of motion replies
// is another robot, or somebody who pretends. The first is believed for as long as it is there;
// of the others nothing is taken, and their presence is told, so that the service stops.
#pragma once

#include <algorithm>

#include "io/dds/endpoint.h"

namespace selfcal {

class SoleWriter {
 public:
  /// Looks at who writes to `reader`: to be called before its messages are taken.
  template <class T>
  void look(const DdsReader<T>& reader) {
    present_ = reader.writers();
    if (std::ranges::find(present_, believed_) != present_.end()) return;
    believed_ = present_.size() == 1 ? present_.front() : 0;
  }
  /// Whether a message of this writer counts; the others are counted as strange.
  template <class T>
  bool believes(dds_instance_handle_t writer, const DdsReader<T>& reader) {
    if (writer != believed_) look(reader);  // it may have come since
    if (writer == believed_) return true;
    ++strange_;
    return false;
  }
  /// Messages of writers that are not believed.
  std::uint64_t strange() const { return strange_; }

 private:
  std::vector<dds_instance_handle_t> present_;
  dds_instance_handle_t believed_ = 0;  ///< 0: nobody, while there are several or none
  std::uint64_t strange_ = 0;
};

}  // namespace selfcal
