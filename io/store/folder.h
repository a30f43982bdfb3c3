// The store's files in its folder: made whole under another name, set aside, and missed when they
// are gone.
//
// A new store gets its name once it is on the disk, and beside it lies from then on selfcal.made:
// so a store of 0 bytes, or none beside that file, is one that was lost, never a new one. That file
// also has the number of changes that the store has had, written after each and not synced: it is
// never ahead of a store that is whole, and tells of one that has lost its log or is an older copy.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "io/result.h"

namespace selfcal {

std::filesystem::path store_in(const std::filesystem::path& folder);
/// Where the next store is made.
std::filesystem::path unnamed_store_in(const std::filesystem::path& folder);

/// Whether there is a file that may be a store: SQLite takes a shorter one for an empty database.
bool has_store(const std::filesystem::path& folder);
/// Whether a store was made here before.
bool had_store(const std::filesystem::path& folder);
/// What has happened to a store that was there; empty where none was or it is still there.
std::string lost_store(const std::filesystem::path& folder);

/// Renames what there is of the store and its log to the first free damaged-N; that name, or none
/// where there was nothing.
Result<std::string> set_store_aside(const std::filesystem::path& folder);
/// Gives the store that was made its name.
Result<void> name_store(const std::filesystem::path& folder);
/// Removes what a power cut has left of one that was being made.
void remove_unnamed_store(const std::filesystem::path& folder);

/// Makes the folder the state of the robot of that name: its file robot.id says so from then on.
/// True where it had a store and nobody's name so far. Bad input where it is another one's.
Result<bool> own_folder(const std::filesystem::path& folder, const std::string& robot);
/// The same failure without making it anybody's.
Result<void> may_own_folder(const std::filesystem::path& folder, const std::string& robot);

/// selfcal.made, open to be written.
class StoreMark {
 public:
  /// Makes it where it is not there yet; it is on the disk then.
  static Result<std::unique_ptr<StoreMark>> open(const std::filesystem::path& folder);
  StoreMark(const StoreMark&) = delete;
  StoreMark& operator=(const StoreMark&) = delete;
  ~StoreMark();

  void put(std::int64_t changes) const;

 private:
  explicit StoreMark(int file) : file_(file) {}
  int file_;
};

/// The number of changes that the mark has; 0 where there is none that can be read.
std::int64_t marked_changes(const std::filesystem::path& folder);

}  // namespace selfcal
