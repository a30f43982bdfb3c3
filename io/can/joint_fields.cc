// The fields of one joint's entry.

#include "io/can/joint_fields.h"

#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

namespace selfcal {
namespace {

// CiA 301: the predefined ids of the four TPDOs of node N.
constexpr std::array<std::uint32_t, 4> kTpdo = {0x180, 0x280, 0x380, 0x480};

std::optional<std::uint32_t> parse_id(std::string_view text) {
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  if (hex) text.remove_prefix(2);
  std::uint32_t id = 0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), id, hex ? 16 : 10);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return id;
}

std::int64_t whole(Fields& f, std::string_view key, std::int64_t fallback, double least,
                   double most) {
  const double number = f.number(key, static_cast<double>(fallback), least, most);
  if (number == std::floor(number)) return static_cast<std::int64_t>(number);
  f.fail(key, "a whole number");
  return fallback;
}

void read_plain(Fields& f, CanJoint& joint) {
  joint.id = read_can_id(f, {});
  const std::string endian = f.text("endian", "little");
  if (endian != "little" && endian != "big") f.fail("endian", "little or big");
  const bool is_signed = f.flag("signed", true), big = endian == "big";
  if (!f.has("bit")) {
    const int byte = f.integer("byte", 0, 0, 63), length = f.integer("length", 4, 1, 8);
    joint.field = byte_field(byte, length, big, is_signed);
    return;
  }
  for (const char* key : {"byte", "length"})
    if (f.has(key)) f.fail(key, "only without 'bit'");
  if (!f.has("bits")) f.fail("bits", "a whole number from 1 to 64");
  joint.field = {.start = f.integer("bit", 0, 0, 511),
                 .bits = f.integer("bits", 1, 1, 64),
                 .big_endian = big,
                 .is_signed = is_signed};
}

void read_cia402(const Node& node, const std::string& what, CanJoint& joint, Problems& problems) {
  Fields f(node, what + " cia402", problems);
  if (!f.has("node")) f.fail("node", "a whole number from 1 to 127");
  const int id = f.integer("node", 1, 1, 127), tpdo = f.integer("tpdo", 1, 1, 4);
  joint.id = {.value = kTpdo[tpdo - 1] + static_cast<std::uint32_t>(id), .extended = false};
  // CiA 402: 0x6064 is an INTEGER32, and CANopen is little-endian.
  joint.field = byte_field(f.integer("byte", 0, 0, 4), 4, false, true);
  f.refuse_unknown();
}

/// What the DBC says of the joint; null, with a problem, when it cannot be used.
const DbcSignal* read_signal(Fields& f, const Dbc* dbc, CanJoint& joint) {
  const std::string message_name = f.text("message"), signal_name = f.text("signal");
  if (!dbc) {
    f.fail("message", "a file in 'dbc'");
    return nullptr;
  }
  const DbcMessage* message = dbc->find(message_name);
  if (!message) {
    f.fail("message", "a message of " + dbc->file);
    return nullptr;
  }
  const DbcSignal* signal = find(*message, signal_name);
  const std::string there = dbc->file + ":" + std::to_string(signal ? signal->line : message->line);
  if (!signal) f.fail("signal", "a signal of " + message_name + " (" + there + ")");
  if (signal && signal->multiplexed)
    f.fail("signal", "one that is not multiplexed (" + there + ")");
  if (signal && signal->floating)
    f.fail("signal", "an integer, not floating point (" + there + ")");
  if (!signal) return nullptr;
  joint.id = message->id;
  joint.field = signal->field;
  joint.fd = joint.fd || message->bytes > 8;
  return signal;
}

constexpr double kFinestCount = 1e-15, kCoarsestCount = 1e3;  // rad or m for a count
constexpr double kMostCounts = 0x1p52;                        // that a double holds exactly

/// What one turn behind the gear moves the joint by (rad or m).
double turn(Fields& f, Quantity quantity, bool counts) {
  const bool turns = quantity == Quantity::angle;
  if (turns && f.has("pitch")) f.fail("pitch", "no pitch of a joint that turns");
  if (!turns && counts && !f.has("pitch"))
    f.fail("pitch", "of a joint that slides the metres for one turn");
  return turns ? 2 * std::numbers::pi : f.positive("pitch", 1);
}

double read_step(Fields& f, const DbcSignal* signal, Quantity quantity) {
  const double gear = f.positive("gear", 1);
  const std::string unit = signal ? f.text("unit") : "counts";
  const double per_turn = turn(f, quantity, unit == "counts");
  const double factor = signal ? signal->factor : 1;
  const bool turns = quantity == Quantity::angle;
  if (unit == (turns ? "rad" : "m")) return factor / gear;
  if (turns && unit == "deg") return factor * std::numbers::pi / 180 / gear;
  if (!turns && unit == "mm") return factor * 1e-3 / gear;
  if (unit != "counts")
    f.fail("unit", turns ? "deg, rad or counts, for the joint turns"
                         : "m, mm or counts, for the joint slides");
  if (!f.has("counts_per_turn")) f.fail("counts_per_turn", "a positive number");
  return factor * per_turn / (f.positive("counts_per_turn", 1) * gear);
}

void read_decoding(Fields& f, const DbcSignal* signal, Quantity quantity, CanJoint& joint) {
  const int sign = f.integer("sign", 1, -1, 1);
  if (sign == 0) f.fail("sign", "1 or -1");
  const double step = read_step(f, signal, quantity);
  if (!(std::abs(step) >= kFinestCount && std::abs(step) <= kCoarsestCount))
    f.fail(signal ? "signal" : "counts_per_turn", "a count of 1e-15 to 1000 rad or m");
  joint.scale.step = step * (sign < 0 ? -1 : 1);
  joint.scale.zero = whole(f, "zero", 0, -kMostCounts, kMostCounts);
  // physical = raw * factor + offset is nothing at raw = -offset / factor. Half a count is lost
  // where that is no whole number: a shift of the zero, which calibration finds.
  const double at_zero = signal ? -signal->offset / signal->factor : 0;
  if (!(std::abs(at_zero) <= kMostCounts))
    f.fail("signal", "an offset of at most 2^52 counts");
  else
    joint.scale.zero += std::llround(at_zero);
  joint.wraps_at = f.has("wraps_at") ? whole(f, "wraps_at", 2, 2, 0x1p48) : 0;
  if (static_cast<double>(joint.wraps_at) > std::ldexp(1.0, joint.field.bits))
    f.fail("wraps_at", "at most what its bits can count");
  joint.most_speed = f.number("speed", joint.most_speed, 1e-3, 1e4);
}

}  // namespace

CanId read_can_id(Fields& fields, CanId fallback) {
  CanId id = fallback;
  id.extended = fields.flag("extended", fallback.extended);
  const std::uint32_t most = id.extended ? CanId::kMostExtended : CanId::kMostStandard;
  const auto value = fields.has("id") ? parse_id(fields.text("id", "")) : fallback.value;
  if (value && *value <= most)
    id.value = *value;
  else
    fields.fail("id", "a CAN id of at most " + to_string({most, id.extended}));
  return id;
}

CanJoint read_can_joint(const Node& node, const std::string& name, Quantity quantity,
                        const Dbc* dbc, bool& cia402, Problems& problems) {
  CanJoint joint;
  joint.name = name;
  Fields f(node, "joint " + name, problems);
  joint.fd = f.flag("fd", false);
  const DbcSignal* signal = nullptr;
  const Node* ready = f.node("cia402");
  const bool plain = f.has("id"), named = f.has("message") || f.has("signal");
  if (plain + named + (ready != nullptr) != 1)
    problems.add(node.place, f.what() + ": expected one of 'id', 'cia402' and 'message'");
  else if (ready)
    read_cia402(*ready, f.what(), joint, problems);
  else if (named)
    signal = read_signal(f, dbc, joint);
  else
    read_plain(f, joint);
  cia402 = cia402 || ready;
  // Without its signal nothing can be said of what its counts mean.
  if (problems.any()) return joint;
  read_decoding(f, signal, quantity, joint);
  f.refuse_unknown();
  return joint;
}

}  // namespace selfcal
