// The clearest slip is taken first and the rest judged anew, for it bends what all other rows
// leave.
#include "constraints/estimation/engagements.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "constraints/estimation/lock_slip.h"

namespace selfcal {
namespace {

int set_of(const std::vector<Set>& sets, const std::string& name) {
  return static_cast<int>(std::ranges::find(sets, name, &Set::name) - sets.begin());
}

class Splitter {
 public:
  explicit Splitter(DataSet data) : origin_(data.sets.size()), left_out_(data.sets.size(), 0) {
    std::iota(origin_.begin(), origin_.end(), 0);
    out_.data = std::move(data);
    out_.kept.resize(static_cast<std::size_t>(out_.data.rows.rows()));
    std::iota(out_.kept.begin(), out_.kept.end(), 0);
  }

  Engagements run(const Robot& robot, const Options& options, const Progress& progress) {
    for (;;) {
      out_.solution = identified(robot, options, progress);
      const std::vector<LockSlip>& now = out_.solution.slips;
      if (now.empty()) break;
      take(*std::ranges::max_element(now, {}, &LockSlip::statistic));
    }
    tell();
    return std::move(out_);
  }

 private:
  Solution identified(const Robot& robot, const Options& options, const Progress& progress) const {
    const DataSet& all = out_.data;
    if (static_cast<int>(out_.kept.size()) == all.rows.rows())
      return identify(robot, all, options, progress);
    const DataSet used{all.sets,   taken(all.rows, out_.kept),
                       all.speeds, all.order_is_time,
                       all.target, all.workspace};
    return identify(robot, used, options, progress);
  }

  /// Of the rows that were kept to the rows of the data set.
  int row(int kept) const { return out_.kept[static_cast<std::size_t>(kept)]; }

  void take(LockSlip slip) {
    slip.before = row(slip.before);
    slip.after = row(slip.after);
    const int set = set_of(out_.data.sets, slip.set), origin = origin_[set];
    if (std::ranges::count(origin_, origin) > kMostSlips) return leave_out(origin);
    const int later = add_engagement(out_.data.sets, set);
    origin_.push_back(origin);
    left_out_.push_back(0);
    bool after = false;
    for (const int each : rows_in_time(out_.data.rows, set)) {
      after = after || each == slip.after;
      if (after) out_.data.rows.set[each] = later;
    }
    slips_.push_back(std::move(slip));
  }

  void leave_out(int origin) {
    for (std::size_t s = 0; s < origin_.size(); ++s)
      if (origin_[s] == origin) left_out_[s] = 1;
    std::erase_if(out_.kept, [&](int each) { return left_out_[out_.data.rows.set[each]] != 0; });
  }

  void tell() {
    Solution& solution = out_.solution;
    for (RowFigure& each : solution.residual.rows) each.row = row(each.row);
    for (Outlier& each : solution.outliers) each.row = row(each.row - 1) + 1;
    const Observations& rows = out_.data.rows;
    for (int each = 0; each < rows.rows(); ++each)
      if (left_out_[rows.set[each]])
        solution.outliers.push_back({.row = each + 1,
                                     .set = out_.data.sets[rows.set[each]].name,
                                     .residual = HUGE_VAL,
                                     .check = rows.check[each] != 0,
                                     .why = "its lock slipped again and again"});
    std::ranges::stable_sort(solution.outliers, {}, &Outlier::row);
    for (std::size_t s = 0; s < left_out_.size(); ++s)
      if (left_out_[s] && origin_[s] == static_cast<int>(s))
        solution.locks_left_out.push_back(out_.data.sets[s].name);
    std::ranges::stable_sort(slips_, {}, &LockSlip::before);
    for (LockSlip& slip : slips_) measure(slip);
    solution.slips = slips_;
    for (const LockSlip& slip : slips_)
      solution.warnings.push_back(slip_words(slip) +
                                  ": the rows after it have a direction of their own");
    for (const std::string& name : solution.locks_left_out)
      solution.warnings.push_back("set " + name +
                                  ": its lock slipped again and again: all its rows are put aside");
  }

  /// Between the two directions that were fitted in the end; the step in the residuals falls short
  /// of it, as one direction was fitted to both sides. Of rows put aside the step is all there is.
  void measure(LockSlip& slip) const {
    const auto direction = [&](int row) {
      std::vector<double> u;
      for (const NuisanceResult& each : out_.solution.sets[out_.data.rows.set[row]].nuisance)
        u.push_back(each.value);
      return u;
    };
    if (out_.solution.sets.empty()) return;
    const std::vector<double> u = direction(slip.before), v = direction(slip.after);
    if (u.size() != 3 || v.size() != 3) return;
    slip.angle = 2 * std::asin(std::hypot(u[0] - v[0], u[1] - v[1], u[2] - v[2]) / 2);
  }

  Engagements out_;
  std::vector<int> origin_;     // by set, the one as given
  std::vector<char> left_out_;  // by set
  std::vector<LockSlip> slips_;
};

}  // namespace

int add_engagement(std::vector<Set>& sets, int set) {
  Set again = sets[set];
  int number = 2;
  const auto name = [&] { return sets[set].name + "-" + std::to_string(number); };
  while (std::ranges::count(sets, name(), &Set::name) > 0) ++number;
  again.name = name();
  sets.push_back(std::move(again));
  return static_cast<int>(sets.size()) - 1;
}

Engagements identify_engagements(const Robot& robot, DataSet data, const Options& options,
                                 const Progress& progress) {
  return Splitter(std::move(data)).run(robot, options, progress);
}

}  // namespace selfcal
