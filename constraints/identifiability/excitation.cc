// Excitation (Khalil and Dombre, 11.4.2.2): structural rank against the rank of the rows at hand.
#include "constraints/identifiability/excitation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <tuple>

#include "constraints/identifiability/lost.h"
#include "constraints/sampling/configurations.h"

namespace selfcal {
namespace {

constexpr int kRows = 80;        ///< random ones of a set that tell what such rows can
constexpr double kHardly = 0.1;  ///< of a joint's range: it hardly moved
constexpr double kMostly = 0.8;  ///< of a joint's range: little of it is left to move through

/// Range of joint j over the rows that identify, and over what it could do.
struct Movement {
  double moved = 0, possible = 0;
  double share() const { return moved / possible; }
};

Movement movement(const Robot& robot, const DataSet& data, size_t j) {
  double lower = HUGE_VAL, upper = -HUGE_VAL;
  for (int row = 0; row < data.rows.rows(); ++row) {
    if (data.rows.check[row]) continue;
    lower = std::min(lower, data.rows.q(row, static_cast<Eigen::Index>(j)));
    upper = std::max(upper, data.rows.q(row, static_cast<Eigen::Index>(j)));
  }
  return {upper - lower, robot.joints()[j].range()};
}

/// The joint whose movement parameter `p` needs most: of its own frame and the ones around it, the
/// one that moved least of what it could.
size_t missing_joint(const Robot& robot, const DataSet& data, const Parameter& p) {
  const int nuisance = find_joint(robot, p.frame);
  size_t at = nuisance < 0 ? 0 : static_cast<size_t>(nuisance);
  if (const Statics* statics = robot.statics(); statics && nuisance < 0)
    for (const Link& link : statics->mechanics().links) {
      if (link.frame == p.frame) break;
      if (link.joint >= 0) ++at;
    }
  size_t best = std::min(at, robot.joints().size() - 1);
  for (size_t j = at > 0 ? at - 1 : 0; j <= at + 1 && j < robot.joints().size(); ++j)
    if (movement(robot, data, j).share() < movement(robot, data, best).share()) best = j;
  return best;
}

Note what_is_missing(const Robot& robot, const DataSet& data, const Parameter& p,
                     const std::vector<Carrier>& carriers) {
  const size_t j = missing_joint(robot, data, p);
  const Joint& joint = robot.joints()[j];
  const Movement m = movement(robot, data, j);
  char text[200];
  if (m.share() < kHardly) {
    std::snprintf(text, sizeof text, "%s moved through %.3g %s only", joint.name.c_str(),
                  1e3 * m.moved, joint.quantity == Quantity::angle ? "mrad" : "mm");
    return {p.name, text, joint.name};
  }
  std::string names;
  for (size_t i = 0; i < carriers.size() && i < 3; ++i) names += (i ? ", " : "") + carriers[i].name;
  const std::string seen = names.empty() ? std::string("hardly seen by these rows; ")
                                         : "not told from " + names + " by these rows; ";
  if (m.share() > kMostly) return {p.name, seen + "more rows in other postures would help"};
  std::snprintf(text, sizeof text, "more movement of %s (%.0f %% of its range so far)",
                joint.name.c_str(), 100 * m.share());
  return {p.name, seen + text + " would help", joint.name};
}

/// By set, so many random rows that they tell all that such sets can: of sets alike, many together
/// what a few do, and each enough for what is its own. None of a set that does not identify.
std::vector<int> rows_that_tell(const DataSet& data) {
  constexpr int kOfAlike = 4 * kRows;
  constexpr int kBeyondOwn = 12;  // equations beside those that a set's own values take
  std::vector<char> used(data.sets.size(), 0);
  for (int row = 0; row < data.rows.rows(); ++row)
    if (!data.rows.check[row]) used[data.rows.set[row]] = 1;
  using Kind = std::tuple<std::string, Body, int, bool>;
  const auto kind = [&](size_t s) {
    const Method& method = *data.sets[s].method;
    return Kind(method.name(), method.body(), method.tangent_dimension(),
                data.sets[s].reference >= 0);
  };
  std::map<Kind, int> alike;
  for (size_t s = 0; s < used.size(); ++s)
    if (used[s]) ++alike[kind(s)];
  std::vector<int> rows(data.sets.size(), 0);
  for (size_t s = 0; s < used.size(); ++s)
    if (used[s])
      rows[s] = std::clamp(kOfAlike / alike[kind(s)],
                           data.sets[s].method->tangent_dimension() + kBeyondOwn, kRows);
  return rows;
}

/// What is told of the robot with all joints free, but not with those held.
std::vector<Lost> lost_by_holding(const Robot& robot, const Identifiability& free,
                                  const Identifiability& locked, const std::vector<int>& held) {
  Lost lost;
  lost.count = free.total() - locked.total();
  if (lost.count <= 0) return {};
  std::string names;
  for (const int joint : held)
    names += (names.empty() ? "" : " and ") + robot.joints()[static_cast<size_t>(joint)].name;
  lost.why = names + (held.size() > 1 ? " are each" : " is") +
             " held at one reading: the links on its two sides are one body, whose place in the "
             "other says all of them, and a gear does what its joint's zero does";
  for (size_t i = 0; i < robot.parameters().size(); ++i)
    if (free.status[i] == Status::identified && locked.status[i] != Status::identified)
      lost.parameters.push_back(robot.parameters()[i].name);
  return {lost};
}

}  // namespace

StructuralRank structural(const Robot& robot, const std::vector<Set>& sets,
                          const std::vector<char>& free_mask, int rows, unsigned long long seed,
                          const std::vector<int>& most, const std::vector<int>& held) {
  DataSet data;
  std::vector<SampleRequest> requests;
  for (size_t s = 0; s < sets.size(); ++s) {
    data.sets.push_back(sets[s]);
    data.sets.back().groups.clear();
    SampleRequest request;
    request.set = static_cast<int>(s);
    request.rows = most.empty() ? rows : std::min(rows, most[s]);
    request.held = held;
    request.together =
        held.empty() && !sets[s].method->paired() && sets[s].method->group_freedom() == 0;
    requests.push_back(request);
  }
  Random random(seed);
  const Eigen::VectorXd xi = nominal_values(robot);
  const Sampled sampled = sample_rows(robot, xi, requests, random, data);
  const Equations equations(robot, data, Use::fit);
  State state = sampled.truth;
  state.xi = xi;
  Weighting weighting{std::vector<Scale>(sets.size()), std::vector<char>(data.rows.rows(), 0)};
  weighting.structural = true;  // among rows of sigma 1, others would bring rounding above tau
  const Linearised at = equations.linearise(state, weighting);
  RankRule rule;
  rule.rows = at.equations;
  StructuralRank result{identifiability(equations, at.R, state, free_mask, rule),
                        equations.nuisance_dimensions(),
                        {},
                        sampled.unreached};
  const auto asked = static_cast<int>(std::count(free_mask.begin(), free_mask.end(), char{1}));
  if (!robot.frame_motions(xi).empty())
    result.lost = lost_directions(equations, at.R, state, free_mask, asked - result.rank.total());
  if (held.empty() || !result.unreached.empty()) return result;
  const StructuralRank free = structural(robot, sets, free_mask, rows, seed, most);
  if (free.unreached.empty())
    for (Lost& lost : lost_by_holding(robot, free.rank, result.rank, held))
      result.lost.push_back(std::move(lost));
  return result;
}

std::vector<Note> unexcited(const Robot& robot, const DataSet& data, const Identifiability& rank,
                            const std::vector<char>& free_mask) {
  if (std::ranges::none_of(rank.status, [](Status status) {
        return status == Status::grouped || status == Status::no_effect;
      }))
    return {};  // other rows could tell no more
  const Identifiability possible =
      structural(robot, data.sets, free_mask, kRows, 1, rows_that_tell(data)).rank;
  std::vector<Note> notes;
  for (size_t i = 0; i < robot.parameters().size(); ++i)
    if (possible.status[i] == Status::identified &&
        (rank.status[i] == Status::grouped || rank.status[i] == Status::no_effect))
      notes.push_back(what_is_missing(robot, data, robot.parameters()[i], rank.grouped_with[i]));
  return notes;
}

}  // namespace selfcal
