// What rows have in common that share structure of no known cause.
#pragma once

#include <string>

namespace selfcal {

/// What close means.
enum class KernelDomain {
  same = 1,    ///< only repeats: anything that a configuration brings along, at every visit
  joints = 2,  ///< similar joint readings
  place = 3,   ///< near each other in the cell
  time = 4,    ///< soon after each other, as the tool sees it
  turned = 5,  ///< one joint is off by a smooth function of one or two readings
  base = 6,    ///< soon after each other, as if the base moved
  kinked = 7,  ///< one joint is off by a function of its reading with steps and kinks
  load = 8,    ///< one joint gives way to its load differently at each of its readings
  warmth = 9,  ///< one joint is off by a function of its reading that grows with the warmth
};

/// Structure of no known cause, as rows show it.
struct UnknownStructure {
  KernelDomain domain;
  std::string joint = {};  ///< whose errors they are; empty where no joint's or no single one's
};

/// How such rows err, as a sentence.
inline std::string in_words(const UnknownStructure& structure) {
  const std::string joint = structure.joint.empty() ? "one joint" : "joint " + structure.joint;
  switch (structure.domain) {
    case KernelDomain::same:
      return "the repeats of a configuration err alike, and no other rows with them";
    case KernelDomain::joints:
      return "rows with like joint readings err alike";
    case KernelDomain::place:
      return "rows near each other in the cell err alike";
    case KernelDomain::time:
      return "rows soon after each other err alike, as the tool sees it";
    case KernelDomain::base:
      return "rows soon after each other err alike, as if the base or the instrument moved";
    case KernelDomain::turned:
      return "rows err as if the reading of " + joint + " were off";
    case KernelDomain::kinked:
      return "rows err as if the reading of " + joint +
             " were off by something that steps or bends at some of its readings";
    case KernelDomain::load:
      return "rows err as if " + joint +
             " gave way to its load differently at each of its readings";
    case KernelDomain::warmth:
      return "rows err as if an error of " + joint + " grew with the temperature";
  }
  return {};
}

}  // namespace selfcal
