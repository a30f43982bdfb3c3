// Rows and files that no cause may be named from, however well one fits them.
//
// A search among effects explains whatever it is given. What it finds in a table of degrees taken
// for radians, or in the rows of another robot, is of a size that no machine has, or leaves what no
// noise is. Then nothing is named: structure of unknown kind is there, and a person looks at the
// rows and files first.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// What speaks against the rows or files, in words; empty where nothing does. In turn: an
/// instrument that was moved between two rows (found by an identification of its own); a given
/// length that contradicts the maker's, or a gear ratio of the robot's file that is off, which
/// would be taken for a cause far beyond its usual size (given_wrongly.h); a named cause far beyond
/// what any machine has, or a spring of the wrong sign; what is left beyond what the maker's
/// tolerances explain; a noise of the files far beyond what calibration leaves; a named cause that
/// closes nothing; rows kept aside that are left far beyond noise where nothing is found; forces
/// without which what gives way under them fits better; where nothing is named, or what is named
/// closes little, noise far beyond the data sheet's that no repeat confirms.
/// `calibrated`: of the same rows.
std::string doubt_of(const LinearisedModel& linearised, const DataSet& data,
                     const Solution& calibrated, const Diagnosis& diagnosis);

/// That what is named is worth nothing on rows that no choice has seen: it surely closes less than
/// a share of what calibration leaves or, where these rows are too few to tell an interval, leaves
/// no less of them. Empty where it is worth more.
std::string closes_nothing(const Diagnosis& diagnosis);

/// The files state a noise far beyond what calibration leaves.
bool may_state_millimetres(const Gap& gap);

/// A base that is moved from one row to the next is no law of the rows' places, which their order
/// may go with: what was halved for that is whole again where calibration shows the step plainly.
/// The surest leads.
void trust_plain_steps(const LinearisedModel& linearised, const DataSet& data,
                       Diagnosis& diagnosis);

/// Of what is named beside the verdict, springs of the wrong sign are left out: the shape of the
/// verdict's own law makes such. Says which and why; nothing where the verdict is one itself.
std::string leave_out_impossible(std::vector<CauseResult>& named, const CauseResult& verdict);

/// Takes back what is named: the verdict is `unknown`, and its words begin with the doubt.
void withdraw(const std::string& doubt, const DiagnosisOptions& options, Diagnosis& diagnosis);

}  // namespace selfcal
