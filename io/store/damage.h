// What was found damaged: noted once with the day, so that it is known a year later; and what
// becomes of it.
//
//   slot       leaves its table (its columns stay in the note); the previous parameters take the
//              place of active ones that are damaged
//   session    that is unfinished and lacks its plan or configuration is ended
//   any other  stays where it is, for a person, and no function returns it
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/result.h"
#include "io/store/checksums.h"
#include "io/store/store.h"

namespace selfcal {

/// The notes, newest first.
Result<std::vector<DamageRecord>> notes_of_damage(sqlite3* database);

/// What is damaged in a table, as a person calls it; no more than a thousand rows and one.
Result<std::vector<std::string>> damaged_rows(sqlite3* database, const Verified& table);

/// Adds a note; within the caller's transaction.
Result<void> note_damage(sqlite3* database, const DamageRecord& found);

/// Takes damaged rows out of the slots, notes them, and lets a sound previous one take the place of
/// a damaged active one; within the caller's transaction. Returns what was found.
Result<std::vector<std::string>> set_slots_aside(sqlite3* database, std::int64_t unix_ms);

/// Looks at every row, in one transaction, and does what is said above. Returns what had not been
/// noted before, in a sentence that may be empty.
Result<std::string> look_over(sqlite3* database, std::int64_t unix_ms);

}  // namespace selfcal
