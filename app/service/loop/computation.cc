#include "app/service/loop/computation.h"

#include <exception>
#include <stdexcept>
#include <utility>

namespace selfcal {

Computation::~Computation() {
  give_up();
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Computation::start(Job job) {
  {
    const std::lock_guard lock(mutex_);
    waiting_ = std::move(job);
    wanted_ = ++last_;
    progress_ = {};
  }
  if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
  changed_.notify_one();
}

void Computation::give_up() {
  const std::lock_guard lock(mutex_);
  wanted_ = 0;
  waiting_.reset();
}

bool Computation::running() const {
  const std::lock_guard lock(mutex_);
  return wanted_ != 0 && done_ != wanted_;
}

bool Computation::take(std::string& failure) {
  const std::lock_guard lock(mutex_);
  if (wanted_ == 0 || done_ != wanted_) return false;
  wanted_ = 0;
  failure = failure_;
  return true;
}

Computation::Progress Computation::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

void Computation::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ending_ || waiting_; });
    if (ending_) return;
    const Job job = *std::exchange(waiting_, std::nullopt);
    const std::uint64_t number = last_;
    lock.unlock();
    std::string failure = run(job, number);
    lock.lock();
    failure_ = std::move(failure);
    done_ = number;
  }
}

std::string Computation::run(const Job& job, std::uint64_t number) {
  const Tell tell = [&](std::string_view stage, double share) {
    const std::lock_guard lock(mutex_);
    if (wanted_ != number) throw std::runtime_error("given up");
    progress_ = {std::string(stage), share};
  };
  try {
    return job(tell);
  } catch (const std::exception& error) {  // out of memory, or a bug that must not end the service
    return error.what();
  }
}

}  // namespace selfcal
