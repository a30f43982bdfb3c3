// A geometric parameter: what it is called, where it acts, what its maker says of it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace selfcal {

enum class Quantity { length, angle, ratio, other };

/// "m", "rad" or "1"; a quantity of another kind has its own (see Parameter::unit).
std::string_view unit(Quantity quantity);

/// Which part of the machine a parameter belongs to. `base` and `tool` are the fixed frames before
/// the first and after the last moving joint; `gear` are transmission ratios; `effect` are those of
/// non-geometric effects (kinematics/effect.h); all else is `link`.
enum class Part { base, link, tool, gear, effect };

struct Parameter {
  std::string name;   ///< "theta2", "K3"
  std::string frame;  ///< "j2"
  std::string field;  ///< "theta", "gear": FRAME.FIELD is accepted wherever the name is
  Quantity quantity = Quantity::length;
  Part part = Part::link;
  double value = 0;             ///< in the model as read (SI)
  double nominal = 0;           ///< centre of the prior: the maker's figure
  double tolerance = 0;         ///< 1 sigma of the prior
  bool free = true;             ///< gear ratios are held unless their tolerance is given
  bool link_length = false;     ///< a nonzero length of the moving links: carries the scale
  bool of_whole_pose = false;   ///< of a frame that its file gives as a whole pose
  std::string other_unit = {};  ///< of a quantity of another kind

  std::string_view unit() const {
    return quantity == Quantity::other ? std::string_view(other_unit) : selfcal::unit(quantity);
  }
};

/// True for parameters of the links and gears, which the maker gives tolerances for.
inline bool is_own(const Parameter& p) { return p.part == Part::link || p.part == Part::gear; }

}  // namespace selfcal
