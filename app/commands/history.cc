// selfcal history: past sessions and results, how the parameters drifted, which slots are filled.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <set>

#include "app/commands/subcommand.h"
#include "app/commands/support/find_store.h"
#include "app/commands/support/session_export.h"
#include "app/report/drift.h"
#include "app/report/format.h"
#include "app/report/live/message_json.h"
#include "app/report/page/history_page.h"
#include "app/report/past.h"
#include "app/service/config/config.h"
#include "app/service/session/decoding.h"
#include "app/service/transitions/state.h"
#include "io/files/file.h"
#include "io/files/json_parts.h"

namespace selfcal {
namespace {

constexpr std::size_t kDrifting = 8;  // parameters shown
constexpr int kAll = 1'000'000;       // more than any store has

struct HistoryArguments {
  std::string where;
  std::vector<std::string> exported;  // session, folder
  std::string report;                 // the page's file
  int newest = 20;
  bool json = false, events = false;
};

void print_sessions(const std::vector<Past>& past) {
  std::printf("%7s  %-16s  %-5s  %-14s  %-11s  %8s %8s %8s  %7s %5s %4s\n", "session", "when",
              "kind", "answer", "decision", "before", "after", "end pos", "touches", "aside",
              "par");
  std::printf("%63s%8s %8s %8s\n", "", "mm", "mm", "mm");
  for (const Past& each : past) {
    const auto& r = each.result;
    std::printf("%7lld  %-16s  %-5s  ", static_cast<long long>(each.session.id),
                date_time(r ? r->unix_ms : each.session.started_ms).c_str(),
                one_line(each.session.kind).c_str());
    if (!r) {
      std::printf("%-14s  %s\n", state_of(each).c_str(), one_line(each.session.reason).c_str());
      continue;
    }
    const bool full = each.session.kind != "check", failed = r->answer == ResultAnswer::failed;
    const auto figure = [&](bool known, double value) { return known ? mm(value) : "-"; };
    std::printf(
        "%-14s  %-11s  %8s %8s %8s  %7d %5d %4s\n", std::string(to_string(r->answer)).c_str(),
        std::string(to_string(r->decision)).c_str(), figure(!failed, r->check_before).c_str(),
        figure(!failed, r->check_after).c_str(),
        figure(full && !failed && std::isfinite(r->endpoint_sigma), r->endpoint_sigma).c_str(),
        r->touches, r->outliers, full ? std::to_string(r->identified).c_str() : "-");
  }
}

Result<void> print_slots(Store& store) {
  std::printf("\nSlots\n");
  std::string empty = "the factory's";
  for (const Slot slot : {Slot::active, Slot::previous, Slot::candidate}) {
    const auto record = store.slot(slot);
    const bool damaged = !record && !store.met().empty();
    if (!record && !damaged) return tl::unexpected(record.error());
    std::string text = damaged ? "damaged: a start of the service sets it aside" : empty;
    if (record && *record && (*record)->session > 0)
      text = "session " + std::to_string((*record)->session) + ", since " +
             date_time((*record)->since_ms);
    // Before the first accepted parameters were the factory's; before those there is nothing.
    if (!damaged && (!*record || slot == Slot::previous)) empty = "none";
    std::printf("  %-10s %s\n", std::string(to_string(slot)).c_str(), text.c_str());
  }
  return {};
}

/// What is damaged: as the service has found it at its starts, and what was met just now.
Result<void> print_damage(Store& store, std::FILE* out) {
  auto all = store.damage();
  if (!all) return tl::unexpected(all.error());
  std::set<std::string> noted;
  for (const DamageRecord& note : *all) noted.insert(note.what);
  for (const std::string& what : store.met())
    if (!noted.contains(what)) all->insert(all->begin(), {0, "", what, ""});
  if (!all->empty()) std::fprintf(out, "\nDamaged and not used, with the day it was found\n");
  for (const DamageRecord& each : *all)
    std::fprintf(out, "  %-16s  %s\n", each.unix_ms == 0 ? "now" : date_time(each.unix_ms).c_str(),
                 one_line(each.what).c_str());
  return {};
}

Result<void> print_events(Store& store, const HistoryArguments& arguments) {
  const auto events = store.events(arguments.newest);
  if (!events) return tl::unexpected(events.error());
  auto list = Json::array();
  for (const EventRecord& event : *events) {
    if (arguments.json)
      list.push_back({{"unix_ms", event.unix_ms}, {"level", event.level}, {"text", event.text}});
    else
      std::printf("%s %s  %-7s  %s\n", date_time(event.unix_ms).substr(0, 10).c_str(),
                  clock_time(event.unix_ms).c_str(), event.level.c_str(),
                  one_line(event.text).c_str());
  }
  if (arguments.json) std::printf("%s\n", line_of(list).c_str());
  return {};
}

Result<void> print_history(Store& store, const HistoryArguments& arguments) {
  const auto past = read_past(store, arguments.newest);
  if (!past) return tl::unexpected(past.error());
  if (arguments.json) {
    auto records = Json::array();
    for (const Past& each : *past) records.push_back(record_of(each));
    std::printf("%s\n", line_of(records).c_str());
    return print_damage(store, stderr);
  }
  if (past->empty())
    std::printf("No session yet.\n");
  else
    print_sessions(*past);
  const auto calibrations = read_calibrations(store);
  if (!calibrations) return tl::unexpected(calibrations.error());
  if (!calibrations->empty())
    std::printf(
        "\nDrift of the parameters that moved most: since the factory (since the one "
        "before)\n%s",
        drift_table(*calibrations, drifts(*calibrations, kDrifting)).c_str());
  if (auto printed = print_slots(store); !printed) return printed;
  return print_damage(store, stdout);
}

/// The accuracy that the newest readable session wants of the end position (m); 0 without one.
double wanted(const std::vector<Past>& past) {
  for (const Past& each : past)
    if (const auto meaning = read_decoding(each.session.config)) return meaning->target;
  return 0;
}

Result<void> write_report(Store& store, const HistoryArguments& arguments,
                          const StoreSource& source) {
  auto past = read_past(store, arguments.newest);
  if (!past) return tl::unexpected(past.error());
  auto calibrations = read_calibrations(store);
  if (!calibrations) return tl::unexpected(calibrations.error());
  auto events = store.events(arguments.newest);
  if (!events) return tl::unexpected(events.error());
  HistoryFindings findings{
      source.state.string(), std::move(*past), std::move(*calibrations), std::move(*events), 0,
      unix_now_ms()};
  if (!findings.calibrations.empty()) findings.robot = findings.calibrations.back().robot->name();
  findings.target = wanted(findings.sessions);
  return write_file_atomically(arguments.report, page_of(history_data(findings)));
}

bool is_check(Store& store, std::int64_t session) {
  const auto record = store.session(session);
  return record && record->kind == to_string(SessionKind::check);
}

Result<void> print_export(Store& store, const HistoryArguments& arguments,
                          const StoreSource& source) {
  const auto session = std::atoll(arguments.exported[0].c_str());
  const std::string& folder = arguments.exported[1];
  const auto rows = export_session(store, session, source.robot_text, folder);
  if (!rows) return tl::unexpected(rows.error());
  for (const std::string& what : store.met())
    if (what.ends_with(" of session " + std::to_string(session)))
      std::fprintf(stderr, "selfcal: %s is damaged and left out\n", what.c_str());
  if (arguments.json)
    std::printf("%s\n",
                line_of({{"session", session}, {"folder", folder}, {"rows", *rows}}).c_str());
  else
    std::printf(
        "%s: %s of session %lld%s\n", folder.c_str(), counted(*rows, "row").c_str(), session,
        is_check(store, session) ? ", a quick check: too few to calibrate by"
                                 : ("; solve them again by: selfcal identify " + folder).c_str());
  return {};
}

int history_command(const HistoryArguments& arguments) {
  if (!arguments.exported.empty()) {
    const std::string& id = arguments.exported[0];
    if (id.empty() || id.size() > 18 || id.find_first_not_of("0123456789") != std::string::npos)
      return wrong_usage("--export SESSION FOLDER: expected a session's number, got '" + id + "'");
  }
  const auto source = find_store(arguments.where);
  if (!source) return tell(source.error());
  const auto store = Store::open_to_read(source->state);
  if (!store) return tell(store.error());
  const auto done = !arguments.exported.empty() ? print_export(**store, arguments, *source)
                    : !arguments.report.empty() ? write_report(**store, arguments, *source)
                    : arguments.events          ? print_events(**store, arguments)
                                                : print_history(**store, arguments);
  return done ? kDone : tell(done.error());
}

}  // namespace

void add_history(CLI::App& app, int& status) {
  auto arguments = std::make_shared<HistoryArguments>();
  CLI::App* command = app.add_subcommand(
      "history", "Show past sessions, drift and slots; a service may be running");
  command->add_option("WHERE", arguments->where, kStoreIsWhere);
  CLI::Option* newest =
      command->add_option("--newest", arguments->newest, "So many sessions or events")
          ->check(CLI::Range(1, kAll))
          ->capture_default_str();
  CLI::Option* events =
      command->add_flag("--events", arguments->events, "The log of the service instead");
  CLI::Option* exported =
      command
          ->add_option("--export", arguments->exported,
                       "SESSION FOLDER: its rows as a data set, to be solved again")
          ->type_name("SESSION FOLDER")
          ->expected(2)
          ->excludes(newest)
          ->excludes(events);
  CLI::Option* json = command->add_flag("--json", arguments->json, "JSON for programs, SI units");
  command
      ->add_option("--report", arguments->report,
                   "FILE: drift, checks and events as a page to open in a browser")
      ->type_name("FILE")
      ->excludes(events)
      ->excludes(exported)
      ->excludes(json);
  command->callback([arguments, &status] { status = history_command(*arguments); });
}

}  // namespace selfcal
