// Sines and cosines.
// Compiled once for each width: foreach_target.h includes this file again and again.
#include "kinematics/kernels/kernels.h"

#include <algorithm>
#include <cmath>

#include "kinematics/kernels/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kinematics/kernels/kernels.cc"
#include <hwy/foreach_target.h>
// After it, and in this order.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace selfcal::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Wide = hn::CappedTag<double, kMultiple>;
using One = hn::CappedTag<double, 1>;

/// Sine and cosine of `x`, less than 3e4: what is left of the nearest quarter turn, taken off in
/// three parts (Cody and Waite), then the polynomials of fdlibm.
template <class D, class V>
void sine_and_cosine(D d, V x, V& sine, V& cosine) {
  const hn::RebindToUnsigned<D> bits;
  const auto c = [d](double value) { return hn::Set(d, value); };
  const auto shifted = hn::MulAdd(x, c(0.63661977236758134308), c(6755399441055744.0));
  const auto turns = hn::Sub(shifted, c(6755399441055744.0));  // 1.5 2^52 leaves a whole number
  auto r = hn::NegMulAdd(turns, c(1.57079632673412561417), x);
  r = hn::NegMulAdd(turns, c(6.07710050630396597660e-11), r);
  r = hn::NegMulAdd(turns, c(2.02226624879595063154e-21), r);
  const auto z = hn::Mul(r, r);
  auto s = hn::MulAdd(z, c(1.58969099521155010221e-10), c(-2.50507602534068634195e-08));
  s = hn::MulAdd(z, s, c(2.75573137070700676789e-06));
  s = hn::MulAdd(z, s, c(-1.98412698298579493134e-04));
  s = hn::MulAdd(z, s, c(8.33333333332248946124e-03));
  s = hn::MulAdd(z, s, c(-1.66666666666666324348e-01));
  s = hn::MulAdd(hn::Mul(z, r), s, r);
  auto k = hn::MulAdd(z, c(-1.13596475577881948265e-11), c(2.08757232129817482790e-09));
  k = hn::MulAdd(z, k, c(-2.75573143513906633035e-07));
  k = hn::MulAdd(z, k, c(2.48015872894767294178e-05));
  k = hn::MulAdd(z, k, c(-1.38888888888741095749e-03));
  k = hn::MulAdd(z, k, c(4.16666666666666019037e-02));
  k = hn::MulAdd(hn::Mul(z, z), k, hn::NegMulAdd(z, c(0.5), c(1)));
  // The last bit of the quarter turns swaps the two, the one before it turns their signs.
  const auto quarters = hn::BitCast(bits, shifted);
  const auto odd = hn::BitCast(
      d, hn::Sub(hn::Zero(bits), hn::And(quarters, hn::Set(bits, 1))));  // all bits or none
  const auto sign = hn::Set(bits, 0x8000000000000000U);
  const auto of_sine = hn::And(hn::ShiftLeft<62>(quarters), sign);
  const auto of_cosine = hn::And(hn::ShiftLeft<62>(hn::Add(quarters, hn::Set(bits, 1))), sign);
  sine = hn::Xor(hn::IfVecThenElse(odd, k, s), hn::BitCast(d, of_sine));
  cosine = hn::Xor(hn::IfVecThenElse(odd, s, k), hn::BitCast(d, of_cosine));
}

template <class D>
void sines_and_cosines(D d, const double* angle, size_t count, double* sine, double* cosine) {
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    auto s = hn::Zero(d), c = hn::Zero(d);
    sine_and_cosine(d, hn::LoadU(d, angle + i), s, c);
    hn::StoreU(s, d, sine + i);
    hn::StoreU(c, d, cosine + i);
  }
}

void sine_cosine(const double* angle, size_t count, double* sine, double* cosine) {
  const size_t wide = count / kMultiple * kMultiple;
  sines_and_cosines(Wide(), angle, wide, sine, cosine);
  sines_and_cosines(One(), angle + wide, count - wide, sine + wide, cosine + wide);
}

}  // namespace selfcal::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selfcal::kernels {

HWY_EXPORT(sine_cosine);

void sine_cosine(const double* angle, size_t count, double* sine, double* cosine) {
  constexpr double kReduced = 3e4;  // rad, to which the reduction of the argument is exact
  if (std::all_of(angle, angle + count, [](double x) { return std::abs(x) < kReduced; })) {
    HWY_DYNAMIC_DISPATCH(sine_cosine)(angle, count, sine, cosine);
    return;
  }
  for (size_t i = 0; i < count; ++i) {
    sine[i] = std::sin(angle[i]);
    cosine[i] = std::cos(angle[i]);
  }
}

}  // namespace selfcal::kernels
#endif
