// What takes long, beside the loop: plans sessions, identifies from their rows, and judges. Nothing
// is applied here.
#pragma once

#include <functional>
#include <memory>

#include "app/service/loop/collector.h"
#include "app/service/loop/computation.h"
#include "app/service/session/acceptance.h"
#include "constraints/estimation/engagements.h"

namespace selfcal {

class Analyst {
 public:
  /// Both outlive it.
  Analyst(ServiceContext& context, Collector& collector) : c_(context), collector_(collector) {}

  /// A quick check has something to compare with.
  bool can_check() const;
  /// A session of the state's kind, which begins once it is planned; of one that is in the
  /// store a further round.
  void plan(const std::string& why);
  /// The rows of what was collected.
  void analyse();
  void identify();
  /// On the rows kept aside; the result is in the store then, with its candidate.
  void judge();
  /// A full session of this robot and configuration is there to look into.
  bool can_diagnose() const;
  /// What the rows of that session and of the touches since say of the cause: further touches that
  /// tell look-alikes apart, or the result.
  void diagnose(const std::string& why);
  /// What is under way is not asked for any more.
  void give_up();
  /// Goes on with what has ended since the last turn.
  void take();
  /// Nothing while nothing is computed.
  std::optional<Computation::Progress> progress() const;

  /// Of the parameters that are active.
  const std::optional<CheckDecision>& last_check() const { return last_check_; }
  void forget_check() { last_check_.reset(); }

 private:
  // analyst.cc
  void keep_plan(SessionRecord record, const TouchPlan& plan);
  /// Touches that a plan has not for want of a free way.
  void tell_left_out(const TouchPlan& plan) const;
  void join_base();
  std::optional<Session> stored_session(const SessionRecord& record) const;
  void keep_solution(Engagements found);

  // analyst_rounds.cc
  /// Of each set those that are still to be made in this round.
  std::vector<TouchTarget> targets_of_round(const std::vector<StepRecord>& made) const;
  void plan_round();
  void keep_round(const TouchPlan& plan);
  bool wants_more() const;
  std::vector<PossibleTouch> touches_made() const;

  // analyst_result.cc
  ResultRecord new_result(const ResultFigures& figures) const;
  ResultRecord result_of_failure(const std::string& why) const;
  ResultRecord result_of_check();
  ResultRecord result_of_candidate() const;
  /// What the calibration leaves, and its cause is looked for by itself.
  bool more_than_noise() const;
  void keep_result(const ResultRecord& result, bool cause);

  // analyst_cause.cc
  struct CauseFindings;
  /// The full session that the rows of this one belong to.
  std::optional<SessionRecord> base() const;
  SessionRecord new_record(const std::string& why) const;
  void keep_findings(const std::string& why, CauseFindings& found);
  void touch_more(const std::string& why, const CauseFindings& found);
  ResultRecord result_of_cause(const CauseFindings& found) const;

  ServiceContext& c_;
  Collector& collector_;
  Computation computation_;
  std::function<void(const std::string& failure)> when_computed_;
  std::shared_ptr<DataSet> data_, base_;
  std::shared_ptr<Solution> solution_, unchanged_;
  std::optional<CheckDecision> last_check_;
};

}  // namespace selfcal
