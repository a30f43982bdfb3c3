// What the parts of the store share: texts kept once, and sessions that must exist.
#pragma once

#include <cstdint>
#include <string_view>

#include "io/store/store.h"

namespace selfcal {

/// The id of a text in the table of texts, where it is put when it is not there. One that is there
/// and damaged is whole again then.
Result<std::int64_t> keep_text(sqlite3* database, std::string_view body);

/// Within the caller's transaction.
Result<void> put_remembered(sqlite3* database, const Remembered& kept);

/// That there is no such session, and which there are: bad input.
tl::unexpected<Failure> no_session(sqlite3* database, std::int64_t session);
/// Fails when there is no such session; it may be damaged.
Result<void> require_session(sqlite3* database, std::int64_t session);
/// Fails when there is none, or it is damaged.
Result<void> require_sound_session(sqlite3* database, std::int64_t session);

/// Within the caller's transaction; fails as require_sound_session.
Result<void> set_session_state(sqlite3* database, std::int64_t session, SessionState state,
                               std::int64_t ended_ms);

/// Sets the decision of a session's result, if it has one that is sound, and adds to its `why`.
Result<void> set_decision(sqlite3* database, std::int64_t session, ResultDecision decision,
                          std::string_view why = {});

}  // namespace selfcal
