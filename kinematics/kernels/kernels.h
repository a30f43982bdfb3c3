// Loops over lanes and columns of doubles, of the width that the processor has.
#pragma once

#include <cstddef>

namespace selfcal::kernels {

/// Counts of rows and lanes are multiples of it, whatever the width is.
inline constexpr std::size_t kMultiple = 8;

/// Sine and cosine of `count` angles (rad), within two units in the last place of 1.
void sine_cosine(const double* angle, std::size_t count, double* sine, double* cosine);

/// One frame of a serial chain, placed in the one before it, and the first of its columns of Psi:
/// of alpha, d, theta, r and beta, or of the three shifts and three turns of a whole pose.
struct ChainFrame {
  bool whole = false;
  std::size_t column = 0;
  /// Rot(y, beta) Rot(x, alpha) Trans(x, d) Rot(z, theta) Trans(z, r + slide); theta and slide may
  /// differ from lane to lane (slide: null for none).
  double cos_beta = 1, sin_beta = 0, cos_alpha = 1, sin_alpha = 0, d = 0, r = 0;
  bool lanes_turn = false;  ///< cosine and sine of theta are a lane each, otherwise one for all
  const double *cosine = nullptr, *sine = nullptr, *slide = nullptr;
  /// Of a whole pose: shift, columns of its rotation, axes that its turns are about, all in the
  /// axes of the frame before.
  double pose[21] = {};
};

/// Goes along `count` frames from the world: rotation (nine numbers, column by column) and origin
/// of the last, and unless `psi` is null its columns, six numbers each. Of every number there are
/// `lanes`, one or a multiple of kMultiple.
void follow_chain(const ChainFrame* frames, std::size_t count, std::size_t lanes, double* rotation,
                  double* position, double* psi);

/// One product of add_products: a factor a lane, and the columns that it multiplies, the first of
/// which is at `columns`.
struct LaneProduct {
  const double* factor = nullptr;
  const double* columns = nullptr;
};

/// out[k, lane] += sum over the products of factor[lane] columns[k, lane], for `count` columns k of
/// `lanes` numbers each, the next of which is `stride` (of what is multiplied) or `out_stride`
/// numbers further on. `lanes` is one or a multiple of kMultiple.
void add_products(const LaneProduct* products, std::size_t terms, std::size_t lanes,
                  std::size_t count, std::size_t stride, double* out, std::size_t out_stride);

/// Columns that add_column_products keeps sums for, of `columns`.
inline constexpr std::size_t padded_columns(std::size_t columns) { return (columns + 3) / 4 * 4; }

/// Adds products of the columns of A to `sums`, of padded_columns() squared times kMultiple
/// numbers: a_i . a_j, i >= j, is the sum of the kMultiple numbers from (j padded + i) kMultiple
/// on. The others mean nothing. A has `rows` rows (a multiple of kMultiple), by columns that begin
/// `stride` numbers apart.
void add_column_products(const double* A, std::size_t columns, std::size_t rows, std::size_t stride,
                         double* sums);

/// R of [R; A] by Householder reflections (Golub and Van Loan 5.2), R upper triangular before and
/// after, `columns` x `columns`, by columns; A of `rows` rows (a multiple of kMultiple), by columns
/// that begin `stride` numbers apart, is lost. The diagonal of a column that A has no part of (or
/// of less than 1e-154) stays as it is.
void append_rows(double* R, std::size_t columns, double* A, std::size_t rows, std::size_t stride);

}  // namespace selfcal::kernels
