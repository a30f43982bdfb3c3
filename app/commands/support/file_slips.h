// What is likely wrong with the files of a data set, when the maker's robot is far from its rows.
#pragma once

#include <Eigen/Dense>
#include <memory>
#include <string>

#include "constraints/slips/first_look.h"
#include "io/files/data_set_file.h"

namespace selfcal {

/// A first look at the data set that was loaded from `path`, with the slips of its robot's file
/// (the other convention, a tool frame that is missing) beside those of its rows. `robot` is the
/// one that its file has. Fails when the file cannot be read again.
Result<FirstLook> look_at_files(const std::string& path, const LoadedDataSet& loaded,
                                const std::shared_ptr<const Robot>& robot);

/// `refused`, which load_data_set() said of `path`, and what a first look at the rows says of it
/// where nothing but the joints' limits was in their way.
Failure with_likely_wrong(Failure refused, const std::string& path);

/// What a fit to all rows found: of the maker's robot, and of the tool.
struct NominalFit {
  double rms = 0;       ///< of the robot as its maker says, base and tool placed (m or rad)
  bool lengths = true;  ///< it is one of lengths
  const Robot& model;   ///< whose parameters `values` are
  const Eigen::VectorXd& values;
  double calibrated = 0;  ///< what calibration leaves of it; 0 where that is not known
  double angle = 0;       ///< rad, what it leaves of angles beside lengths; 0 where none are known
};

/// The same look for somebody who asked for something else.
struct LikelyWrong {
  std::string words;       ///< a sentence; empty where nothing is likely wrong
  bool explained = false;  ///< one slip brings the rows to the robot
  bool tool = false;       ///< it is the tool's frame, which a calibration takes in
};

/// Costs nothing where `nominal` is not gross.
LikelyWrong likely_wrong(const std::string& path, const LoadedDataSet& loaded,
                         const std::shared_ptr<const Robot>& robot, const NominalFit& nominal);

}  // namespace selfcal
