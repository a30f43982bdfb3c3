// Random numbers by purpose: more noise must not move the configurations, nor a repeat the robot.
#pragma once

#include <random>

#include "constraints/methods/method.h"

namespace selfcal {

enum class Draw : unsigned {
  errors,
  own_values,
  configurations,
  repeats,
  noise,
  false_rows,
  check,
  readings
};

/// The stream of one purpose; equal for equal seeds.
inline Random stream(int seed, Draw draw) {
  std::seed_seq sequence{static_cast<unsigned>(seed), static_cast<unsigned>(draw)};
  return Random(sequence);
}

}  // namespace selfcal
