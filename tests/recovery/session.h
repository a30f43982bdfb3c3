// A simulated session: sets of a few methods on a robot with known truth.
#pragma once

#include <string>
#include <vector>

#include "constraints/configurations.h"
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
};

/// Rows of every part on `machine` (which may be KDL's) with parameters `xi`; touches scatter by
/// `noise` (m), instruments by `noise` and noise / 0.2 m in angle; every third row is `check`.
inline Session make_session(const Robot& machine, const Eigen::VectorXd& xi,
                            const std::vector<SetPart>& parts, double noise, Random& random) {
  Session session;
  Problems problems;
  Node all = Node::map();
  for (const SetPart& part : parts) {
    session.data.sets.push_back(make_set(part.name, part.node, problems));
    all.set(part.name, part.node);
  }
  link_sets(session.data.sets, all, problems);
  std::normal_distribution<double> normal;
  std::vector<SampleRequest> requests;
  for (size_t s = 0; s < parts.size(); ++s) {
    SampleRequest request;
    request.set = static_cast<int>(s);
    request.rows = parts[s].rows;
    request.rows_per_group = parts[s].rows_per_group;
    const std::vector<Quantity> quantities = session.data.sets[s].method->equations();
    request.residual = [&normal, &random, quantities, noise](int) {
      Eigen::VectorXd r(static_cast<Eigen::Index>(quantities.size()));
      for (size_t a = 0; a < quantities.size(); ++a)
        r[static_cast<Eigen::Index>(a)] =
            normal(random) * (quantities[a] == Quantity::angle ? noise / 0.2 : noise);
      return r;
    };
    requests.push_back(request);
  }
  session.unreached = sample_rows(machine, xi, requests, random, session.data).unreached;
  Observations& rows = session.data.rows;
  for (int i = 0; i < rows.rows(); ++i) {
    rows.check[i] = i % 3 == 2;
    if (noise == 0 || session.data.sets[rows.set[i]].method->constrains()) continue;
    for (int c = 0; c < 3; ++c) rows.position(i, c) += noise * normal(random);
    rows.distance[i] += noise * normal(random);
    const auto q = rows.orientation.row(i);
    const Eigen::Vector3d turn(normal(random), normal(random), normal(random));
    const Eigen::Quaterniond turned(exp_rotation(noise / 0.2 * turn) *
                                    Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix());
    rows.orientation.row(i) << turned.w(), turned.x(), turned.y(), turned.z();
  }
  return session;
}

/// Position of the endpoint at readings q.
inline Eigen::Vector3d endpoint(const Robot& robot, const Eigen::VectorXd& xi,
                                const Eigen::VectorXd& q) {
  ConfigurationBlock block;
  block.q = q.transpose().replicate(kLanes, 1).array();
  block.count = 1;
  Locations X;
  robot.locate(block, xi, Body::endpoint, X, nullptr);
  return X.p(0);
}

}  // namespace selfcal::recovery
