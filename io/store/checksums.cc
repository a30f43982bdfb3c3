#include "io/store/checksums.h"

#include <sqlite3.h>

#include <bit>
#include <charconv>
#include <string>
#include <tuple>

#include "io/files/file.h"

namespace selfcal {
namespace {

void put_number(std::string& out, std::uint64_t value) {
  for (int shift = 0; shift < 64; shift += 8) out += static_cast<char>((value >> shift) & 255);
}

std::string_view content_of(sqlite3_value* value) {
  const void* bytes = sqlite3_value_blob(value);  // before the size: SQLite may convert
  const auto size = static_cast<std::size_t>(sqlite3_value_bytes(value));
  return bytes == nullptr ? std::string_view()
                          : std::string_view(static_cast<const char*>(bytes), size);
}

/// The type, then the number, or the length and the bytes: no two lists of columns are alike.
void put_column(std::string& out, sqlite3_value* value) {
  const int type = sqlite3_value_type(value);
  out += static_cast<char>(type);
  switch (type) {
    case SQLITE_INTEGER:
      return put_number(out, static_cast<std::uint64_t>(sqlite3_value_int64(value)));
    case SQLITE_FLOAT:
      return put_number(out, std::bit_cast<std::uint64_t>(sqlite3_value_double(value)));
    case SQLITE_NULL:
      return;
    default:
      const std::string_view bytes = content_of(value);
      put_number(out, bytes.size());
      out += bytes;
  }
}

void checksum(sqlite3_context* context, int count, sqlite3_value** values) {
  std::string columns;
  for (int i = 0; i < count; ++i) put_column(columns, values[i]);
  const std::string hex = sha256_hex(columns);
  std::uint64_t first = 0;
  std::from_chars(hex.data(), hex.data() + 12, first, 16);
  // With its sign from the top bit, SQLite keeps it in 6 bytes.
  sqlite3_result_int64(context, static_cast<sqlite3_int64>(first << 16) >> 16);
}

void sha256(sqlite3_context* context, int, sqlite3_value** values) {
  if (sqlite3_value_type(values[0]) == SQLITE_NULL) return sqlite3_result_null(context);
  const std::string hex = sha256_hex(content_of(values[0]));
  sqlite3_result_text(context, hex.data(), static_cast<int>(hex.size()), SQLITE_TRANSIENT);
}

}  // namespace

Result<void> add_checksum_functions(sqlite3* database) {
  constexpr int kFlags = SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_DIRECTONLY;
  for (const auto& [name, count, function] :
       {std::tuple{"selfcal_checksum", -1, &checksum}, std::tuple{"selfcal_sha256", 1, &sha256}}) {
    if (sqlite3_create_function_v2(database, name, count, kFlags, nullptr, function, nullptr,
                                   nullptr, nullptr) != SQLITE_OK) {
      return sqlite::failure(database);
    }
  }
  return {};
}

Result<void> put_checksum(sqlite3* database, const Verified& table, sqlite::Value key) {
  const std::string sql = std::string("UPDATE ") + table.table +
                          " SET checksum = " + table.checksum + " WHERE " + table.key + " = ?1";
  if (auto put = sqlite::run(database, sql.c_str(), {key}); !put) {
    return tl::unexpected(put.error());
  }
  return {};
}

}  // namespace selfcal
