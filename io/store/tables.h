// What the parts of the store share: texts kept once, and sessions that must exist.
#pragma once

#include <cstdint>
#include <string_view>

#include "io/result.h"

struct sqlite3;

namespace selfcal {

/// The id of a text in the table of texts, where it is put when it is not there.
Result<std::int64_t> keep_text(sqlite3* database, std::string_view body);

/// Fails when there is no such session.
Result<void> require_session(sqlite3* database, std::int64_t session);

}  // namespace selfcal
