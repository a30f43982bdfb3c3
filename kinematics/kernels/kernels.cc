// Compiled once for each width: foreach_target.h includes this file again and again.
#include "kinematics/kernels/kernels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kinematics/kernels/kernels.cc"
#include <hwy/foreach_target.h>
// After it, and in this order.
#include <hwy/highway.h>
//
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace selfcal::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Wide = hn::CappedTag<double, kMultiple>;

void sine_cosine(const double* angle, size_t count, double* sine, double* cosine) {
  const Wide d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto x = hn::LoadU(d, angle + i);
    hn::StoreU(hn::Sin(d, x), d, sine + i);
    hn::StoreU(hn::Cos(d, x), d, cosine + i);
  }
}

void add_products(const LaneProduct* products, size_t terms, size_t lanes, size_t count,
                  size_t stride, double* out, size_t out_stride) {
  const Wide d;
  for (size_t k = 0; k < count; ++k)
    for (size_t i = 0; i < lanes; i += hn::Lanes(d)) {
      double* at = out + k * out_stride + i;
      auto sum = hn::LoadU(d, at);
      for (size_t t = 0; t < terms; ++t)
        sum = hn::MulAdd(hn::LoadU(d, products[t].factor + i),
                         hn::LoadU(d, products[t].columns + k * stride + i), sum);
      hn::StoreU(sum, d, at);
    }
}

/// Reflects columns k … k + 3 of [R; A] by [first; a], whose square is -2 / scale.
void reflect_four(const double* a, double first, double scale, size_t rows, double* const R[4],
                  double* const A[4]) {
  const Wide d;
  auto s0 = hn::Zero(d), s1 = hn::Zero(d), s2 = hn::Zero(d), s3 = hn::Zero(d);
  for (size_t i = 0; i < rows; i += hn::Lanes(d)) {
    const auto v = hn::LoadU(d, a + i);
    s0 = hn::MulAdd(v, hn::LoadU(d, A[0] + i), s0);
    s1 = hn::MulAdd(v, hn::LoadU(d, A[1] + i), s1);
    s2 = hn::MulAdd(v, hn::LoadU(d, A[2] + i), s2);
    s3 = hn::MulAdd(v, hn::LoadU(d, A[3] + i), s3);
  }
  double w[4] = {hn::GetLane(hn::SumOfLanes(d, s0)), hn::GetLane(hn::SumOfLanes(d, s1)),
                 hn::GetLane(hn::SumOfLanes(d, s2)), hn::GetLane(hn::SumOfLanes(d, s3))};
  for (int k = 0; k < 4; ++k) {
    w[k] = scale * (w[k] + first * *R[k]);
    *R[k] -= w[k] * first;
  }
  const auto w0 = hn::Set(d, w[0]), w1 = hn::Set(d, w[1]), w2 = hn::Set(d, w[2]),
             w3 = hn::Set(d, w[3]);
  for (size_t i = 0; i < rows; i += hn::Lanes(d)) {
    const auto v = hn::LoadU(d, a + i);
    hn::StoreU(hn::NegMulAdd(v, w0, hn::LoadU(d, A[0] + i)), d, A[0] + i);
    hn::StoreU(hn::NegMulAdd(v, w1, hn::LoadU(d, A[1] + i)), d, A[1] + i);
    hn::StoreU(hn::NegMulAdd(v, w2, hn::LoadU(d, A[2] + i)), d, A[2] + i);
    hn::StoreU(hn::NegMulAdd(v, w3, hn::LoadU(d, A[3] + i)), d, A[3] + i);
  }
}

void reflect_one(const double* a, double first, double scale, size_t rows, double* R, double* A) {
  const Wide d;
  auto s = hn::Zero(d);
  for (size_t i = 0; i < rows; i += hn::Lanes(d))
    s = hn::MulAdd(hn::LoadU(d, a + i), hn::LoadU(d, A + i), s);
  const double w = scale * (hn::GetLane(hn::SumOfLanes(d, s)) + first * *R);
  *R -= w * first;
  const auto factor = hn::Set(d, w);
  for (size_t i = 0; i < rows; i += hn::Lanes(d))
    hn::StoreU(hn::NegMulAdd(hn::LoadU(d, a + i), factor, hn::LoadU(d, A + i)), d, A + i);
}

void append_rows(double* R, size_t columns, double* A, size_t rows, size_t stride) {
  const Wide d;
  for (size_t j = 0; j < columns; ++j) {
    const double* a = A + j * stride;
    auto squares = hn::Zero(d);
    for (size_t i = 0; i < rows; i += hn::Lanes(d)) {
      const auto v = hn::LoadU(d, a + i);
      squares = hn::MulAdd(v, v, squares);
    }
    const double below = hn::GetLane(hn::SumOfLanes(d, squares));
    // Columns that depend on each other leave what is left of what is left: beyond the normal
    // numbers the reflection would be infinite.
    if (below < std::numeric_limits<double>::min()) continue;
    double& diagonal = R[j * columns + j];
    const double reflected = -std::copysign(std::sqrt(diagonal * diagonal + below), diagonal);
    const double first = diagonal - reflected;
    const double scale = -1 / (reflected * first);
    diagonal = reflected;
    size_t k = j + 1;
    for (; k + 4 <= columns; k += 4) {
      double* const in_R[] = {R + k * columns + j, R + (k + 1) * columns + j,
                              R + (k + 2) * columns + j, R + (k + 3) * columns + j};
      double* const in_A[] = {A + k * stride, A + (k + 1) * stride, A + (k + 2) * stride,
                              A + (k + 3) * stride};
      reflect_four(a, first, scale, rows, in_R, in_A);
    }
    for (; k < columns; ++k)
      reflect_one(a, first, scale, rows, R + k * columns + j, A + k * stride);
  }
}

}  // namespace selfcal::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selfcal::kernels {

HWY_EXPORT(sine_cosine);
HWY_EXPORT(add_products);
HWY_EXPORT(append_rows);

void sine_cosine(const double* angle, size_t count, double* sine, double* cosine) {
  constexpr double kReduced = 3e4;  // rad, to which Highway's reduction of the argument is exact
  if (std::all_of(angle, angle + count, [](double x) { return std::abs(x) < kReduced; })) {
    HWY_DYNAMIC_DISPATCH(sine_cosine)(angle, count, sine, cosine);
    return;
  }
  for (size_t i = 0; i < count; ++i) {
    sine[i] = std::sin(angle[i]);
    cosine[i] = std::cos(angle[i]);
  }
}

void add_products(const LaneProduct* products, size_t terms, size_t lanes, size_t count,
                  size_t stride, double* out, size_t out_stride) {
  HWY_DYNAMIC_DISPATCH(add_products)(products, terms, lanes, count, stride, out, out_stride);
}

void append_rows(double* R, size_t columns, double* A, size_t rows, size_t stride) {
  HWY_DYNAMIC_DISPATCH(append_rows)(R, columns, A, rows, stride);
}

}  // namespace selfcal::kernels
#endif
