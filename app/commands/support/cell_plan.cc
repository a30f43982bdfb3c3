#include "app/commands/support/cell_plan.h"

#include <algorithm>

#include "app/report/curve_report.h"
#include "app/report/format.h"
#include "io/files/json_parts.h"
#include "io/files/observations_text.h"

namespace selfcal {
namespace {

struct SetCount {
  int touches = 0, check = 0, home = 0;
};

SetCount count_of(const TouchPlan& plan, int set) {
  SetCount count;
  for (const PlannedTouch& touch : plan.touches)
    if (touch.set == set) {
      ++count.touches;
      count.check += touch.check;
      count.home += touch.via_home;
    }
  return count;
}

/// What is lacking; empty where the plan is whole.
std::string lacking(const CellPlan& cell) {
  if (!cell.plan.unreached.empty()) return cell.plan.unreached;
  const int poses = cell.expected.workspace.poses;
  if (poses == 0) return "the robot does not reach the workspace";
  return poses < kFewestPoses ? "the robot hardly reaches the workspace: check its box and cone"
                              : "";
}

}  // namespace

bool CellPlan::reaches(const Config& config) const {
  return lacking(*this).empty() && known_to(expected.workspace, config.target);
}

CellPlan plan_cell(const Config& config, const Progress& progress) {
  const Eigen::VectorXd xi = values(*config.robot);
  CellPlan cell;
  cell.plan = plan_touches(*config.robot, xi, config.sets, config.targets, config.obstacles,
                           config.workspace, config.plan, progress);
  if (!cell.plan.unreached.empty()) return cell;
  if (progress) progress("how well the end position is known then", 0);
  cell.expected = expected_sigma(*config.robot, xi, config.sets, config.targets, cell.plan,
                                 config.workspace, progress, config.plan.known.prior);
  cell.time = motion_time(*config.robot, xi, cell.plan, config.plan);
  return cell;
}

std::string cell_plan_report(const Config& config, const CellPlan& cell) {
  std::string text;
  int name_width = 0, method_width = 0;
  for (const Set& set : config.sets) {
    name_width = std::max(name_width, characters(set.name));
    method_width = std::max(method_width, characters(set.method->name()));
  }
  for (int s = 0; s < static_cast<int>(config.sets.size()); ++s) {
    const Set& set = config.sets[static_cast<std::size_t>(s)];
    const SetCount count = count_of(cell.plan, s);
    text += "  " + padded(set.name, name_width) + "  " + padded(set.method->name(), method_width) +
            printed(" %4d touches, %d to check, %d reached through home\n", count.touches,
                    count.check, count.home);
  }
  if (!cell.plan.left_out.empty()) text += "  " + cell.plan.left_out + "\n";
  if (const std::string what = lacking(cell); !what.empty())
    return text + "  no plan: " + what + "\n";
  text += printed(
      "  end position known then to %.3g mm in the workspace (1 sigma; worst %.3g mm), to %.3g mm "
      "over the whole range of the joints\n",
      1e3 * cell.expected.workspace.rms, 1e3 * cell.expected.workspace.max,
      1e3 * cell.expected.endpoint.rms);
  text += printed("  motion at most %s: %s between touches, %s into contacts and out\n",
                  duration(cell.time.total()).c_str(), duration(cell.time.travel).c_str(),
                  duration(cell.time.touching).c_str());
  text += curve_report(cell.expected.curve, config.target, "touches that identify", "  ");
  return text + printed("  target %.3g mm: %s\n", 1e3 * config.target,
                        cell.reaches(config)
                            ? "yes"
                            : "no; plan more touches or surfaces, or give a known length (a step, "
                              "a ball or sockets a known distance apart)");
}

nlohmann::ordered_json cell_plan_json(const Config& config, const CellPlan& cell) {
  const auto q_of = [](const Eigen::VectorXd& q) { return array_of(q, finite); };
  const std::string what = lacking(cell);
  Json json{{"robot", config.robot->name()}, {"problem", what}, {"target", config.target}};
  const auto sigma = [&](const EndpointSigma& each) {
    return what.empty() ? Json{{"rms", finite(each.rms)}, {"max", finite(each.max)}}
                        : Json(nullptr);
  };
  json["sigma"] = sigma(cell.expected.workspace);
  json["sigma_range"] = sigma(cell.expected.endpoint);
  json["reached"] = cell.reaches(config);
  put_curve(cell.expected.curve, config.target, json);
  json["motion"] = {{"travel", cell.time.travel}, {"touching", cell.time.touching}};
  json["configurations"] = array_of(cell.plan.touches, [&](const PlannedTouch& touch) {
    Json each{{"set", config.sets[static_cast<std::size_t>(touch.set)].name},
              {"part", touch.check ? "check" : "fit"},
              {"q", q_of(touch.touch)},
              {"start", q_of(touch.start)},
              {"end", q_of(touch.end)}};
    std::vector<Eigen::VectorXd> way = touch.way;
    if (touch.via_home) way = {config.plan.home};
    each["way"] = array_of(way, q_of);
    return each;
  });
  return json;
}

DataSet cell_plan_data(const Config& config, const CellPlan& cell) {
  DataSet data;
  data.sets = config.sets;
  const auto count = static_cast<Eigen::Index>(cell.plan.touches.size());
  data.rows.q.resize(count, static_cast<Eigen::Index>(config.robot->joints().size()));
  data.rows.noise_factor.setOnes(count);
  for (const PlannedTouch& touch : cell.plan.touches) {
    data.rows.q.row(static_cast<Eigen::Index>(data.rows.set.size())) = touch.touch.transpose();
    data.rows.set.push_back(touch.set);
    data.rows.group.push_back(touch.group);
    data.rows.check.push_back(touch.check ? 1 : 0);
    std::vector<std::string>& groups = data.sets[static_cast<std::size_t>(touch.set)].groups;
    while (static_cast<int>(groups.size()) <= touch.group)
      groups.push_back("g" + std::to_string(groups.size()));
  }
  return data;
}

std::string cell_plan_rows(const Config& config, const CellPlan& cell) {
  return observations_text(cell_plan_data(config, cell));
}

}  // namespace selfcal
