// What a diagnosis asks to be measured next, as `plan --separate` reads it.
#include "app/commands/support/separating_rows.h"

#include "tests/fuzz/given.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace selfcal;
  const auto rows =
      read_separating_rows(given_folder().write("diagnosis.json", text_of(data, size)).string());
  if (rows) (void)separating_report(*rows);
  return 0;
}
