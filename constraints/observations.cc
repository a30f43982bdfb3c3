#include "constraints/observations.h"

namespace selfcal {
namespace {

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

}  // namespace

Observations taken(const Observations& data, const std::vector<int>& rows) {
  Observations some;
  some.q = picked(data.q, rows);
  some.position = picked(data.position, rows);
  some.orientation = picked(data.orientation, rows);
  some.distance = picked(data.distance, rows);
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
  return some;
}

Conditions conditions(const Observations& data, const std::vector<int>& rows) {
  Conditions at;
  at.wrench = picked(data.wrench, rows);
  at.velocity = picked(data.velocity, rows);
  at.normal = picked(data.normal, rows);
  at.temperature = picked(data.temperature, rows);
  at.time = picked(data.time, rows);
  at.set = picked(data.set, rows);
  return at;
}

}  // namespace selfcal
