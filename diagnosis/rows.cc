#include "diagnosis/rows.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

namespace selfcal {

std::vector<Scale> pooled_noise(const DataSet& data, const Fit& fitted) {
  std::map<std::string_view, std::pair<double, double>> pooled;  // squares, rows
  const auto method = [&](size_t s) { return data.sets[s].method->name(); };
  for (const RowResidual& r : fitted.at.residuals) {
    auto& [squares, rows] = pooled[method(static_cast<size_t>(r.set))];
    squares += std::pow(fitted.noise.estimated[r.set].length, 2);
    rows += 1;
  }
  std::vector<Scale> noise = fitted.noise.estimated;
  for (size_t s = 0; s < noise.size(); ++s)
    if (const auto found = pooled.find(method(s)); found != pooled.end())
      noise[s].length = std::sqrt(found->second.first / found->second.second);
  return noise;
}

std::vector<char> weighed_rows(const Observations& rows, double equations, double most) {
  const double step = std::max(1.0, equations / most);
  std::vector<char> take(static_cast<size_t>(rows.rows()), 0);
  std::map<int, char> repeats;
  double next = 0, configurations = 0;
  for (size_t row = 0; row < take.size(); ++row) {
    if (rows.check[row]) continue;
    const int repeat = rows.repeat.empty() ? -1 : rows.repeat[row];
    if (repeat >= 0 && repeats.contains(repeat)) {
      take[row] = repeats[repeat];
      continue;
    }
    take[row] = configurations >= next;
    if (take[row]) next += step;
    configurations += 1;
    if (repeat >= 0) repeats[repeat] = take[row];
  }
  return take;
}

DenseEquations kept(const DenseEquations& all, const std::vector<char>& take) {
  std::vector<int> rows;
  for (size_t i = 0; i < all.row.size(); ++i)
    if (all.row[i] < 0 || take[static_cast<size_t>(all.row[i])])
      rows.push_back(static_cast<int>(i));
  DenseEquations some{all.W(rows, Eigen::all), all.y(rows), all.shift(rows, Eigen::all), {}};
  for (const int i : rows) some.row.push_back(all.row[i]);
  return some;
}

Eigen::MatrixXd tips(const Robot& robot, const Observations& rows) {
  Eigen::MatrixXd tips(rows.rows(), 3);
  for (int row = 0; row < rows.rows(); ++row)
    tips.row(row) = robot.link_poses(rows.q.row(row).transpose()).back().translation().transpose();
  return tips;
}

}  // namespace selfcal
