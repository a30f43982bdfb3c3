// Sums of products over lanes, products of columns, rows added to a triangular factor.
// Compiled once for each width: foreach_target.h includes this file again and again.
#include "kinematics/kernels/kernels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinematics/kernels/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kinematics/kernels/kernels_columns.cc"
#include <hwy/foreach_target.h>
// After it, and in this order.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace selfcal::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Wide = hn::CappedTag<double, kMultiple>;
using One = hn::CappedTag<double, 1>;

template <class D>
void products(D d, const LaneProduct* products, size_t terms, size_t lanes, size_t count,
              size_t stride, double* out, size_t out_stride) {
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

void add_products(const LaneProduct* list, size_t terms, size_t lanes, size_t count, size_t stride,
                  double* out, size_t out_stride) {
  if (lanes % kMultiple == 0)
    products(Wide(), list, terms, lanes, count, stride, out, out_stride);
  else
    products(One(), list, terms, lanes, count, stride, out, out_stride);
}

/// Adds the products of kA columns and kB of the same rows from row `from` on, every so many, to
/// their sums.
template <size_t kA, size_t kB, class V>
HWY_INLINE void accumulate(const double* const (&a)[kA], const double* const (&b)[kB], size_t from,
                           size_t rows, size_t every, V (&sums)[kA][kB]) {
  const Wide d;
  for (size_t i = from; i < rows; i += every) {
    V y[kB];
    for (size_t k = 0; k < kB; ++k) y[k] = hn::LoadU(d, b[k] + i);
    for (size_t n = 0; n < kA; ++n) {
      const V x = hn::LoadU(d, a[n] + i);
      for (size_t k = 0; k < kB; ++k) sums[n][k] = hn::MulAdd(x, y[k], sums[n][k]);
    }
  }
}

/// Adds the products of four columns and two of A to their sums, kMultiple numbers each.
void add_four_by_two(const double* const (&a)[4], const double* const (&b)[2], size_t rows,
                     double* const (&sums)[4][2]) {
  const Wide d;
  for (size_t part = 0; part < kMultiple; part += hn::Lanes(d)) {
    decltype(hn::Zero(d)) s[4][2];
    for (size_t n = 0; n < 4; ++n)
      for (size_t k = 0; k < 2; ++k) s[n][k] = hn::LoadU(d, sums[n][k] + part);
    accumulate(a, b, part, rows, kMultiple, s);
    for (size_t n = 0; n < 4; ++n)
      for (size_t k = 0; k < 2; ++k) hn::StoreU(s[n][k], d, sums[n][k] + part);
  }
}

void add_column_products(const double* A, size_t columns, size_t rows, size_t stride,
                         double* sums) {
  const size_t padded = padded_columns(columns);
  const auto column = [&](size_t k) { return A + std::min(k, columns - 1) * stride; };
  const auto sum = [&](size_t i, size_t j) { return sums + (j * padded + i) * kMultiple; };
  for (size_t i = 0; i < columns; i += 4)
    for (size_t j = 0; j < std::min(i + 4, columns); j += 2) {
      const double* const a[] = {column(i), column(i + 1), column(i + 2), column(i + 3)};
      const double* const b[] = {column(j), column(j + 1)};
      double* const of[4][2] = {{sum(i, j), sum(i, j + 1)},
                                {sum(i + 1, j), sum(i + 1, j + 1)},
                                {sum(i + 2, j), sum(i + 2, j + 1)},
                                {sum(i + 3, j), sum(i + 3, j + 1)}};
      add_four_by_two(a, b, rows, of);
    }
}

constexpr size_t kReflections = 4;  // that are applied to the columns after them at once

/// Reflections by v_i = [first_i; a_i], a_i columns of A that follow one another and first_i in the
/// row of R of that column: their product is I - V T V^T.
struct Reflections {
  size_t count = 0;
  const double* a[kReflections] = {};
  double first[kReflections] = {}, T[kReflections][kReflections] = {};
};

double product_of(const double* a, const double* b, size_t rows) {
  const Wide d;
  decltype(hn::Zero(d)) sum[1][1] = {{hn::Zero(d)}};
  accumulate<1, 1>({a}, {b}, 0, rows, hn::Lanes(d), sum);
  return hn::GetLane(hn::SumOfLanes(d, sum[0][0]));
}

/// The row of T of one more reflection, I - scale v v^T.
void add_reflection(double first, double scale, const double* a, size_t rows, Reflections& V) {
  double product[kReflections] = {};
  for (size_t l = 0; l < V.count; ++l) product[l] = product_of(V.a[l], a, rows);
  const size_t n = V.count++;
  V.a[n] = a;
  V.first[n] = first;
  V.T[n][n] = scale;
  for (size_t l = 0; l < n; ++l) {
    double sum = 0;
    for (size_t m = l; m < n; ++m) sum += V.T[l][m] * product[m];
    V.T[l][n] = -scale * sum;
  }
}

/// What the reflections take from a column, whose products with their a_i are `w`; its part in R is
/// finished.
void shares_of(const Reflections& V, double (&w)[kReflections], double* R) {
  for (size_t i = 0; i < V.count; ++i) w[i] += V.first[i] * R[i];
  for (size_t i = V.count; i-- > 0;) {
    double sum = 0;
    for (size_t l = 0; l <= i; ++l) sum += V.T[l][i] * w[l];
    w[i] = sum;
  }
  for (size_t i = 0; i < V.count; ++i) R[i] -= w[i] * V.first[i];
}

/// kCount reflections, all that V has, of kColumns columns.
template <size_t kCount, size_t kColumns>
void reflect(const Reflections& V, size_t rows, double* const (&R)[kColumns],
             double* const (&A)[kColumns]) {
  const Wide d;
  using Lane = decltype(hn::Zero(d));
  const double* v[kCount];
  double* a[kColumns];
  const double* read[kColumns];
  for (size_t n = 0; n < kCount; ++n) v[n] = V.a[n];
  for (size_t k = 0; k < kColumns; ++k) read[k] = a[k] = A[k];
  Lane sums[kCount][kColumns];
  for (size_t n = 0; n < kCount; ++n)
    for (size_t k = 0; k < kColumns; ++k) sums[n][k] = hn::Zero(d);
  accumulate(v, read, 0, rows, hn::Lanes(d), sums);
  Lane share[kCount][kColumns];
  for (size_t k = 0; k < kColumns; ++k) {
    double w[kReflections] = {};
    for (size_t n = 0; n < kCount; ++n) w[n] = hn::GetLane(hn::SumOfLanes(d, sums[n][k]));
    shares_of(V, w, R[k]);
    for (size_t n = 0; n < kCount; ++n) share[n][k] = hn::Set(d, w[n]);
  }
  for (size_t i = 0; i < rows; i += hn::Lanes(d)) {
    Lane x[kColumns];
    for (size_t k = 0; k < kColumns; ++k) x[k] = hn::LoadU(d, a[k] + i);
    for (size_t n = 0; n < kCount; ++n) {
      const Lane by = hn::LoadU(d, v[n] + i);
      for (size_t k = 0; k < kColumns; ++k) x[k] = hn::NegMulAdd(by, share[n][k], x[k]);
    }
    for (size_t k = 0; k < kColumns; ++k) hn::StoreU(x[k], d, a[k] + i);
  }
}

void append_rows(double* R, size_t columns, double* A, size_t rows, size_t stride) {
  for (size_t from = 0; from < columns; from += kReflections) {
    const size_t to = std::min(from + kReflections, columns);
    Reflections V;
    for (size_t j = from; j < to; ++j) {
      double* const a = A + j * stride;
      double first = 0, scale = 0;  // nothing is reflected
      const double below = product_of(a, a, rows);
      // Columns that depend on each other leave what is left of what is left: beyond the normal
      // numbers the reflection would be infinite.
      if (!(below < std::numeric_limits<double>::min())) {
        double& diagonal = R[j * columns + j];
        const double reflected = -std::copysign(std::sqrt(diagonal * diagonal + below), diagonal);
        first = diagonal - reflected;
        scale = -1 / (reflected * first);
        diagonal = reflected;
        Reflections one;
        add_reflection(first, scale, a, rows, one);
        for (size_t k = j + 1; k < to; ++k)
          reflect<1, 1>(one, rows, {R + k * columns + j}, {A + k * stride});
      }
      add_reflection(first, scale, a, rows, V);
    }
    // Columns are left only after a full panel.
    size_t k = to;
    for (; k + 2 <= columns; k += 2)
      reflect<kReflections, 2>(V, rows, {R + k * columns + from, R + (k + 1) * columns + from},
                               {A + k * stride, A + (k + 1) * stride});
    if (k < columns) reflect<kReflections, 1>(V, rows, {R + k * columns + from}, {A + k * stride});
  }
}

}  // namespace selfcal::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selfcal::kernels {

HWY_EXPORT(add_products);
HWY_EXPORT(add_column_products);
HWY_EXPORT(append_rows);

void add_products(const LaneProduct* products, size_t terms, size_t lanes, size_t count,
                  size_t stride, double* out, size_t out_stride) {
  HWY_DYNAMIC_DISPATCH(add_products)(products, terms, lanes, count, stride, out, out_stride);
}

void add_column_products(const double* A, size_t columns, size_t rows, size_t stride,
                         double* sums) {
  HWY_DYNAMIC_DISPATCH(add_column_products)(A, columns, rows, stride, sums);
}

void append_rows(double* R, size_t columns, double* A, size_t rows, size_t stride) {
  HWY_DYNAMIC_DISPATCH(append_rows)(R, columns, A, rows, stride);
}

}  // namespace selfcal::kernels
#endif
