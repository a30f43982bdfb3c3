#include "app/report/page/diagnosis_page.h"

#include <cmath>

#include "app/report/diagnosis_json.h"
#include "app/report/format.h"
#include "app/report/gap_report.h"
#include "app/report/page/robot_picture.h"
#include "io/files/json_parts.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostValidationRows = 5000;  // of a page below 2 MB
constexpr int kMostDiagnosisPoses = 12;

Json validation_json(const std::vector<ValidationRow>& rows) {
  Json json = {{"of", rows.size()}};
  const std::size_t step =
      std::max<std::size_t>(1, (rows.size() + kMostValidationRows - 1) / kMostValidationRows);
  const auto column = [&](const char* name, double ValidationRow::*squared) {
    json[name] = Json::array();
    for (std::size_t i = 0; i < rows.size(); i += step)
      if (!rows[i].false_reading) json[name].push_back(finite(std::sqrt(rows[i].*squared)));
  };
  column("nominal", &ValidationRow::nominal);
  column("before", &ValidationRow::before);
  column("after", &ValidationRow::after);
  column("all", &ValidationRow::all);
  return json;
}

std::vector<std::string> next_sentences(const Diagnosis& diagnosis) {
  std::vector<std::string> list;
  for (const NextStep& step : diagnosis.next) list.push_back(step.what + next_in_words(step));
  if (list.empty() && !diagnosis.next_why.empty()) list.push_back("nothing: " + diagnosis.next_why);
  return list;
}

}  // namespace

std::vector<std::string> simulator_sentences(const Findings& findings) {
  std::vector<std::string> list;
  if (!findings.sim) return list;
  if (findings.sim->gap) list.push_back(gap_in_words(*findings.sim->gap));
  if (const auto& mended = findings.sim->mended; mended && mended->gap.rows > 0) {
    list.push_back("mended by what was found in the robot and run again, " + mm(mended->gap.rms) +
                   " mm, of which " + mm(findings.diagnosis.gap.noise_floor) + " mm are noise");
    std::string left;
    for (const std::string& each : mended->left_out) left += (left.empty() ? "" : "; ") + each;
    if (!left.empty()) list.push_back("the mended model lacks: " + left);
  }
  for (const std::string& each : findings.sim->differences.sentences) list.push_back(each);
  return list;
}

Json to_json(const Findings& findings) {
  Json json = to_json(findings.diagnosis);
  if (findings.since) json["since"] = to_json(findings.since->comparison);
  if (findings.sim) {
    json["sim"] = to_json(findings.sim->differences);
    if (findings.sim->gap)
      json["sim"]["gap"] = {{"rms", finite(findings.sim->gap->rms)},
                            {"rows", findings.sim->gap->rows}};
    if (const auto& mended = findings.sim->mended)
      json["sim"]["mended"] = {{"rms", finite(mended->gap.rms)},
                               {"rows", mended->gap.rows},
                               {"left_out", mended->left_out}};
  }
  return json;
}

Json diagnosis_data(const PageSubject& subject, const Findings& findings) {
  const Diagnosis& diagnosis = findings.diagnosis;
  Json json = page_begin("diagnosis", subject);
  json["verdict"] = {{"sentence", diagnosis.why},
                     {"effect", diagnosis.verdict.effect},
                     {"next", next_sentences(diagnosis)}};
  json["result"] = to_json(findings);
  json["words"] = {{"named", named_in_words(diagnosis)},
                   {"found", found_in_words(diagnosis)},
                   {"closed", closed_in_words(diagnosis)},
                   {"false_rows", false_rows_in_words(diagnosis)},
                   {"simulator", simulator_sentences(findings)}};
  if (findings.since) json["since_name"] = findings.since->name;
  if (findings.sim) json["sim_name"] = findings.sim->name;
  if (!diagnosis.validation_rows.empty())
    json["judged"] = validation_json(diagnosis.validation_rows);
  json["picture"] = robot_picture(subject.robot, subject.data.rows.q, kMostDiagnosisPoses);
  return json;
}

}  // namespace selfcal
