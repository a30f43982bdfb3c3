// What the equations are told and what they say: state, weights and noise of the rows; residuals,
// linearised and normal equations; the order of the rows.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "constraints/methods/method.h"
#include "kinematics/parameter.h"

namespace selfcal {

/// What is estimated: the robot's parameters, each set's own values, each set's group values
/// (one column a group).
struct State {
  Eigen::VectorXd xi;
  std::vector<Eigen::VectorXd> nuisance;
  std::vector<Eigen::MatrixXd> groups;
};

/// 1 sigma of one scalar residual of a set, by quantity (m, rad).
struct Scale {
  double length = 1, angle = 1;
  double of(Quantity quantity) const { return quantity == Quantity::angle ? angle : length; }
};

/// The scalars of a residual: few in place, the further ones (of markers) beside them. There are as
/// many of it as rows.
class Scalars {
 public:
  Scalars() = default;
  Scalars(Scalars&&) noexcept = default;
  Scalars(const Scalars& other)
      : few_(other.few_), more_(other.more_ ? std::make_unique<More>(*other.more_) : nullptr) {}
  Scalars& operator=(Scalars other) noexcept {
    std::swap(few_, other.few_);
    std::swap(more_, other.more_);
    return *this;
  }

  double operator[](std::size_t i) const { return i < kFew ? few_[i] : (*more_)[i - kFew]; }
  void set(std::size_t i, double value) {
    if (i < kFew) {
      few_[i] = value;
      return;
    }
    if (!more_) more_ = std::make_unique<More>();
    if (more_->size() <= i - kFew) more_->resize(i - kFew + 1);
    (*more_)[i - kFew] = value;
  }

 private:
  using More = std::vector<double>;
  static constexpr std::size_t kFew = 3;
  std::array<double, kFew> few_{};
  std::unique_ptr<More> more_;
};

/// Residual of one row: the length of its length and angle parts and the scalars of each. Infinite
/// where the robot, as it is, cannot take the row's configuration.
struct RowResidual {
  int row = 0, set = 0;
  double length = 0, angle = 0;   ///< norms (m, rad)
  short lengths = 0, angles = 0;  ///< counts of scalars
  double factor = 1;              ///< of its noise over its set's
  Scalars scalars = {};           ///< lengths + angles entries, in the method's order
  /// Its length, or its angle where it has no lengths (m; rad).
  double size() const { return lengths > 0 ? length : angle; }
  /// Distance from zero in sigmas of the set's noise and the row's factor.
  double sigmas(const Scale& scale) const;
};

/// World (m): where the method's body is at a row, and its shortest way to where the row's lengths
/// would be met, to first order; zero of rows without lengths and of those it cannot take.
struct RowPlace {
  Eigen::Vector3d at = Eigen::Vector3d::Zero(), way = Eigen::Vector3d::Zero();
};

/// Weights of the rows.
struct Weighting {
  std::vector<Scale> scale;     ///< by set
  std::vector<char> outlier;    ///< by row of the data set; 1 weighs nothing
  double soft_quantile = 0.99;  ///< rows beyond this chi quantile are weighed down (Huber)
  bool structural = false;  ///< links and equations between nuisance parameters have a sigma of 1
  bool passed_over =
      false;  ///< rows that weigh nothing need not be looked at: their norms are zero
};

enum class Use { fit, check, align };

/// A row whose configuration the robot cannot take, as far as its maker's figures go: no equation.
struct OpenRow {
  int row = 0, set = 0;
  std::string why;
};

/// The factor of one cluster of groups: enough to get its unknowns back from the global step.
struct ClusterFactor {
  /// Local freedoms x [local | columns of the system | Delta Y], upper triangular in local; zero
  /// rows of those that the cluster's rows do not tell.
  Eigen::MatrixXd rows;
};

/// Lengths of a row's residual; infinite as RowResidual's.
struct RowNorm {
  double length = 0, angle = 0;  ///< m, rad
};

/// What linearise() and normal_equations() share.
struct Passed {
  double cost = 0;    ///< sum of the rows' Huber costs and of the squares of the own equations
  int equations = 0;  ///< scalars that took part
  std::vector<RowNorm> norms;  ///< of every row of the use, put aside or not, in the plans' order
  std::vector<ClusterFactor> clusters;
};

struct Linearised : Passed {
  Eigen::MatrixXd R;  ///< [W | Delta Y], whitened and weighed, square upper triangular
};

/// Sums of products in place of the factor.
struct NormalEquations : Passed {
  std::vector<int> columns;  ///< of W that take part: some of the robot's, all own ones; ascending
  Eigen::MatrixXd H;         ///< [W | Delta Y]^T [W | Delta Y]
};

/// Every equation of some rows, for data sets small enough to hold them: whitened, not weighed.
struct DenseEquations {
  Eigen::MatrixXd W;      ///< equations x [columns() | freedoms of the groups, set by set]
  Eigen::VectorXd y;      ///< Delta Y
  Eigen::MatrixXd shift;  ///< equations x 3, derivative to a shift of the world (1/sigma per m)
  std::vector<int> row;   ///< of the data set, by equation; -1 of an equation that no row carries
  std::vector<Quantity> quantity;  ///< by equation; a length where no row carries it
};

/// Rows of one set in the order of evaluation, and how its groups hang together.
struct SetPlan {
  struct Item {
    int row, previous;  ///< previous row of the group for paired methods, else -1
  };
  struct Cluster {
    int first, last;          ///< items, one past the end
    std::vector<int> groups;  ///< group indices; empty when the method has no group unknowns
    std::vector<GroupDistance> links;
    /// Position of `group` in groups, which are in ascending order.
    int place(int group) const {
      return static_cast<int>(std::lower_bound(groups.begin(), groups.end(), group) -
                              groups.begin());
    }
  };
  std::vector<Item> items;
  std::vector<Cluster> clusters;
};

}  // namespace selfcal
