// What was made of blocks of configurations, kept for the next time that the same are asked for: a
// fit comes back to its rows a hundred times.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "kinematics/robot.h"

namespace selfcal {

/// All that a block says and the body, number for number.
inline std::string block_key(const ConfigurationBlock& block, Body body) {
  std::string key;
  const auto add = [&](const auto* first, std::size_t count) {
    key.append(reinterpret_cast<const char*>(&count), sizeof count);
    key.append(reinterpret_cast<const char*>(first), count * sizeof *first);
  };
  const auto add_all = [&](const auto& M) { add(M.data(), static_cast<std::size_t>(M.size())); };
  const MeasurementConditions& c = block.conditions;
  add(&block.count, 1);
  add(&body, 1);
  add_all(block.q);
  for (const Eigen::MatrixXd* each : {&c.wrench, &c.velocity, &c.normal}) add_all(*each);
  for (const Eigen::VectorXd* each : {&c.temperature, &c.time}) add_all(*each);
  add_all(c.set);
  if (block.start) {  // where the loops are closed from, and so whether they close
    add_all(block.start->R);
    add_all(block.start->p);
  }
  return key;
}

/// Safe to ask from several threads.
template <class Made>
class BlockMemory {
 public:
  /// Keeps up to so many bytes; what comes later is made again each time.
  explicit BlockMemory(std::size_t most) : most_(most) {}

  /// What `make()` gives for this block, which takes `bytes`.
  template <class Make>
  std::shared_ptr<const Made> of(const ConfigurationBlock& block, Body body, std::size_t bytes,
                                 const Make& make) {
    if (bytes > most_ / kFewest) return std::make_shared<const Made>(make());
    std::string key = block_key(block, body);
    {
      const std::scoped_lock lock(mutex_);
      if (const auto known = made_.find(key); known != made_.end()) return known->second;
    }
    auto made = std::make_shared<const Made>(make());
    const std::scoped_lock lock(mutex_);
    const std::size_t size = bytes + key.size();
    if (kept_ + size > most_) return made;
    if (made_.try_emplace(std::move(key), made).second) kept_ += size;
    return made;
  }

 private:
  static constexpr std::size_t kFewest = 8;  ///< blocks that there must be room for

  const std::size_t most_;
  std::mutex mutex_;
  std::size_t kept_ = 0;
  std::unordered_map<std::string, std::shared_ptr<const Made>> made_;
};

}  // namespace selfcal
