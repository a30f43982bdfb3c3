// The system of equations that a data set gives: from rows and a state to R of [W | Delta Y].
//
// Columns of the system: every parameter of the robot, then the own freedoms of each set, then (on
// demand, beside the unknowns) the six motions of the world and the known lengths, then Delta Y.
// The unknowns of a group of rows (a shared point) are eliminated as its rows pass by Householder
// reflections on the group's columns, so that the system stays small however many groups there are.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "constraints/equations/equation_results.h"
#include "constraints/methods/data_set.h"
#include "kinematics/robot.h"

namespace selfcal {

class SharedTouches;

/// The equations of the rows of one use. `fit`: rows that identify. `align`: `check` rows of the
/// sets and groups that have no `fit` rows. `check`: all rows that judge.
class Equations {
 public:
  Equations(const Robot& robot, const DataSet& data, Use use);

  const Robot& robot() const { return robot_; }
  const DataSet& data() const { return data_; }
  const SetPlan& plan(int set) const { return plans_[set]; }
  /// 1 sigma of a residual of the set as its data sheet says, 0 where it does not; with
  /// noise_joints, what that adds up to on the rows here.
  const Scale& stated(int set) const { return stated_[set]; }
  /// Rows of the use that are left out.
  const std::vector<OpenRow>& open_rows() const { return open_rows_; }
  /// Whether the robot can take the configurations of up to kLanes rows with parameters `xi`.
  Closure closure_at(const std::vector<int>& rows, Body body, const Eigen::VectorXd& xi) const;

  int robot_columns() const { return static_cast<int>(robot_.parameters().size()); }
  int nuisance_columns() const { return nuisance_end_ - robot_columns(); }
  /// First column of the own freedoms of `set`, and their count (0 for a set without rows here).
  int own_at(int set) const { return nuisance_at_[set]; }
  int tangent_dimension(int set) const { return nuisance_count_[set]; }
  /// What a change of nuisance column `column` is measured by: the robot's size where it is a
  /// length, else 1.
  double nuisance_unit(int column) const { return nuisance_unit_[column - robot_columns()]; }
  /// Columns before Delta Y, without those beside the unknowns.
  int columns() const { return nuisance_end_; }
  /// Lengths that the entries of sets with rows here give (Method::known_lengths), and the place of
  /// the first one of `set` among their columns.
  int known_lengths() const { return known_end_; }
  int known_at(int set) const { return known_at_[set]; }
  int group_freedoms(int set) const;
  /// Freedoms of all nuisance parameters, those of groups included.
  int nuisance_dimensions() const;

  /// Own and group values that fit the rows best with parameters xi; other entries of `state` stay.
  void start(State& state) const;

  /// `beside`: with the columns beside the unknowns. That of a known length is what the rows say
  /// when the length were shorter than its entry says, over their sigma.
  Linearised linearise(const State& state, const Weighting& weighting, bool beside = false) const;
  /// The same as sums of products, of W's `columns` alone (as NormalEquations has them): several
  /// times as fast, and right to rounding of the squares of the columns' lengths, which hides what
  /// is left of columns that nearly depend on each other.
  NormalEquations normal_equations(const State& state, const Weighting& weighting,
                                   const std::vector<int>& columns) const;
  /// W^T (-r_vv) at `state`, r_vv the second derivative of the rows along `step` (which gives the
  /// unweighed rows' second difference over a tenth of the step); `at` is the linearisation at
  /// `state`.
  Eigen::VectorXd geodesic_acceleration(const State& state, const Weighting& weighting,
                                        const NormalEquations& at,
                                        const Eigen::VectorXd& step) const;
  std::vector<RowResidual> residuals(const State& state) const;
  /// Of the same rows, in the same order, those whose numbers in the data set `every` divides.
  std::vector<RowPlace> places(const State& state, int every = 1) const;
  /// The lengths of the same, in the same order.
  std::vector<RowNorm> norms(const State& state) const;
  /// `scale` by set. Rows that are put aside in `outlier` (by row of the data set) are left out.
  DenseEquations dense(const State& state, const std::vector<Scale>& scale,
                       const std::vector<char>& outlier) const;

  /// The state after a step of the global columns (columns() entries).
  State stepped(const State& state, const Linearised& at, const Eigen::VectorXd& step) const;
  State stepped(const State& state, const NormalEquations& at, const Eigen::VectorXd& step) const;

 private:
  struct Block;
  struct GeodesicStep;
  struct Layout;
  struct Pass;
  struct Swept;
  /// Items of a set that are gone through together: always the same ones.
  struct Part {
    int set, first, last;
    std::size_t cluster;  ///< that its first item is of
  };
  class Gatherer;
  class Rows;

  std::size_t items_of_all() const;
  void make_parts(int set);
  void make_plan(int set, Use use);
  /// An item that the robot cannot take with its maker's figures.
  struct OpenItem {
    SetPlan::Item item;
    std::string why;
  };
  /// Takes such out of `items`.
  std::vector<OpenItem> take_open(int set, std::vector<SetPlan::Item>& items) const;
  void evaluate(int set, int first, int count, const State& state, Block& block,
                bool jacobian) const;
  /// Finds what makes the equations of each row of a set with noise_joints independent.
  void propagate_readings(int set);
  /// Makes those of a block so.
  void make_independent(int set, int first, Block& block) const;
  void add_norms(int set, const Block& block, std::vector<RowNorm>& norms) const;
  void add_residuals(int set, const Block& block, std::vector<RowResidual>& list) const;
  /// Takes the vectors of a method that has such in the axes of the first moving link.
  void into_axes(Block& block) const;
  /// Where the rows of `set` have their columns, in the order of the whole system.
  Layout whole_layout(int set, bool beside) const;
  /// The same in few columns: those that rows of this set have, first those that no others have.
  Layout layout(int set, const Pass& pass) const;
  void chain_rule(const Block& block, int set, const Layout& layout, Eigen::MatrixXd& W) const;
  /// Writes the columns beside the unknowns.
  void beside_unknowns(const Block& block, int set, const Layout& layout, Eigen::MatrixXd& W) const;
  /// Divides what a block says by its noise and multiplies it by the root of its weight.
  void weigh(int set, const Weighting& weighting, Block& block, Passed& out) const;
  /// Makes rows of differences that share a touch independent.
  void share(int set, int first, int count, SharedTouches& shared, Eigen::MatrixXd& W,
             Passed& out) const;
  void gather(int set, const SetPlan::Cluster& cluster, int lane, const Block& block,
              const Eigen::MatrixXd& W, Gatherer& gatherer) const;
  /// Writes the derivatives of a link's residual over `sigma` to its groups, whose columns begin at
  /// `at_a` and `at_b`, and returns it.
  double link_row(int set, const GroupDistance& link, double sigma, const State& state,
                  Eigen::Index at_a, Eigen::Index at_b,
                  Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> row) const;
  void gather_links(int set, const SetPlan::Cluster& cluster, const Pass& pass,
                    const Layout& layout, Gatherer& gatherer, Passed& out) const;
  Eigen::MatrixXd own_equations(int set, const Pass& pass, const Layout& layout, Passed& out) const;
  bool weighs_nothing(int set, int first, int count, const Weighting& weighting) const;
  /// The rows of a part go through `rows`, in the columns of `layout`.
  void sweep_part(const Part& part, const Pass& pass, const Layout& layout, Rows& rows,
                  Passed& out) const;
  /// All parts, several at a time; `take` has what became of one, in their order.
  template <class Take>
  void sweep(const Pass& pass, const std::vector<Layout>& layouts, Passed& out,
             const Take& take) const;
  std::vector<Layout> layouts(const Pass& pass) const;
  /// Evaluates the blocks of all parts without derivatives; `of` makes entries of each.
  template <class Entry, class Of>
  std::vector<Entry> of_every_block(const State& state, const Of& of) const;
  void bend_right_side(int set, int first, int count, const GeodesicStep& geodesic_acceleration,
                       Block& block) const;
  NormalEquations sum_products(const Pass& pass, const std::vector<int>& columns) const;
  State stepped(const State& state, const std::vector<ClusterFactor>& clusters,
                const Eigen::VectorXd& step, const Eigen::VectorXd& of_columns) const;

  const Robot& robot_;
  const DataSet& data_;
  bool conditions_matter_ = false;  ///< the robot has effects, which ask for them
  std::vector<SetPlan> plans_;
  std::vector<Part> parts_;
  std::vector<Scale> stated_;
  /// By set and item, to multiply the residuals with; empty of sets without noise_joints.
  std::vector<std::vector<Eigen::MatrixXd>> independent_;
  std::vector<std::vector<Quantity>> quantities_;  ///< by set, of its equations
  std::vector<char> shared_;                       ///< by set: another one refers to it
  std::vector<OpenRow> open_rows_;
  std::vector<int> nuisance_at_, nuisance_count_, known_at_;
  std::vector<double> nuisance_unit_;  ///< by nuisance column
  int nuisance_end_ = 0, known_end_ = 0;
};

}  // namespace selfcal
