// The inner loop of an identification takes nothing from the heap: as many rows as you like cost as
// many allocations as few.
#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>

#include "tests/contracts/arm.h"
#include "tests/contracts/path_case.h"

// Sanitizers have a heap of their own.
#if !defined(__SANITIZE_ADDRESS__)

namespace {
thread_local long allocations = 0;
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);  // NOLINT(bugprone-reserved-identifier): glibc's own
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
}

namespace selfcal {
namespace {

long taken_by_a_pass(const MethodCase& each, int rows) {
  const PathCase made(six_axis_arm(), each, rows);
  const Equations equations(*made.robot, made.data, Use::fit);
  std::vector<int> all(static_cast<size_t>(equations.columns()));
  std::iota(all.begin(), all.end(), 0);
  const long before = allocations;
  const NormalEquations at = equations.normal_equations(made.state, made.weighting, all);
  const long taken = allocations - before;
  EXPECT_GT(at.equations, 0);
  return taken;
}

TEST(InnerLoop, TakesNothingFromTheHeapForARow) {
  for (const MethodCase& each : method_cases()) {
    SCOPED_TRACE(each.sets);
    const PathCase made(six_axis_arm(), each, 8);
    const bool grouped = made.data.sets[0].method->group_freedom() > 0;  // their factors are kept
    if (!made.answers() || grouped || made.data.sets[0].method->shares_touches()) continue;
    const long few = taken_by_a_pass(each, 128);
    EXPECT_GT(few, 0);  // the counter counts
    EXPECT_EQ(taken_by_a_pass(each, 1024), few);
  }
}

}  // namespace
}  // namespace selfcal

#endif
