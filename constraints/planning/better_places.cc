#include "constraints/planning/better_places.h"

#include <algorithm>
#include <cmath>

namespace selfcal {
namespace {

constexpr double kFirstStep = 0.1;  // of a coordinate's range: the length of a direction
constexpr double kLongest = 2;      // of its direction, the longest step; the shortest is 1/90
constexpr int kRounds = 2;          // of all directions, of one unit in a sweep
constexpr int kTaken = 3;           // of the steps that gain, tried until one can be taken
constexpr double kShorter = 0.3;    // of the directions, after a sweep
constexpr std::size_t kUnitsAfresh = 10;  // after so many the design is made anew
constexpr double kWorth =
    2e-3;  // a sweep that gains less, of the variance or of a log, is the last

class Powell {
 public:
  Powell(Design& design, const Moves& moves) : design_(design), moves_(moves) {}

  int run(const Progress& progress) {
    const std::vector<int> units = design_.chosen();
    std::vector<Eigen::MatrixXd> directions;
    for (const int unit : units) directions.push_back(first_directions(unit));
    for (int sweep = 0; sweep < moves_.sweeps; ++sweep) {
      const double before = design_.merit();
      for (std::size_t i = 0; i < units.size(); ++i) {
        if (progress)
          progress(
              "moving configurations",
              (sweep + static_cast<double>(i) / static_cast<double>(units.size())) / moves_.sweeps);
        improve(units[i], directions[i]);
        if (i % kUnitsAfresh == 0 || i + 1 == units.size()) design_.refresh();
        directions[i] *= kShorter;
      }
      if (design_.merit() - before < kWorth * std::min(1.0, std::abs(before))) break;
    }
    return moved_;
  }

 private:
  Eigen::MatrixXd first_directions(int unit) const {
    const Eigen::VectorXd range = moves_.range(unit);
    std::vector<Eigen::Index> moving;
    for (Eigen::Index c = 0; c < range.size(); ++c)
      if (range[c] > 0) moving.push_back(c);
    const Eigen::MatrixXd all = (kFirstStep * range).asDiagonal();
    return all(Eigen::all, moving);
  }

  void improve(int unit, Eigen::MatrixXd& directions) {
    merit_ = design_.merit();
    design_.change(unit, -1);
    for (int round = 0; round < kRounds; ++round) {
      Eigen::VectorXd led = Eigen::VectorXd::Zero(directions.rows());
      double most = 0;
      Eigen::Index best = -1;
      for (Eigen::Index d = 0; d < directions.cols(); ++d) {
        const double before = merit_;
        led += along(unit, directions.col(d));
        if (merit_ - before <= most) continue;
        most = merit_ - before;
        best = d;
      }
      if (best < 0) break;
      // As long as the others: a short way is still a direction.
      const double length = directions.colwise().norm().mean();
      if (!(led.norm() > 1e-3 * length)) continue;
      const Eigen::VectorXd way = length / led.norm() * led;
      along(unit, way);
      directions.col(best) = way;
    }
    design_.change(unit, +1);
  }

  /// The step along `direction` that gains most and can be taken; zero where none does.
  Eigen::VectorXd along(int unit, const Eigen::VectorXd& direction) {
    Eigen::MatrixXd by(direction.size(), kLanes);
    for (int lane = 0; lane < kLanes; ++lane)
      by.col(lane) = (lane % 2 == 0 ? 1 : -1) * kLongest *
                     std::pow(0.5, lane / 4.0 - lane % 2 / 4.0) * direction;
    const std::vector<Eigen::MatrixXd> rows = moves_.look(unit, by);
    std::vector<Eigen::MatrixXd> possible;
    std::vector<int> lanes;
    for (int lane = 0; lane < kLanes; ++lane) {
      const Eigen::MatrixXd& w = rows[static_cast<std::size_t>(lane)];
      if (w.rows() != design_.rows(unit)) continue;
      possible.push_back(w);
      lanes.push_back(lane);
    }
    const std::vector<double> merits = design_.merits_with(possible);
    std::vector<std::pair<double, int>> gaining;
    for (std::size_t i = 0; i < merits.size(); ++i)
      if (merits[i] > merit_ + 1e-9 * std::abs(merit_)) gaining.emplace_back(-merits[i], lanes[i]);
    std::ranges::sort(gaining);
    for (std::size_t i = 0; i < gaining.size() && i < kTaken; ++i) {
      const auto [merit, lane] = gaining[i];
      if (!moves_.take(unit, lane)) continue;
      merit_ = -merit;
      ++moved_;
      design_.replace(unit, rows[static_cast<std::size_t>(lane)]);
      return by.col(lane);
    }
    return Eigen::VectorXd::Zero(direction.size());
  }

  Design& design_;
  const Moves& moves_;
  double merit_ = 0;  ///< with the unit where it is
  int moved_ = 0;
};

}  // namespace

int move_to_better_places(Design& design, const Moves& moves, const Progress& progress) {
  return Powell(design, moves).run(progress);
}

}  // namespace selfcal
