// In which order configurations are visited so that the way is short.
//
// From each of several beginnings, the next one is the nearest; then a stretch turned round (2-opt;
// only where ways are as long back as forth) or up to three visits moved elsewhere (Or-opt), as
// long as the way gets shorter.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <vector>

namespace selfcal {

/// From where a visit is begun to where it ends (readings).
struct Visit {
  Eigen::VectorXd first, last;
};

/// Time (s) from one configuration to another, all joints moving at once, each at its speed (rad/s,
/// m/s; above 0).
double joint_time(const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                  const Eigen::VectorXd& speed);

/// Time from the first visit to the end of the last in this order, what the visits themselves take
/// included.
double way_time(const std::vector<Visit>& visits, const std::vector<int>& order,
                const Eigen::VectorXd& speed);

/// The order, which begins at any visit.
std::vector<int> short_tour(const std::vector<Visit>& visits, const Eigen::VectorXd& speed);

/// Leaves visits out of `order`, one after another, until the way takes `longest` (s) at most or
/// one is left: each time the one whose `worth` (above 0) is least for the time that it costs.
/// `left` hears of it, and the worth of the others may then be another.
void leave_out(const std::vector<Visit>& visits, const Eigen::VectorXd& speed, double longest,
               const std::function<double(int)>& worth, const std::function<void(int)>& left,
               std::vector<int>& order);

/// The order of places, begun at the first one, by the time from one to another (s; symmetric).
std::vector<int> short_tour_from_first(const Eigen::MatrixXd& way);

}  // namespace selfcal
