// What takes long, beside the loop: plans sessions, identifies from their rows, and judges. Nothing
// is applied here.
#pragma once

#include <functional>
#include <memory>

#include "app/service/acceptance.h"
#include "app/service/collector.h"
#include "app/service/computation.h"
#include "constraints/estimation/engagements.h"

namespace selfcal {

class Analyst {
 public:
  /// Both outlive it.
  Analyst(ServiceContext& context, Collector& collector) : c_(context), collector_(collector) {}

  /// A quick check has something to compare with.
  bool can_check() const;
  /// A session of the situation's kind; it begins once it is planned.
  void plan(const std::string& why);
  /// The rows of what was collected.
  void analyse();
  void identify();
  /// On the rows kept aside; the result is in the store then, with its candidate.
  void judge();
  /// What is under way is not asked for any more.
  void give_up();
  /// Goes on with what has ended since the last turn.
  void take();
  /// Nothing while nothing is computed.
  std::optional<Computation::Progress> progress() const;

  /// Of the parameters that are active.
  const std::optional<CheckRuling>& last_check() const { return last_check_; }
  void forget_check() { last_check_.reset(); }

 private:
  // analyst.cc
  void keep_plan(SessionRecord record, const TouchPlan& plan);
  void join_base();
  void keep_solution(Engagements found);

  // analyst_result.cc
  ResultRecord new_result(const ResultFigures& figures) const;
  ResultRecord result_of_failure(const std::string& why) const;
  ResultRecord result_of_check();
  ResultRecord result_of_candidate() const;
  void keep_result(const ResultRecord& result);

  ServiceContext& c_;
  Collector& collector_;
  Computation computation_;
  std::function<void(const std::string& failure)> when_computed_;
  std::shared_ptr<DataSet> data_, base_;
  std::shared_ptr<Solution> solution_, unchanged_;
  std::optional<CheckRuling> last_check_;
};

}  // namespace selfcal
