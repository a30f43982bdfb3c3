// Two sessions of one robot under one tracker, with noise of their own, and the options of
// a quick diagnosis.
#pragma once

#include <memory>

#include "diagnosis/findings.h"
#include "io/files/robot_file.h"
#include "tests/recovery/session.h"

namespace selfcal {

inline constexpr double kTrackerNoise = 20e-6;  // m, of one coordinate

struct TwoSessions {
  /// Of `rows` rows each.
  explicit TwoSessions(int rows = 60) {
    auto loaded = load_robot(SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml");
    if (!loaded) std::abort();
    robot = *std::move(loaded);
    Random random(3);
    Eigen::VectorXd xi(static_cast<Eigen::Index>(robot->parameters().size()));
    std::normal_distribution<double> normal;
    for (Eigen::Index i = 0; i < xi.size(); ++i) {
      const Parameter& p = robot->parameters()[static_cast<size_t>(i)];
      xi[i] = p.nominal + (p.part == Part::link ? 5e-4 * normal(random) : 0);
    }
    const Node tracker = recovery::entry(
        {{"method", "position"}, {"frame", "unknown"}, {"point", "unknown"}, {"noise", "2e-5"}});
    const DataSet all =
        recovery::make_session(*robot, xi, {{"tracker", tracker, 2 * rows}}, kTrackerNoise, random)
            .data;
    before = after = all;
    before.rows = every_other(all.rows, 0);
    after.rows = every_other(all.rows, 1);
  }

  static Observations every_other(const Observations& all, int first) {
    std::vector<int> rows;
    for (int row = first; row < all.rows(); row += 2) rows.push_back(row);
    return taken(all, rows);
  }

  std::shared_ptr<const Robot> robot;
  DataSet before, after;
};

/// Enough resamples for a cause to be named, no simulated sessions.
inline DiagnosisOptions quick() {
  DiagnosisOptions options;
  options.simulated_sessions = 0;
  options.resamples = 99;
  return options;
}

}  // namespace selfcal
