// Encoders from a topic of joint states.
//
// counts = round(position / step), step = 1e-9 rad or m: a nanoradian, 2 nm at 2 m, far below what
// any encoder tells apart.

#include "io/dds/encoders.h"

#include <cmath>

#include "io/dds/convert.h"
#include "io/dds/names.h"

namespace selfcal {
namespace {

// Beyond this many rad or m no robot goes, and no count overflows.
constexpr double kFarthest = 1e6;

}  // namespace

Result<std::unique_ptr<DdsEncoders>> DdsEncoders::open(const DdsParticipant& participant,
                                                       DdsEncodersConfig config,
                                                       std::shared_ptr<TimeMapping> mapping) {
  if (config.joints.empty() || config.joints.size() > kMostJoints)
    return bad_input("there must be 1 to " + std::to_string(kMostJoints) + " joints in topic " +
                     config.topic);
  auto reader =
      DdsReader<dds::JointState>::open(participant, ros_topic(config.topic), kSensorReader);
  if (!reader) return tl::make_unexpected(reader.error());
  return std::unique_ptr<DdsEncoders>(
      new DdsEncoders(std::move(config.joints), std::move(mapping), *std::move(reader)));
}

DdsEncoders::DdsEncoders(std::vector<std::string> joints, std::shared_ptr<TimeMapping> mapping,
                         DdsReader<dds::JointState> reader)
    : joints_(std::move(joints)),
      places_(joints_.size(), 0),
      scales_(joints_.size(), {.step = kStep, .zero = 0}),
      mapping_(std::move(mapping)),
      reader_(std::move(reader)) {}

Result<void> DdsEncoders::take(std::vector<EncoderSample>& out) {
  const auto first = static_cast<std::ptrdiff_t>(out.size());
  writer_.look(reader_);
  auto taken =
      reader_.take(kMostSamples, [&](const dds::JointState& state, dds_instance_handle_t writer) {
        if (!writer_.believes(writer, reader_)) return;
        EncoderSample sample;
        const auto lack = read(state, sample);
        if (!lack) {
          out.push_back(sample);
          in_a_row_ = 0;
          return;
        }
        lack_ = *lack;
        ++incomplete_;
        ++in_a_row_;
      });
  if (!taken) return taken;
  if (out.begin() + first == out.end()) return {};
  if (mapping_->observe(out.back().time, reader_.newest_arrival())) {
    stepped_ += out.size() - static_cast<std::size_t>(first) - 1;
    out.erase(out.begin() + first, out.end() - 1);
  }
  for (auto sample = out.begin() + first; sample != out.end(); ++sample)
    sample->time = *mapping_->ours(sample->time);
  return {};
}

std::string DdsEncoders::trouble() const {
  if (in_a_row_ == 0) return {};
  const bool one = in_a_row_ == 1;
  const std::string last = one ? "the last message" : "the last messages";
  const std::string& joint = joints_[lack_.joint];
  if (lack_.named) return last + (one ? " has" : " have") + " no position of joint " + joint;
  return last + (one ? " lacks" : " lack") + " joint " + joint;
}

// The sample with the sender's stamp, or what the message lacks.
std::optional<DdsEncoders::Lack> DdsEncoders::read(const dds::JointState& state,
                                                   EncoderSample& sample) {
  sample.time = nanoseconds(state.header_.stamp_);
  sample.joints = static_cast<int>(joints_.size());
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    if (!find(joint, state)) return Lack{joint, false};
    const std::uint32_t place = places_[joint];
    if (place >= state.position_._length) return Lack{joint, true};
    const double position = state.position_._buffer[place];
    if (!(std::abs(position) < kFarthest)) return Lack{joint, true};
    sample.counts[joint] = std::llround(position / kStep);
  }
  return std::nullopt;
}

// Where the joint stands in the message: nearly always where it stood in the last one.
bool DdsEncoders::find(std::size_t joint, const dds::JointState& state) {
  const std::uint32_t size = state.name_._length;
  std::uint32_t& place = places_[joint];
  if (place < size && joints_[joint] == state.name_._buffer[place]) return true;
  for (place = 0; place < size; ++place)
    if (joints_[joint] == state.name_._buffer[place]) return true;
  return false;
}

}  // namespace selfcal
