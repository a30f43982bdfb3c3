// What rows have in common that share structure of no known cause.
#pragma once

#include <string_view>

namespace selfcal {

/// What close means.
enum class KernelDomain {
  same = 1,    ///< only repeats: anything that a configuration brings along, at every visit
  joints = 2,  ///< similar joint readings
  place = 3,   ///< near each other in the cell
  time = 4,    ///< soon after each other, as the tool sees it
  turned = 5,  ///< one joint is off by a smooth function of one or two readings
  base = 6,    ///< soon after each other, as if the base moved
};

/// How such rows err, as a sentence.
constexpr std::string_view in_words(KernelDomain domain) {
  switch (domain) {
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
      return "rows err as if the reading of one joint were off";
  }
  return "";
}

}  // namespace selfcal
