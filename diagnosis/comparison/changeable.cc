#include "diagnosis/comparison/changeable.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "constraints/identifiability/gauge.h"
#include "diagnosis/constants.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

/// What is usual of a length (m), an angle (rad) or a ratio.
EffectParameter usual_parameter(const Robot& robot, const std::string& name, std::string unit) {
  const double size = unit == "m" ? size_of(robot) : 1;
  return {name, std::move(unit), size * kDiagnosis.comparison.usual_least,
          size * kDiagnosis.comparison.usual_most, 0};
}

/// Of a freedom of what a set measures: "turn", "shift".
std::string word_of(Quantity quantity) {
  return quantity == Quantity::angle ? "turn" : quantity == Quantity::length ? "shift" : "ratio";
}

class Builder {
 public:
  Builder(const Equations& equations, const Eigen::MatrixXd& W, Between between)
      : robot_(equations.robot()), equations_(equations), W_(W), between_(between) {}

  void add_zeros() {
    for (size_t j = 0; j < robot_.joints().size(); ++j)
      add_own("zero_shift", robot_.joints()[j].name,
              {robot_.variable_parameter(static_cast<int>(j))});
  }

  void add_frames(Part part, const char* effect, const char* at) {
    std::vector<int> frames;
    for (size_t p = 0; p < robot_.parameters().size(); ++p)
      if (robot_.parameters()[p].part == part) frames.push_back(static_cast<int>(p));
    if (!frames.empty()) add_own(placing(effect), at, frames);
  }

  void add_fixtures(const DataSet& before, const DataSet& after) {
    for (size_t s = 0; s < before.sets.size(); ++s) {
      const int set = static_cast<int>(s), freedoms = equations_.tangent_dimension(set);
      if (freedoms == 0 || same_set(after.sets, before.sets[s]) < 0) continue;
      std::vector<int> nuisance;
      std::vector<EffectParameter> parameters;
      std::map<Quantity, int> of_kind;
      for (int k = 0; k < freedoms; ++k) {
        nuisance.push_back(equations_.own_at(set) + k);
        const Quantity quantity = before.sets[s].method->tangent_quantity(k);
        const std::string number = std::to_string(++of_kind[quantity]);
        parameters.push_back(usual_parameter(robot_, word_of(quantity) + number,
                                             std::string(selfcal::unit(quantity))));
      }
      add(fixture_moved(between_), before.sets[s].name, nuisance, std::move(parameters));
    }
  }

  /// One of those that look alike (the lengths of parallel axes) stands for all; a zero does first.
  void add_geometry() {
    std::vector<int> had;
    for (size_t j = 0; j < robot_.joints().size(); ++j)
      had.push_back(robot_.variable_parameter(static_cast<int>(j)));
    for (int p = 0; p < static_cast<int>(robot_.parameters().size()); ++p) {
      const Part part = robot_.parameters()[p].part;
      if ((part != Part::link && part != Part::gear) ||
          std::ranges::any_of(had, [&](int other) { return alike(p, other); }))
        continue;
      had.push_back(p);
      add_own("geometry_differs", robot_.parameters()[p].name, {p});
    }
  }

  Changeable done() {
    std::vector<Candidate>& list = all_.candidates.list;
    for (Candidate& each : list) {
      const auto family = std::ranges::count(list, each.effect, &Candidate::effect);
      each.log_prior = -std::log(static_cast<double>(family));
    }
    return std::move(all_);
  }

 private:
  /// What the robot stands on, holds and meets stands elsewhere in a simulator: that has not moved.
  std::string placing(const char* effect) const {
    return between_ == Between::machines ? "placed_elsewhere" : effect;
  }

  /// Of parameters of the robot.
  void add_own(const std::string& effect, const std::string& at, const std::vector<int>& columns) {
    std::vector<EffectParameter> parameters;
    for (const int c : columns)
      parameters.push_back(usual_parameter(robot_, robot_.parameters()[c].name,
                                           std::string(robot_.parameters()[c].unit())));
    add(effect, at, columns, std::move(parameters));
  }

  void add(const std::string& effect, const std::string& at, const std::vector<int>& columns,
           std::vector<EffectParameter> parameters) {
    Candidate candidate{.effect = effect, .at = at};
    for (size_t k = 0; k < columns.size(); ++k) {
      candidate.main.push_back(static_cast<int>(all_.columns.size()));
      all_.columns.push_back(columns[k]);
      all_.parameters.push_back(std::move(parameters[k]));
    }
    all_.candidates.list.push_back(std::move(candidate));
  }

  bool alike(int a, int b) const {
    return a == b || std::abs(W_.col(a).dot(W_.col(b))) >=
                         kDiagnosis.comparison.alike * W_.col(a).norm() * W_.col(b).norm();
  }

  const Robot& robot_;
  const Equations& equations_;
  const Eigen::MatrixXd& W_;
  const Between between_;
  Changeable all_;
};

}  // namespace

std::string fixture_moved(Between between) {
  return between == Between::machines ? "placed_elsewhere" : "fixture_shift";
}

Changeable changeable(const Equations& equations, const Eigen::MatrixXd& W, const DataSet& before,
                      const DataSet& after, Between between) {
  Builder builder(equations, W, between);
  builder.add_zeros();
  if (held_base(equations.robot(), equations).empty())
    builder.add_frames(Part::base, "base_moved", "base");
  builder.add_frames(Part::tool, "probe_changed", "probe");
  builder.add_fixtures(before, after);
  if (between == Between::machines) builder.add_geometry();
  return builder.done();
}

}  // namespace selfcal
