#include "constraints/methods/observations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "kinematics/description.h"

namespace selfcal {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

template <class Column>
Column picked(const Column& column, const std::vector<int>& rows) {
  return column.rows() > 0 ? Column(column(rows, Eigen::all)) : Column();
}

template <class T>
std::vector<T> picked(const std::vector<T>& column, const std::vector<int>& rows) {
  std::vector<T> list;
  for (const int row : rows)
    if (!column.empty()) list.push_back(column[row]);
  return list;
}

/// Two parts of one column, of n and m rows.
template <class Column>
Column stacked(const Column& a, const Column& b, Eigen::Index n, Eigen::Index m, double absent) {
  if (a.rows() == 0 && b.rows() == 0) return {};
  Column all = Column::Constant(n + m, std::max(a.cols(), b.cols()), absent);
  if (a.rows() > 0) all.topRows(n) = a;
  if (b.rows() > 0) all.bottomRows(m) = b;
  return all;
}

template <class T>
std::vector<T> stacked(std::vector<T> a, std::vector<T> b, int n, int m, T absent) {
  if (a.empty() && b.empty()) return {};
  a.resize(static_cast<size_t>(n), absent);
  b.resize(static_cast<size_t>(m), absent);
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

const Eigen::VectorXd& Observations::column(std::string_view name) const {
  static const Eigen::VectorXd kNone;
  const auto found = measured.find(name);
  return found == measured.end() ? kNone : found->second;
}

Observations taken(const Observations& data, const std::vector<int>& rows) {
  Observations some;
  some.q = picked(data.q, rows);
  some.position = picked(data.position, rows);
  some.orientation = picked(data.orientation, rows);
  some.turns = {data.turns.axes, picked(data.turns.angles, rows)};
  some.normal = picked(data.normal, rows);
  some.wrench = picked(data.wrench, rows);
  some.velocity = picked(data.velocity, rows);
  some.temperature = picked(data.temperature, rows);
  some.time = picked(data.time, rows);
  some.noise_factor = picked(data.noise_factor, rows);
  some.set = picked(data.set, rows);
  some.group = picked(data.group, rows);
  some.repeat = picked(data.repeat, rows);
  some.check = picked(data.check, rows);
  for (const auto& [name, column] : data.measured) some.measured[name] = picked(column, rows);
  return some;
}

Observations joined(const Observations& a, const Observations& b) {
  const int n = a.rows(), m = b.rows();
  const auto both = [&](auto column, double absent = kNaN) {
    return stacked(a.*column, b.*column, n, m, absent);
  };
  Observations all;
  all.q = both(&Observations::q);
  all.position = both(&Observations::position);
  all.orientation = both(&Observations::orientation);
  if (a.turns.axes == b.turns.axes)
    all.turns = {a.turns.axes, stacked(a.turns.angles, b.turns.angles, n, m, kNaN)};
  all.normal = both(&Observations::normal);
  all.wrench = both(&Observations::wrench);
  all.velocity = both(&Observations::velocity);
  all.temperature = both(&Observations::temperature);
  all.time = both(&Observations::time);
  all.noise_factor = both(&Observations::noise_factor, 1);
  all.set = stacked(a.set, b.set, n, m, 0);
  all.group = stacked(a.group, b.group, n, m, -1);
  all.repeat = stacked(a.repeat, b.repeat, n, m, -1);
  all.check = stacked(a.check, b.check, n, m, char{0});
  for (const auto* measured : {&a.measured, &b.measured})
    for (const auto& [name, column] : *measured)
      all.measured[name] = stacked(a.column(name), b.column(name), n, m, kNaN);
  return all;
}

namespace {

constexpr int kLongGap = 10;           ///< rows that lack their temperature one after the other
constexpr double kUnread = 85;         ///< C, of a usual thermometer before its first reading
constexpr double kFarFromUnread = 15;  ///< K, that all others lie below it

/// "temperature is empty in 3 of 60 rows, first row 17".
std::string emptiness(const char* column, const Eigen::VectorXd& values) {
  Eigen::Index first = 0;
  while (std::isfinite(values[first])) ++first;
  return std::string(column) + " is empty in " +
         std::to_string(values.size() - values.array().isFinite().count()) + " of " +
         std::to_string(values.size()) + " rows, first row " + std::to_string(first + 1);
}

/// Temperatures that are what a thermometer says that is not read, far from all others: these rows
/// have none then. In words; empty where there are none.
std::string without_unread(Eigen::VectorXd& values) {
  std::vector<double> others;
  std::vector<Eigen::Index> unread;
  for (Eigen::Index row = 0; row < values.size(); ++row) {
    if (values[row] == kUnread)
      unread.push_back(row);
    else if (std::isfinite(values[row]))
      others.push_back(values[row]);
  }
  if (unread.empty() || others.size() < unread.size() ||
      kUnread - std::ranges::max(others) < kFarFromUnread)
    return {};
  for (const Eigen::Index row : unread) values[row] = kNaN;
  return "temperature is " + format_number(kUnread) + " in " + std::to_string(unread.size()) +
         " of " + std::to_string(values.size()) + " rows, first row " +
         std::to_string(unread.front() + 1) +
         ", as of a thermometer that is not read: it is taken as empty there";
}

/// Values between the neighbours' of the rows that have one, of few next to each other; whether all
/// have theirs then.
bool interpolate(Eigen::VectorXd& values, const std::vector<int>& order) {
  std::ptrdiff_t known = -1;  // the place of the last that is
  const auto count = std::ssize(order);
  const auto at = [&](std::ptrdiff_t i) -> double& {
    return values[order[static_cast<size_t>(i)]];
  };
  bool all = true;
  for (std::ptrdiff_t i = 0; i <= count; ++i) {
    if (i < count && !std::isfinite(at(i))) continue;
    const bool near = i - known - 1 <= kLongGap && (known >= 0 || i < count);
    all = all && near;
    for (std::ptrdiff_t k = known + 1; near && k < i; ++k) {
      const double from = known < 0 ? at(i) : at(known), to = i == count ? from : at(i);
      at(k) = from + (to - from) * static_cast<double>(k - known) / static_cast<double>(i - known);
    }
    known = i;
  }
  return all;
}

}  // namespace

std::vector<std::string> fill_gaps(Observations& rows) {
  std::vector<std::string> done;
  const auto fill = [&](const char* column, Eigen::VectorXd& values, const std::vector<int>& order,
                        const char* otherwise) {
    if (values.size() == 0 || values.allFinite()) return true;
    const std::string words = emptiness(column, values);
    const bool all = interpolate(values, order);
    done.push_back(words + (all ? ": it is taken from the rows before and after" : otherwise));
    return all;
  };
  std::vector<int> order(static_cast<size_t>(rows.rows()));
  std::iota(order.begin(), order.end(), 0);
  if (!fill("time", rows.time, order,
            ", many of them one after the other: the order of the rows is taken for it"))
    rows.time = {};
  if (std::string unread = without_unread(rows.temperature); !unread.empty())
    done.push_back(std::move(unread));
  fill("temperature", rows.temperature, in_time(rows),
       ", many of them one after the other: these are taken to be as warm as the reference");
  if (!rows.temperature.array().isFinite().any()) rows.temperature = {};
  return done;
}

std::vector<int> in_time(const Observations& rows) {
  std::vector<int> order(static_cast<size_t>(rows.rows()));
  std::iota(order.begin(), order.end(), 0);
  if (rows.time.size() > 0 && rows.time.allFinite())
    std::ranges::stable_sort(order, {}, [&](int row) { return rows.time[row]; });
  return order;
}

std::vector<int> configurations(const Observations& rows) {
  std::vector<int> numbers(static_cast<size_t>(rows.rows()));
  std::map<std::pair<int, int>, int> known;  // by set and repeat
  int count = 0;
  for (const int row : in_time(rows)) {
    const int repeat = rows.repeat.empty() ? -1 : rows.repeat[row];
    if (repeat < 0)
      numbers[row] = count++;
    else if (const auto [found, made] = known.try_emplace({rows.set[row], repeat}, count); made)
      numbers[row] = count++;
    else
      numbers[row] = found->second;
  }
  return numbers;
}

MeasurementConditions conditions(const Observations& data, const std::vector<int>& rows) {
  MeasurementConditions at;
  at.wrench = picked(data.wrench, rows);
  at.velocity = picked(data.velocity, rows);
  at.normal = picked(data.normal, rows);
  at.temperature = picked(data.temperature, rows);
  at.time = picked(data.time, rows);
  at.set = picked(data.set, rows);
  return at;
}

}  // namespace selfcal
