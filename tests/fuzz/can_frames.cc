// Frames of a CAN bus to samples: settings and a DBC file as text, then the frames as bytes, parted
// by
// =====.
#include <algorithm>

#include "io/can/assembler.h"
#include "io/can/settings.h"
#include "io/files/yaml.h"
#include "tests/fuzz/bytes.h"
#include "tests/fuzz/given.h"

namespace selfcal {
namespace {

/// The joints under `joints`: those that have a pitch slide.
std::vector<Joint> joints_of(const Node& settings) {
  const Node* entries = settings.find("joints");
  if (!entries || entries->keys.empty()) return {{.name = "a", .quantity = Quantity::angle}};
  std::vector<Joint> joints;
  for (std::size_t j = 0; j < entries->keys.size() && j < kMostJoints; ++j)
    joints.push_back(
        {.name = entries->keys[j],
         .quantity = entries->items[j].find("pitch") ? Quantity::length : Quantity::angle});
  return joints;
}

/// `raw` is what a counter that begins anew, or a field of so many bits, has of `count`.
bool is_same_count(const CanJoint& joint, std::int64_t raw, std::int64_t count) {
  if (const std::int64_t turn = joint.wraps_at; turn > 0)
    return (raw % turn + turn) % turn == (count % turn + turn) % turn;
  const int over = 64 - joint.field.bits;
  const auto up = static_cast<std::uint64_t>(count) << over;
  return raw == (joint.field.is_signed ? static_cast<std::int64_t>(up) >> over
                                       : static_cast<std::int64_t>(up >> over));
}

void expect_meaning(const CanMap& map) {
  for (const CanJoint& joint : map.joints) {
    const EncoderScale& scale = joint.scale;
    promise(std::isfinite(scale.step) && scale.step != 0, "joint " + joint.name + ": no step");
    promise(std::abs(static_cast<double>(scale.zero)) <= 0x1p53,
            "joint " + joint.name + ": no zero");
  }
}

void expect_round_trip(const CanMap& map, const std::vector<std::int64_t>& counts) {
  for (const CanMessage& message : map.messages) {
    const CanFrame frame = encode(map, message, counts);
    promise(well_formed(message, frame), "its own frame is malformed");
    if (message.joints.size() > 1) continue;  // fields may overlap
    const auto joint = static_cast<std::size_t>(message.joints.front());
    promise(is_same_count(map.joints[joint], raw_counts(map.joints[joint], frame), counts[joint]),
            "a count reads back otherwise");
  }
}

/// The next frame and the time (ns) since the one before.
CanFrame next_frame(Bytes& bytes, const CanMap& map, Nanoseconds& t) {
  const std::uint8_t kind = bytes.byte();
  t += bytes.take<std::int16_t>() * (kind & 0x80 ? kMillisecond : 10'000);
  CanFrame frame;
  if ((kind & 7) == 0 && map.sync) {
    frame.id = *map.sync;
  } else if ((kind & 7) == 1) {
    frame.id.value = bytes.take<std::uint32_t>() & CanId::kMostExtended;
    frame.id.extended = (kind & 8) != 0;
    frame.error = (kind & 16) != 0;
    frame.size = static_cast<std::uint8_t>(bytes.below(9));
    for (std::size_t i = 0; i < 8; ++i) frame.data[i] = bytes.byte();
  } else {
    const auto count = static_cast<int>(map.messages.size());
    const CanMessage& message = map.messages[static_cast<std::size_t>(bytes.below(count))];
    std::vector<std::int64_t> counts(map.joints.size(), bytes.take<std::int32_t>());
    if (kind & 8) counts.assign(counts.size(), bytes.take<std::int64_t>());
    frame = encode(map, message, counts);
    if (kind & 16) frame.size = static_cast<std::uint8_t>(bytes.below(frame.size + 1));
    if (kind & 32) frame.fd = !frame.fd;
  }
  frame.stamp = t;
  if (kind & 64) frame.lost = bytes.byte();
  return frame;
}

void run_frames(const CanSettings& settings, Bytes bytes) {
  CanFaults faults("can0");
  CanAssembler assembler(settings.map, settings.timing, faults);
  std::vector<EncoderSample> samples;
  Nanoseconds t = 100 * kSecond;
  while (!bytes.empty()) {
    const CanFrame frame = next_frame(bytes, settings.map, t);
    if (frame.error)
      faults.note_error_frame(frame, t);
    else if (frame.lost > 0)
      assembler.interrupt();
    else
      assembler.add(frame, t, samples);
    promise(faults.trouble(t).size() < 10'000, "trouble without end");
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    promise(samples[i].joints == static_cast<int>(settings.map.joints.size()), "a partial sample");
    promise(i == 0 || !samples[i].follows || samples[i].time > samples[i - 1].time,
            "a sample follows one that is not before it");
  }
}

void try_bus(std::string_view input) {
  const auto parts = parts_of(input, 3);
  given_folder().write("given.dbc", parts[1]);
  const auto node = parse_yaml(parts[0], "given.yaml");
  if (!node) return;
  Problems problems;
  const CanSettings settings =
      read_can_settings(*node, joints_of(*node), given_folder().path(), problems);
  if (problems.any()) return;
  expect_meaning(settings.map);
  Bytes bytes(reinterpret_cast<const std::uint8_t*>(parts[2].data()), parts[2].size());
  std::vector<std::int64_t> counts;
  for (const CanJoint& joint : settings.map.joints)
    counts.push_back(counts_of(joint.scale, bytes.number()));
  expect_round_trip(settings.map, counts);
  run_frames(settings, bytes);
}

}  // namespace
}  // namespace selfcal

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  selfcal::try_bus(selfcal::text_of(data, size));
  return 0;
}
