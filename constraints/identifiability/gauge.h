// What the rows can never see: the scale of touches, the place of the base, how the tool is
// turned, the target's point.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/solution.h"

namespace selfcal {

/// Parameters that are held before anything is estimated, with the reason: the base frames when
/// every set is measured by a device whose own frame is unknown.
std::vector<Note> held_base(const Robot& robot, const Equations& equations);

/// The same of how a tool is turned that is a whole pose, when no row sees an orientation: where it
/// is says it all then.
std::vector<Note> held_orientation(const Robot& robot, const Equations& equations);

/// True when a row tells how the endpoint is turned.
bool orientation_is_seen(const Equations& equations);

/// Index of the link length to hold because the rows leave the scale free, if they do: the scale is
/// known worse than the maker's tolerance tells it. Judged on whitened R; `free` are the free
/// parameters.
std::optional<int> held_scale(const Equations& equations, const Eigen::MatrixXd& R,
                              const Eigen::VectorXd& xi, const std::vector<char>& free);

/// Joints that slide read lengths, and so have a part of the scale.
bool has_slides(const Robot& robot);

/// What is said of the length that is held for it.
std::string why_scale_is_held(const Robot& robot);

/// Independent combinations (columns, 6 x k) of the world's motions that the rows do not see, own
/// unknowns being unknown; orthonormal with shifts over the robot's size. R is whitened, with the
/// six motion columns before its last.
Eigen::MatrixXd unseen_motions(const Equations& equations, const Eigen::MatrixXd& R);

/// True when no row tells where the tool's point is: every set measures an unknown one, or angles.
bool point_is_unknown(const Equations& equations);

}  // namespace selfcal
