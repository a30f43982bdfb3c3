#include "tests/slips/changes.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace selfcal::slips {
namespace {

const std::vector<std::string> kPosition = {"x", "y", "z"};

std::vector<std::string> readings(const Files& files) {
  std::vector<std::string> columns;
  for (int j = 1; files.has("q" + std::to_string(j)); ++j)
    columns.push_back("q" + std::to_string(j));
  return columns;
}

}  // namespace

Make reading(const std::string& column, const std::function<double(double)>& of) {
  return
      [=](Files& files) { files.change({column}, [&](Numbers& q, double) { q[0] = of(q[0]); }); };
}

Make sign(const std::string& column) {
  return reading(column, [](double q) { return -q; });
}

Make factor(const std::string& column, double by) {
  return reading(column, [by](double q) { return by * q; });
}

Make offset(const std::string& column, double degrees) {
  return reading(column, [degrees](double q) { return q + degrees * kDegree; });
}

Make exchanged(const std::string& a, const std::string& b) {
  return [=](Files& files) {
    files.change({a, b}, [](Numbers& v, double) { std::swap(v[0], v[1]); });
  };
}

Make every_reading(const std::function<double(double)>& of) {
  return [=](Files& files) {
    files.change(readings(files), [&](Numbers& q, double) {
      for (double& each : q) each = of(each);
    });
  };
}

Make place(const std::function<void(Numbers&, double)>& change) {
  return [=](Files& files) { files.change(kPosition, change); };
}

Make position_times(double factor) {
  return place([factor](Numbers& p, double) {
    for (double& each : p) each *= factor;
  });
}

Make moved_from_half(const Numbers& by) {
  return place([by](Numbers& p, double done) {
    for (std::size_t i = 0; i < 3; ++i) p[i] += done >= 0.5 ? by[i] : 0;
  });
}

Make turned_from_half(double degrees) {
  return place(
      [c = std::cos(degrees * kDegree), s = std::sin(degrees * kDegree)](Numbers& p, double done) {
        if (done >= 0.5) p = {c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]};
      });
}

Make false_places(double share, double size) {
  return [=](Files& files) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> error(0, size);
    std::bernoulli_distribution hit(share);
    files.change(kPosition, [&](Numbers& p, double) {
      const bool this_one = hit(random);
      for (double& each : p) each += this_one ? error(random) : 0;
    });
  };
}

Make other_tip_from_half(const Numbers& tip) {
  return [tip](Files& files) {
    files.change({"x", "y", "z", "qw", "qx", "qy", "qz"}, [&](Numbers& v, double done) {
      if (done < 0.5) return;
      const double w = v[3], a = v[4], b = v[5], c = v[6];
      const double R[3][3] = {{1 - 2 * (b * b + c * c), 2 * (a * b - w * c), 2 * (a * c + w * b)},
                              {2 * (a * b + w * c), 1 - 2 * (a * a + c * c), 2 * (b * c - w * a)},
                              {2 * (a * c - w * b), 2 * (b * c + w * a), 1 - 2 * (a * a + b * b)}};
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) v[i] += R[i][k] * tip[static_cast<std::size_t>(k)];
    });
  };
}

Make measured_elsewhere(bool by_one) {
  return [by_one](Files& files) {
    std::vector<std::size_t> order(files.rows.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = (i + 1) % order.size();
    std::mt19937_64 random(3);
    if (!by_one) std::shuffle(order.begin(), order.end(), random);
    const std::vector<Files::Row> before = files.rows;
    for (const std::string column : {"x", "y", "z", "qw", "qx", "qy", "qz"})
      for (std::size_t i = 0; files.has(column) && i < order.size(); ++i) {
        Files::Row from = before[order[i]];
        files.cell(files.rows[i], column) = files.cell(from, column);
      }
  };
}

Make twice_or_more(int times) {
  return [times](Files& files) {
    std::vector<Files::Row> rows;
    for (const Files::Row& row : files.rows) rows.insert(rows.end(), times, row);
    files.rows = std::move(rows);
  };
}

Make temperature(const std::function<double(double)>& of) {
  return [of](Files& files) { files.set_column("temperature", of); };
}

Make shuffled_times() {
  return [](Files& files) {
    std::vector<double> times(files.rows.size());
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = 30.0 * static_cast<double>(i);
    std::mt19937_64 random(7);
    std::shuffle(times.begin(), times.end(), random);
    files.set_column("time", [&, i = std::size_t(0)](double) mutable { return times[i++]; });
  };
}

Make wrench(const std::vector<std::string>& columns) {
  return [=](Files& files) {
    std::mt19937_64 random(2);
    std::normal_distribution<double> force(0, 50);
    for (const std::string& column : columns)
      files.set_column(column, [&](double) { return force(random); });
  };
}

Make data_set(const std::string& what, const std::string& by) {
  return [=](Files& files) { Files::replace_all(files.data_set, what, by); };
}

Make robot(const std::string& what, const std::string& by) {
  return [=](Files& files) { Files::replace_all(files.robot, what, by); };
}

Make first_rows(std::size_t count) {
  return [count](Files& files) { files.rows.resize(count); };
}

Make on_one_line() {
  return [](Files& files) {
    for (Files::Row& row : files.rows) row = files.rows.front();
    files.change({"q1"}, [](Numbers& q, double done) { q[0] += 0.01 * done; });
  };
}

Make renamed(const std::string& column, const std::string& from, const std::string& to) {
  return [=](Files& files) {
    for (Files::Row& row : files.rows)
      if (files.cell(row, column) == from) files.cell(row, column) = to;
  };
}

Make rounded(const std::vector<std::string>& columns, double step) {
  return [=](Files& files) {
    files.change(columns, [step](Numbers& v, double) {
      for (double& each : v) each = step * std::round(each / step);
    });
  };
}

}  // namespace selfcal::slips
