// Real data sets beside the checkout, and what is known to be reached on them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "constraints/estimation/identification.h"
#include "io/files/data_set_file.h"
#include "tests/shared_data.h"

namespace selfcal::real {

/// Residual on check rows (mm) that geometry alone is known to reach with default priors.
struct Known {
  const char* name;
  double before, geometry;
};
inline constexpr Known kKnown[] = {
    {"mukca-panda-1", 8.59, 0.53},    {"mukca-panda-3", 2.94, 0.218},
    {"mukca-panda-6", 9.08, 0.229},   {"mukca-kuka-14", 0.567, 0.218},
    {"ipa-ur10-random", 0.98, 0.495}, {"ipa-ur10-joint", 1.08, 0.445},
    {"motoman-tracker", 2.17, 1.60},  {"motoman-selfcontact", 1.33, 0.084},
    {"motoman-planes", 1.0, 0.317},   {"talos-contact", 5.3, 0.89},
    {"ur10-mocap", 3.985, 4.049},     {"delta-bed", 1.62, 0.044},
};

inline LoadedDataSet load(const std::string& name) {
  auto loaded = load_data_set(shared_dir() / "data" / name);
  EXPECT_TRUE(loaded.has_value()) << (loaded ? "" : loaded.error().what);
  return std::move(*loaded);
}

/// The placement of a group: its name without the socket's number ("front_0" is of "front").
inline std::string placement(const std::string& group) { return group.substr(0, group.rfind('_')); }

/// Every placement left out in turn and judged with its own sockets fitted: the pooled residual
/// (m).
inline double left_out(const std::string& name, const Options& options = {}) {
  std::map<std::string, int> placements;
  {
    const LoadedDataSet loaded = load(name);
    for (const std::string& group : loaded.data.sets[0].groups) ++placements[placement(group)];
  }
  double square = 0;
  int rows = 0;
  for (const auto& [left, count] : placements) {
    LoadedDataSet loaded = load(name);
    Observations& o = loaded.data.rows;
    for (int i = 0; i < o.rows(); ++i)
      o.check[i] = placement(loaded.data.sets[0].groups[o.group[i]]) == left;
    const Figures check = identify(*loaded.robot, loaded.data, options).residual.check;
    square += check.rms_after * check.rms_after * check.rows;
    rows += check.rows;
  }
  return std::sqrt(square / rows);
}

}  // namespace selfcal::real
