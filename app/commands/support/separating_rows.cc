#include "app/commands/support/separating_rows.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "app/report/format.h"
#include "constraints/planning/tour.h"
#include "diagnosis/constants.h"
#include "diagnosis/evidence/hypothesis.h"
#include "io/files/file.h"
#include "io/files/json_parts.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostBytes = 64 << 20;  // of a diagnosis

/// A list of numbers or nulls as a row of `width` cells.
Eigen::RowVectorXd cells(const Json& list, Eigen::Index width) {
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Constant(width, std::nan(""));
  for (Eigen::Index i = 0; i < width && i < static_cast<Eigen::Index>(list.size()); ++i)
    if (const Json& each = list.at(static_cast<std::size_t>(i)); !each.is_null())
      row[i] = each.get<double>();
  return row;
}

int index_of(const std::string& name, std::vector<std::string>& names) {
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  names.push_back(name);
  return static_cast<int>(names.size()) - 1;
}

/// Throws what nlohmann::json throws where `list` is not as diagnose writes it; nothing where rows
/// have no readings, or not as many as others.
std::optional<DataSet> rows_of(const Json& list) {
  DataSet data;
  data.order_is_time = false;
  Observations& rows = data.rows;
  const auto count = static_cast<Eigen::Index>(list.size());
  if (count == 0) return data;
  const auto joints = static_cast<Eigen::Index>(list.front().at("q").size());
  rows.q.setConstant(count, joints, std::nan(""));
  rows.wrench.setConstant(count, 6, std::nan(""));
  rows.velocity.setConstant(count, joints, std::nan(""));
  rows.time.setConstant(count, std::nan(""));
  rows.noise_factor.setOnes(count);
  std::vector<std::string> sets, repeats;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Json& each = list.at(static_cast<std::size_t>(i));
    const Json& q = each.at("q");
    if (joints == 0 || static_cast<Eigen::Index>(q.size()) != joints) return std::nullopt;
    rows.q.row(i) = cells(q, joints);
    if (each.contains("wrench")) rows.wrench.row(i) = cells(each.at("wrench"), 6);
    if (each.contains("dq")) rows.velocity.row(i) = cells(each.at("dq"), joints);
    if (each.contains("time") && !each.at("time").is_null()) rows.time[i] = each.at("time");
    rows.set.push_back(index_of(each.at("set"), sets));
    rows.group.push_back(-1);
    rows.check.push_back(0);
    rows.repeat.push_back(each.contains("repeat") ? index_of(each.at("repeat"), repeats) : -1);
  }
  for (const std::string& name : sets) {
    data.sets.emplace_back();
    data.sets.back().name = name;
  }
  return data;
}

/// In the order of a short tour; repeats stay together.
void order(DataSet& data) {
  const Observations& rows = data.rows;
  std::vector<std::vector<int>> visits;
  for (int row = 0; row < rows.rows(); ++row) {
    if (row > 0 && rows.repeat[row] >= 0 && rows.repeat[row] == rows.repeat[row - 1])
      visits.back().push_back(row);
    else
      visits.push_back({row});
  }
  if (visits.empty()) return;
  std::vector<Visit> places;
  for (const std::vector<int>& each : visits) {
    const Eigen::VectorXd q = rows.q.row(each.front()).transpose();
    places.push_back({q, q});
  }
  std::vector<int> all;
  for (const int visit : short_tour(places, Eigen::VectorXd::Ones(rows.q.cols())))
    all.insert(all.end(), visits[static_cast<std::size_t>(visit)].begin(),
               visits[static_cast<std::size_t>(visit)].end());
  data.rows = taken(data.rows, all);
}

}  // namespace

bool SeparatingStep::settles() const { return !(probability_after < kDiagnosis.report.settled); }

Result<SeparatingRows> read_separating_rows(const std::string& file) {
  const auto text = read_file(file, kMostBytes);
  if (!text) return tl::unexpected(text.error());
  try {
    const Json json = Json::parse(*text);
    SeparatingRows result;
    const bool whole = json.contains("next");
    result.why = json.value(whole ? "next_why" : "why", "");
    for (const Json& each : json.at(whole ? "next" : "steps")) {
      SeparatingStep step;
      step.what = each.at("what");
      step.separates = each.at("separates").get<std::vector<std::string>>();
      const Json& probability = each.at("probability_after");
      step.probability_after = probability.is_null() ? std::nan("") : probability.get<double>();
      std::optional<DataSet> rows = rows_of(each.at("rows"));
      if (!rows)
        return bad_input(file + ": the rows of step " + std::to_string(result.steps.size() + 1) +
                         " have no readings q, or not as many as one another");
      step.rows = std::move(*rows);
      order(step.rows);
      result.steps.push_back(std::move(step));
    }
    return result;
  } catch (const nlohmann::json::exception& error) {
    return bad_input(
        file + ": expected what `diagnose` writes as diagnosis.json or --next: " + error.what());
  }
}

std::string separating_report(const SeparatingRows& rows) {
  std::string text;
  for (std::size_t i = 0; i < rows.steps.size(); ++i) {
    const SeparatingStep& step = rows.steps[i];
    const bool closer = std::isnan(step.probability_after);  // at what no known effect explains
    std::string names;
    for (const std::string& each : step.separates)
      if (!closer || each != kUnknown) names += (names.empty() ? "" : " from ") + each;
    text += printed("%zu  %s: tells %s", i + 1, step.what.c_str(), names.c_str());
    text += closer ? "\n"
                   : printed(", which is then %.0f %% sure%s\n", 100 * step.probability_after,
                             step.settles() ? "" : ": not enough to name it");
  }
  if (!rows.why.empty())
    text += (rows.steps.empty() ? "nothing to measure: " : "") + rows.why + "\n";
  return text;
}

}  // namespace selfcal
