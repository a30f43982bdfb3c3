// selfcal_generate MESSAGES OUT: writes OUT/PACKAGE/msg/NAME.idl for every
// MESSAGES/PACKAGE/NAME.msg and OUT/selfcal_messages/types.h. A tool of the build, not installed.

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "io/dds/generate/interface_text.h"

namespace {

using selfcal::Result;

Result<void> write_file(const std::filesystem::path& path, const std::string& text) {
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) return selfcal::device_failed(path.string() + ": cannot be written");
  return {};
}

Result<void> generate(const std::string& messages, const std::filesystem::path& out) {
  const auto all = selfcal::generate::read_messages(messages);
  if (!all) return tl::make_unexpected(all.error());
  for (const auto& [name, message] : *all) {
    const auto path = out / message.package / "msg" / (message.name + ".idl");
    if (auto done = write_file(path, selfcal::generate::idl_text(message)); !done) return done;
  }
  const auto header = selfcal::generate::header_text(*all);
  if (!header) return tl::make_unexpected(header.error());
  return write_file(out / "selfcal_messages" / "types.h", *header);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: selfcal_generate MESSAGES OUT\n", stderr);
    return 2;
  }
  const auto done = generate(argv[1], argv[2]);
  if (done) return 0;
  std::fprintf(stderr, "selfcal_generate: %s\n", done.error().what.c_str());
  return done.error().exit_status;
}
