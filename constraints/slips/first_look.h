// A first look at a data set: whether the robot as its maker says fits the rows where only base,
// tool and nuisance parameters may move, and which one slip would explain it where it does not.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "constraints/slips/slips_of_rows.h"
#include "kinematics/robot.h"

namespace selfcal {

/// What a slip leaves.
struct TriedSlip {
  std::string what;
  double left = 0;  ///< median of the rows' residuals (m; rad where no row measures a length)
};

struct FirstLook {
  bool lengths = true;    ///< residuals are lengths, not angles
  double left = 0;        ///< median of the rows' residuals, as given; infinite where none has one
  double expected = 0;    ///< what the maker's tolerances leave, 1 sigma
  int equations = 0;      ///< of the rows that identify
  int taken = 0;          ///< of them by placing base, tool and surfaces: no more tell nothing
  double tool_held = 0;   ///< what is left with the tool as its file says
  double tool_moved = 0;  ///< m, how far the rows put the tool from where its file has it
  std::vector<TriedSlip> tried;  ///< best first
  bool explained = false;        ///< the best of them is believed
  bool tool = false;             ///< the tool's frame is
  bool angles = false;           ///< what is found speaks of the angles alone
  std::string found;             ///< what is likely wrong; empty where nothing is
};

/// From what residual on (m; rad where `lengths` is false) no tolerance of the maker's explains it:
/// what base and tool leave of the rows is gross beyond it.
double gross_misfit(const Robot& robot, bool lengths);

/// Tries every slip of the rows and `others`, which the caller knows of the files. No row, or none
/// that gives an equation: nothing is found. Of a set with very many rows a part is looked at.
FirstLook first_look(const std::shared_ptr<const Robot>& robot, const DataSet& data,
                     const std::vector<Slip>& others);

}  // namespace selfcal
