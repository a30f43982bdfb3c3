// Compiled once for each width: foreach_target.h includes this file again and again.
#include "tests/bench/peak.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/bench/peak.cc"
#include <hwy/foreach_target.h>
// After it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace selfcal::bench::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

double multiply_and_add(int rounds, double& result) {
  const hn::CappedTag<double, 8> d;
  const auto factor = hn::Set(d, 0.999999), term = hn::Set(d, 1e-9);
  auto a = hn::Set(d, 1.0), b = hn::Set(d, 1.1), c = hn::Set(d, 1.2), e = hn::Set(d, 1.3),
       f = hn::Set(d, 1.4), g = hn::Set(d, 1.5), h = hn::Set(d, 1.6), i = hn::Set(d, 1.7),
       j = hn::Set(d, 1.8), k = hn::Set(d, 1.9);
  for (int round = 0; round < rounds; ++round) {
    a = hn::MulAdd(a, factor, term);
    b = hn::MulAdd(b, factor, term);
    c = hn::MulAdd(c, factor, term);
    e = hn::MulAdd(e, factor, term);
    f = hn::MulAdd(f, factor, term);
    g = hn::MulAdd(g, factor, term);
    h = hn::MulAdd(h, factor, term);
    i = hn::MulAdd(i, factor, term);
    j = hn::MulAdd(j, factor, term);
    k = hn::MulAdd(k, factor, term);
  }
  const auto all = hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, e)),
                           hn::Add(hn::Add(f, g), hn::Add(hn::Add(h, i), hn::Add(j, k))));
  result = hn::GetLane(hn::SumOfLanes(d, all));
  return 2.0 * 10 * rounds * static_cast<double>(hn::Lanes(d));
}

}  // namespace selfcal::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selfcal::bench {

HWY_EXPORT(multiply_and_add);

double multiply_and_add(int rounds, double& sum) {
  return HWY_DYNAMIC_DISPATCH(multiply_and_add)(rounds, sum);
}

}  // namespace selfcal::bench
#endif
