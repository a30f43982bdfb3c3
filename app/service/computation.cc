#include "app/service/computation.h"

#include <exception>
#include <stdexcept>

namespace selfcal {

Computation::~Computation() {
  if (thread_.joinable()) thread_.join();
}

void Computation::start(Job job) {
  if (thread_.joinable()) thread_.join();
  given_up_ = false;
  progress_ = {};
  failure_.clear();
  running_ = true;
  wanted_ = true;
  thread_ = std::thread([this, job = std::move(job)] {
    const Tell tell = [this](std::string_view stage, double share) {
      if (given_up_) throw std::runtime_error("given up");
      const std::lock_guard lock(mutex_);
      progress_.stage = stage;
      progress_.share = share;
    };
    std::string failure;
    try {
      failure = job(tell);
    } catch (
        const std::exception& error) {  // out of memory, or a bug that must not end the service
      failure = error.what();
    }
    const std::lock_guard lock(mutex_);
    failure_ = std::move(failure);
    running_ = false;
  });
}

bool Computation::take(std::string& failure) {
  if (!wanted_ || running_) return false;
  thread_.join();
  wanted_ = false;
  failure = failure_;
  return true;
}

Computation::Progress Computation::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

}  // namespace selfcal
