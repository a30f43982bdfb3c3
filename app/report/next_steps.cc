#include "app/report/next_steps.h"

#include <algorithm>

#include "constraints/estimation/check_comparison.h"
#include "constraints/statistics.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

constexpr double kMost = 0.71;      ///< of a sigma: half the squares
constexpr double kMetBetter = 0.8;  ///< of what half the rows were met to before
constexpr double kApart = 10;       ///< times what those that identify are met to

double doubt_from(const Solution& solution, std::string_view source) {
  const std::vector<BudgetLine>& budget = solution.uncertainty.budget;
  const auto found = std::ranges::find(budget, source, &BudgetLine::source);
  return found == budget.end() ? 0 : found->sigma;
}

/// What halves of the rows differ by.
double doubt_of_structure(const Solution& solution) {
  return std::hypot(doubt_from(solution, kSharedErrors), doubt_from(solution, kImitatedLaws));
}

/// Rows that are near each other, in time or by configuration, err alike more than by chance, or
/// scatter more than they should.
bool structured(const Solution& solution) {
  return doubt_of_structure(solution) > doubt_from(solution, kNoiseOfRows) ||
         std::ranges::any_of(solution.sets, &SetResult::unexplained);
}

/// A surface that is not identified, or a length that the scale stands on.
bool sets_give_any(const DataSet& data, const Solution& solution) {
  return !solution.scale.stands_on.empty() || std::ranges::any_of(data.sets, [](const Set& set) {
    return set.method && set.method->touches() != TouchedSurface::none &&
           set.method->tangent_dimension() == 0;
  });
}

/// Most of what is not known of the end position is the doubt of what the sets give, and it is a
/// usual one: no set says its own.
bool given_without_tolerance(const DataSet& data, const Solution& solution) {
  return doubt_from(solution, kWhatWasGiven) > kMost * solution.workspace.rms &&
         sets_give_any(data, solution) && std::ranges::all_of(data.sets, [](const Set& set) {
           return set.given.place < 0 && set.given.turn < 0 && set.given.length < 0;
         });
}

/// "Add rows that move j1, j2 and j4 further", of all whose further movement would help.
std::string rows_to_add(const std::vector<Note>& unexcited) {
  std::vector<std::string> joints;
  for (const Note& each : unexcited)
    if (!each.joint.empty() && std::ranges::find(joints, each.joint) == joints.end())
      joints.push_back(each.joint);
  if (joints.empty()) return "Add rows in other postures";
  return "Add rows that move " + listed(joints) + " further";
}

/// Against the largest part of the end position's doubt.
std::string what_helps(const Solution& solution) {
  const double shared = doubt_of_structure(solution);
  const bool of_rows = std::ranges::all_of(
      solution.uncertainty.budget, [&](const BudgetLine& each) { return each.sigma <= shared; });
  if (shared > 0 && of_rows)
    return "Most of that comes of what the geometry does not explain; more rows like these do not "
           "help.";
  return rows_to_add(solution.unexcited) +
         (solution.gauge.empty() ? "." : ", and a known length for the scale.");
}

}  // namespace

bool seem_met_better(const Residuals& residual) {
  std::vector<double> before, after;
  for (const RowFigure& row : residual.rows)
    if (row.check) {
      before.push_back(row.before);
      after.push_back(row.after);
    }
  return !before.empty() && median(after) < kMetBetter * median(before);
}

bool lie_apart(const Residuals& residual) {
  std::vector<double> aside, others;
  for (const RowFigure& row : residual.rows) (row.check ? aside : others).push_back(row.after);
  return !aside.empty() && !others.empty() &&
         median(std::move(aside)) > kApart * median(std::move(others));
}

std::vector<std::string> next_steps(const DataSet& data, const Solution& solution) {
  for (const std::string& warning : solution.warnings)
    if (warning.starts_with(kFilesFirst)) return {warning};
  std::vector<std::string> steps;
  const std::vector<char>& check = data.rows.check;
  if (!check.empty() && std::ranges::none_of(check, [](char each) { return each == 0; }))
    return {
        "Leave `check` (column part) to about a third of the rows: the others are to identify."};
  if (solution.sets.empty() && !check.empty())
    return {"Look at rows and robot file first: `selfcal data check` says what is likely wrong."};
  if (!solution.converged)
    steps.push_back("Not converged: " + solution.stop_reason +
                    ". Check that the nominal model, units and joint signs belong to these rows.");
  if (solution.endpoint.poses == 0)
    steps.push_back("Leave free (--fix holds) what these rows are to identify.");
  else if (solution.residual.check.rows == 0)
    steps.push_back(
        "Mark about a third of the rows `check` (column part): a result is judged on rows "
        "it has not seen.");
  else if (solution.scale.against_maker)
    steps.push_back(
        "Measure the length given once more, or give another one: on a wrong one the whole robot "
        "is "
        "too large or too small.");
  else if (solution.workspace.poses < kFewestPoses)
    steps.push_back(std::string("The robot as it is ") +
                    (solution.workspace.poses == 0 ? "does not reach" : "hardly reaches") +
                    " the workspace that the data set gives: check its box and cone.");
  else if (solution.workspace.rms > data.target)
    steps.push_back(
        with_figures("The end position is known to %.3g mm only. ", 1e3 * solution.workspace.rms) +
        what_helps(solution));
  else if (solution.verdict.answer == Answer::not_improved && seem_met_better(solution.residual))
    steps.push_back(
        with_figures("Keep more configurations aside than %.0f (column part)",
                     solution.residual.check.configurations) +
        (solution.residual.check.rms_without_outliers < solution.residual.check.rms_after
             ? ", and look at those beyond the noise: they hide how the others are met."
             : ": of so few a gain may be chance."));
  else if (solution.verdict.answer == Answer::not_improved && lie_apart(solution.residual))
    steps.push_back(
        "See what is another one in the rows kept aside: the session, the robot, where the "
        "instrument or a surface stands. They say nothing of the others.");
  else if (solution.verdict.answer == Answer::not_improved)
    steps.push_back("The maker's figures explain the check rows as well: keep them.");
  else if (solution.verdict.answer == Answer::not_determined &&
           solution.residual.check.configurations < kFewestCompared)
    steps.push_back(with_figures(
        "Keep at least %.0f configurations aside (column part), better a third: fewer cannot say "
        "that they are met better.",
        kFewestCompared));
  else if (solution.verdict.answer == Answer::not_determined)
    steps.push_back(
        "Mend what the verdict and the warnings name: until then nothing of it is to be used.");
  else if (solution.converged)
    steps.push_back(
        "The result is a candidate: look at the changes, then use "
        "calibrated.robot.yaml.");
  if (given_without_tolerance(data, solution))
    steps.push_back(
        "Say how well the surfaces and lengths are known that the sets give (`tolerance: {place: "
        "m, turn: rad, length: m}` of a set): taken as good to 0.1 mrad and 0.01 %, they make most "
        "of the end position's doubt.");
  if (solution.converged && structured(solution))
    steps.push_back(
        "What the geometry leaves of these rows is more than noise: see what causes it (selfcal "
        "diagnose).");
  return steps;
}

}  // namespace selfcal
