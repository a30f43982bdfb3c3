// All that a store gives back, as one text, so that two of them can be compared; and a store with
// something in every table.
#pragma once

#include <sqlite3.h>

#include <sstream>

#include "io/files/file.h"
#include "tests/io/store_records.h"

namespace selfcal {

inline constexpr const char* kRobotText =
    "robot: arm\nframes:\n  - {name: base, joint: fixed, r: 0.499}\n";

/// Runs SQL on the file itself, as other hands would.
inline void with_sqlite(const std::filesystem::path& path, const std::string& sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  sqlite3_exec(database, "PRAGMA ignore_check_constraints = ON", nullptr, nullptr, nullptr);
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(database);
  sqlite3_close(database);
}

/// A session whose robot becomes the candidate.
inline std::int64_t session_with_robot(Store& store, const std::string& robot, int steps = 6) {
  const std::int64_t id = store.begin(some_session(), some_plan(steps, 6)).value();
  for (int i = 0; i < steps; ++i) {
    TouchRecord touch = some_touch(i, 6, static_cast<std::uint64_t>(id));
    if (i == 2) touch.outcome = TouchOutcome::outlier, touch.why = "no edge within 2 s";
    EXPECT_TRUE(store.add(id, touch).has_value());
  }
  ResultRecord result = some_result(id);
  result.robot_text = robot;
  const SlotRecord candidate = candidate_of(result);
  EXPECT_TRUE(store.finish(result, &candidate).has_value());
  return id;
}

/// Sessions 1 (previous) and 2 (active, 0.499 m), 3 (candidate), 4 (unfinished); events; texts.
inline void fill(Store& store) {
  session_with_robot(store, "robot: arm\nframes:\n  - {name: base, joint: fixed, r: 0.501}\n");
  EXPECT_TRUE(store.accept(1'790'000'001'000).has_value());
  session_with_robot(store, kRobotText);
  EXPECT_TRUE(store.accept(1'790'000'002'000).has_value());
  session_with_robot(store, "robot: arm\nframes:\n  - {name: base, joint: fixed, r: 0.498}\n");
  const std::int64_t open = store.begin(some_session(), some_plan(6, 6)).value();
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(store.add(open, some_touch(i, 6)).has_value());
  for (int i = 0; i < 12; ++i) {
    EXPECT_TRUE(store.add(EventRecord{0, 100 + i, "info", "event " + std::to_string(i)}));
  }
  EXPECT_TRUE(store.remember("held", "yes").has_value());
  EXPECT_TRUE(store.remember("use", "12.5 1790000000000 3 21.5 4").has_value());
}

inline void put(std::ostream& out, const SessionRecord& s) {
  out << "session " << s.id << '|' << s.kind << '|' << s.reason << '|' << s.model_hash << '|'
      << s.config_hash << '|' << s.config << '|' << s.seed << '|' << static_cast<int>(s.state)
      << '|' << s.started_ms << '|' << s.ended_ms << '|' << s.steps << '\n';
}

inline void put(std::ostream& out, const StepRecord& s) {
  out << "step " << s.index << '|' << s.set << '|' << s.group << '|' << s.check << s.via_home;
  for (const std::vector<double>* q : {&s.start, &s.touch, &s.end}) {
    for (const double each : *q) out << ' ' << std::bit_cast<std::uint64_t>(each);
  }
  for (const std::vector<double>& q : s.way)
    for (const double each : q) out << ' ' << std::bit_cast<std::uint64_t>(each);
  out << '\n';
}

inline void put(std::ostream& out, const TouchRecord& t) {
  out << "touch " << t.step << '|' << t.attempt << '|' << static_cast<int>(t.outcome) << '|'
      << t.why << '|' << t.unix_ms << '|' << t.edge << '|'
      << std::bit_cast<std::uint64_t>(t.temperature);
  for (const EncoderSample& sample : {t.before, t.after}) {
    out << '|' << sample.time << ' ' << sample.joints;
    for (const std::int64_t count : sample.counts) out << ' ' << count;
  }
  out << '\n';
}

inline void put(std::ostream& out, const ResultRecord& r) {
  out << "result " << r.session << '|' << r.unix_ms << '|' << to_string(r.answer) << '|'
      << to_string(r.decision) << '|' << r.why;
  for (const double each : {r.p_value, r.check_before, r.check_after, r.endpoint_sigma}) {
    out << '|' << std::bit_cast<std::uint64_t>(each);
  }
  out << '|' << r.touches << '|' << r.outliers << '|' << r.identified << '|' << r.json << '|'
      << r.robot_text << '\n';
}

/// Everything; what cannot be read stands there as a failure.
inline std::string content_of(Store& store) {
  std::ostringstream out;
  const auto each = [&](const auto& result, const auto& write) {
    if (result) {
      write(*result);
    } else {
      out << "failed: " << result.error().what << '\n';
    }
  };
  const auto list = [&](const auto& records) {
    for (const auto& record : records) put(out, record);
  };
  for (std::int64_t id = 1; id <= 6; ++id) {
    each(store.session(id), [&](const auto& s) { put(out, s); });
    each(store.plan(id), list);
    each(store.touches(id), list);
    each(store.result(id), [&](const auto& r) {
      if (r) put(out, *r);
    });
  }
  each(store.sessions(100), list);
  each(store.results(100), list);
  each(store.unfinished(), [&](const auto& s) {
    if (s) out << "unfinished " << s->id << '\n';
  });
  for (const Slot slot : {Slot::active, Slot::previous, Slot::candidate}) {
    each(store.slot(slot), [&](const auto& s) {
      out << to_string(slot);
      if (s)
        out << ' ' << s->session << '|' << s->since_ms << '|' << s->model_hash << '|'
            << s->robot_text;
      out << '\n';
    });
  }
  each(store.events(100), [&](const auto& events) {
    for (const EventRecord& e : events) {
      out << "event " << e.id << '|' << e.unix_ms << '|' << e.level << '|' << e.text << '\n';
    }
  });
  for (const char* name : {"held", "use"}) {
    each(store.remembered(name),
         [&](const std::string& text) { out << name << '=' << text << '\n'; });
  }
  return out.str();
}

}  // namespace selfcal
