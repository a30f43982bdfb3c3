#include "diagnosis/report/doubt.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "constraints/estimation/frame_step.h"
#include "constraints/estimation/identification.h"
#include "constraints/fitting/noise.h"
#include "constraints/slips/first_look.h"
#include "diagnosis/constants.h"
#include "diagnosis/report/beyond_noise.h"
#include "diagnosis/report/given_wrongly.h"
#include "diagnosis/report/named.h"
#include "diagnosis/report/recalibration.h"
#include "diagnosis/report/scatter.h"
#include "diagnosis/report/verdict.h"
#include "diagnosis/search/naming.h"
#include "kinematics/corrected_robot.h"
#include "kinematics/effect.h"
#include "kinematics/expects.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

/// What a moved instrument may be taken for.
bool moves(std::string_view effect) {
  const EffectLasting lasting = lasting_of(effect);
  return lasting == EffectLasting::moves || lasting == EffectLasting::moved_at_will;
}

std::string impossible_size(const std::vector<CauseResult>& named) {
  for (const CauseResult& each : named)
    if (const NamedValue* v = of_impossible_size(each))
      return each.effect == "fixture_shift"
                 ? "no fixture moves by " + v->name + " of " + in_readable_unit(v->value, v->unit) +
                       ": some touches of " + listed(each.where) +
                       " are of another surface, or what its set says of it (parallel_to, "
                       "distance, "
                       "normal) is wrong"
                 : "no machine has " + v->name + " of " + in_readable_unit(v->value, v->unit) +
                       ", which is what the rows would need";
  return {};
}

/// A step with hardly a row of its set before it is no event: all of the set lies elsewhere.
std::string elsewhere_from_the_first(const DataSet& data, const std::vector<CauseResult>& named) {
  for (const CauseResult& each : named) {
    if (each.effect != "fixture_shift" || !each.between || each.where.size() != 1 ||
        data.rows.time.size() == 0)
      continue;
    const auto set = std::ranges::find(data.sets, each.where.front(), &Set::name);
    std::size_t before = 0;
    for (int row = 0; row < data.rows.rows(); ++row)
      before += set - data.sets.begin() == data.rows.set[row] &&
                data.rows.time[row] < each.between->second;
    if (set != data.sets.end() && before < kDiagnosis.shapes.fewest_between)
      return "nearly all rows of " + set->name +
             " lie elsewhere than its set says, from the first ones on: is its place in the file "
             "(plane, distance, normal, radius) right, and are they of that surface?";
  }
  return {};
}

bool gives_way(const CauseResult& cause) { return cause.effect.ends_with("_compliance"); }

/// A spring stiffer than any would be seen where the loads are said to be larger than they are.
std::string too_stiff(const std::vector<CauseResult>& named) {
  for (const CauseResult& each : named)
    for (const NamedValue& v : each.parameters)
      if (gives_way(each) && v.positive && v.value > 0 &&
          kDiagnosis.report.too_stiff * (v.value + kDiagnosis.report.sigmas * v.sigma) <
              v.usual_least)
        return "no machine is so stiff as " + v.name + " of " + in_readable_unit(v.value, v.unit) +
               " says: are the masses in the robot's file in kg, its gravity in m/s^2, and forces "
               "in N?";
  return {};
}

/// What a joint, a link or a tool that pushes back more than it is pushed would need.
std::string impossible_sign(const CauseResult& cause) {
  for (const NamedValue& v : cause.parameters)
    if (gives_way(cause) && v.positive && v.value + kDiagnosis.report.other_sign * v.sigma < 0)
      return "no machine has " + v.name + " below zero, and the rows would need " +
             in_readable_unit(v.value, v.unit) + ": something else pulls where its weight would";
  return {};
}

std::string impossible_sign(const std::vector<CauseResult>& named) {
  for (const CauseResult& each : named)
    if (std::string why = impossible_sign(each); !why.empty()) return why;
  return {};
}

std::string beyond_tolerances(const LinearisedModel& linearised, const Diagnosis& diagnosis) {
  const double angle = linearised.angles_left();
  const bool lengths = diagnosis.noise > gross_misfit(linearised.geometry(), true);
  if (!lengths && angle <= gross_misfit(linearised.geometry(), false)) return {};
  return "calibration and all effects leave " +
         (lengths ? in_readable_unit(diagnosis.noise, "m") : in_readable_unit(angle, "rad")) +
         ", which no tolerance of the maker explains";
}

std::string beyond_sheet(const LinearisedModel& linearised, const DataSet& data) {
  for (const Scatter& each : scatter_of_sets(linearised, data))
    if (each.found > kDiagnosis.report.beyond_sheet * each.declared &&
        each.repeats.sigma() <= kDiagnosis.report.confirmed * each.found)
      return scatter_in_words(each, data);
  return {};
}

/// What is named closes little: noise, or what is taken for it, is nearly all of what is left.
bool hardly_closes(const Diagnosis& diagnosis) {
  return diagnosis.named.empty() ||
         diagnosis.gap.rms_after > kDiagnosis.report.hardly_closes * diagnosis.gap.rms_before;
}

bool drifts_too_far(const std::vector<CauseResult>& named) {
  return std::ranges::any_of(named, [](const CauseResult& each) {
    return each.effect == "base_drift" && beyond_usual(each, kDiagnosis.report.too_far) != nullptr;
  });
}

/// A joint, a link or a tool is said to give way, and does so better without the forces of the
/// rows, by gravity alone: they are not what acted.
std::string forces_that_never_were(const LinearisedModel& linearised, const DataSet& data,
                                   const Diagnosis& diagnosis) {
  if (std::ranges::none_of(diagnosis.named, gives_way) || data.rows.wrench.rows() == 0) return {};
  DataSet unforced = data;
  unforced.rows.wrench.resize(0, 6);
  const double with = left_with(linearised, data, diagnosis.found);
  const double without = left_with(linearised, unforced, diagnosis.found);
  if (!(without < kDiagnosis.report.forces_cost * with)) return {};
  return "the rows fit better without their forces and torques (fx to tz), " +
         in_readable_unit(without, "m") + " in place of " + in_readable_unit(with, "m") +
         ": are they those that acted on the tool, in its frame, without its own weight?";
}

/// The steps that are left when what was found and stays the same from row to row is in the model.
std::vector<FrameStep> steps_beside_what_stays(const LinearisedModel& linearised,
                                               const DataSet& data, const Correction& found) {
  Correction stays;
  std::ranges::copy_if(found, std::back_inserter(stays),
                       [](const FoundEffect& each) { return !moves(each.what.effect); });
  const std::shared_ptr<const Robot> robot = with_effects(linearised, stays);
  Options options = free_effects(*robot);
  for (const FoundEffect& each : stays)
    options.effect_sigma.insert(options.effect_sigma.end(), each.sigma.begin(), each.sigma.end());
  const Solution calibrated = identify(*robot, data, options);
  return frame_steps(*robot, calibrated.values, data, calibrated.residual.rows);
}

/// What is named leaves plainly less than a step of the instrument would: a drift as machines have
/// it looks like one where the rows of either end lie together, and so may several causes at once.
bool named_tells_better(const LinearisedModel& linearised, const DataSet& data,
                        const Diagnosis& diagnosis, const Solution& calibrated) {
  if (diagnosis.named.empty() || drifts_too_far(diagnosis.named) ||
      !impossible_size(diagnosis.named).empty())
    return false;
  const double with_step =
      (1 - calibrated.frame_steps.front().share) * std::pow(calibrated.residual.fit.rms_after, 2);
  return std::pow(left_with(linearised, data, named_of(diagnosis.found)), 2) <
         kDiagnosis.report.better_than_moved * with_step;
}

/// Rows of which some were taken with the instrument, or the base, elsewhere.
std::string moved_between_rows(const LinearisedModel& linearised, const DataSet& data,
                               const Diagnosis& diagnosis, const Solution& calibrated) {
  std::vector<FrameStep> steps = calibrated.frame_steps;
  if (!steps.empty() && named_tells_better(linearised, data, diagnosis, calibrated)) return {};
  const bool tool_moves = std::ranges::any_of(
      diagnosis.named, [](const CauseResult& each) { return each.effect == "tool_shift"; });
  if (steps.empty() && (tool_moves || drifts_too_far(diagnosis.named)))
    steps = steps_beside_what_stays(linearised, data, diagnosis.found);
  return steps.empty() ? "" : step_words(steps.front());
}

/// The same robot, none of whose effects is named.
std::shared_ptr<const Robot> without_names(const std::shared_ptr<const Robot>& robot) {
  std::vector<Node> entries;
  for (const Node& each : effect_entries(*robot)) {
    entries.push_back(each.without({"named"}));
    entries.back().set("named", Node::of(std::string("false")));
  }
  Problems problems;
  std::shared_ptr<const Robot> same = correct(geometry_of(robot), entries, {}, problems);
  expects(same != nullptr, "the effects of a robot are those that it can have");
  return same;
}

/// Nothing is told of a gap far below the noise that the files state.
std::string far_below_sheet(const Diagnosis& diagnosis) {
  const Gap& gap = diagnosis.gap;
  if (diagnosis.named.empty() || !may_state_millimetres(gap)) return {};
  return "calibration leaves " + in_readable_unit(gap.rms_before, "m") +
         " of the rows that no choice has seen, where the files state a noise of " +
         in_readable_unit(gap.noise_floor, "m") + ": is it in metres, and 1 sigma?";
}

}  // namespace

bool may_state_millimetres(const Gap& gap) {
  return gap.noise_floor > kDiagnosis.report.beyond_sheet * gap.rms_before;
}

std::string closes_nothing(const Diagnosis& diagnosis) {
  const Gap& gap = diagnosis.gap;
  if (diagnosis.named.empty() || gap.rows == 0) return {};
  const bool told = std::isfinite(gap.closed.most);
  if (told ? gap.closed.most >= kDiagnosis.report.closes_little
           : gap.rms_after < gap.rms_before || gap.validated_on != "check")
    return {};
  return "what would be named leaves " + in_readable_unit(gap.rms_after, "m") +
         " of the rows that no choice has seen, and calibration alone " +
         in_readable_unit(gap.rms_before, "m");
}

std::string doubt_of(const LinearisedModel& linearised, const DataSet& data,
                     const Solution& calibrated, const Diagnosis& diagnosis) {
  if (std::string why = moved_between_rows(linearised, data, diagnosis, calibrated); !why.empty())
    return why;
  if (std::string why = length_given_wrongly(diagnosis, calibrated); !why.empty()) return why;
  if (std::string why = ratio_given_wrongly(linearised, data, diagnosis); !why.empty()) return why;
  if (std::string why = reading_scaled_wrongly(linearised.geometry(), data.rows.q, diagnosis.named);
      !why.empty())
    return why;
  if (std::string why = impossible_size(diagnosis.named); !why.empty()) return why;
  if (std::string why = elsewhere_from_the_first(data, diagnosis.named); !why.empty()) return why;
  if (std::string why = impossible_sign(diagnosis.named); !why.empty()) return why;
  if (std::string why = too_stiff(diagnosis.named); !why.empty()) return why;
  if (std::string why = beyond_tolerances(linearised, diagnosis); !why.empty()) return why;
  if (std::string why = far_below_sheet(diagnosis); !why.empty()) return why;
  if (std::string why = closes_nothing(diagnosis); !why.empty()) return why;
  if (std::string why = beyond_noise(linearised, data, diagnosis); !why.empty()) return why;
  if (std::string why = forces_that_never_were(linearised, data, diagnosis); !why.empty())
    return why;
  const bool settled = diagnosis.verdict.effect == kUnknown && diagnosis.named.empty();
  return !settled && hardly_closes(diagnosis) ? beyond_sheet(linearised, data) : std::string();
}

void trust_plain_steps(const LinearisedModel& linearised, const DataSet& data,
                       Diagnosis& diagnosis) {
  std::vector<CauseResult>& named = diagnosis.named;
  if (!data.order_is_time || std::ranges::none_of(named, is_moved_at_once)) return;
  if (identify(linearised.geometry(), data).frame_steps.empty()) return;
  const auto trust = [](CauseResult& each) {
    if (!is_moved_at_once(each)) return;
    each.probability = each.of_its_kind();
    std::erase(each.confounded_with, kUnknown);
  };
  std::ranges::for_each(named, trust);
  std::ranges::for_each(diagnosis.candidates, trust);
  trust(diagnosis.verdict);
  std::ranges::stable_sort(diagnosis.candidates, std::ranges::greater{}, &CauseResult::probability);
  const auto moved = std::ranges::find_if(named, is_moved_at_once);
  if (!names_effect(diagnosis.verdict.effect) || moved->probability < diagnosis.verdict.probability)
    return;
  std::rotate(named.begin(), moved, moved + 1);
  diagnosis.verdict = named.front();
}

std::string leave_out_impossible(std::vector<CauseResult>& named, const CauseResult& verdict) {
  std::string why;
  if (!impossible_sign(verdict).empty()) return why;
  std::erase_if(named, [&](const CauseResult& each) {
    const std::string of_this = impossible_sign(each);
    if (of_this.empty()) return false;
    why += (why.empty() ? "" : "; ") + each.effect + " is not named: " + of_this;
    return true;
  });
  return why;
}

void withdraw(const std::string& doubt, const DiagnosisOptions& options, Diagnosis& diagnosis) {
  const std::string names = names_in_words(diagnosis.named);
  const bool idle = doubt == closes_nothing(diagnosis);
  const double unknown = idle ? kDiagnosis.report.withdrawn_idle : kDiagnosis.report.withdrawn;
  diagnosis.named.clear();
  if (!names.empty() && diagnosis.next.empty())
    diagnosis.next_why = "nothing is named: look at the rows and files first";
  for (FoundEffect& each : diagnosis.found) each.named = false;
  if (!names.empty()) diagnosis.model = without_names(diagnosis.model);
  for (ValidationRow& each : diagnosis.validation_rows) each.after = each.before;
  diagnosis.gap = gap_of(diagnosis.validation_rows, options.seed, diagnosis.floor_freedom,
                         diagnosis.gap.validated_on);
  say_unknown(unknown, diagnosis.candidates, diagnosis.verdict);
  for (CauseResult& each : diagnosis.candidates)
    if (each.effect != kUnknown) each.probability = std::min(each.probability, 1 - unknown);
  diagnosis.scatter.clear();
  diagnosis.why = "no cause is named, and noise explains it as little: " + doubt +
                  "; look at the rows and files first" +
                  (names.empty() ? "" : ". Without this doubt it would be " + names);
}

}  // namespace selfcal
