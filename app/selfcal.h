// selfcal as a library: everything that another program may rely on. Installed as
// <selfcal/selfcal.h>.
//
// SI and radians throughout, everything in namespace selfcal. What the world does wrong comes back
// as Result<T> with a sentence for the user; bad measurements are an answer (Solution::verdict);
// broken preconditions abort. Nothing is written but by the functions that say so, and nothing is
// global: any number of threads may identify and diagnose at once. Headers that are installed but
// not listed here change without notice.
#pragma once

// The machine: its parameters, its locations, its effects.
#include "kinematics/corrected_robot.h"
#include "kinematics/parameter.h"
#include "kinematics/robot.h"

// What to command: Compensation, CompensationStream, fit_controller().
#include "kinematics/inverse/compensation.h"
#include "kinematics/inverse/compensation_stream.h"
#include "kinematics/inverse/controller_fit.h"

// What the rows say: identify().
#include "constraints/estimation/identification.h"
#include "constraints/methods/data_set.h"

// Where to measure: plan_configurations().
#include "constraints/planning/configuration_plan.h"

// What causes the gap that is left: diagnose(), compare().
#include "diagnosis/comparison/compare.h"
#include "diagnosis/diagnosis.h"

// Files: load_data_set(), load_robot() and back, to_json(), write_file_atomically().
#include "io/files/data_set_file.h"
#include "io/files/data_set_writer.h"
#include "io/files/file.h"
#include "io/files/robot_file.h"
#include "io/files/solution_json.h"
#include "io/result.h"
