// What is told: status on every change, progress after every touch, the result, and how well
// everything is.
#pragma once

#include <vector>

#include "app/service/loop/analyst.h"
#include "io/supervisor.h"

namespace selfcal {

class Reporter {
 public:
  /// `damaged` is what the store had to set aside, or empty. All references outlive it.
  Reporter(ServiceContext& context, const Collector& collector, const Analyst& analyst,
           std::string damaged);

  /// What has changed since the last turn, and all of it once a second.
  void report();
  void progress(const TouchRecord* touch, const std::string& note);
  void result(const ResultRecord& result);
  void ready() { supervisor_.ready(); }
  void alive() { supervisor_.alive(c_.now); }
  void stopping() { supervisor_.stopping(); }
  /// What was found damaged in earlier lives.
  void recall_damage();
  /// How many commands were refused so far.
  void refused(std::uint64_t commands) { refused_commands_ = commands; }

 private:
  StatusMessage status() const;

  // reporter_health.cc
  void tell_damage();
  void report_health(bool in_any_case);
  std::vector<HealthMessage> health() const;
  HealthMessage health_of_service() const;
  HealthMessage health_of_encoders() const;
  HealthMessage health_of_trigger() const;
  HealthMessage health_of_store() const;
  HealthMessage health_of_calibration() const;

  ServiceContext& c_;
  const Collector& collector_;
  const Analyst& analyst_;
  Supervisor supervisor_;
  std::string damaged_, damaged_before_;  ///< of the store: found now, and in earlier lives
  std::size_t damage_told_ = 0;           ///< of Store::met
  std::uint64_t refused_commands_ = 0;
  Nanoseconds last_report_ = 0, last_health_ = 0;
  ExtendedState told_;  ///< as last published
  std::string told_active_, last_levels_, last_stage_;
};

}  // namespace selfcal
