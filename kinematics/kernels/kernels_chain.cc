// The frames of a chain with their derivatives.
// Compiled once for each width: foreach_target.h includes this file again and again.
#include "kinematics/kernels/kernels.h"

#include <array>

#include "kinematics/kernels/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kinematics/kernels/kernels_chain.cc"
#include <hwy/foreach_target.h>
// After it, and in this order.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace selfcal::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Wide = hn::CappedTag<double, kMultiple>;
using One = hn::CappedTag<double, 1>;

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

}  // namespace selfcal::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selfcal::kernels {

HWY_EXPORT(follow_chain);

void follow_chain(const ChainFrame* frames, size_t count, size_t lanes, double* rotation,
                  double* position, double* psi) {
  HWY_DYNAMIC_DISPATCH(follow_chain)(frames, count, lanes, rotation, position, psi);
}

}  // namespace selfcal::kernels
#endif
