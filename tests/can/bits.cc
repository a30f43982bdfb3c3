// Numbers among the bits of a payload: bytes worked out by hand or published.
#include "io/can/bits.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

namespace selfcal {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(Bits, ReadWholeBytesInEitherOrder) {
  const Bytes payload = {0x37, 0x06, 0x78, 0x56, 0x34, 0x12, 0xff, 0xfe};
  EXPECT_EQ(get_bits(byte_field(2, 4, false, true), payload), 0x12345678);
  EXPECT_EQ(get_bits(byte_field(2, 4, true, true), payload), 0x78563412);
  EXPECT_EQ(get_bits(byte_field(6, 2, true, true), payload), -2);
  EXPECT_EQ(get_bits(byte_field(6, 2, true, false), payload), 0xfffe);
  EXPECT_EQ(get_bits(byte_field(6, 2, false, true), payload), -257);  // 0xfeff
  EXPECT_EQ(get_bits(byte_field(0, 1, false, false), payload), 0x37);
}

TEST(Bits, ReadThreeBytesWithTheirSign) {
  const Bytes payload = {0x01, 0x00, 0x80};
  EXPECT_EQ(get_bits(byte_field(0, 3, false, true), payload), 0x800001 - 0x1000000);
  EXPECT_EQ(get_bits(byte_field(0, 3, false, false), payload), 0x800001);
}

TEST(Bits, KeepAllOfEightBytes) {
  const Bytes payload = {0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07, 0x88};
  const auto little = static_cast<std::int64_t>(0x8807060504030201u);
  EXPECT_EQ(get_bits(byte_field(0, 8, false, true), payload), little);
  EXPECT_EQ(get_bits(byte_field(0, 8, false, false), payload), little);
  EXPECT_EQ(get_bits(byte_field(0, 8, true, true), payload), 0x0102030405060788);
}

// cantools' motohawk.dbc and its documented payloads: Temperature : 0|12@0- (0.01,250),
// AverageRadius : 6|6@0+ (0.1,0), Enable : 7|1@0+ (1,0).
TEST(Bits, ReadThePublishedMotorolaExample) {
  const BitField temperature = {0, 12, true, true};
  const BitField radius = {6, 6, true, false}, enable = {7, 1, true, false};
  const Bytes first = {0xc0, 0x06, 0xe0, 0, 0, 0, 0, 0};
  const Bytes second = {0xc0, 0x01, 0x40, 0, 0, 0, 0, 0};
  EXPECT_EQ(get_bits(temperature, first), 55);   // 250.55
  EXPECT_EQ(get_bits(temperature, second), 10);  // 250.10
  EXPECT_EQ(get_bits(radius, first), 32);        // 3.2
  EXPECT_EQ(get_bits(enable, first), 1);

  Bytes written(8, 0);
  put_bits(temperature, 55, written);
  put_bits(radius, 32, written);
  put_bits(enable, 1, written);
  EXPECT_EQ(written, first);
}

TEST(Bits, ReadANegativeMotorolaNumberOverAByteBoundary) {
  // 12 bits from bit 0 of byte 0: its lowest bit, byte 1, the upper three of byte 2.
  // -3 = 0xffd = 1 11111111 101.
  const Bytes payload = {0x01, 0xff, 0xa0};
  EXPECT_EQ(get_bits({0, 12, true, true}, payload), -3);
}

TEST(Bits, ReadAnIntelNumberOverAByteBoundary) {
  // 10 bits from bit 6: the upper two of byte 0 are the lowest. 0b1010101011 = 683.
  const Bytes payload = {0xc0, 0xaa};
  EXPECT_EQ(get_bits({6, 10, false, false}, payload), 0b1010101011);
}

TEST(Bits, CountTheBytesTheyNeed) {
  EXPECT_EQ(bytes_of(byte_field(2, 4, false, true)), 6);
  EXPECT_EQ(bytes_of(byte_field(2, 4, true, true)), 6);
  EXPECT_EQ(bytes_of({6, 10, false, false}), 2);
  EXPECT_EQ(bytes_of({0, 12, true, true}), 3);
  EXPECT_EQ(bytes_of({7, 8, true, true}), 1);
}

TEST(Bits, ReadBackWhatWasWrittenAndLeaveTheRest) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 20000; ++i) {
    BitField field;
    field.bits = static_cast<int>(random() % 64) + 1;
    field.start = static_cast<int>(random() % 512);
    field.big_endian = random() % 2 == 0;
    field.is_signed = random() % 2 == 0;
    if (bytes_of(field) > 64) continue;
    std::array<std::uint8_t, 64> payload{};
    for (auto& byte : payload) byte = static_cast<std::uint8_t>(random());
    const auto before = payload;
    const std::int64_t old = get_bits(field, payload);
    put_bits(field, static_cast<std::int64_t>(random()), payload);
    const std::int64_t value = get_bits(field, payload);
    put_bits(field, value, payload);
    ASSERT_EQ(get_bits(field, payload), value);
    put_bits(field, old, payload);
    ASSERT_EQ(payload, before);
  }
}

}  // namespace
}  // namespace selfcal
