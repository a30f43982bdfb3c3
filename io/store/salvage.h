// What can still be read of a damaged store.
#pragma once

#include <cstdint>

#include "io/result.h"

struct sqlite3;

namespace selfcal {

/// Copies to `fresh`, a store without rows, every row of `damaged` that can be read and whose
/// checksum holds, in one transaction; rows of slots whether it holds or not, for what becomes of
/// those is for look_over to say. Returns their number; a store without checksums has none.
Result<std::int64_t> salvage(sqlite3* damaged, sqlite3* fresh);

}  // namespace selfcal
