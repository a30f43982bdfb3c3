// Parts of a sum on several threads: each once, in their order, with the same last bit.
#include "constraints/equations/in_order.h"

#include <gtest/gtest.h>

#include <cmath>

namespace selfcal {
namespace {

constexpr int kParts = 500;

TEST(InOrder, TakesEachPartOnceInItsOrderHoweverManyAreMadeAtOnce) {
  const auto sum = [](int at_once) {
    double total = 0;
    int next = 0;
    in_order(
        kParts, at_once,
        [](int i) {
          double part = 0;  // parts of different lengths overtake each other
          for (int k = 0; k < 1 + i * 7919 % 3000; ++k) part += std::sin(i + 0.1 * k);
          return part;
        },
        [&](int i, double part) {
          EXPECT_EQ(i, next++);
          total += part;
        });
    EXPECT_EQ(next, kParts);
    return total;
  };
  const double alone = sum(1);
  for (const int at_once : {2, 3, 8, 2 * kParts}) EXPECT_EQ(sum(at_once), alone) << at_once;
}

TEST(InOrder, DoesNothingOfNoParts) {
  in_order(
      0, 4, [](int i) { return i; }, [](int, int) { FAIL(); });
}

}  // namespace
}  // namespace selfcal
