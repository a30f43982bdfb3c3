// Compiled once for each width: foreach_target.h includes this file again and again.
#include "kinematics/kernels/kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

// Frames and arrows below are structs of vectors, which those without a size cannot be in.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#endif

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

/// A vector of a chain, and a frame of it, some lanes at once.
template <class V>
struct Arrow {
  V x, y, z;
};
template <class V>
struct Axes {
  Arrow<V> x, y, z, p;
};

template <class V>
Arrow<V> turned(V c, const Arrow<V>& u, V s, const Arrow<V>& v) {
  return {hn::MulAdd(c, u.x, hn::Mul(s, v.x)), hn::MulAdd(c, u.y, hn::Mul(s, v.y)),
          hn::MulAdd(c, u.z, hn::Mul(s, v.z))};
}
template <class V>
Arrow<V> turned_back(V c, const Arrow<V>& u, V s, const Arrow<V>& v) {
  return {hn::NegMulAdd(s, v.x, hn::Mul(c, u.x)), hn::NegMulAdd(s, v.y, hn::Mul(c, u.y)),
          hn::NegMulAdd(s, v.z, hn::Mul(c, u.z))};
}
template <class V>
Arrow<V> advanced(const Arrow<V>& p, V length, const Arrow<V>& axis) {
  return {hn::MulAdd(length, axis.x, p.x), hn::MulAdd(length, axis.y, p.y),
          hn::MulAdd(length, axis.z, p.z)};
}
/// The vector with coordinates w[0 … 2] in the axes of `frame`.
template <class D, class V>
Arrow<V> in_axes(D d, const Axes<V>& frame, const double* w) {
  const V a = hn::Set(d, w[0]), b = hn::Set(d, w[1]), c = hn::Set(d, w[2]);
  const auto sum = [&](V x, V y, V z) { return hn::MulAdd(c, z, hn::MulAdd(b, y, hn::Mul(a, x))); };
  return {sum(frame.x.x, frame.y.x, frame.z.x), sum(frame.x.y, frame.y.y, frame.z.y),
          sum(frame.x.z, frame.y.z, frame.z.z)};
}

/// Three numbers a lane, the next of which is `lanes` further on.
template <class D, class V>
void store(D d, const Arrow<V>& a, double* at, size_t lanes) {
  hn::StoreU(a.x, d, at);
  hn::StoreU(a.y, d, at + lanes);
  hn::StoreU(a.z, d, at + 2 * lanes);
}
template <class D>
auto load(D d, const double* at, size_t lanes) {
  return Arrow<decltype(hn::Zero(d))>{hn::LoadU(d, at), hn::LoadU(d, at + lanes),
                                      hn::LoadU(d, at + 2 * lanes)};
}

/// One column of Psi: of a shift along an axis; of a turn about an axis through a point, which
/// stands where the shift of the body follows once that is known.
template <class D, class V>
void shift_column(D d, const Arrow<V>& axis, double* column, size_t lanes) {
  store(d, axis, column, lanes);
  store(d, Arrow<V>{hn::Zero(d), hn::Zero(d), hn::Zero(d)}, column + 3 * lanes, lanes);
}
template <class D, class V>
void turn_column(D d, const Arrow<V>& axis, const Arrow<V>& point, double* column, size_t lanes) {
  store(d, point, column, lanes);
  store(d, axis, column + 3 * lanes, lanes);
}
template <class D, class V>
void finish_turn(D d, const Arrow<V>& end, double* column, size_t lanes) {
  const Arrow<V> o = load(d, column, lanes), a = load(d, column + 3 * lanes, lanes);
  const V x = hn::Sub(end.x, o.x), y = hn::Sub(end.y, o.y), z = hn::Sub(end.z, o.z);
  store(d,
        Arrow<V>{hn::NegMulAdd(a.z, y, hn::Mul(a.y, z)), hn::NegMulAdd(a.x, z, hn::Mul(a.z, x)),
                 hn::NegMulAdd(a.y, x, hn::Mul(a.x, y))},
        column, lanes);
}

template <class D, class V>
void step_numbers(D d, const ChainFrame& f, size_t lane, size_t lanes, Axes<V>& at,
                  double* columns) {
  const auto c = [d](double value) { return hn::Set(d, value); };
  const size_t next = 6 * lanes;
  if (columns) turn_column(d, at.y, at.p, columns + 4 * next, lanes);  // beta
  const Arrow<V> x = turned_back(c(f.cos_beta), at.x, c(f.sin_beta), at.z);
  const Arrow<V> z = turned(c(f.sin_beta), at.x, c(f.cos_beta), at.z);
  if (columns) {
    turn_column(d, x, at.p, columns, lanes);    // alpha
    shift_column(d, x, columns + next, lanes);  // d
  }
  const Arrow<V> y = turned(c(f.cos_alpha), at.y, c(f.sin_alpha), z);
  at.z = turned_back(c(f.cos_alpha), z, c(f.sin_alpha), at.y);
  at.p = advanced(at.p, c(f.d), x);
  if (columns) {
    turn_column(d, at.z, at.p, columns + 2 * next, lanes);  // theta
    shift_column(d, at.z, columns + 3 * next, lanes);       // r
  }
  const V cosine = f.lanes_turn ? hn::LoadU(d, f.cosine + lane) : c(*f.cosine);
  const V sine = f.lanes_turn ? hn::LoadU(d, f.sine + lane) : c(*f.sine);
  at.x = turned(cosine, x, sine, y);
  at.y = turned_back(cosine, y, sine, x);
  V length = c(f.r);
  if (f.slide) length = hn::Add(length, hn::LoadU(d, f.slide + lane));
  at.p = advanced(at.p, length, at.z);
}

template <class D, class V>
void step_pose(D d, const ChainFrame& f, size_t lanes, Axes<V>& at, double* columns) {
  at.p = advanced(at.p, hn::Set(d, 1), in_axes(d, at, f.pose));
  if (columns) {
    const Arrow<V>* const axes[] = {&at.x, &at.y, &at.z};
    for (size_t i = 0; i < 3; ++i) {
      shift_column(d, *axes[i], columns + i * 6 * lanes, lanes);
      turn_column(d, in_axes(d, at, f.pose + 12 + 3 * i), at.p, columns + (3 + i) * 6 * lanes,
                  lanes);
    }
  }
  at = {in_axes(d, at, f.pose + 3), in_axes(d, at, f.pose + 6), in_axes(d, at, f.pose + 9), at.p};
}

template <class D>
void chain(D d, const ChainFrame* frames, size_t count, size_t lanes, double* rotation,
           double* position, double* psi) {
  for (size_t lane = 0; lane < lanes; lane += hn::Lanes(d)) {
    const auto one = hn::Set(d, 1), zero = hn::Zero(d);
    Axes<decltype(hn::Zero(d))> at{
        {one, zero, zero}, {zero, one, zero}, {zero, zero, one}, {zero, zero, zero}};
    for (size_t i = 0; i < count; ++i) {
      double* const columns = psi ? psi + frames[i].column * 6 * lanes + lane : nullptr;
      if (frames[i].whole)
        step_pose(d, frames[i], lanes, at, columns);
      else
        step_numbers(d, frames[i], lane, lanes, at, columns);
    }
    store(d, at.x, rotation + lane, lanes);
    store(d, at.y, rotation + 3 * lanes + lane, lanes);
    store(d, at.z, rotation + 6 * lanes + lane, lanes);
    store(d, at.p, position + lane, lanes);
    for (size_t i = 0; psi && i < count; ++i)
      for (const size_t turn :
           frames[i].whole ? std::array<size_t, 3>{3, 4, 5} : std::array<size_t, 3>{0, 2, 4})
        finish_turn(d, at.p, psi + (frames[i].column + turn) * 6 * lanes + lane, lanes);
  }
}

void follow_chain(const ChainFrame* frames, size_t count, size_t lanes, double* rotation,
                  double* position, double* psi) {
  if (lanes % kMultiple == 0)
    chain(Wide(), frames, count, lanes, rotation, position, psi);
  else
    chain(One(), frames, count, lanes, rotation, position, psi);
}

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

/// Adds the products of four columns and two of A to their sums, kMultiple numbers each.
void add_four_by_two(const double* const a[4], const double* const b[2], size_t rows,
                     double* const sums[4][2]) {
  const Wide d;
  for (size_t part = 0; part < kMultiple; part += hn::Lanes(d)) {
    auto s00 = hn::LoadU(d, sums[0][0] + part), s01 = hn::LoadU(d, sums[0][1] + part);
    auto s10 = hn::LoadU(d, sums[1][0] + part), s11 = hn::LoadU(d, sums[1][1] + part);
    auto s20 = hn::LoadU(d, sums[2][0] + part), s21 = hn::LoadU(d, sums[2][1] + part);
    auto s30 = hn::LoadU(d, sums[3][0] + part), s31 = hn::LoadU(d, sums[3][1] + part);
    for (size_t i = part; i < rows; i += kMultiple) {
      const auto b0 = hn::LoadU(d, b[0] + i), b1 = hn::LoadU(d, b[1] + i);
      const auto a0 = hn::LoadU(d, a[0] + i), a1 = hn::LoadU(d, a[1] + i);
      s00 = hn::MulAdd(a0, b0, s00);
      s01 = hn::MulAdd(a0, b1, s01);
      s10 = hn::MulAdd(a1, b0, s10);
      s11 = hn::MulAdd(a1, b1, s11);
      const auto a2 = hn::LoadU(d, a[2] + i), a3 = hn::LoadU(d, a[3] + i);
      s20 = hn::MulAdd(a2, b0, s20);
      s21 = hn::MulAdd(a2, b1, s21);
      s30 = hn::MulAdd(a3, b0, s30);
      s31 = hn::MulAdd(a3, b1, s31);
    }
    hn::StoreU(s00, d, sums[0][0] + part);
    hn::StoreU(s01, d, sums[0][1] + part);
    hn::StoreU(s10, d, sums[1][0] + part);
    hn::StoreU(s11, d, sums[1][1] + part);
    hn::StoreU(s20, d, sums[2][0] + part);
    hn::StoreU(s21, d, sums[2][1] + part);
    hn::StoreU(s30, d, sums[3][0] + part);
    hn::StoreU(s31, d, sums[3][1] + part);
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

/// The row of T of one more reflection, I - scale v v^T.
void add_reflection(double first, double scale, const double* a, size_t rows, Reflections& V) {
  const Wide d;
  double product[kReflections] = {};
  for (size_t l = 0; l < V.count; ++l) {
    auto sum = hn::Zero(d);
    for (size_t i = 0; i < rows; i += hn::Lanes(d))
      sum = hn::MulAdd(hn::LoadU(d, V.a[l] + i), hn::LoadU(d, a + i), sum);
    product[l] = hn::GetLane(hn::SumOfLanes(d, sum));
  }
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

/// Four reflections of two columns.
void reflect_two(const Reflections& V, size_t rows, double* R0, double* R1, double* A0,
                 double* A1) {
  const Wide d;
  const double *const a0 = V.a[0], *const a1 = V.a[1], *const a2 = V.a[2], *const a3 = V.a[3];
  auto s00 = hn::Zero(d), s10 = s00, s20 = s00, s30 = s00;
  auto s01 = s00, s11 = s00, s21 = s00, s31 = s00;
  for (size_t i = 0; i < rows; i += hn::Lanes(d)) {
    const auto x = hn::LoadU(d, A0 + i), y = hn::LoadU(d, A1 + i);
    const auto v0 = hn::LoadU(d, a0 + i), v1 = hn::LoadU(d, a1 + i);
    s00 = hn::MulAdd(v0, x, s00);
    s01 = hn::MulAdd(v0, y, s01);
    s10 = hn::MulAdd(v1, x, s10);
    s11 = hn::MulAdd(v1, y, s11);
    const auto v2 = hn::LoadU(d, a2 + i), v3 = hn::LoadU(d, a3 + i);
    s20 = hn::MulAdd(v2, x, s20);
    s21 = hn::MulAdd(v2, y, s21);
    s30 = hn::MulAdd(v3, x, s30);
    s31 = hn::MulAdd(v3, y, s31);
  }
  const auto sum = [d](auto v) { return hn::GetLane(hn::SumOfLanes(d, v)); };
  double w0[] = {sum(s00), sum(s10), sum(s20), sum(s30)};
  double w1[] = {sum(s01), sum(s11), sum(s21), sum(s31)};
  shares_of(V, w0, R0);
  shares_of(V, w1, R1);
  const auto w00 = hn::Set(d, w0[0]), w10 = hn::Set(d, w0[1]), w20 = hn::Set(d, w0[2]),
             w30 = hn::Set(d, w0[3]);
  const auto w01 = hn::Set(d, w1[0]), w11 = hn::Set(d, w1[1]), w21 = hn::Set(d, w1[2]),
             w31 = hn::Set(d, w1[3]);
  for (size_t i = 0; i < rows; i += hn::Lanes(d)) {
    auto x = hn::LoadU(d, A0 + i), y = hn::LoadU(d, A1 + i);
    const auto v0 = hn::LoadU(d, a0 + i), v1 = hn::LoadU(d, a1 + i);
    x = hn::NegMulAdd(v1, w10, hn::NegMulAdd(v0, w00, x));
    y = hn::NegMulAdd(v1, w11, hn::NegMulAdd(v0, w01, y));
    const auto v2 = hn::LoadU(d, a2 + i), v3 = hn::LoadU(d, a3 + i);
    hn::StoreU(hn::NegMulAdd(v3, w30, hn::NegMulAdd(v2, w20, x)), d, A0 + i);
    hn::StoreU(hn::NegMulAdd(v3, w31, hn::NegMulAdd(v2, w21, y)), d, A1 + i);
  }
}

/// Any count of reflections, the last of them or all, of one column.
void reflect_one(const Reflections& V, size_t rows, double* R, double* A) {
  const Wide d;
  double w[kReflections] = {};
  for (size_t n = 0; n < V.count; ++n) {
    auto sum = hn::Zero(d);
    for (size_t i = 0; i < rows; i += hn::Lanes(d))
      sum = hn::MulAdd(hn::LoadU(d, V.a[n] + i), hn::LoadU(d, A + i), sum);
    w[n] = hn::GetLane(hn::SumOfLanes(d, sum));
  }
  shares_of(V, w, R);
  for (size_t n = 0; n < V.count; ++n) {
    const auto share = hn::Set(d, w[n]);
    for (size_t i = 0; i < rows; i += hn::Lanes(d))
      hn::StoreU(hn::NegMulAdd(hn::LoadU(d, V.a[n] + i), share, hn::LoadU(d, A + i)), d, A + i);
  }
}

double sum_of_squares(const double* a, size_t rows) {
  const Wide d;
  auto squares = hn::Zero(d);
  for (size_t i = 0; i < rows; i += hn::Lanes(d)) {
    const auto v = hn::LoadU(d, a + i);
    squares = hn::MulAdd(v, v, squares);
  }
  return hn::GetLane(hn::SumOfLanes(d, squares));
}

void append_rows(double* R, size_t columns, double* A, size_t rows, size_t stride) {
  for (size_t from = 0; from < columns; from += kReflections) {
    const size_t to = std::min(from + kReflections, columns);
    Reflections V;
    for (size_t j = from; j < to; ++j) {
      double* const a = A + j * stride;
      double first = 0, scale = 0;  // nothing is reflected
      const double below = sum_of_squares(a, rows);
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
          reflect_one(one, rows, R + k * columns + j, A + k * stride);
      }
      add_reflection(first, scale, a, rows, V);
    }
    size_t k = to;
    for (; V.count == kReflections && k + 2 <= columns; k += 2)
      reflect_two(V, rows, R + k * columns + from, R + (k + 1) * columns + from, A + k * stride,
                  A + (k + 1) * stride);
    for (; k < columns; ++k) reflect_one(V, rows, R + k * columns + from, A + k * stride);
  }
}

}  // namespace selfcal::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selfcal::kernels {

HWY_EXPORT(sine_cosine);
HWY_EXPORT(follow_chain);
HWY_EXPORT(add_products);
HWY_EXPORT(add_column_products);
HWY_EXPORT(append_rows);

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

void follow_chain(const ChainFrame* frames, size_t count, size_t lanes, double* rotation,
                  double* position, double* psi) {
  HWY_DYNAMIC_DISPATCH(follow_chain)(frames, count, lanes, rotation, position, psi);
}

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
