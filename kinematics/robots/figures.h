// The figures of a robot file that gives a machine's parameters part by part, with what may stand
// beside those of a part: `tolerance` and `nominal`, mappings from the figures' names to numbers.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string>
#include <vector>

#include "kinematics/description.h"
#include "kinematics/parameter.h"

namespace selfcal {

inline constexpr double kOwnTolerance = 2.0e-3;  ///< m or rad, where the file is silent

struct PartFigures {
  explicit PartFigures(int count)
      : value(Eigen::VectorXd::Zero(count)),
        nominal(value),
        tolerance(Eigen::VectorXd::Constant(count, -1)) {}

  Eigen::VectorXd value, nominal;  ///< m, rad, 1
  Eigen::VectorXd tolerance;       ///< negative where the file is silent
};

/// A number of the file by the place that it has among the figures.
struct Named {
  std::string name;
  int at;
};

/// Reads `tolerance` and `nominal` of a part whose values are there already.
void read_beside(Fields& of, const std::vector<Named>& names, Problems& problems,
                 PartFigures& figures);
/// Adds them to the part's mapping; false when there is nothing to add.
bool write_beside(const PartFigures& figures, const std::vector<Named>& names, Node& into);

/// The lowest and the highest reading (m) of a drive, its `limits`; nothing where the file is
/// silent.
std::optional<Eigen::Vector2d> read_travel(Fields& drive);

/// Value, nominal and tolerance (`silent` where the file gives none) of the figure at `at`.
void take_figures(const PartFigures& figures, int at, double silent, Parameter& p);

}  // namespace selfcal
