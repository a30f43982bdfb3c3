// The layouts of packing.h, written and read byte by byte: no byte order of the machine enters.
#include "io/store/packing.h"

#include <algorithm>
#include <bit>
#include <map>

namespace selfcal {
namespace {

constexpr std::uint64_t kMostPlaces = 64;  // that a way leads through
constexpr std::uint64_t kSlow = 512, kLoaded = 1024;

void put_u(std::string& out, std::uint64_t value) {
  for (; value >= 128; value >>= 7) out += static_cast<char>((value & 127) | 128);
  out += static_cast<char>(value);
}

void put_z(std::string& out, std::int64_t value) {
  const auto sign = static_cast<std::uint64_t>(value >> 63);
  put_u(out, (static_cast<std::uint64_t>(value) << 1) ^ sign);
}

void put_d(std::string& out, double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  for (int shift = 0; shift < 64; shift += 8) out += static_cast<char>((bits >> shift) & 255);
}

std::int64_t minus(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

std::int64_t plus(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

/// Reads what the put functions wrote; once something does not fit, `good` is false and all that
/// follows is zero.
struct PackedReader {
  std::string_view rest;
  bool good = true;

  std::uint8_t byte() {
    if (rest.empty()) {
      good = false;
      return 0;
    }
    const auto value = static_cast<std::uint8_t>(rest.front());
    rest.remove_prefix(1);
    return value;
  }

  std::uint64_t u() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const std::uint8_t next = byte();
      value |= static_cast<std::uint64_t>(next & 127) << shift;
      if (next < 128) return value;
    }
    good = false;
    return 0;
  }

  std::int64_t z() {
    const std::uint64_t value = u();
    return static_cast<std::int64_t>((value >> 1) ^ (0 - (value & 1)));
  }

  double d() {
    std::uint64_t bits = 0;
    for (int shift = 0; shift < 64; shift += 8) bits |= static_cast<std::uint64_t>(byte()) << shift;
    return std::bit_cast<double>(bits);
  }

  /// A number of things of which each takes at least `least` bytes of the rest.
  std::size_t size(std::size_t least) {
    const std::uint64_t value = u();
    if (value <= rest.size() / least) return value;
    good = false;
    return 0;
  }

  std::string s() {
    const std::size_t length = size(1);
    std::string text(rest.substr(0, length));
    rest.remove_prefix(length);
    return text;
  }

  int joints() {
    const std::uint64_t value = u();
    if (value > kMostJoints) good = false;
    return good ? static_cast<int>(value) : 0;
  }

  bool at_end() const { return good && rest.empty(); }
};

void put_counts(std::string& out, const EncoderSample& sample, const EncoderSample& base) {
  const auto joints = static_cast<std::size_t>(std::clamp(sample.joints, 0, kMostJoints));
  put_u(out, joints);
  for (std::size_t i = 0; i < joints; ++i) put_z(out, minus(sample.counts[i], base.counts[i]));
}

void get_counts(PackedReader& in, EncoderSample& sample, const EncoderSample& base) {
  sample.joints = in.joints();
  for (std::size_t i = 0; i < static_cast<std::size_t>(sample.joints); ++i) {
    sample.counts[i] = plus(in.z(), base.counts[i]);
  }
}

void put_q(std::string& out, const std::vector<double>& q) {
  put_u(out, q.size());
  for (const double reading : q) put_d(out, reading);
}

void get_q(PackedReader& in, std::vector<double>& q) {
  q.resize(in.size(8));
  for (double& reading : q) reading = in.d();
}

/// `sample` without the counts that do not count.
EncoderSample tidy(const EncoderSample& sample) {
  EncoderSample base;
  const int joints = std::clamp(sample.joints, 0, kMostJoints);
  std::copy_n(sample.counts.begin(), joints, base.counts.begin());
  return base;
}

}  // namespace

std::string pack_stamps(const TouchRecord& touch) {
  std::string out;
  put_z(out, touch.before.time);
  put_z(out, minus(touch.edge, touch.before.time));
  put_z(out, minus(touch.after.time, touch.before.time));
  put_counts(out, touch.before, EncoderSample{});
  put_counts(out, touch.after, tidy(touch.before));
  return out;
}

bool unpack_stamps(std::string_view packed, TouchRecord& touch) {
  PackedReader in{packed};
  touch.before = touch.after = EncoderSample{};
  touch.before.time = in.z();
  touch.edge = plus(in.z(), touch.before.time);
  touch.after.time = plus(in.z(), touch.before.time);
  get_counts(in, touch.before, EncoderSample{});
  get_counts(in, touch.after, touch.before);
  return in.at_end();
}

std::string pack_labels(const std::vector<StepRecord>& plan) {
  std::map<std::string_view, std::size_t> places;
  std::vector<std::string_view> names;
  const auto place = [&](std::string_view name) {
    const auto [found, fresh] = places.try_emplace(name, names.size());
    if (fresh) names.push_back(name);
    return found->second;
  };
  std::string steps;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    put_u(steps, place(plan[i].set));
    put_u(steps, place(plan[i].group));
    put_u(steps, (plan[i].check ? 1U : 0U) + (plan[i].via_home ? 2U : 0U) + 4 * plan[i].way.size() +
                     (plan[i].slow ? kSlow : 0U) + (plan[i].loaded ? kLoaded : 0U));
    put_z(steps, plan[i].index - static_cast<std::int64_t>(i));
  }
  std::string out;
  put_u(out, plan.size());
  put_u(out, names.size());
  for (const std::string_view name : names) {
    put_u(out, name.size());
    out += name;
  }
  return out + steps;
}

bool unpack_labels(std::string_view packed, std::vector<StepRecord>& plan) {
  PackedReader in{packed};
  plan.assign(in.size(4), {});
  std::vector<std::string> names(in.size(1));
  for (std::string& name : names) name = in.s();
  std::int64_t place = 0;
  for (StepRecord& step : plan) {
    const std::uint64_t set = in.u();
    const std::uint64_t group = in.u();
    const std::uint64_t flags = in.u();
    if (!in.good || set >= names.size() || group >= names.size()) return false;
    step.set = names[set];
    step.group = names[group];
    step.check = (flags & 1) != 0;
    step.via_home = (flags & 2) != 0;
    step.slow = (flags & kSlow) != 0;
    step.loaded = (flags & kLoaded) != 0;
    const std::uint64_t places = (flags & ~(kSlow | kLoaded)) / 4;
    if (places > kMostPlaces) return false;
    step.way.resize(places);
    step.index = static_cast<int>(plus(in.z(), place++));
  }
  return in.at_end();
}

std::string pack_postures(const std::vector<StepRecord>& plan) {
  std::string out;
  for (const StepRecord& step : plan) {
    for (const std::vector<double>* q : {&step.start, &step.touch, &step.end}) put_q(out, *q);
    for (const std::vector<double>& q : step.way) put_q(out, q);
  }
  return out;
}

bool unpack_postures(std::string_view packed, std::vector<StepRecord>& plan) {
  PackedReader in{packed};
  for (StepRecord& step : plan) {
    for (std::vector<double>* q : {&step.start, &step.touch, &step.end}) get_q(in, *q);
    for (std::vector<double>& q : step.way) get_q(in, q);
  }
  return in.at_end();
}

}  // namespace selfcal
