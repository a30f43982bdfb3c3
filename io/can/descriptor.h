// A file descriptor with an owner.
#pragma once

#include <unistd.h>

#include <utility>

namespace selfcal {

class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int handle) : handle_(handle) {}
  Descriptor(Descriptor&& other) noexcept : handle_(std::exchange(other.handle_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Descriptor() {
    if (handle_ >= 0) ::close(handle_);
  }

  int handle() const { return handle_; }
  bool open() const { return handle_ >= 0; }

 private:
  int handle_ = -1;
};

}  // namespace selfcal
