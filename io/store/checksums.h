// Every row of the store carries a checksum over its table's name and all its columns, its key
// among them: a digit, a byte or a reference that changes by other hands than this program's shows
// when the row is read.
//
//   checksum    the first 6 bytes of the SHA-256 of the columns, each with its type and length; of
//               touches, of which there will be a million, the first 4
//   a text      counts by its own hash, a full SHA-256, in the rows that refer to it
//
// SQL reads it by two functions of every connection, selfcal_checksum(…) and selfcal_sha256(body).
// The expressions below stand in version 2 of the schema: a later one that changes a table copies
// them there first.
#pragma once

#include <cstdint>
#include <string_view>

#include "io/result.h"
#include "io/store/sqlite.h"

#define SELFCAL_HASH_OF(id) "(SELECT hash FROM text WHERE text.id = " id ")"

#define SELFCAL_SESSION_CHECKSUM \
  "selfcal_checksum('session', session.id, session.kind, session.reason,"                    \
  " session.model_hash, session.config_hash, " SELFCAL_HASH_OF("session.config")             \
  ", session.seed, session.state, session.started_ms, session.ended_ms, session.steps)"
#define SELFCAL_PLAN_CHECKSUM "selfcal_checksum('plan', plan.session, plan.labels)"
#define SELFCAL_POSTURE_CHECKSUM "selfcal_checksum('posture', posture.session, posture.postures)"
#define SELFCAL_TOUCH_CHECKSUM                                                                \
  "(selfcal_checksum('touch', touch.id, touch.step, touch.attempt, touch.outcome, touch.why," \
  " touch.unix_ms, touch.temperature, touch.stamps) >> 16)"
#define SELFCAL_RESULT_CHECKSUM                                                                   \
  "selfcal_checksum('result', result.session, result.unix_ms, result.answer,"                     \
  " result.decision, result.why, result.p_value, result.check_before, result.check_after,"        \
  " result.endpoint_sigma, result.touches, result.rejected, result.identified, " SELFCAL_HASH_OF( \
      "result.robot") ")"
#define SELFCAL_JSON_CHECKSUM "selfcal_checksum('json', json.session, json.body)"
#define SELFCAL_SLOT_CHECKSUM_AS(slot) \
  "selfcal_checksum('slot', " slot     \
  ", slot.session, slot.since_ms, slot.model_hash, " SELFCAL_HASH_OF("slot.robot") ")"
#define SELFCAL_SLOT_CHECKSUM SELFCAL_SLOT_CHECKSUM_AS("slot.slot")
#define SELFCAL_EVENT_CHECKSUM \
  "selfcal_checksum('event', event.id, event.unix_ms, event.level, event.text)"
#define SELFCAL_REMEMBERED_CHECKSUM \
  "selfcal_checksum('remembered', remembered.name, remembered.text)"
#define SELFCAL_DAMAGE_CHECKSUM \
  "selfcal_checksum('damage', damage.id, damage.unix_ms, damage.place, damage.what, damage.row)"
#define SELFCAL_CHANGE_CHECKSUM_AS(number) "selfcal_checksum('change', change.id, " number ")"
#define SELFCAL_CHANGE_CHECKSUM SELFCAL_CHANGE_CHECKSUM_AS("change.number")

// NULL for a sound row; of a damaged one, what a person calls it.
#define SELFCAL_DAMAGED(sound, name) "iif(" sound ", NULL, " name ")"

#define SELFCAL_DAMAGED_TEXT                                                         \
  SELFCAL_DAMAGED("text.hash IS selfcal_sha256(text.body)",                          \
                  "'text ' || text.id || coalesce(' (the robot of session ' ||"      \
                  " (SELECT min(session) FROM result WHERE robot = text.id) || ')'," \
                  " ' (the configuration of session ' ||"                            \
                  " (SELECT min(id) FROM session WHERE config = text.id) || ')', '')")
#define SELFCAL_DAMAGED_SESSION \
  SELFCAL_DAMAGED("session.checksum IS " SELFCAL_SESSION_CHECKSUM, "'session ' || session.id")
#define SELFCAL_DAMAGED_PLAN                                 \
  SELFCAL_DAMAGED("plan.checksum IS " SELFCAL_PLAN_CHECKSUM, \
                  "'the plan of session ' || plan.session")
#define SELFCAL_DAMAGED_POSTURE                                    \
  SELFCAL_DAMAGED("posture.checksum IS " SELFCAL_POSTURE_CHECKSUM, \
                  "'the postures of session ' || posture.session")
#define SELFCAL_DAMAGED_TOUCH                                  \
  SELFCAL_DAMAGED("touch.checksum IS " SELFCAL_TOUCH_CHECKSUM, \
                  "'touch ' || (touch.id & 1048575) || ' of session ' || (touch.id >> 20)")
#define SELFCAL_DAMAGED_RESULT                                   \
  SELFCAL_DAMAGED("result.checksum IS " SELFCAL_RESULT_CHECKSUM, \
                  "'the result of session ' || result.session")
#define SELFCAL_DAMAGED_JSON                                 \
  SELFCAL_DAMAGED("json.checksum IS " SELFCAL_JSON_CHECKSUM, \
                  "'result.json of session ' || json.session")
// A slot is as sound as its text.
#define SELFCAL_DAMAGED_SLOT                                                       \
  SELFCAL_DAMAGED("slot.slot < 3 AND slot.checksum IS " SELFCAL_SLOT_CHECKSUM      \
                  " AND (SELECT hash IS selfcal_sha256(body) FROM text"            \
                  " WHERE text.id = slot.robot)",                                  \
                  "CASE slot.slot WHEN 0 THEN 'the active parameters' WHEN 1 THEN" \
                  " 'the previous parameters' WHEN 2 THEN 'the candidate' ELSE"    \
                  " 'slot ' || slot.slot END || ' (' ||"                           \
                  " coalesce('session ' || slot.session, 'the factory''s') || ')'")
#define SELFCAL_DAMAGED_EVENT \
  SELFCAL_DAMAGED("event.checksum IS " SELFCAL_EVENT_CHECKSUM, "'event ' || event.id")
#define SELFCAL_DAMAGED_REMEMBERED                                       \
  SELFCAL_DAMAGED("remembered.checksum IS " SELFCAL_REMEMBERED_CHECKSUM, \
                  "'what is remembered as ' || remembered.name")
#define SELFCAL_DAMAGED_DAMAGE \
  SELFCAL_DAMAGED("damage.checksum IS " SELFCAL_DAMAGE_CHECKSUM, "'note ' || damage.id")
#define SELFCAL_DAMAGED_CHANGE \
  SELFCAL_DAMAGED("change.checksum IS " SELFCAL_CHANGE_CHECKSUM, "'the number of changes'")

namespace selfcal {

/// Makes selfcal_checksum and selfcal_sha256 known to a connection.
Result<void> add_checksum_functions(sqlite3* database);

/// A table whose rows are verified.
struct Verified {
  const char* table;
  const char* key;       ///< its column
  const char* checksum;  ///< SQL: what the row's must be; null where a column is a hash already
  const char* damaged;   ///< SQL: SELFCAL_DAMAGED_…
};

inline constexpr Verified kTexts{"text", "id", nullptr, SELFCAL_DAMAGED_TEXT};
inline constexpr Verified kSessions{"session", "id", SELFCAL_SESSION_CHECKSUM,
                                    SELFCAL_DAMAGED_SESSION};
inline constexpr Verified kPlans{"plan", "session", SELFCAL_PLAN_CHECKSUM, SELFCAL_DAMAGED_PLAN};
inline constexpr Verified kPostures{"posture", "session", SELFCAL_POSTURE_CHECKSUM,
                                    SELFCAL_DAMAGED_POSTURE};
inline constexpr Verified kTouches{"touch", "id", SELFCAL_TOUCH_CHECKSUM, SELFCAL_DAMAGED_TOUCH};
inline constexpr Verified kResults{"result", "session", SELFCAL_RESULT_CHECKSUM,
                                   SELFCAL_DAMAGED_RESULT};
inline constexpr Verified kJsons{"json", "session", SELFCAL_JSON_CHECKSUM, SELFCAL_DAMAGED_JSON};
inline constexpr Verified kSlots{"slot", "slot", SELFCAL_SLOT_CHECKSUM, SELFCAL_DAMAGED_SLOT};
inline constexpr Verified kEvents{"event", "id", SELFCAL_EVENT_CHECKSUM, SELFCAL_DAMAGED_EVENT};
inline constexpr Verified kRemembered{"remembered", "name", SELFCAL_REMEMBERED_CHECKSUM,
                                      SELFCAL_DAMAGED_REMEMBERED};
inline constexpr Verified kDamage{"damage", "id", SELFCAL_DAMAGE_CHECKSUM, SELFCAL_DAMAGED_DAMAGE};
inline constexpr Verified kChanges{"change", "id", SELFCAL_CHANGE_CHECKSUM, SELFCAL_DAMAGED_CHANGE};

/// All of them, a table after those that it refers to.
inline constexpr Verified kVerified[] = {kTexts,   kSessions,   kPlans,  kPostures,
                                         kTouches, kResults,    kJsons,  kSlots,
                                         kEvents,  kRemembered, kDamage, kChanges};

/// Puts the checksum of a row that was just written.
Result<void> put_checksum(sqlite3* database, const Verified& table, sqlite::Value key);

}  // namespace selfcal
