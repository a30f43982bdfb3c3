// What this core can do at most, of the width that the kernels run at.
#pragma once

namespace selfcal::bench {

/// Multiplies and adds `rounds` times in as many registers as hide the latency; how many floating
/// point operations that were. The `sum` of the registers is there to be used.
double multiply_and_add(int rounds, double& sum);

}  // namespace selfcal::bench
