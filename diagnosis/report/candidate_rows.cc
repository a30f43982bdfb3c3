#include "diagnosis/report/candidate_rows.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <numeric>
#include <optional>

#include "constraints/sampling/configurations.h"
#include "diagnosis/constants.h"
#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/readable.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr double kLeastPayload = 0.1;  // kg: less tells nothing

/// Rows of `data` that spread over the fit rows, evenly.
std::vector<int> spread_rows(const DataSet& data) {
  std::vector<int> fit, some;
  for (int row = 0; row < data.rows.rows(); ++row)
    if (!data.rows.check[row]) fit.push_back(row);
  const int count = std::min<int>(kDiagnosis.further_rows.most_new, static_cast<int>(fit.size()));
  for (int i = 0; i < count; ++i) some.push_back(fit[i * fit.size() / count]);
  return some;
}

/// The data set and after it its rows `rows` once more, each a configuration of its own.
DataSet with_copies(const DataSet& data, const std::vector<int>& rows) {
  std::vector<int> all(static_cast<size_t>(data.rows.rows()));
  std::iota(all.begin(), all.end(), 0);
  all.insert(all.end(), rows.begin(), rows.end());
  DataSet more = data;
  more.rows = taken(data.rows, all);
  for (size_t i = static_cast<size_t>(data.rows.rows()); i < more.rows.repeat.size(); ++i)
    more.rows.repeat[i] = -1;
  return more;
}

/// Where the endpoint is, and how each joint moves it (6 x joints, world).
struct Endpoint {
  Location at;
  Eigen::MatrixXd J;
};

class CandidateSet {
 public:
  CandidateSet(const LinearisedModel& linearised, const DataSet& data)
      : linearised_(linearised),
        robot_(linearised.geometry()),
        xi_(linearised.adjusted().fitted.state.xi),
        data_(data),
        copies_(with_copies(data, spread_rows(data))),
        first_(data.rows.rows()) {}

  std::vector<CandidateRows> run() {
    twice_at_once();
    with_payload();
    if (data_.rows.velocity.rows() > 0) {
      DataSet back = copies_, fast = copies_;
      back.rows.velocity.bottomRows(count()) *= -1;
      fast.rows.velocity.bottomRows(count()) *= kDiagnosis.further_rows.faster;
      add("approached from the other side", std::move(back), "play or an after-effect");
      if (data_.speeds) add("at three times the speed", std::move(fast));
    }
    if (data_.rows.time.size() > 0) {
      DataSet again = copies_;
      again.rows.time.tail(count()).setConstant(linearised_.context().end + 1);
      add("once more at the end", std::move(again), "what changes with time");
    }
    joints_elsewhere();
    constexpr double kHalf = std::numbers::pi;
    add_postures("with the tool rolled about its axis", {kHalf, kHalf / 2, -kHalf / 2});
    if (!robot_.has_loops())
      add_postures("in another posture (elbow up and down, wrist turned)", {0});
    return std::move(list_);
  }

 private:
  Eigen::Index count() const { return copies_.rows.q.rows() - first_; }

  void add(const std::string& how, DataSet both, const std::string& tells = {}) {
    const Eigen::Index more = both.rows.q.rows() - first_;
    list_.push_back({"repeat " + std::to_string(more) + " rows " + how, std::move(both), tells});
  }

  /// Each of the copies as a repeat of itself.
  void twice_at_once() {
    std::vector<int> rows(static_cast<size_t>(first_));
    std::iota(rows.begin(), rows.end(), 0);
    for (auto row = static_cast<int>(first_); row < copies_.rows.rows(); ++row)
      rows.insert(rows.end(), 2, row);
    DataSet twice = copies_;
    twice.rows = taken(copies_.rows, rows);
    std::vector<int>& repeat = twice.rows.repeat;
    repeat.resize(rows.size(), -1);
    const int taken_ids = repeat.empty() ? 0 : std::ranges::max(repeat) + 1;
    for (auto i = static_cast<size_t>(first_); i < rows.size(); ++i)
      repeat[i] = taken_ids + rows[i] - static_cast<int>(first_);
    add("twice at once", std::move(twice), "how much is noise");
  }

  void with_payload() {
    if (!robot_.statics() || robot_.statics()->mechanics().gravity.norm() == 0) return;
    const Mechanics& mechanics = robot_.statics()->mechanics();
    double mass = 0;
    for (const Link& link : mechanics.links) mass += link.mass.value_or(0);
    // What it may carry is the file's to say: without that no figure is asked of anybody. Of that
    // the tool has what the rows say of it.
    const double carried = copies_.rows.wrench.rows() == 0
                               ? 0
                               : copies_.rows.wrench.leftCols<3>().rowwise().norm().maxCoeff() /
                                     mechanics.gravity.norm();
    const bool rated = linearised_.rated_payload() > 0;
    if (rated && linearised_.rated_payload() - carried < kLeastPayload) return;
    const double usual = mechanics.masses_known()
                             ? std::max(1.0, std::round(kDiagnosis.further_rows.of_mass * mass))
                             : kDiagnosis.further_rows.on_paper;
    const double payload = rated ? linearised_.rated_payload() - carried : usual;
    DataSet loaded = copies_;
    Observations& rows = loaded.rows;
    if (rows.wrench.rows() == 0) rows.wrench.setZero(rows.q.rows(), 6);
    for (Eigen::Index row = first_; row < rows.q.rows(); ++row)
      rows.wrench.row(row).head<3>() +=
          payload *
          (endpoint(rows.q.row(row).transpose()).at.R.transpose() * mechanics.gravity).transpose();
    add(rated ? "with the " + plain_figure(payload) + " kg more that the robot may carry"
              : "with a payload within the robot's rating",
        std::move(loaded), "what gives way to a load");
  }

  /// The ball that the touches of a set so far lie in: the surface may end there.
  Patch seen_of(int set) const {
    const Eigen::MatrixXd tips = linearised_.tips();
    std::vector<int> nuisance;
    for (int row = 0; row < first_; ++row)
      if (data_.rows.set[row] == set) nuisance.push_back(row);
    Patch patch;
    if (nuisance.empty()) return patch;
    patch.centre = tips(nuisance, Eigen::all).colwise().mean().transpose();
    for (const int row : nuisance)
      patch.radius = std::max(patch.radius, (tips.row(row).transpose() - patch.centre).norm());
    return patch;
  }

  /// Other configurations that touch the same surfaces, or any where nothing is touched. Rows of
  /// shared points stay: elsewhere they would be of another point.
  void joints_elsewhere() {
    DataSet elsewhere = copies_;
    Observations& rows = elsewhere.rows;
    std::vector<std::vector<int>> rows_of(data_.sets.size());
    for (auto row = static_cast<int>(first_); row < rows.rows(); ++row)
      rows_of[rows.set[row]].push_back(row);
    DataSet found;
    found.sets = data_.sets;
    std::vector<SampleRequest> requests;
    for (int s = 0; s < static_cast<int>(data_.sets.size()); ++s) {
      const Method& method = *data_.sets[s].method;
      if (method.group_freedom() > 0 || method.paired()) continue;
      SampleRequest request;
      request.set = s;
      request.rows = static_cast<int>(rows_of[s].size());
      request.nuisance = linearised_.adjusted().fitted.state.nuisance[s];
      if (method.constrains()) request.patch = seen_of(s);
      request.together = true;
      request.tries = kDiagnosis.further_rows.tries;
      requests.push_back(std::move(request));
    }
    Random random(1);
    sample_rows(robot_, xi_, requests, random, found);
    std::vector<size_t> used(data_.sets.size(), 0);
    for (int i = 0; i < found.rows.rows(); ++i) {
      const int s = found.rows.set[i];
      rows.q.row(rows_of[s][used[s]++]) = found.rows.q.row(i);
    }
    if (found.rows.rows() > 0)
      add("with the joints elsewhere in their range", std::move(elsewhere), "where it lies");
  }

  Endpoint endpoint(const Eigen::VectorXd& q) const {
    Locations X;
    PsiBlock psi;
    robot_.locate(block_of(q), xi_, Body::endpoint, X, &psi);
    Endpoint there{X.at(0), {}};
    robot_.joint_jacobian(block_of(q), xi_, Body::endpoint, psi, there.J);
    return there;
  }

  /// Readings within the limits that bring the endpoint to `place`: of those found, the farthest
  /// from `q`. Nothing where none is another one.
  std::optional<Eigen::VectorXd> posture(const Location& place, const Eigen::VectorXd& q) const {
    Problems problems;
    Node node = Node::map();
    node.set("method", Node::of(std::string("location-constraint")));
    DataSet found;
    found.sets.push_back(make_set("place", node, problems));
    expects(!problems.any(), "a location constraint needs nothing else");
    SampleRequest request;
    request.rows = request.rows_per_group = kDiagnosis.further_rows.postures;
    request.places = {place};
    request.together = true;
    // Of closed loops a place determines the readings: the first starts find them, or none do.
    request.tries = robot_.has_loops() ? 1 : kDiagnosis.further_rows.tries;
    Random random(1);
    sample_rows(robot_, xi_, {request}, random, found);
    std::optional<Eigen::VectorXd> best;
    double farthest = kDiagnosis.further_rows.another;
    for (Eigen::Index row = 0; row < found.rows.q.rows(); ++row) {
      const Eigen::VectorXd other = found.rows.q.row(row).transpose();
      const double far = ((other - q).array().abs() / units_of_readings(robot_)).maxCoeff();
      if (far < farthest) continue;
      farthest = far;
      best = other;
    }
    return best;
  }

  struct Reached {
    Eigen::VectorXd q;
    Eigen::Matrix3d turned;  ///< the tool in its own axes
  };
  /// The endpoint of `q` in another posture, by the first of `rolls` that reaches one.
  std::optional<Reached> reach(const Location& place, const Eigen::VectorXd& q,
                               std::initializer_list<double> rolls) const {
    for (const double roll : rolls) {
      const Eigen::Matrix3d turned = Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()).matrix();
      if (const auto other = posture({place.R * turned, place.p}, q))
        return Reached{*other, turned};
    }
    return std::nullopt;
  }

  /// The same endpoint in another posture, with the tool rolled about its axis by one of `rolls`
  /// (rad). It is approached as before, and what pulls at the tool keeps its direction.
  void add_postures(const char* how, std::initializer_list<double> rolls) {
    DataSet others = copies_;
    Observations& rows = others.rows;
    std::vector<int> take(static_cast<size_t>(first_));
    std::iota(take.begin(), take.end(), 0);
    for (Eigen::Index row = first_; row < rows.q.rows(); ++row) {
      const Eigen::VectorXd q = rows.q.row(row).transpose();
      const Endpoint before = endpoint(q);
      const auto reached = reach(before.at, q, rolls);
      if (!reached) continue;
      take.push_back(static_cast<int>(row));
      rows.q.row(row) = reached->q.transpose();
      if (rows.velocity.rows() > 0 && rows.velocity.row(row).allFinite())
        rows.velocity.row(row) =
            least_squares(endpoint(reached->q).J, before.J * rows.velocity.row(row).transpose())
                .transpose();
      for (Eigen::Index part = 0; part < rows.wrench.cols(); part += 3)
        rows.wrench.row(row).segment<3>(part) *= reached->turned;
    }
    if (static_cast<Eigen::Index>(take.size()) < first_ + kDiagnosis.further_rows.fewest) return;
    rows = taken(rows, take);
    add(how, std::move(others));
  }

  const LinearisedModel& linearised_;
  const Robot& robot_;
  const Eigen::VectorXd& xi_;
  const DataSet& data_;
  const DataSet copies_;  ///< the rows at hand and after them some of them once more
  const Eigen::Index first_;
  std::vector<CandidateRows> list_;
};

}  // namespace

std::vector<CandidateRows> candidate_rows(const LinearisedModel& linearised, const DataSet& data) {
  return CandidateSet(linearised, data).run();
}

}  // namespace selfcal
