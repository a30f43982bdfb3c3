// What is stored with a session is the description of a data set and what the raw counts mean;
// dataset.yaml is the former. It is written last: a folder without it is no data set.
#include "app/commands/support/session_export.h"

#include <algorithm>
#include <system_error>

#include "app/report/format.h"
#include "app/service/session/cause_search.h"
#include "app/service/session/session_rows.h"
#include "io/files/file.h"
#include "io/files/observations_text.h"
#include "io/files/robot_file.h"
#include "io/files/yaml.h"

namespace selfcal {
namespace {

namespace fs = std::filesystem;

std::string session_name(std::int64_t session) { return "session " + std::to_string(session); }

Result<void> make_empty_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) &&
      (!fs::is_directory(folder, error) || !fs::is_empty(folder, error)))
    return bad_input(folder.string() + ": is not an empty folder: choose a new one");
  return make_folder(folder);
}

/// The file of the robot that the session measured, as its maker gives it.
Result<std::string> nominal_text(Store& store, const SessionRecord& record,
                                 const std::string& given) {
  const auto result = store.result(record.id);
  if (!result && given.empty()) return tl::unexpected(result.error());
  const bool stored = result && *result && !(*result)->robot_text.empty();
  if (!stored && given.empty())
    return bad_input(session_name(record.id) +
                     ": no robot is stored with it (it is a check, or came to no result): give "
                     "CONFIG.yaml in place of the state's folder");
  const auto robot = robot_of(stored ? (*result)->robot_text : given, session_name(record.id));
  if (!robot) return tl::unexpected(robot.error());
  if (model_hash(**robot) != record.model_hash)
    return bad_input(session_name(record.id) + ": measured another robot than this one");
  return robot_text(**robot, nominal_values(**robot));
}

/// With entries of the later engagements of locks, which share the method of their first.
Node with_engagements(Node entries, const std::vector<Set>& sets) {
  for (const Set& set : sets) {
    if (entries.find(set.name)) continue;
    const Node* first = entries.find(std::ranges::find(sets, set.method, &Set::method)->name);
    if (first) entries.set(set.name, Node(*first));
  }
  return entries;
}

/// dataset.yaml of a stored description.
Result<std::string> description_text(const SessionRecord& record, const std::vector<Set>& sets) {
  const Result<Node> stored = parse_yaml(record.config, session_name(record.id));
  if (!stored) return tl::unexpected(stored.error());
  Node node = Node::map();
  node.set("robot", Node::of(std::string("robot.yaml")));
  node.set("observations", Node::of(std::string("observations.csv")));
  for (const char* key : {"target", "workspace", "sets"})
    if (const Node* value = stored->find(key))
      node.set(key, key == std::string("sets") ? with_engagements(*value, sets) : *value);
  return "# Session " + std::to_string(record.id) + " (" + record.kind + "), begun " +
         date_time(record.started_ms) + ".\n" + write_yaml(node);
}

Result<Session> stored_session(Store& store, const SessionRecord& record) {
  auto plan = store.plan(record.id);
  if (!plan) return tl::unexpected(plan.error());
  auto touches = store.touches(record.id);
  if (!touches) return tl::unexpected(touches.error());
  Session session{record, std::move(*plan), std::move(*touches)};
  // A cause may be found without any touch.
  if (session.kind() == SessionKind::cause) return session;
  for (const StepRecord& step : session.plan)
    if (!good_touches(session, step.index).empty()) return session;
  return bad_input(session_name(record.id) +
                   ": has no rows (none were taken, or they were pruned)");
}

}  // namespace

Result<SessionRows> session_rows(Store& store, std::int64_t session,
                                 const std::string& robot_text) {
  const auto record = store.session(session);
  if (!record) return tl::unexpected(record.error());
  const auto kept = stored_session(store, *record);
  if (!kept) return tl::unexpected(kept.error());
  const auto meaning = read_decoding(record->config);
  if (!meaning) return tl::unexpected(meaning.error());
  const auto base = record->kind == to_string(SessionKind::cause)
                        ? base_of_cause(store, record->model_hash, record->config_hash, session)
                        : std::nullopt;
  auto robot_file = nominal_text(store, base.value_or(*record), robot_text);
  if (!robot_file) return tl::unexpected(robot_file.error());
  auto robot = robot_of(*robot_file, session_name(session));
  if (!robot) return tl::unexpected(robot.error());
  DataSet data = rows_of(**robot, *kept, *meaning);
  if (base) {
    const auto full = stored_session(store, *base);
    if (!full) return tl::unexpected(full.error());
    const DataSet before = rows_of(**robot, *full, *meaning);
    data = data.rows.rows() > 0 ? merged(before, data) : before;
  }
  return SessionRows{*record, *std::move(robot_file), *std::move(robot), std::move(data)};
}

Result<int> export_session(Store& store, std::int64_t session, const std::string& robot_text,
                           const fs::path& folder) {
  const auto rows = session_rows(store, session, robot_text);
  if (!rows) return tl::unexpected(rows.error());
  const auto description = description_text(rows->record, rows->data.sets);
  if (!description) return tl::unexpected(description.error());
  if (auto made = make_empty_folder(folder); !made) return tl::unexpected(made.error());
  const std::pair<const char*, std::string> files[] = {
      {"robot.yaml", rows->robot_text},
      {"observations.csv", observations_text(rows->data)},
      {"dataset.yaml", *description}};
  for (const auto& [name, text] : files)
    if (auto written = write_file_atomically(folder / name, text); !written)
      return tl::unexpected(written.error());
  return rows->data.rows.rows();
}

}  // namespace selfcal
