// Messages and signals of a DBC file: the subset that says where a number stands in a payload.
//
//   BO_ ID NAME: BYTES SENDER                      bit 31 of ID: extended
//    SG_ NAME : START|BITS@ORDER SIGN (FACTOR,OFFSET) [MIN|MAX] "UNIT" RECEIVERS
//   SIG_VALTYPE_ ID NAME : TYPE;                   floating point: refused when asked for
//
// ORDER 1 is little-endian (Intel), 0 big-endian (Motorola); SIGN + or -. All other lines say
// nothing about where numbers stand and are passed over.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/can/bits.h"
#include "io/can/frame.h"
#include "io/result.h"

namespace selfcal {

/// physical = raw * factor + offset
struct DbcSignal {
  std::string name;
  BitField field;
  double factor = 1, offset = 0;
  bool multiplexed = false;  ///< stands in the frame only at times
  bool floating = false;     ///< an IEEE number, not an integer
  std::string unit;
  int line = 0;
};

struct DbcMessage {
  std::string name;
  CanId id;
  int bytes = 0;
  std::vector<DbcSignal> signals;
  int line = 0;
};

struct Dbc {
  std::string file;
  std::vector<DbcMessage> messages;
  const DbcMessage* find(std::string_view name) const;
};
const DbcSignal* find(const DbcMessage& message, std::string_view name);

/// Refuses, with the line, what cannot be read and signals that reach beyond their payload.
Result<Dbc> parse_dbc(std::string_view text, const std::string& file);
Result<Dbc> read_dbc(const std::filesystem::path& path);

}  // namespace selfcal
