// From the fit to what the user is told.
#include "constraints/estimation/results.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "constraints/identifiability/observability.h"
#include "constraints/methods/lone_groups.h"
#include "constraints/statistics.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

/// sqrt(g^T C g) with g given over the own freedoms of a set and of the one it refers to.
double sigma_of(const NuisanceReport& report, const Equations& equations, int set,
                const Eigen::MatrixXd& C) {
  Eigen::VectorXd g = Eigen::VectorXd::Zero(C.rows());
  g.segment(equations.own_at(set), equations.tangent_dimension(set)) = report.D_own;
  const int reference = equations.data().sets[set].reference;
  if (reference >= 0 && report.D_reference.size() > 0)
    g.segment(equations.own_at(reference), equations.tangent_dimension(reference)) =
        report.D_reference.head(equations.tangent_dimension(reference));
  return std::sqrt(std::max(0.0, g.dot(C * g)));
}

/// Standard deviations of one cluster's local freedoms: (I + R_lg C R_lg^T) seen through R_ll^-1.
Eigen::VectorXd local_sigmas(const Eigen::MatrixXd& factor, const Eigen::MatrixXd& C) {
  const Eigen::Index local = factor.rows();
  const Eigen::MatrixXd R_lg = factor.middleCols(local, C.rows());
  const Eigen::MatrixXd inverse = inverse_of_triangle(factor.leftCols(local));
  const Eigen::MatrixXd middle =
      Eigen::MatrixXd::Identity(local, local) + R_lg * C * R_lg.transpose();
  return (inverse * middle * inverse.transpose()).diagonal().cwiseMax(0).cwiseSqrt();
}

void report_groups(const Equations& equations, int set, const Fit& fit, const Eigen::MatrixXd& C,
                   size_t& cluster_index, std::vector<NuisanceResult>& nuisance) {
  const Set& s = equations.data().sets[set];
  const std::vector<std::string> names = s.method->group_names();
  const int freedom = s.method->group_freedom();
  for (const SetPlan::Cluster& cluster : equations.plan(set).clusters) {
    if (cluster.groups.empty()) continue;
    const Eigen::VectorXd sigma = local_sigmas(fit.at.clusters[cluster_index++].rows, C);
    for (size_t g = 0; g < cluster.groups.size(); ++g)
      for (size_t i = 0; i < names.size(); ++i) {
        const int group = cluster.groups[g];
        const auto place = static_cast<Eigen::Index>(g) * freedom + static_cast<Eigen::Index>(i);
        nuisance.push_back({s.name + "." + s.groups[group] + "." + names[i],
                            fit.state.groups[set](static_cast<Eigen::Index>(i), group),
                            sigma[place]});
      }
  }
}

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
  return "set " + set.name + ": " + std::to_string(far) +
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
std::string unexplained(const SetResult& set, const Scatter& scatter, double expected,
                        const char* than, const char* unless) {
  return "set " + set.name + ": the " + scatter.what + " scatter " +
         ratio(scatter.found, expected) + " times as much as " + than +
         ": the geometry does not explain them all; beside what is known of it the robot strays "
         "by " +
         with_figures("%.2g ", 1e3 * beside(scatter.found, expected)) + scatter.unit +
         " in each direction measured" + unless;
}

}  // namespace

std::vector<ParameterResult> parameter_results(const Robot& robot, const Eigen::VectorXd& xi,
                                               const Eigen::MatrixXd& C,
                                               const Identifiability& rank,
                                               const std::vector<char>& candidate,
                                               const std::vector<char>& free) {
  std::vector<ParameterResult> list;
  for (size_t i = 0; i < robot.parameters().size(); ++i) {
    ParameterResult each;
    each.parameter = robot.parameters()[i];
    each.value = xi[i];
    each.status = !candidate[i] ? Status::fixed : !free[i] ? Status::held : rank.status[i];
    if (each.status == Status::identified || each.status == Status::grouped) {
      each.sigma = std::sqrt(C(i, i));
      each.grouped_with = rank.grouped_with[i];
    }
    list.push_back(std::move(each));
  }
  return list;
}

std::pair<std::vector<std::string>, Eigen::MatrixXd> covariance_result(
    const std::vector<ParameterResult>& parameters, const Eigen::MatrixXd& C) {
  std::vector<std::string> names;
  std::vector<int> columns;
  for (size_t i = 0; i < parameters.size(); ++i)
    if (C.rows() > 0 && C(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) > 0) {
      names.push_back(parameters[i].parameter.name);
      columns.push_back(static_cast<int>(i));
    }
  return {names, C(columns, columns)};
}

Observability identified_observability(const Equations& equations, const Eigen::MatrixXd& R,
                                       const Identifiability& rank, const Noise& noise) {
  std::vector<int> columns;
  for (size_t i = 0; i < rank.status.size(); ++i)
    if (rank.status[i] == Status::identified) columns.push_back(static_cast<int>(i));
  double quietest = 0;
  int rows = 0;
  for (int s = 0; s < static_cast<int>(equations.data().sets.size()); ++s) {
    const int count = static_cast<int>(equations.plan(s).items.size());
    if (count == 0) continue;
    rows += count;
    const bool lengths = equations.data().sets[s].method->has_lengths();
    const double sigma = lengths ? noise.used[s].length : noise.used[s].angle;
    quietest = quietest == 0 ? sigma : std::min(quietest, sigma);
  }
  // The sets' nuisance parameters are projected out first: what they could mimic is not seen.
  const Eigen::MatrixXd nuisance =
      R.middleCols(equations.robot_columns(), equations.nuisance_columns());
  return observability(quietest * beyond(nuisance, R(Eigen::all, columns)), rows);
}

std::vector<SetResult> set_results(const Equations& equations, const Fit& fit,
                                   const Eigen::MatrixXd& C, const Judged& after) {
  std::vector<SetResult> list;
  size_t cluster_index = 0;
  const DataSet& data = equations.data();
  for (int s = 0; s < static_cast<int>(data.sets.size()); ++s) {
    const Set& set = data.sets[s];
    SetResult each;
    each.name = set.name;
    each.method = set.method->name();
    const bool identifies = each.identifies = !equations.plan(s).items.empty();
    each.aligned = after.aligned[s];
    const Scale& noise = identifies ? fit.noise.estimated[s] : after.align_noise.estimated[s];
    for (const SetPlan::Item& item : equations.plan(s).items) {
      ++each.rows;
      if (!fit.noise.outlier[item.row]) ++each.used;
    }
    if (!identifies)
      for (const RowResidual& r : after.check) each.rows += r.set == s;
    if (identifies || each.aligned) {
      if (set.method->has_lengths()) each.noise_sigma = noise.length;
      if (set.method->has_angles()) each.noise_angle_sigma = noise.angle;
      const RepeatSpreads repeats =
          repeat_spreads(data, s, identifies ? after.fit : after.check, fit.noise.outlier);
      each.repeat_sigma = repeats.length.sigma();
      each.repeat_angle_sigma = repeats.angle.sigma();
    }
    if (identifies) {
      const Eigen::VectorXd* reference =
          set.reference < 0 ? nullptr : &fit.state.nuisance[set.reference];
      for (const NuisanceReport& report : set.method->report(fit.state.nuisance[s], reference))
        each.nuisance.push_back(
            {set.name + "." + report.name, report.value, sigma_of(report, equations, s, C)});
      report_groups(equations, s, fit, C, cluster_index, each.nuisance);
    }
    list.push_back(std::move(each));
  }
  return list;
}

void add_set_warnings(const Equations& equations, const Fit& fit, Solution& solution) {
  const DataSet& data = equations.data();
  const bool redundant = fit.at.equations > kRedundant * unknowns(fit, solution);
  for (size_t s = 0; s < data.sets.size(); ++s) {
    SetResult& set = solution.sets[s];
    const Scale& stated = equations.stated(static_cast<int>(s));
    const bool judges =
        std::ranges::count(solution.residual.check_by_set, set.name, &SetFigures::name) > 0;
    if (set.aligned && !judges)
      solution.warnings.push_back("set " + set.name +
                                  ": its rows kept aside are no more than what places it: they "
                                  "judge nothing; measure more of it");
    if (!set.identifies) continue;
    if (fit.noise.at_bound[s])
      solution.warnings.push_back("set " + set.name +
                                  ": more rows lie beyond the noise than may be " +
                                  "put aside; they are structure rather than false rows");
    if (set.noise_sigma > data.target)
      solution.warnings.push_back("set " + set.name +
                                  ": what is left of its rows is larger than the " +
                                  "end-position accuracy wanted");
    for (const auto& [scatter, noise] :
         {std::pair(rows_of(set), stated.length), std::pair(angles_of(set), stated.angle)})
      if (beyond_sheet(scatter, noise, set.used)) {
        set.unexplained = true;
        solution.warnings.push_back(unexplained(set, scatter, noise, "its data sheet says",
                                                ", unless the sheet states too little"));
      }
    const double freedoms =
        set.used * static_cast<double>(data.sets[s].method->equations().size()) -
        equations.tangent_dimension(static_cast<int>(s)) -
        equations.group_freedoms(static_cast<int>(s));
    const bool plainly =
        1 - chi_square_exceeds(freedoms / (kMisstated * kMisstated), freedoms) < kQuietByChance;
    if (redundant && plainly && stated.length > kMisstated * set.noise_sigma && set.noise_sigma > 0)
      solution.warnings.push_back(
          "set " + set.name + ": its data sheet's noise is " +
          ratio(stated.length, set.noise_sigma) +
          " times what its rows scatter by: is `noise` in metres, and 1 sigma?");
    const Method& method = *data.sets[s].method;
    const bool placed = is_placed_by_rows(set, method);
    for (const auto& [scatter, repeats] : {std::pair(rows_of(set), set.repeat_sigma),
                                           std::pair(angles_of(set), set.repeat_angle_sigma)})
      if (placed && beyond_repeats(scatter, repeats)) {
        set.unexplained = true;
        solution.warnings.push_back(unexplained(set, scatter, repeats, "their repeats", ""));
      }
    if (std::string often = often_beyond(set, solution); !often.empty())
      solution.warnings.push_back(std::move(often));
    if (std::string lone = lone_groups(data, static_cast<int>(s)); !lone.empty())
      solution.warnings.push_back(std::move(lone));
    if (!placed && judges)
      solution.warnings.push_back(
          "set " + set.name + ": its rows to identify are too few to place it; those kept aside " +
          "judge the robot alone, where they place it best");
  }
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
