#include "constraints/planning/tour.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace selfcal {
namespace {

constexpr int kLongestMoved = 3;
constexpr int kStarts = 8;         // visits from which a tour is begun
constexpr double kShorter = 1e-9;  // s: a smaller gain is rounding

class TourSearch {
 public:
  /// `way`: from the end of one to the beginning of another (s). The first `fixed` places stay.
  TourSearch(Eigen::MatrixXd way, bool both_ways, int fixed)
      : count_(static_cast<int>(way.rows())),
        fixed_(fixed),
        way_(std::move(way)),
        both_ways_(both_ways) {}

  std::vector<int> run() {
    std::vector<int> best;
    double shortest = 0;
    const int starts = std::min(count_, fixed_ > 0 ? 1 : kStarts);
    for (int start = 0; start < starts; ++start) {
      nearest(start);
      while ((both_ways_ && turn_a_stretch()) || move_some())
        ;
      double way = 0;
      for (int i = 1; i < count_; ++i) way += between(i - 1, i);
      if (!best.empty() && way >= shortest) continue;
      shortest = way;
      best = order_;
    }
    return best;
  }

 private:
  void nearest(int start) {
    order_.resize(static_cast<std::size_t>(count_));
    std::iota(order_.begin(), order_.end(), 0);
    std::swap(order_[0], order_[start]);
    for (int i = 1; i < count_; ++i) {
      const auto next = std::min_element(order_.begin() + i, order_.end(), [&](int a, int b) {
        return way_(order_[i - 1], a) < way_(order_[i - 1], b);
      });
      std::swap(order_[i], *next);
    }
  }

  /// The way between the visits at two places; none before the first or after the last.
  double between(int i, int j) const {
    return i < 0 || j >= count_ ? 0 : way_(order_[i], order_[j]);
  }

  bool turn_a_stretch() {
    bool shorter = false;
    for (int i = fixed_; i + 1 < count_; ++i)
      for (int j = i + 1; j < count_; ++j) {
        const double before = between(i - 1, i) + between(j, j + 1);
        const double after = (i > 0 ? way_(order_[i - 1], order_[j]) : 0) +
                             (j + 1 < count_ ? way_(order_[i], order_[j + 1]) : 0);
        if (after > before - kShorter) continue;
        std::reverse(order_.begin() + i, order_.begin() + j + 1);
        shorter = true;
      }
    return shorter;
  }

  bool move_some() {
    bool shorter = false;
    for (int length = 1; length <= kLongestMoved; ++length)
      for (int i = fixed_; i + length <= count_; ++i)
        if (move(i, length)) shorter = true;
    return shorter;
  }

  /// Moves the `length` visits from place i on to where the way gets shortest.
  bool move(int i, int length) {
    const int end = i + length, first = order_[i], last = order_[end - 1];
    const double left = between(i - 1, i) + between(end - 1, end) -
                        (i > 0 && end < count_ ? way_(order_[i - 1], order_[end]) : 0);
    double most = kShorter;
    int best = -1;
    for (int to = fixed_; to <= count_; ++to) {  // before the visit at place `to`
      if (to >= i && to <= end) continue;
      const double more = (to > 0 ? way_(order_[to - 1], first) : 0) +
                          (to < count_ ? way_(last, order_[to]) : 0) - between(to - 1, to);
      if (left - more <= most) continue;
      most = left - more;
      best = to;
    }
    if (best < 0) return false;
    if (best < i)
      std::rotate(order_.begin() + best, order_.begin() + i, order_.begin() + end);
    else
      std::rotate(order_.begin() + i, order_.begin() + end, order_.begin() + best);
    return true;
  }

  int count_, fixed_;
  Eigen::MatrixXd way_;
  bool both_ways_;
  std::vector<int> order_;
};

}  // namespace

double joint_time(const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                  const Eigen::VectorXd& speed) {
  return ((to - from).array().abs() / speed.array()).maxCoeff();
}

double way_time(const std::vector<Visit>& visits, const std::vector<int>& order,
                const Eigen::VectorXd& speed) {
  double time = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Visit& here = visits[static_cast<std::size_t>(order[i])];
    time += joint_time(here.first, here.last, speed);
    if (i > 0)
      time += joint_time(visits[static_cast<std::size_t>(order[i - 1])].last, here.first, speed);
  }
  return time;
}

std::vector<int> short_tour(const std::vector<Visit>& visits, const Eigen::VectorXd& speed) {
  const auto count = static_cast<Eigen::Index>(visits.size());
  Eigen::MatrixXd way(count, count);
  for (Eigen::Index a = 0; a < count; ++a)
    for (Eigen::Index b = 0; b < count; ++b)
      way(a, b) = joint_time(visits[static_cast<std::size_t>(a)].last,
                             visits[static_cast<std::size_t>(b)].first, speed);
  const bool both_ways =
      std::ranges::all_of(visits, [](const Visit& v) { return v.first == v.last; });
  return TourSearch(std::move(way), both_ways, 0).run();
}

void leave_out(const std::vector<Visit>& visits, const Eigen::VectorXd& speed, double longest,
               const std::function<double(int)>& worth, const std::function<void(int)>& left,
               std::vector<int>& order) {
  const auto visit = [&](std::size_t place) -> const Visit& {
    return visits[static_cast<std::size_t>(order[place])];
  };
  const auto between = [&](std::size_t a, std::size_t b) {
    return joint_time(visit(a).last, visit(b).first, speed);
  };
  // What the visit at a place costs: its own time, and that of the way round by it.
  const auto cost = [&](std::size_t i) {
    double time = joint_time(visit(i).first, visit(i).last, speed);
    if (i > 0) time += between(i - 1, i);
    if (i + 1 < order.size()) time += between(i, i + 1);
    return i > 0 && i + 1 < order.size() ? time - between(i - 1, i + 1) : time;
  };
  while (order.size() > 1 && way_time(visits, order, speed) > longest) {
    std::size_t least = 0;
    double worth_of_time = HUGE_VAL;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const double each = worth(order[i]) / std::max(cost(i), kShorter);
      if (each >= worth_of_time) continue;
      worth_of_time = each;
      least = i;
    }
    left(order[least]);
    order.erase(order.begin() + static_cast<std::ptrdiff_t>(least));
  }
}

std::vector<int> short_tour_from_first(const Eigen::MatrixXd& way) {
  return TourSearch(way, true, 1).run();
}

}  // namespace selfcal
