// Loops over lanes and columns of doubles, of the width that the processor has.
#pragma once

#include <cstddef>

namespace selfcal::kernels {

/// Counts of rows and lanes are multiples of it, whatever the width is.
inline constexpr std::size_t kMultiple = 8;

/// Sine and cosine of `count` angles (rad), within two units in the last place of 1. `count` is a
/// multiple of kMultiple.
void sine_cosine(const double* angle, std::size_t count, double* sine, double* cosine);

/// One product of add_products: a factor a lane, and the columns that it multiplies, the first of
/// which is at `columns`.
struct LaneProduct {
  const double* factor = nullptr;
  const double* columns = nullptr;
};

/// out[k, lane] += sum over the products of factor[lane] columns[k, lane], for `count` columns k of
/// `lanes` numbers each, the next of which is `stride` (of what is multiplied) or `out_stride`
/// numbers further on. `lanes` is a multiple of kMultiple.
void add_products(const LaneProduct* products, std::size_t terms, std::size_t lanes,
                  std::size_t count, std::size_t stride, double* out, std::size_t out_stride);

/// R of [R; A] by Householder reflections (Golub and Van Loan 5.2), R upper triangular before and
/// after, `columns` x `columns`, by columns; A of `rows` rows (a multiple of kMultiple), by columns
/// that begin `stride` numbers apart, is lost. The diagonal of a column that A has no part of (or
/// of less than 1e-154) stays as it is.
void append_rows(double* R, std::size_t columns, double* A, std::size_t rows, std::size_t stride);

}  // namespace selfcal::kernels
