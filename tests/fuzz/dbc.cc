// A DBC file. Every signal of what is accepted can be read from its frame and written into it.
#include "io/can/dbc.h"

#include "tests/fuzz/given.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace selfcal;
  const auto dbc = parse_dbc(text_of(data, size), "given.dbc");
  if (!dbc) {
    promise(!dbc.error().what.empty(), "refused without a word");
    return 0;
  }
  for (const DbcMessage& message : dbc->messages) {
    promise(message.bytes >= 0 && message.bytes <= 64, "no frame is of so many bytes");
    std::vector<std::uint8_t> payload(static_cast<std::size_t>(message.bytes), 0xa5);
    for (const DbcSignal& signal : message.signals) {
      if (message.bytes == 0) continue;  // of no frame
      promise(bytes_of(signal.field) <= message.bytes, "a signal beyond its payload");
      promise(std::isfinite(signal.factor) && std::isfinite(signal.offset), "a scale not finite");
      const std::int64_t value = get_bits(signal.field, payload);
      put_bits(signal.field, value, payload);
      promise(get_bits(signal.field, payload) == value, "a signal that reads back otherwise");
    }
  }
  return 0;
}
