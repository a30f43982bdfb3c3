// A simulated session: sets of a few methods on a robot with known truth.
#pragma once

#include <string>
#include <vector>

#include "constraints/estimation/identification.h"
#include "constraints/identifiability/excitation.h"
#include "constraints/sampling/configurations.h"
#include "kinematics/rotation.h"

namespace selfcal::recovery {

struct Session {
  DataSet data;
  std::string unreached;
};

/// One set by its name and its entry in flow style: {"method", "plane"}, {"noise", "2e-5"}, ...
inline Node entry(std::initializer_list<std::pair<const char*, const char*>> fields) {
  Node node = Node::map();
  for (const auto& [key, value] : fields) node.set(key, Node::of(std::string(value)));
  return node;
}

struct SetPart {
  std::string name;
  Node node;
  int rows;
  int rows_per_group = 6;
  double noise_times = 1;  ///< of the session's noise
};

/// Rows of every part on `machine` (which may be KDL's) with parameters `xi`; touches scatter by
/// `noise` (m), instruments by `noise` (m; rad of measured angles) and noise / 0.2 m in
/// orientation; every third row is `check`.
inline Session make_session(const Robot& machine, const Eigen::VectorXd& xi,
                            const std::vector<SetPart>& parts, double noise, Random& random) {
  Session session;
  Problems problems;
  Node all = Node::map();
  for (const SetPart& part : parts) all.set(part.name, part.node);
  session.data.sets = read_sets(all, problems);
  std::normal_distribution<double> normal;
  std::vector<SampleRequest> requests;
  for (size_t s = 0; s < parts.size(); ++s) {
    SampleRequest request;
    request.set = static_cast<int>(s);
    request.rows = parts[s].rows;
    request.rows_per_group = parts[s].rows_per_group;
    const std::vector<Quantity> quantities = session.data.sets[s].method->equations();
    const double sigma = noise * parts[s].noise_times;
    request.residual = [&normal, &random, quantities, sigma](int) {
      Eigen::VectorXd r(static_cast<Eigen::Index>(quantities.size()));
      for (size_t a = 0; a < quantities.size(); ++a)
        r[static_cast<Eigen::Index>(a)] =
            normal(random) * (quantities[a] == Quantity::angle ? sigma / 0.2 : sigma);
      return r;
    };
    requests.push_back(request);
  }
  session.unreached = sample_rows(machine, xi, requests, random, session.data).unreached;
  Observations& rows = session.data.rows;
  for (int i = 0; i < rows.rows(); ++i) {
    rows.check[i] = i % 3 == 2;
    if (noise == 0 || session.data.sets[rows.set[i]].method->constrains()) continue;
    const double sigma = noise * parts[static_cast<size_t>(rows.set[i])].noise_times;
    for (int c = 0; c < 3; ++c) rows.position(i, c) += sigma * normal(random);
    double drawn = normal(random);  // for every row, whatever its method measures
    for (const MeasuredColumn& each : session.data.sets[rows.set[i]].method->measures()) {
      rows.column(each.name)[i] += sigma * drawn;
      drawn = normal(random);
    }
    const auto q = rows.orientation.row(i);
    const Eigen::Vector3d turn(normal(random), normal(random), normal(random));
    const Eigen::Quaterniond turned(exp_rotation(sigma / 0.2 * turn) *
                                    Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix());
    rows.orientation.row(i) << turned.w(), turned.x(), turned.y(), turned.z();
  }
  return session;
}

/// An identification from the rows alone, of a machine that is off only in what they determine.
struct Exact {
  Solution solution;
  double largest_error = 0;  ///< of any parameter (m or rad)
  std::string unreached;
};

/// Rows under 20 um of noise tell what the parts determine, of the nominal robot too, where the
/// iteration starts; the rest (grouped, without effect, held) is fixed, and in the machine as its
/// maker says. Then exact rows and no priors: rounding of
/// 1e-15 m a row, some thousand times magnified, is all that may be left of the errors.
inline Exact without_priors(const Robot& robot, Eigen::VectorXd truth,
                            const std::vector<SetPart>& parts, Random& random) {
  Exact exact;
  const Session noisy = make_session(robot, truth, parts, 20e-6, random);
  if (!noisy.unreached.empty()) return {{}, 0, noisy.unreached};
  std::vector<char> candidate;
  for (const Parameter& p : robot.parameters()) candidate.push_back(p.free);
  constexpr int kRows = 80;
  const Identifiability nominal = structural(robot, noisy.data.sets, candidate, kRows, 1).rank;
  const Solution first = identify(robot, noisy.data);
  Options options;
  for (size_t i = 0; i < candidate.size(); ++i) {
    const ParameterResult& p = first.parameters[i];
    if (p.status == Status::identified && nominal.status[i] == Status::identified) continue;
    options.fix.push_back(p.parameter.name);
    truth[static_cast<Eigen::Index>(i)] = p.parameter.nominal;
  }
  const Session session = make_session(robot, truth, parts, 0, random);
  if (!session.unreached.empty()) return {{}, 0, session.unreached};
  options.priors = false;
  exact.solution = identify(robot, session.data, options);
  exact.largest_error = (exact.solution.values - truth).cwiseAbs().maxCoeff();
  return exact;
}

}  // namespace selfcal::recovery
