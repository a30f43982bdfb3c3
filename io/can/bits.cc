#include "io/can/bits.h"

#include "kinematics/expects.h"

namespace selfcal {
namespace {

// Where the field's bit of weight 2^(bits - 1 - i) (big-endian) or 2^i (little-endian) stands.
int place(const BitField& field, int i) {
  if (!field.big_endian) return field.start + i;
  // Counted from the payload's first bit on the bus, the field's bits follow one another.
  const int on_bus = 8 * (field.start / 8) + (7 - field.start % 8) + i;
  return 8 * (on_bus / 8) + (7 - on_bus % 8);
}

int weight(const BitField& field, int i) { return field.big_endian ? field.bits - 1 - i : i; }

}  // namespace

BitField byte_field(int offset, int length, bool big_endian, bool is_signed) {
  return {.start = 8 * offset + (big_endian ? 7 : 0),
          .bits = 8 * length,
          .big_endian = big_endian,
          .is_signed = is_signed};
}

int bytes_of(const BitField& field) { return place(field, field.bits - 1) / 8 + 1; }

std::int64_t get_bits(const BitField& field, std::span<const std::uint8_t> payload) {
  expects(bytes_of(field) <= static_cast<int>(payload.size()), "the payload holds the field");
  std::uint64_t value = 0;
  for (int i = 0; i < field.bits; ++i) {
    const int bit = place(field, i);
    const std::uint64_t one = (payload[bit / 8] >> (bit % 8)) & 1u;
    value |= one << weight(field, i);
  }
  const std::uint64_t sign = std::uint64_t{1} << (field.bits - 1);
  if (field.is_signed && (value & sign) != 0) value |= ~(sign - 1);
  return static_cast<std::int64_t>(value);
}

void put_bits(const BitField& field, std::int64_t value, std::span<std::uint8_t> payload) {
  expects(bytes_of(field) <= static_cast<int>(payload.size()), "the payload holds the field");
  const auto bits = static_cast<std::uint64_t>(value);
  for (int i = 0; i < field.bits; ++i) {
    const int bit = place(field, i);
    const auto mask = static_cast<std::uint8_t>(1u << (bit % 8));
    if ((bits >> weight(field, i)) & 1u)
      payload[bit / 8] = static_cast<std::uint8_t>(payload[bit / 8] | mask);
    else
      payload[bit / 8] = static_cast<std::uint8_t>(payload[bit / 8] & ~mask);
  }
}

}  // namespace selfcal
