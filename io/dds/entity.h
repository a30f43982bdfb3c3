// A handle of the DDS library that is given back, and what its return codes mean.
#pragma once

#include <dds/dds.h>

#include <string>
#include <utility>

#include "io/result.h"

namespace selfcal {

class DdsEntity {
 public:
  DdsEntity() = default;
  explicit DdsEntity(dds_entity_t handle) : handle_(handle) {}
  DdsEntity(DdsEntity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  DdsEntity& operator=(DdsEntity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  /// Waits for a listener that is running.
  ~DdsEntity() {
    if (handle_ > 0) dds_delete(handle_);
  }

  dds_entity_t handle() const { return handle_; }

 private:
  dds_entity_t handle_ = 0;
};

/// `what` could not be done, with the library's reason.
inline tl::unexpected<Failure> dds_failed(const std::string& what, dds_return_t code) {
  return device_failed("DDS: " + what + ": " + dds_strretcode(code));
}

}  // namespace selfcal
