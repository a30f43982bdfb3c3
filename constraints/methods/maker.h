// What a method's maker gets: the set's entry in the file and the names of its groups so far.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "constraints/methods/method.h"
#include "kinematics/description.h"

namespace selfcal {

struct SetEntry {
  std::string name;
  Fields& fields;  ///< `method`, `noise` and `noise_angle` are read elsewhere
  Problems& problems;
  std::vector<std::string>& groups;  ///< names that the options bring up are appended
};

using MethodPtr = std::unique_ptr<const Method>;

/// Index of group `name`, appended when new.
int group_index(std::vector<std::string>& groups, const std::string& name);

/// True when `key: unknown` is given; another text is a problem.
bool read_unknown(Fields& fields, std::string_view key);

/// `distance` (m) between two loci and its `noise` (1 sigma, m).
struct Apart {
  double distance = 0, noise = 0;
};
Apart read_apart(Fields& fields);

/// Unit vector of `key`, or nothing when the key is missing; a zero vector is a problem.
std::optional<Eigen::Vector3d> read_direction(Fields& fields, std::string_view key);

/// An angle within half a turn of zero.
inline double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

/// Writes G = d(a . body position + ...) for one equation: components 0 to 2 linear, 3 to 5
/// angular.
template <class Block>
void set_linear(Block& G, int lane, int equation, const Eigen::Vector3d& a) {
  G.row(lane).template segment<3>(6 * equation) = a.transpose();
}
template <class Block>
void set_angular(Block& G, int lane, int equation, const Eigen::Vector3d& a) {
  G.row(lane).template segment<3>(6 * equation + 3) = a.transpose();
}

}  // namespace selfcal
