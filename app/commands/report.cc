// selfcal report SESSION: a stored session as a page, from its rows solved once more.
#include <cstdio>
#include <memory>

#include "app/commands/subcommand.h"
#include "app/commands/support/find_store.h"
#include "app/commands/support/session_export.h"
#include "app/report/format.h"
#include "app/report/page/diagnosis_page.h"
#include "app/report/page/identification_page.h"
#include "app/report/progress_line.h"
#include "app/service/transitions/state.h"
#include "constraints/estimation/engagements.h"
#include "diagnosis/diagnosis.h"
#include "io/files/file.h"
#include "io/files/json_parts.h"

namespace selfcal {
namespace {

struct ReportArguments {
  std::int64_t session = 0;
  std::string where, out = "report.html";
};

/// What to do about a result that improves the robot, once something was decided; empty before.
std::string_view next_of(ResultDecision decision) {
  switch (decision) {
    case ResultDecision::none:
      return "";
    case ResultDecision::candidate:
      return "It waits for a person: look at the changes, then `selfcal command accept` or "
             "`reject`.";
    case ResultDecision::applying:
    case ResultDecision::applied:
      return "It was accepted and applied: `selfcal history` shows which parameters are in use, "
             "`selfcal command rollback` goes back to those before.";
    case ResultDecision::rejected:
      return "It was rejected: the parameters before it stay.";
    case ResultDecision::replaced:
      return "A newer result took its place before anybody had decided.";
    case ResultDecision::rolled_back:
      return "It was applied and given up afterwards: the parameters before it are back.";
  }
  return "";
}

/// What the store has of the session beside its rows.
nlohmann::ordered_json session_json(const SessionRecord& record,
                                    const std::optional<ResultRecord>& result) {
  nlohmann::ordered_json json = {{"number", record.id},
                                 {"kind", record.kind},
                                 {"when", date_time(record.started_ms)},
                                 {"reason", record.reason}};
  if (!result) return json;
  json["decision"] = to_string(result->decision);
  json["in_use"] = {{"before", finite(result->check_before)},
                    {"after", finite(result->check_after)}};
  return json;
}

/// Of a session that looked for a cause: its rows diagnosed once more.
std::string cause_page(const SessionRows& rows, const nlohmann::ordered_json& session) {
  ProgressLine line;
  const Findings found{
      "session " + std::to_string(rows.record.id),
      diagnose(rows.robot, rows.data, {},
               [&](std::string_view stage, double share) { line.show(stage, share); }),
      {},
      {}};
  nlohmann::ordered_json data =
      diagnosis_data({*rows.robot, rows.data, found.name, unix_now_ms()}, found);
  data["session"] = session;
  return page_of(data);
}

Result<void> write_page(const ReportArguments& arguments) {
  const auto source = find_store(arguments.where);
  if (!source) return tl::unexpected(source.error());
  const auto store = Store::open_to_read(source->state);
  if (!store) return tl::unexpected(store.error());
  const auto record = (*store)->session(arguments.session);
  if (!record) return tl::unexpected(record.error());
  if (record->kind == to_string(SessionKind::check))
    return bad_input("session " + std::to_string(record->id) +
                     " is a quick check: its touches are too few to calibrate by, `selfcal "
                     "history` says what it found");
  const auto rows = session_rows(**store, arguments.session, source->robot_text);
  if (!rows) return tl::unexpected(rows.error());
  const auto result = (*store)->result(rows->record.id);
  if (!result) return tl::unexpected(result.error());
  const nlohmann::ordered_json session = session_json(rows->record, *result);
  if (rows->record.kind == to_string(SessionKind::cause))
    return write_file_atomically(arguments.out, cause_page(*rows, session));
  if (const std::string why = lacking_reference(rows->data); !why.empty())
    return bad_input("session " + std::to_string(record->id) +
                     " cannot be solved from the touches that it has: " + why);
  Engagements found;
  {
    ProgressLine line;
    found = identify_engagements(
        *rows->robot, rows->data, {},
        [&](std::string_view stage, double share) { line.show(stage, share); });
  }
  const PageSubject subject{*rows->robot, found.data,
                            "session " + std::to_string(arguments.session), unix_now_ms()};
  nlohmann::ordered_json data = identification_data(subject, found.solution);
  data["session"] = session;
  if (*result && found.solution.verdict.answer == Answer::improved)
    if (const std::string_view next = next_of((*result)->decision); !next.empty())
      data["verdict"]["next"].front() = next;  // what a candidate asks for; the rest still holds
  return write_file_atomically(arguments.out, page_of(data));
}

}  // namespace

void add_report(CLI::App& app, int& status) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command =
      app.add_subcommand("report", "Write a stored session's report, a page to open in a browser");
  command->add_option("SESSION", arguments->session, "Its number, as history shows it")
      ->required()
      ->check(CLI::PositiveNumber);
  command->add_option("WHERE", arguments->where, kStoreIsWhere);
  command->add_option("--out", arguments->out, "The page's file")->capture_default_str();
  command->callback([arguments, &status] {
    const auto written = write_page(*arguments);
    if (written) std::printf("%s\n", arguments->out.c_str());
    status = written ? kDone : tell(written.error());
  });
}

}  // namespace selfcal
