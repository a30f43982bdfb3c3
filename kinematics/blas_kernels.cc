#include "kinematics/blas_kernels.h"

#include <cblas.h>

#include <cstdlib>
#include <string_view>

// What its constructor calls; a build of it for one processor alone has no such.
extern "C" [[gnu::weak]] void gotoblas_dynamic_quit();
extern "C" [[gnu::weak]] void gotoblas_dynamic_init();

namespace selfcal {
namespace {

/// As OpenBLAS calls them; nothing where its own choice stays.
const char* kernels_of_processor() {
#ifdef __x86_64__
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
    return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
  return nullptr;
}

}  // namespace

bool suit_blas_to_processor() {
  constexpr const char* kVariable = "OPENBLAS_CORETYPE";
  const char* better = kernels_of_processor();
  if (!better || !gotoblas_dynamic_quit || !gotoblas_dynamic_init || std::getenv(kVariable) ||
      std::string_view(openblas_get_corename()) != "Prescott")
    return false;
  setenv(kVariable, better, 0);
  gotoblas_dynamic_quit();
  gotoblas_dynamic_init();
  unsetenv(kVariable);
  return true;
}

}  // namespace selfcal
