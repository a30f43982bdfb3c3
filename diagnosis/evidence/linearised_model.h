// The rows of a diagnosis as its algebra sees them: linearised where geometry alone fits best,
// whitened by the noise as known so far, without the rows that are false.
#pragma once

#include <memory>
#include <vector>

#include "constraints/equations/resolution.h"
#include "constraints/equations/rows_before.h"
#include "constraints/estimation/adjustment.h"
#include "diagnosis/evidence/candidates.h"
#include "diagnosis/evidence/joint_kernels.h"
#include "diagnosis/evidence/whitened.h"

namespace selfcal {

struct DiagnosisOptions;

/// How the geometry is fitted wherever a gap is looked for.
Options geometry_options(const DiagnosisOptions& options);

/// Parameter that each joint's reading is added to, by joint.
std::vector<int> reading_columns(const Robot& robot);

class LinearisedModel {
 public:
  /// Fits the geometry and linearises the equations of all candidates there.
  LinearisedModel(std::shared_ptr<const Robot> robot, const DataSet& data,
                  const DiagnosisOptions& options, const Progress& progress);
  LinearisedModel(const LinearisedModel&) = delete;

  const Robot& geometry() const { return *geometry_; }
  const std::shared_ptr<const Robot>& shared_geometry() const { return geometry_; }
  /// The robot's file is silent of masses: geometry() has that of robots of its size.
  bool mass_of_its_size() const { return geometry_ != given_; }
  /// kg, that the robot may carry by its file; 0: not told.
  double rated_payload() const {
    return given_->statics() ? given_->statics()->mechanics().payload : 0;
  }
  const MeasurementContext& context() const { return context_; }
  const Candidates& candidates() const { return candidates_; }
  const std::vector<EffectParameter>& parameters() const { return parameters_; }
  const Adjusted& adjusted() const { return adjusted_; }
  /// Of the rows as the calibrated geometry leaves them.
  std::vector<RowResidual> residuals_of_rows() const {
    return equations_->residuals(adjusted_.fitted.state);
  }
  const Equations& equations() const { return *equations_; }

  /// The rows that are no outliers, with the noise `scale` times what the geometry's fit says.
  Whitened whitened() const;
  /// The same without any cause's columns.
  Whitened whitened_geometry() const;
  /// Which they are, without their columns W.
  DenseEquations kept() const;
  std::vector<Eigen::Isometry3d> ends() const;
  Eigen::MatrixXd tips() const;
  /// Of the equations of kept(); whitened.
  ReadingErrors reading_errors() const;
  /// Of the equations of kept(), whitened, and of the readings of all rows.
  JointErrors joint_errors() const;
  /// What the geometry alone leaves of `rows` (as whitened()).
  Eigen::VectorXd geometry_residuals(const Whitened& rows) const;
  /// Variance that noise of one has beyond the geometry, by equation of `rows`: 1 less its
  /// leverage.
  Eigen::VectorXd geometry_leaves(const Whitened& rows) const;
  const std::vector<char>& outlier() const { return outlier_; }
  /// Times are places in the file: see DataSet.
  bool order_is_time() const { return data_.order_is_time; }
  /// As known so far, by set; no less than its data sheet says, unless repeats tell.
  std::vector<Scale> noise_of_sets() const;
  /// 1 sigma of one scalar (m), pooled over the sets that measure lengths; 0 without such.
  double noise() const;
  /// What the best explanation so far leaves of the angles that take part: from the middle of them,
  /// 1 sigma (rad), whatever the data sheets say; 0 without any.
  double angles_left() const;
  /// Sets whose rows the geometry meets better than their data sheet's noise allows, with no
  /// repeats that would tell it better.
  const std::vector<int>& quieter() const { return quieter_; }

  /// What the geometry with the effects' parameters `effects` (prior sigma `prior`) leaves of
  /// all(), put aside or not, when fitted to the kept ones; whitened at the current scale.
  Eigen::VectorXd residuals(const std::vector<int>& effects, const Eigen::VectorXd& prior) const;
  /// What the best explanation so far leaves, by equation of kept(); at first
  /// the geometry's fit.
  Eigen::VectorXd left() const;
  /// Takes the noise from the variance of the best explanation, of sets and quantities that it
  /// leaves unlike each by its own rows, and puts aside the rows whose `residuals` lie beyond one
  /// in a hundred thousand. True when that changed anything.
  bool refine(const Eigen::VectorXd& residuals, double variance);
  /// Puts aside these of the held rows (by row of the data set), no others, with the noise that the
  /// geometry's fit has.
  void start_with(std::vector<char> outlier);
  /// The rows marked take part again, if they are among those that are weighed.
  void take_back(const std::vector<char>& rows);
  /// These of the held rows take no part. True where any of them did.
  bool put_aside(const std::vector<char>& rows);
  /// The rows that are held, put aside or not; of a large data set one of every so many
  /// configurations. Whitened at a scale of one.
  const DenseEquations& all() const { return all_; }

  /// Tries `steps` that are likely at as many more moments near their own. True where any of them
  /// was not tried so before.
  bool try_moments_near(const std::vector<ShapedEffect>& steps);
  /// Tries the fine waves that what the best explanation leaves hints at; the same.
  bool try_fine_waves();

  /// How many equations take part (a data set with more is thinned out).
  void weigh(double most);

 private:
  /// The equations with every candidate's columns.
  void linearise();
  /// Candidates and their columns anew.
  void try_hints();
  /// By row: weighed and that are no outliers.
  std::vector<char> taking_part() const;
  /// What an error of each joint's reading moves each equation of kept() (equations x joints,
  /// sigmas a rad or m), at a scale of one.
  Eigen::MatrixXd by_joint() const;
  /// What each joint's giving way to its load, by one, moves the same equations, whitened; zeros
  /// where its load is not known or says nothing.
  Eigen::MatrixXd by_load() const;
  /// Those equations of all(), with these columns of the effects.
  Whitened of(const std::vector<int>& equations, const std::vector<int>& effects) const;
  /// Takes no noise for less than its data sheet says, unless repeats tell.
  void bound_noise();
  /// The least that the data sheets allow of each set's noise, over what it is taken for.
  std::vector<Scale> least_of_sets() const;
  /// Variance of the noise, at least, over what it is taken for.
  double least() const;
  /// What the noise of these equations of all() is taken for, at a scale of one.
  Eigen::VectorXd scales(const std::vector<int>& equations) const;

  const DataSet& data_;
  double most_outliers_;
  std::shared_ptr<const Robot> given_, geometry_, everything_;
  MeasurementContext context_;
  Hints hints_;
  Candidates candidates_;
  std::vector<EffectParameter> parameters_;
  std::unique_ptr<Equations> equations_, all_equations_;
  Adjusted adjusted_;
  Nuisance nuisance_;
  DenseEquations all_;  ///< of the noise as the geometry's fit has it
  RowsBefore before_;   ///< of the same equations
  std::vector<int> quieter_;
  std::vector<Scale> noise_;   ///< by set, at a scale of one
  std::vector<char> held_;     ///< by row: all() is of it
  std::vector<char> weighed_;  ///< by row: takes part in choosing the causes
  std::vector<char> outlier_;  ///< by row of the data set
  Eigen::VectorXd steps_;      ///< that each joint's readings are rounded to; 0: not known
  Eigen::VectorXd left_;       ///< by equation of all()
  double scale_ = 1;
  std::vector<Scale> relative_;  ///< of a set's lengths and angles over that, by set
};

}  // namespace selfcal
