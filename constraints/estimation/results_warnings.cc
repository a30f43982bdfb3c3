// What is wrong, in words: moves beyond tolerances, noise beyond what was expected, rows that judge
// nothing.
#include <algorithm>
#include <cmath>
#include <set>

#include "constraints/estimation/covariance_sources.h"
#include "constraints/estimation/results.h"
#include "constraints/identifiability/gauge.h"
#include "constraints/methods/lone_groups.h"
#include "constraints/statistics.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

constexpr double kRedundant = 3;         // equations an unknown: fewer are met whatever the noise
constexpr double kQuietByChance = 1e-3;  // that noise as stated scatters so much less
constexpr double kMisstated = 3;         // of the data sheet's noise that rows scatter by less
/// Of the data sheet's noise, of that of immediate repeats.
constexpr double kMoreThanSheet = 1.2, kMoreThanRepeats = 2;
constexpr int kFewestFar = 3;     // rows kept aside beyond the noise, and their share,
constexpr double kOften = 0.1;    // that are no false rows
constexpr double kRarely = 0.01;  // of as much, where the data sheet is right

double unknowns(const Fit& fit, const Solution& solution) {
  double count = static_cast<double>(
      std::ranges::count(solution.parameters, Status::identified, &ParameterResult::status));
  for (const auto& own : fit.state.nuisance) count += static_cast<double>(own.size());
  return count;
}

std::string ratio(double a, double b) { return format_number(std::round(a / b * 10) / 10); }

/// What is said of sets: the same of several once.
class WordsOfSets {
 public:
  void add(const SetResult& set, const std::string& words) {
    const auto said = std::ranges::find(list_, words, &Words::what);
    if (said == list_.end())
      list_.push_back({words, {set.name}});
    else
      said->sets.push_back(set.name);
  }

  void copy_to(std::vector<std::string>& warnings) const {
    for (const auto& [what, sets] : list_) {
      const std::vector<std::string> others(sets.begin() + 1, sets.end());
      const std::string alike = others.empty() ? "" : " (alike: " + listed(others) + ")";
      warnings.push_back("set " + sets.front() + alike + ": " + what);
    }
  }

 private:
  struct Words {
    std::string what;
    std::vector<std::string> sets;
  };
  std::vector<Words> list_;
};

/// Rows kept aside that lie beyond the noise: so many that they are no false ones.
std::string often_beyond(const SetResult& set, const Solution& solution) {
  std::set<int> rows;
  for (const Outlier& each : solution.outliers)
    if (each.check && each.set == set.name) rows.insert(each.row);
  const auto far = static_cast<std::ptrdiff_t>(rows.size());
  const auto own = std::ranges::find(solution.residual.check_by_set, set.name, &SetFigures::name);
  if (own == solution.residual.check_by_set.end() || far < kFewestFar ||
      static_cast<double>(far) < kOften * own->figures.rows)
    return {};
  return std::to_string(far) +
         (far <= own->figures.rows ? " of " + std::to_string(own->figures.rows) : "") +  // or pairs
         " rows kept aside lie beyond the noise of those that identify: the robot strays from its "
         "geometry where they were taken, or so many readings are false; what is known of it "
         "holds for the others";
}

/// Residuals of one unit, of a set's rows.
struct Scatter {
  const char* what;  ///< "rows"
  double found;      ///< 1 sigma
  const char* unit;  ///< of a thousandth of it
};

bool beyond_sheet(const Scatter& scatter, double stated, int rows) {
  return stated > 0 && scatter.found > kMoreThanSheet * stated &&
         chi_square_exceeds(rows * std::pow(scatter.found / stated, 2), rows) < kRarely;
}

/// What the rows have beside the noise that was expected, in each direction measured.
double beside(double found, double expected) {
  return std::sqrt(std::pow(found, 2) - std::pow(expected, 2));
}

Scatter rows_of(const SetResult& set) { return {"rows", set.noise_sigma, "mm"}; }

Scatter angles_of(const SetResult& set) { return {"angles", set.noise_angle_sigma, "mrad"}; }

/// The rows that identify placed all of the set.
bool is_placed_by_rows(const SetResult& set, const Method& method) {
  return !set.aligned || method.group_freedom() > 0;
}

bool beyond_repeats(const Scatter& scatter, double repeats) {
  return repeats > 0 && scatter.found > kMoreThanRepeats * repeats;
}

/// It is the robot's, and in no figure of it.
std::string unexplained(const Scatter& scatter, double expected, const char* than,
                        const char* unless) {
  return std::string("the ") + scatter.what + " scatter " + ratio(scatter.found, expected) +
         " times as much as " + than +
         ": the geometry does not explain them all; beside what is known of it the robot strays "
         "by " +
         with_figures("%.2g ", 1e3 * beside(scatter.found, expected)) + scatter.unit +
         " in each direction measured" + unless;
}

constexpr double kFewestFreedoms = 3;  // that tell a noise which no data sheet states

std::string rounded(double value) { return format_number(std::round(value * 10) / 10); }

/// Moves beyond four tolerances; of an angle of the tool, where no row sees how it is turned,
/// beyond one: it then imitates an offset.
void warn_of_move(const ParameterResult& each, bool orientation_is_seen,
                  std::vector<std::string>& warnings) {
  const Parameter& p = each.parameter;
  if (each.status == Status::fixed || p.part == Part::effect) return;
  const double moved = std::abs(each.value - p.nominal) / p.tolerance;
  const std::string in_frame = p.frame + "." + p.field;
  const std::string name = p.name == in_frame ? p.name : p.name + " (" + in_frame + ")";
  if (moved > 4) warnings.push_back(name + " moved by " + rounded(moved) + " tolerances");
  if (moved > 1 && !orientation_is_seen && p.part == Part::tool && p.quantity == Quantity::angle)
    warnings.push_back(name + " turns the tool by " + rounded(1e3 * (each.value - p.nominal)) +
                       " mrad (" + rounded(moved) +
                       " tolerances) where no row sees how it is turned, to imitate an offset: its "
                       "orientation is false; give the tool as a whole pose (xyz, rpy)");
}

/// Noise far above the data sheet's or the repeats', rows put aside up to the bound.
void add_set_warnings(const Equations& equations, const Fit& fit, Solution& solution) {
  const DataSet& data = equations.data();
  const bool redundant = fit.at.equations > kRedundant * unknowns(fit, solution);
  WordsOfSets words;
  for (size_t s = 0; s < data.sets.size(); ++s) {
    SetResult& set = solution.sets[s];
    const Scale& stated = equations.stated(static_cast<int>(s));
    const bool judges =
        std::ranges::count(solution.residual.check_by_set, set.name, &SetFigures::name) > 0;
    if (set.aligned && !judges)
      words.add(set,
                "its rows kept aside are no more than what places it: they judge nothing; measure "
                "more of it");
    if (!set.identifies) continue;
    if (fit.noise.at_bound[s])
      words.add(set,
                "more rows lie beyond the noise than may be put aside; they are structure rather "
                "than false rows");
    if (set.noise_sigma > data.target)
      words.add(set, "what is left of its rows is larger than the end-position accuracy wanted");
    for (const auto& [scatter, noise] :
         {std::pair(rows_of(set), stated.length), std::pair(angles_of(set), stated.angle)})
      if (beyond_sheet(scatter, noise, set.used)) {
        set.unexplained = true;
        words.add(set, unexplained(scatter, noise, "its data sheet says",
                                   ", unless the sheet states too little"));
      }
    const double freedoms =
        set.used * static_cast<double>(data.sets[s].method->equations().size()) -
        equations.tangent_dimension(static_cast<int>(s)) -
        equations.group_freedoms(static_cast<int>(s));
    const bool plainly =
        1 - chi_square_exceeds(freedoms / (kMisstated * kMisstated), freedoms) < kQuietByChance;
    if (redundant && plainly && stated.length > kMisstated * set.noise_sigma && set.noise_sigma > 0)
      words.add(set, "its data sheet's noise is " + ratio(stated.length, set.noise_sigma) +
                         " times what its rows scatter by: is `noise` in metres, and 1 sigma?");
    const Method& method = *data.sets[s].method;
    const bool placed = is_placed_by_rows(set, method);
    for (const auto& [scatter, repeats] : {std::pair(rows_of(set), set.repeat_sigma),
                                           std::pair(angles_of(set), set.repeat_angle_sigma)})
      if (placed && beyond_repeats(scatter, repeats)) {
        set.unexplained = true;
        words.add(set, unexplained(scatter, repeats, "their repeats", ""));
      }
    if (std::string often = often_beyond(set, solution); !often.empty()) words.add(set, often);
    if (std::string lone = lone_groups(data, static_cast<int>(s)); !lone.empty())
      solution.warnings.push_back(std::move(lone));
    if (!placed && judges)
      words.add(set,
                "its rows to identify are too few to place it; those kept aside judge the robot "
                "alone, where they place it best");
  }
  words.copy_to(solution.warnings);
}

}  // namespace

void add_warnings(const Equations& equations, const Adjusted& adjusted, Solution& solution) {
  if (adjusted.widening != 1)
    solution.warnings.push_back(
        "the robot differs from the maker's figures more than their tolerances allow (chi2 " +
        format_number(std::round(adjusted.chi2.value)) + " for " +
        format_number(std::round(adjusted.chi2.freedom)) +
        " degrees of freedom): priors widened by " +
        format_number(std::round(adjusted.widening * 100) / 100));
  const bool seen = orientation_is_seen(equations);
  for (const ParameterResult& each : solution.parameters)
    warn_of_move(each, seen, solution.warnings);
  if (!adjusted.before.converged)
    solution.warnings.push_back(
        "the figures before are of a nominal robot not placed to the end: " +
        adjusted.before.stop_reason);
  add_set_warnings(equations, adjusted.fitted, solution);
}

std::string hardly_reached(const Workspace& workspace, Eigen::Index poses, int wanted) {
  if (!workspace.box || poses >= wanted) return {};
  const auto corner = [](const Eigen::Vector3d& p) {
    return with_figures("[%.3g, %.3g, %.3g]", p.x(), p.y(), p.z());
  };
  return "workspace: " + (poses > 0 ? "only " + std::to_string(poses) : "none") +
         " of the configurations tried reach its box " + corner(workspace.box->min()) + " to " +
         corner(workspace.box->max()) + " m within the joint limits" +
         (workspace.cone ? " and its cone" : "") +
         ": see that it is where the robot works, in the world of the robot file";
}

std::string untold_noise(const Equations& equations, const Adjusted& adjusted) {
  if (freedoms_left(equations, adjusted) >= kFewestFreedoms) return {};
  for (size_t s = 0; s < equations.data().sets.size(); ++s) {
    const Set& set = equations.data().sets[s];
    if (set.noise <= 0 && set.noise_angle <= 0 &&
        !equations.plan(static_cast<int>(s)).items.empty())
      return "no `noise:` is stated for set " + set.name +
             ", and so few rows leave nothing that tells it: how sure any of this is nobody knows; "
             "state it, or add rows";
  }
  return {};
}

double strays(const Equations& equations, const std::vector<SetResult>& sets) {
  double most = 0;
  for (size_t s = 0; s < sets.size(); ++s) {
    const SetResult& set = sets[s];
    const double stated = equations.stated(static_cast<int>(s)).length;
    if (!set.identifies) continue;
    if (is_placed_by_rows(set, *equations.data().sets[s].method) &&
        beyond_repeats(rows_of(set), set.repeat_sigma))
      most = std::max(most, beside(set.noise_sigma, set.repeat_sigma));
    else if (beyond_sheet(rows_of(set), stated, set.used))
      most = std::max(most, beside(set.noise_sigma, stated));
  }
  return most;
}

}  // namespace selfcal
