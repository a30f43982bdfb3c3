// Newton steps of least length on a method's residual from kLanes random starts at once.
#include "constraints/sampling/configurations.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "constraints/methods/shared/unit_normal.h"
#include "constraints/sampling/newton.h"
#include "constraints/sampling/random_poses.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kEnough = 8;      // lanes that reach the residual before the others are given up
constexpr double kSame = 1e-6;  // units of readings: farther apart, two configurations differ
constexpr int kTries = 60;      // blocks of starts before a place is given up

/// Columns for what instruments read, empty where they are new.
void make_columns(DataSet& data) {
  Observations& d = data.rows;
  const Eigen::Index rows = d.q.rows();
  for (const auto& [column, width] :
       {std::pair{&d.position, 3}, {&d.orientation, 4}, {&d.normal, 3}})
    if (column->rows() != rows) column->setConstant(rows, width, std::nan(""));
  for (const Set& set : data.sets)
    for (const MeasuredColumn& column : set.method->measures())
      if (d.measured[column.name].rows() != rows)
        d.measured[column.name].setConstant(rows, std::nan(""));
}

class Sampler {
 public:
  Sampler(const Robot& robot, const Eigen::VectorXd& xi, Random& random, DataSet& data,
          const Progress& progress)
      : robot_(robot), xi_(xi), random_(random), data_(data), progress_(progress) {}

  Sampled run(const std::vector<SampleRequest>& requests) {
    sampled_.truth.xi = xi_;
    sampled_.truth.nuisance.resize(data_.sets.size());
    sampled_.truth.groups.resize(data_.sets.size());
    reserve(requests);
    // A set that refers to another comes after it: its own values start from the other's.
    for (const bool referring : {false, true})
      for (const SampleRequest& request : requests)
        if ((data_.sets[request.set].reference >= 0) == referring) fill(request);
    shrink();
    return std::move(sampled_);
  }

 private:
  void reserve(const std::vector<SampleRequest>& requests) {
    Eigen::Index rows = 0;
    for (const SampleRequest& request : requests) rows += request.rows + 1;
    Observations& d = data_.rows;
    d = {};
    d.q.resize(rows, static_cast<Eigen::Index>(robot_.joints().size()));
    make_columns(data_);
  }

  void shrink() {
    Observations& d = data_.rows;
    const auto rows = static_cast<Eigen::Index>(d.set.size());
    d.q.conservativeResize(rows, Eigen::NoChange);
    d.position.conservativeResize(rows, Eigen::NoChange);
    d.orientation.conservativeResize(rows, Eigen::NoChange);
    d.normal.conservativeResize(rows, Eigen::NoChange);
    for (auto& [name, column] : d.measured) column.conservativeResize(rows);
    d.check.assign(rows, 0);
  }

  ConfigurationBlock starts() {
    ConfigurationBlock block;
    block.q = random_poses(robot_, nullptr, kLanes, random_()).array();
    block.count = kLanes;
    for (const auto& [joint, reading] : locked_) block.q.col(joint) = reading;
    return block;
  }

  Location anywhere(const Method& method, const Patch& patch) {
    Locations X;
    for (int attempt = 0; attempt < kTries; ++attempt) {
      const Closure closure = robot_.locate(starts(), xi_, method.body(), X, nullptr);
      for (int lane = 0; lane < kLanes; ++lane)
        if (closure.closes(lane) && patch.contains(X.p(lane))) return X.at(lane);
    }
    return X.at(0);
  }

  void fill(const SampleRequest& request) {
    Set& set = data_.sets[request.set];
    const Method& method = *set.method;
    locked_.clear();
    std::vector<int> held = request.held;
    const int turning = find_joint(robot_, method.turning_joint());
    for (int joint = 0; turning >= 0 && joint < static_cast<int>(robot_.joints().size()); ++joint)
      if (joint != turning) held.push_back(joint);
    if (!held.empty()) {
      const Eigen::MatrixXd there = random_poses(robot_, nullptr, 1, random_());
      for (const int joint : held) locked_.emplace_back(joint, there(0, joint));
    }
    Eigen::VectorXd& nuisance = sampled_.truth.nuisance[request.set];
    const Eigen::VectorXd* reference =
        set.reference < 0 ? nullptr : &sampled_.truth.nuisance[set.reference];
    nuisance = request.nuisance
                   ? *request.nuisance
                   : method.through(anywhere(method, request.patch), reference, random_);
    int last_of_group = -1;
    spare_.clear();
    for (int i = 0; i < request.rows; ++i) {
      int group = method.paired() ? 0 : -1;
      if (method.group_freedom() > 0) group = i / request.rows_per_group;
      if (group >= opened_groups(request.set)) open_group(request, set, last_of_group);
      if (progress_ && i % kLanes == 0)
        progress_("drawing configurations", static_cast<double>(data_.rows.set.size()) /
                                                static_cast<double>(data_.rows.q.rows()));
      if (!append(request, i, group, last_of_group)) {
        sampled_.unreached = "set " + set.name + ": only " + std::to_string(i) + " of " +
                             std::to_string(request.rows) +
                             " configurations within the joint limits were found";
        return;
      }
    }
  }

  int opened_groups(int set) const {
    return data_.sets[set].method->group_freedom() > 0
               ? static_cast<int>(sampled_.truth.groups[set].cols())
               : static_cast<int>(data_.sets[set].groups.size());
  }

  void open_group(const SampleRequest& request, Set& set, int& last_of_group) {
    const Method& method = *set.method;
    if (opened_groups(request.set) >= static_cast<int>(set.groups.size()))
      set.groups.push_back("g" + std::to_string(set.groups.size()));
    last_of_group = -1;
    spare_.clear();
    if (method.group_freedom() == 0) return;
    Eigen::MatrixXd& groups = sampled_.truth.groups[request.set];
    const auto place = static_cast<std::size_t>(groups.cols());
    const bool given = place < request.places.size();
    Eigen::VectorXd values =
        method.start_group({given ? request.places[place] : anywhere(method, request.patch)});
    for (const GroupDistance& link :
         method.links()) {  // a known distance from a group opened before
      const auto self = static_cast<int>(groups.cols());
      const int other = link.a == self ? link.b : link.b == self ? link.a : self;
      if (given || other >= self) continue;
      values.head<3>() = groups.col(other).head<3>() + link.distance * random_direction(random_);
    }
    groups.conservativeResize(values.size(), groups.cols() + 1);
    groups.rightCols(1) = values;
  }

  /// Finds and writes one row; false when none was reached.
  bool append(const SampleRequest& request, int i, int group, int& last_of_group) {
    const Method& method = *data_.sets[request.set].method;
    const int row = static_cast<int>(data_.rows.set.size());
    const auto equations = static_cast<Eigen::Index>(method.equations().size());
    const Eigen::VectorXd wanted =
        request.residual ? request.residual(i) : Eigen::VectorXd::Zero(equations);
    data_.rows.set.push_back(request.set);
    data_.rows.group.push_back(group);
    const int reference = data_.sets[request.set].reference;
    method.approach(sampled_.truth.nuisance[request.set],
                    reference < 0 ? nullptr : &sampled_.truth.nuisance[reference], data_.rows, row);
    const auto take = [&](const Eigen::ArrayXd& q, const Location& there) {
      data_.rows.q.row(row) = q.matrix().transpose();
      const Location before = last_of_group < 0 ? Location{} : at(last_of_group, method.body());
      method.measure(there, before, sampled_.truth.nuisance[request.set], data_.rows, row);
      last_of_group = row;
    };
    if (!spare_.empty()) {
      take(spare_.back().q, spare_.back().there);
      spare_.pop_back();
      return true;
    }
    for (int attempt = 0; attempt < request.tries; ++attempt) {
      ConfigurationBlock block = starts();
      Locations X;
      const bool must = method.constrains() && !(method.paired() && last_of_group < 0);
      const std::vector<int> found =
          must ? newton(method, wanted, row, last_of_group, request.held, block, X)
               : everywhere(method, block, X);
      bool taken = false;
      for (const int lane : found) {
        if (!within_limits(robot_, block.q.row(lane).transpose()) ||
            !request.patch.contains(X.p(lane)) ||
            (!request.held.empty() && taken_before(block.q.row(lane), row)))
          continue;
        if (taken) {
          spare_.push_back({block.q.row(lane), X.at(lane)});
          continue;
        }
        take(block.q.row(lane), X.at(lane));
        if (!request.together) return true;
        taken = true;
      }
      if (taken) return true;
    }
    data_.rows.set.pop_back();
    data_.rows.group.pop_back();
    return false;
  }

  /// Whether a row before `row` of its group has the same configuration.
  bool taken_before(const Eigen::ArrayXd& q, int row) const {
    const Observations& d = data_.rows;
    for (int i = row - 1; i >= 0 && d.set[i] == d.set[row] && d.group[i] == d.group[row]; --i)
      if (((d.q.row(i).transpose().array() - q) / units_).abs().maxCoeff() < kSame) return true;
    return false;
  }

  std::vector<int> everywhere(const Method& method, const ConfigurationBlock& block, Locations& X) {
    const Closure closure = robot_.locate(block, xi_, method.body(), X, nullptr);
    std::vector<int> lanes;
    for (int lane = 0; lane < kLanes; ++lane)
      if (closure.closes(lane)) lanes.push_back(lane);
    return lanes;
  }

  Location at(int row, Body body) const {
    return locate(robot_, xi_, data_.rows.q.row(row).transpose(), body);
  }

  /// Lanes that reached the wanted residual; moves block.q there and leaves their locations in X.
  std::vector<int> newton(const Method& method, const Eigen::VectorXd& wanted, int row,
                          int previous, const std::vector<int>& held, ConfigurationBlock& block,
                          Locations& X) const {
    Locations before;
    if (previous >= 0) {
      const Location there = at(previous, method.body());
      before.rotation.rowwise() = there.R.reshaped().transpose().array();
      before.position.rowwise() = there.p.transpose().array();
    }
    NewtonStep newton(robot_, data_, sampled_.truth, {row}, before, held);
    std::vector<int> reached = newton.reach(wanted, kEnough, block);
    X = newton.X();
    return reached;
  }

  const Robot& robot_;
  const Eigen::VectorXd& xi_;
  Random& random_;
  DataSet& data_;
  const Eigen::ArrayXd units_ = units_of_readings(robot_);
  const Progress& progress_;
  Sampled sampled_;
  std::vector<std::pair<int, double>> locked_;  ///< joints and their readings, of the request
  struct Found {
    Eigen::ArrayXd q;
    Location there;
  };
  std::vector<Found> spare_;  ///< solved together with the last row, for the next ones
};

}  // namespace

Sampled sample_rows(const Robot& robot, const Eigen::VectorXd& xi,
                    const std::vector<SampleRequest>& requests, Random& random, DataSet& data,
                    const Progress& progress) {
  return Sampler(robot, xi, random, data, progress).run(requests);
}

void measure_rows(const Robot& robot, const State& truth, const std::vector<int>& rows,
                  DataSet& data) {
  make_columns(data);
  Locations X;
  Location before;
  for (std::size_t first = 0; first < rows.size();) {
    const int set = data.rows.set[rows[first]];
    const Method& method = *data.sets[set].method;
    ConfigurationBlock block{Eigen::ArrayXXd(kLanes, data.rows.q.cols()), 0};
    while (block.count < kLanes && first + block.count < rows.size() &&
           data.rows.set[rows[first + block.count]] == set)
      ++block.count;
    for (int lane = 0; lane < kLanes; ++lane)
      block.q.row(lane) = data.rows.q.row(rows[first + std::min(lane, block.count - 1)]).array();
    robot.locate(block, truth.xi, method.body(), X, nullptr);
    for (int lane = 0; lane < block.count; ++lane) {
      method.measure(X.at(lane), before, truth.nuisance[set], data.rows, rows[first + lane]);
      before = X.at(lane);
    }
    first += block.count;
  }
}

}  // namespace selfcal
