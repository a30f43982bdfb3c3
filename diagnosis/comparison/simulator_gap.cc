// Gauss-Newton on the nuisance parameters alone: the tool's poses are given,
//   minimise over u: sum over fit rows |r(X_row, u)|^2,   u <- u - (D^T D)^-1 D^T r
#include "diagnosis/comparison/simulator_gap.h"

#include <algorithm>
#include <cmath>

#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr int kMostFits = 50;
constexpr double kFitted = 1e-12;  // of how far the poses reach: what the last step moves

struct ValidationPoses {
  std::vector<int> fit, check;
  bool apart = true;
};

ValidationPoses poses_of_set(const DataSet& data, int set, const ToolPoses& tool) {
  ValidationPoses rows;
  for (int row = 0; row < data.rows.rows(); ++row) {
    if (data.rows.set[row] != set || !tool[static_cast<std::size_t>(row)] ||
        data.rows.check[row] == kCopy)
      continue;
    (data.rows.check[row] ? rows.check : rows.fit).push_back(row);
  }
  rows.apart = !rows.fit.empty() && !rows.check.empty();
  if (rows.fit.empty()) rows.fit = rows.check;
  if (rows.check.empty()) rows.check = rows.fit;
  return rows;
}

/// The rows' residuals and their derivatives to the set's own freedoms, one equation a row.
struct ToolResiduals {
  Eigen::VectorXd r;
  Eigen::MatrixXd D;
};

ToolResiduals residuals_of(const DataSet& data, const Method& method, const std::vector<int>& rows,
                           const ToolPoses& tool, const Eigen::VectorXd& own) {
  const auto equations = static_cast<int>(method.equations().size());
  const int freedoms = method.tangent_dimension();
  const auto count = static_cast<Eigen::Index>(rows.size());
  ToolResiduals all{Eigen::VectorXd(count * equations),
                    Eigen::MatrixXd(count * equations, freedoms)};
  MethodOutput out;
  for (Eigen::Index i = 0; i < count; ++i) {
    Locations now;
    const Location& X = *tool[static_cast<std::size_t>(rows[static_cast<std::size_t>(i)])];
    for (int c = 0; c < 9; ++c) now.rotation(0, c) = X.R.data()[c];
    now.position.row(0) = X.p.transpose().array();
    out.resize(equations, freedoms, 0, 0);
    MethodInput in;
    in.count = 1;
    in.data = &data.rows;
    in.rows = &rows[static_cast<std::size_t>(i)];
    in.now = &now;
    in.nuisance = &own;
    method.evaluate(in, out);
    for (int a = 0; a < equations; ++a) {
      const bool length = method.equations()[static_cast<std::size_t>(a)] == Quantity::length;
      all.r[i * equations + a] = length ? out.r(0, a) : 0;
      for (int k = 0; k < freedoms; ++k)
        all.D(i * equations + a, k) = length ? out.D_own(0, a * freedoms + k) : 0;
    }
  }
  return all;
}

Eigen::VectorXd fitted(const DataSet& data, const Method& method, const std::vector<int>& rows,
                       const ToolPoses& tool) {
  std::vector<Location> X;
  double reach = 0;  // m, from the world's origin
  for (const int row : rows) {
    X.push_back(*tool[static_cast<std::size_t>(row)]);
    reach = std::max(reach, X.back().p.norm());
  }
  Eigen::VectorXd own = method.start(X, rows, data.rows, nullptr, {});
  if (method.tangent_dimension() == 0) return own;
  for (int i = 0; i < kMostFits; ++i) {
    const ToolResiduals at = residuals_of(data, method, rows, tool, own);
    const Eigen::VectorXd step = -least_squares(at.D, at.r);
    method.retract(own, step);
    if ((at.D * step).cwiseAbs().maxCoeff() < kFitted * reach) break;
  }
  return own;
}

bool stands_alone(const Method& method) {
  return method.has_lengths() && !method.paired() && method.group_freedom() == 0 &&
         method.reference().empty() && method.body() <= Body::last_link;
}

}  // namespace

ToolPoses without_false_rows(ToolPoses tool, const std::vector<Outlier>& outliers) {
  for (const Outlier& each : outliers) tool[static_cast<std::size_t>(each.row - 1)].reset();
  return tool;
}

SimulatorGap simulator_gap(const DataSet& data, const ToolPoses& tool) {
  SimulatorGap gap;
  double squares = 0;
  for (std::size_t s = 0; s < data.sets.size(); ++s) {
    const Method& method = *data.sets[s].method;
    const ValidationPoses rows = poses_of_set(data, static_cast<int>(s), tool);
    if (rows.fit.empty()) continue;
    if (!stands_alone(method)) {
      gap.sets.push_back(data.sets[s].name);
      continue;
    }
    const Eigen::VectorXd own = fitted(data, method, rows.fit, tool);
    squares += residuals_of(data, method, rows.check, tool, own).r.squaredNorm();
    gap.kept_aside = gap.kept_aside && rows.apart;
    gap.rows += static_cast<int>(rows.check.size());
  }
  if (gap.rows > 0) gap.rms = std::sqrt(squares / gap.rows);
  return gap;
}

}  // namespace selfcal
