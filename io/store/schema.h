// The tables of the store and the way from each older version to the newest.
#pragma once

#include <span>
#include <string_view>

#include "io/result.h"

struct sqlite3;

namespace selfcal {

/// Statements that make version N + 1 of a store of version N, where N is the place in the list.
using Migration = std::string_view;

/// The store's own list; its length is the version that this program writes.
std::span<const Migration> migrations();

/// The version of the file: PRAGMA user_version, 0 for an empty one.
Result<int> version(sqlite3* database);

/// Whether the file has the columns and references that its version has: the text of the schema is
/// a row like any other, and may be damaged.
Result<bool> has_its_columns(sqlite3* database);

/// Brings the file from its version to the end of `list` in one transaction, so that a failure
/// leaves it as it was. Fails on a version beyond the list, of a newer program.
Result<void> migrate(sqlite3* database, std::span<const Migration> list);

}  // namespace selfcal
