// What the sources of the equations share; nobody else includes this.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "constraints/equations/column_products.h"
#include "constraints/equations/equations.h"
#include "constraints/equations/in_order.h"
#include "constraints/equations/streaming_qr.h"

namespace selfcal {

inline constexpr int kMotions = 6;  ///< columns of the world's motions

/// Everything about up to kLanes rows of one set.
struct Equations::Block {
  ConfigurationBlock now, before;
  Locations X_now, X_before, X_axes;
  Closure closure;  ///< of a lane that it leaves open all else is zero
  PsiBlock psi_now, psi_before, psi_axes;
  MethodOutput out;
  MethodOutput::Block G_axes;  ///< as G, to the axes of vectors; without columns: there are none
  const Eigen::MatrixXd* independent = nullptr;  ///< by lane, of sets with noise_joints
  MethodOutput::Block
      factor;  ///< root of the weight over sigma of each equation; one unless weighed
  std::array<int, kLanes> rows;
  int count = 0;
};

/// Columns of the rows of a set.
struct Equations::Layout {
  struct Run {
    int from = 0, to = 0, count = 0;  ///< `count` columns of Psi from `from` on stand from `to` on
  };
  std::vector<Run> robot;
  /// First columns of what is its own, of the set referred to, of the world's motions and of its
  /// known lengths; -1 of what is not there.
  int own = -1, reference = -1, motions = -1, known = -1;
  int lone = 0;             ///< so many first columns no other set has
  std::vector<int> global;  ///< by column, its place in the system; the last is Delta Y
  int width() const { return static_cast<int>(global.size()); }
};

/// What one pass over all rows is for.
struct Equations::Pass {
  const State& state;
  const Weighting& weighting;
  std::vector<int> robot;  ///< columns of parameters that take part, ascending
  bool beside = false, products = false;
  const GeodesicStep* bend = nullptr;
  int width = 0;  ///< of the whole system, Delta Y too
};

/// Where the rows of a set end: in a factor or in sums of products.
class Equations::Rows {
 public:
  Rows(int width, bool products) {
    if (products)
      products_.emplace(width);
    else
      factor_.emplace(width);
  }
  void push(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
    if (products_)
      products_->push(rows);
    else
      factor_->push(rows);
  }
  /// A block's rows, of which the first `count` of kLanes for each equation say something.
  void push_block(const Eigen::MatrixXd& W, int count) {
    if (products_) return products_->add(W);
    for (Eigen::Index at = 0; at < W.rows(); at += kLanes) push(W.middleRows(at, count));
  }
  /// All that was pushed is in the result, which alone is kept of the products.
  void finish() {
    result_ = products_ ? products_->sum() : factor_->rows();
    products_.reset();
  }
  const Eigen::MatrixXd& rows() const { return result_; }
  const Eigen::MatrixXd& products() const { return result_; }

 private:
  std::optional<StreamingQr> factor_;
  std::optional<ColumnProducts> products_;
  Eigen::MatrixXd result_;
};

/// Parts that are worth going through at once where there are so many rows.
inline int parts_at_once(std::size_t rows) {
  constexpr std::size_t kRowsOfAThread = 4096;  // some milliseconds; to begin one takes a tenth
  return static_cast<int>(
      std::clamp<std::size_t>(rows / kRowsOfAThread, 1, static_cast<std::size_t>(processors())));
}

/// States a little ahead and behind along a step, and in between.
struct Equations::GeodesicStep {
  static constexpr double kPart = 0.1;  ///< of the step
  State ahead, middle, behind;
};

}  // namespace selfcal
