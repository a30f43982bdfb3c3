// The widths that the kernels are compiled for.
#pragma once

// Frames and arrows are structs of vectors, which those without a size cannot be in.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#endif
