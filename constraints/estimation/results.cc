// From the fit to what the user is told.
#include "constraints/estimation/results.h"

#include <algorithm>
#include <cmath>

#include "constraints/identifiability/observability.h"
#include "constraints/methods/lone_groups.h"
#include "kinematics/linear_algebra.h"

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

}  // namespace selfcal
