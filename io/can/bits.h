// Numbers among the bits of a payload, in the way of DBC files.
//
// Bit 8 i + k is bit k (0: least significant) of byte i. A little-endian (Intel) field of n bits
// starts at its least significant bit and goes up. A big-endian (Motorola) one starts at its most
// significant bit, goes down to bit 0 of that byte and on at bit 7 of the next.
#pragma once

#include <cstdint>
#include <span>

namespace selfcal {

struct BitField {
  int start = 0;
  int bits = 32;  ///< 1 to 64
  bool big_endian = false;
  bool is_signed = true;
};

/// `length` whole bytes from byte `offset`.
BitField byte_field(int offset, int length, bool big_endian, bool is_signed);

/// Bytes that a payload must have to hold the field.
int bytes_of(const BitField& field);

/// The field's number; an unsigned one of 64 bits keeps its bits. The payload must hold the field.
std::int64_t get_bits(const BitField& field, std::span<const std::uint8_t> payload);

/// Writes the lowest bits of `value` and leaves all others. The payload must hold the field.
void put_bits(const BitField& field, std::int64_t value, std::span<std::uint8_t> payload);

}  // namespace selfcal
