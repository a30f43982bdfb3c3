// Every robot of a DDS domain, as they come and go.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/report/live/listener.h"
#include "io/dds/clients/diagnostics.h"
#include "io/dds/clients/discovery.h"

namespace selfcal {

/// `Robot` keeps what one robot tells:
///   bool take(const std::vector<HealthReport>& health)   takes what has come and its part of what
///                                                        came for all; whether anything is new
///   const Watched& watched() const;  bool connected() const
template <class Robot>
class DomainListener {
 public:
  static constexpr std::size_t kMostRobots = 256;
  /// A robot whose service has gone is shown as silent for so long.
  static constexpr double kRemembered = 3600;  ///< s

  using Open = std::function<Result<std::unique_ptr<Robot>>(const std::string& robot)>;
  using Robots = std::map<std::string, std::unique_ptr<Robot>>;

  /// `open` begins to watch a robot, by its name as it stands in topics. `wakeup` hears of
  /// everything that comes, and must outlive this.
  static Result<DomainListener> open(const DdsParticipant& participant, Wakeup& wakeup, Open open) {
    auto discovery = DdsRobots::open(participant, wakeup);
    if (!discovery) return tl::unexpected(discovery.error());
    auto diagnostics = DdsDiagnostics::open(participant, wakeup);
    if (!diagnostics) return tl::unexpected(diagnostics.error());
    return DomainListener(*std::move(discovery), *std::move(diagnostics), std::move(open));
  }

  /// Takes what has come; whether anything is new.
  Result<bool> take() {
    const auto heard = discovery_->heard();
    if (!heard) return tl::unexpected(heard.error());
    for (const std::string& name : *heard) {
      if (robots_.contains(name) || robots_.size() >= kMostRobots) continue;
      auto robot = open_(name);
      if (!robot) return tl::unexpected(robot.error());
      if (*robot) robots_[name] = *std::move(robot);
    }
    bool news = false;
    const auto health = diagnostics_->take();
    for (const auto& [name, robot] : robots_) {
      const auto of_robot = health.find(name);
      news =
          robot->take(of_robot == health.end() ? std::vector<HealthReport>() : of_robot->second) ||
          news;
    }
    return news;
  }

  /// Robots that have gone for so long that nobody waits for them: they are watched no more.
  std::vector<std::unique_ptr<Robot>> forget() {
    std::vector<std::unique_ptr<Robot>> gone;
    for (auto each = robots_.begin(); each != robots_.end();) {
      if (each->second->connected() || each->second->watched().silent < kRemembered) {
        ++each;
        continue;
      }
      gone.push_back(std::move(each->second));
      each = robots_.erase(each);
    }
    return gone;
  }

  const Robots& robots() const { return robots_; }

 private:
  DomainListener(std::unique_ptr<DdsRobots> discovery, std::unique_ptr<DdsDiagnostics> diagnostics,
                 Open open)
      : discovery_(std::move(discovery)),
        diagnostics_(std::move(diagnostics)),
        open_(std::move(open)) {}

  std::unique_ptr<DdsRobots> discovery_;
  std::unique_ptr<DdsDiagnostics> diagnostics_;
  Open open_;
  Robots robots_;
};

}  // namespace selfcal
