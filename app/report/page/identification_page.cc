// Rows as columns of numbers with five significant digits: a picture needs no more, and a page is
// to stay small.
#include "app/report/page/identification_page.h"

#include <algorithm>
#include <cstdlib>

#include "app/report/format.h"
#include "app/report/next_steps.h"
#include "app/report/page/robot_picture.h"
#include "app/report/summary.h"
#include "io/files/json_parts.h"
#include "io/files/robot_file.h"
#include "io/files/solution_json.h"

namespace selfcal {
namespace {

constexpr int kMostRows = 2000;  // of a page below 2 MB
constexpr int kMostPoses = 24;

Json short_number(double number) {
  if (!std::isfinite(number)) return nullptr;
  return std::strtod(printed("%.5g", number).c_str(), nullptr);
}

template <class Vector>
Json short_vector(const Vector& vector) {
  return array_of(vector, short_number);
}

/// Every how many-th row is kept.
std::size_t step_of(std::size_t rows) { return (rows + kMostRows - 1) / kMostRows; }

/// The rows that a page has room for: of many, one of so many.
std::vector<const RowFigure*> chosen(const std::vector<RowFigure>& rows) {
  std::vector<const RowFigure*> list;
  const std::size_t step = std::max<std::size_t>(1, step_of(rows.size()));
  for (std::size_t i = 0; i < rows.size(); i += step) list.push_back(&rows[i]);
  return list;
}

/// A column of `data`, if the file has it: `of` a row's number.
template <class Of>
void add_column(Json& json, const char* name, bool there, const std::vector<const RowFigure*>& rows,
                Of of) {
  if (!there) return;
  json[name] = array_of(rows, [&](const RowFigure* each) { return of(each->row); });
}

Json rows_json(const DataSet& data, const std::vector<RowFigure>& all) {
  const std::vector<const RowFigure*> rows = chosen(all);
  const Observations& o = data.rows;
  Json json = {{"of", all.size()}};
  const auto each = [&](const char* name, auto of) {
    json[name] = array_of(rows, [&](const RowFigure* row) { return Json(of(*row)); });
  };
  each("row", [](const RowFigure& r) { return r.row + 1; });
  each("set", [](const RowFigure& r) { return r.set; });
  each("check", [](const RowFigure& r) { return r.check ? 1 : 0; });
  each("rejected", [](const RowFigure& r) { return r.outlier ? 1 : 0; });
  each("angle_alone",
       [&](const RowFigure& r) { return data.sets[r.set].method->has_lengths() ? 0 : 1; });
  each("before", [](const RowFigure& r) { return short_number(r.before); });
  each("after", [](const RowFigure& r) { return short_number(r.after); });
  each("at", [](const RowFigure& r) { return short_vector(r.at); });
  each("way_before", [](const RowFigure& r) { return short_vector(r.way_before); });
  each("way_after", [](const RowFigure& r) { return short_vector(r.way_after); });
  each("q", [&](const RowFigure& r) { return short_vector(o.q.row(r.row)); });
  add_column(json, "load", o.wrench.rows() > 0, rows,
             [&](int row) { return short_number(o.wrench.row(row).head<3>().norm()); });
  add_column(json, "dq", o.velocity.rows() > 0, rows,
             [&](int row) { return short_vector(o.velocity.row(row)); });
  add_column(json, "temperature", o.temperature.rows() > 0, rows,
             [&](int row) { return short_number(o.temperature[row]); });
  return json;
}

Json result_json(const Robot& robot, const Solution& solution) {
  Json json = to_json(solution, robot.name(), model_hash(robot));
  json.erase("covariance");
  for (Json& set : json["sets"]) set.erase("own");
  return json;
}

}  // namespace

Json identification_data(const PageSubject& subject, const Solution& solution) {
  Json json = page_begin("identification", subject);
  json["verdict"] = {{"answer", to_string(solution.verdict.answer)},
                     {"sentence", headline(solution)},
                     {"why", solution.verdict.why},
                     {"next", next_steps(subject.data, solution)}};
  json["result"] = result_json(subject.robot, solution);
  json["full_names"] = Json::object();
  for (const ParameterResult& each : solution.parameters)
    json["full_names"][each.parameter.name] = full_name(each.parameter);
  if (solution.residual.rows.empty()) return json;
  json["rows"] = rows_json(subject.data, solution.residual.rows);
  json["picture"] = robot_picture(subject.robot, subject.data.rows.q, kMostPoses);
  return json;
}

}  // namespace selfcal
