// The kernels with which OpenBLAS multiplies.
#pragma once

namespace selfcal {

/// Takes those that the processor can run. OpenBLAS goes by the processor's model, and where that
/// is younger than itself by what every x86-64 has (Prescott, 2004), at a quarter of the speed.
/// What its OPENBLAS_CORETYPE asks for stays. Returns whether it took others. For a program's main,
/// before any thread: a library leaves the process that loads it as it is.
bool suit_blas_to_processor();

}  // namespace selfcal
