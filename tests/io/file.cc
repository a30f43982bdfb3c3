// Whole files: atomic writes leave the old content or the new, and nothing else.
#include "io/files/file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>

#include "tests/io/scratch.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

std::size_t entries(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
  return count;
}

TEST(File, ReadsBackWhatWasWrittenAndLeavesNothingElse) {
  const Scratch scratch;
  const std::filesystem::path path = scratch.folder() / "result.json";
  const std::string text = std::string(200000, 'x') + '\0' + "end";
  ASSERT_TRUE(write_file_atomically(path, "old").has_value());
  ASSERT_TRUE(write_file_atomically(path, text).has_value());
  EXPECT_EQ(read_file(path, 1 << 20).value(), text);
  EXPECT_EQ(entries(scratch.folder()), 1u);
}

TEST(File, WritesBesideWhatAProcessOfTheSameNumberLeftWhenItWasKilled) {
  const Scratch scratch;
  const std::filesystem::path path = scratch.folder() / "active.yaml";
  const std::string of_this = ".active.yaml." + std::to_string(getpid()) + ".";
  for (int count = 0; count < 40; ++count)
    scratch.write(of_this + std::to_string(count) + ".new", "half of i");
  ASSERT_TRUE(write_file_atomically(path, "whole").has_value());
  EXPECT_EQ(read_file(path, 10).value(), "whole");
  EXPECT_EQ(entries(scratch.folder()), 41u);
}

TEST(File, ReadsAnEmptyFile) {
  const Scratch scratch;
  EXPECT_EQ(read_file(scratch.write("empty", ""), 10).value(), "");
}

TEST(File, RefusesAtOnceWhatIsNoFile) {
  const Scratch scratch;
  const std::filesystem::path pipe = scratch.folder() / "rows.csv";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(read_file(pipe, 10).error().what,
              HasSubstr("rows.csv: expected a file, got a named pipe"));
  EXPECT_THAT(read_file("/dev/zero", 10).error().what, HasSubstr("expected a file, got a device"));
  EXPECT_THAT(read_file(scratch.folder(), 10).error().what, HasSubstr("got a folder"));
  EXPECT_EQ(read_file("/dev/null", 10).value(), "");
}

TEST(File, ReadsTheEndOfAPipeThatItWasGiven) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  ASSERT_EQ(write(ends[1], "rows", 4), 4);
  close(ends[1]);
  EXPECT_EQ(read_file("/dev/fd/" + std::to_string(ends[0]), 10).value(), "rows");
  close(ends[0]);
}

TEST(File, RefusesAFileAboveTheLimitOnly) {
  const Scratch scratch;
  const std::filesystem::path path = scratch.write("ten", "0123456789");
  EXPECT_TRUE(read_file(path, 10).has_value());
  const auto read = read_file(path, 9);
  ASSERT_FALSE(read.has_value());
  EXPECT_EQ(read.error().exit_status, kBadInput);
  EXPECT_THAT(read.error().what, HasSubstr("ten: longer than 9 bytes"));
}

TEST(File, WriteIntoAMissingFolderFailsWithItsName) {
  const Scratch scratch;
  const auto written = write_file_atomically(scratch.folder() / "none" / "a", "text");
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().exit_status, kDeviceFailed);
  EXPECT_THAT(written.error().what, HasSubstr("none/a: cannot be written: No such file"));
}

TEST(File, WriteOverAFolderFailsAndLeavesNothingBehind) {
  const Scratch scratch;
  std::filesystem::create_directory(scratch.folder() / "taken");
  EXPECT_FALSE(write_file_atomically(scratch.folder() / "taken", "text").has_value());
  EXPECT_FALSE(write_file_atomically(scratch.folder() / "", "text").has_value());
  EXPECT_EQ(entries(scratch.folder()), 1u);
}

TEST(File, KeepsTheOldContentWhenTheDiskTakesNoMore) {
  const Scratch scratch;
  const std::filesystem::path path = scratch.write("result.json", "old");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{1000, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);

  const auto written = write_file_atomically(path, std::string(5000, 'x'));

  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(written.has_value());
  EXPECT_THAT(written.error().what, HasSubstr("result.json: cannot be written: File too large"));
  EXPECT_EQ(read_file(path, 100).value(), "old");
  EXPECT_EQ(entries(scratch.folder()), 1u);
}

// FIPS 180-4, examples of SHA-256.
TEST(Sha256, GivesThePublishedDigests) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

}  // namespace
}  // namespace selfcal
